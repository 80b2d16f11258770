//! Sets of functions.

use super::UnknownFunction;
use super::table::Function;

/// A set of [functions](Function); the default is all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Functions(u64);

impl Functions {
    /// Every function.
    pub const ALL: Functions = Functions((1 << Function::ALL.len()) - 1);

    /// These functions.
    ///
    /// ```
    /// use redysim_runtime::{Function, Functions};
    ///
    /// let functions = Functions::of([Function::InverseDynamics, Function::MassMatrix]);
    /// assert!(functions.contains(Function::MassMatrix) && !functions.contains(Function::Energy));
    /// ```
    pub fn of(functions: impl IntoIterator<Item = Function>) -> Functions {
        Functions(functions.into_iter().fold(0, |set, function| set | Functions::bit(function)))
    }

    /// The functions of these names.
    ///
    /// # Errors
    ///
    /// If a name is not that of a function.
    pub fn named<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Functions, UnknownFunction> {
        names.into_iter().try_fold(Functions(0), |set, name| Ok(Functions(set.0 | Functions::bit(name.parse()?))))
    }

    /// The same but for `function`.
    pub fn without(self, function: Function) -> Functions {
        Functions(self.0 & !Functions::bit(function))
    }

    /// Those of them that a mechanism with this many frames of interest has: without frames, none of those that need
    /// frames.
    pub fn with_frames(self, frames: usize) -> Functions {
        self.unless(frames == 0, Function::needs_frames)
    }

    /// Those of them that a mechanism with this many closed loops has: without loops, none of those that need loops.
    pub fn with_loops(self, loops: usize) -> Functions {
        self.unless(loops == 0, Function::needs_loops)
    }

    /// Those of them that a mechanism has of which some joints have an actuator and some do not, if `some` is true and
    /// it has no loops; else none of those that need that.
    pub fn with_passive_joints(self, some: bool) -> Functions {
        self.unless(!some, Function::needs_passive_joints)
    }

    /// Without those for which `needs` holds, if what they need is `missing`.
    fn unless(self, missing: bool, needs: impl Fn(Function) -> bool) -> Functions {
        self.iter().filter(|&function| missing && needs(function)).fold(self, Functions::without)
    }

    /// Whether `function` is among them.
    pub const fn contains(self, function: Function) -> bool {
        self.0 & Functions::bit(function) != 0
    }

    /// The functions, in the order of [`Function::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Function> {
        Function::ALL.iter().copied().filter(move |&function| self.contains(function))
    }

    const fn bit(function: Function) -> u64 {
        1 << function as u64
    }
}

impl Default for Functions {
    fn default() -> Self {
        Functions::ALL
    }
}
