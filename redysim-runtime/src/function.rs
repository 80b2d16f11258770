//! The functions that a mechanism can have: one table, which code generation, the macro, the command and documentation
//! read.

use crate::operations::OperationCount;
use core::fmt;
use core::ops::Index;
use core::str::FromStr;

/// What a function takes and returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The trait that has it.
    pub interface: Interface,
    /// Its arguments, in order.
    pub arguments: &'static [Argument],
    /// What it returns.
    pub result: Shape,
    /// What it computes, with formula and units.
    pub summary: &'static str,
}

/// The trait that has a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// A trait of this name that has the function alone.
    Own(&'static str),
    /// A trait of this name that has the function and its tangent, the derivative in a direction.
    WithTangent(&'static str),
    /// The trait `LoopClosure`, of mechanisms with closed loops.
    LoopClosure,
}

/// An argument: its name, and how long the array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Joint coordinates `q`, rad or m.
    Coordinates,
    /// Joint velocities `v`, rad/s or m/s.
    Velocities,
    /// Joint accelerations `a`, rad/s² or m/s².
    Accelerations,
    /// Joint forces `tau`, N m or N.
    Forces,
}

impl Argument {
    /// Its name in generated code.
    pub const fn name(self) -> &'static str {
        match self {
            Argument::Coordinates => "q",
            Argument::Velocities => "v",
            Argument::Accelerations => "a",
            Argument::Forces => "tau",
        }
    }

    /// Number of its elements.
    pub const fn dimension(self) -> Dimension {
        match self {
            Argument::Coordinates => Dimension::Coordinates,
            Argument::Velocities | Argument::Accelerations | Argument::Forces => Dimension::Velocities,
        }
    }
}

/// A size of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Joint coordinates, NQ.
    Coordinates,
    /// Joint velocities, NV.
    Velocities,
    /// Links, NL.
    Links,
    /// Rows of the loop constraints, NC.
    LoopRows,
}

/// What a function returns, and so in what order its values stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Joint forces, `[S; NV]`.
    Forces,
    /// Joint accelerations, `[S; NV]`.
    Accelerations,
    /// The generalised inertia matrix, `[[S; NV]; NV]`, by rows.
    MassMatrix,
    /// `Energy<S>`: kinetic, potential.
    Energy,
    /// `CenterOfMass<S>`: position, velocity.
    CenterOfMass,
    /// `[LinkState<S>; NL]`: rotation by rows, origin, centre of mass, velocity, angular velocity.
    Links,
    /// Rows of the loop constraints, `[S; NC]`.
    LoopRows,
    /// The Jacobian of the loop constraints, `[[S; NV]; NC]`, by rows.
    LoopJacobian,
}

/// The enumeration and the counts of the functions, from one table.
macro_rules! functions {
    ($($variant:ident $name:ident, $interface:expr, ($($argument:ident),*) -> $shape:ident, $summary:literal;)*) => {
        /// A function of a mechanism.
        ///
        /// The enumeration is exhaustive, so that the compiler shows where a new function is to be handled.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Function {
            $(#[doc = $summary] $variant,)*
        }

        impl Function {
            /// Every function, in the order in which generated code has them.
            pub const ALL: &'static [Function] = &[$(Function::$variant),*];

            /// Its name.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Function::$variant => stringify!($name),)*
                }
            }

            /// What it takes and returns.
            pub const fn signature(self) -> Signature {
                match self {
                    $(Function::$variant => Signature {
                        interface: $interface,
                        arguments: &[$(Argument::$argument),*],
                        result: Shape::$shape,
                        summary: $summary,
                    },)*
                }
            }
        }

        /// Operations of all generated functions of one mechanism; zero for what it does not have.
        ///
        /// Each function has a field of its name, and `operations[Function::MassMatrix]` is the same as
        /// `operations.mass_matrix`.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Operations {
            $(
                #[doc = concat!("Of `", stringify!($name), "`.")]
                pub $name: OperationCount,
            )*
        }

        impl Operations {
            /// No operations.
            pub const NONE: Operations = Operations { $($name: OperationCount::NONE,)* };
        }

        impl Index<Function> for Operations {
            type Output = OperationCount;
            fn index(&self, function: Function) -> &OperationCount {
                match function {
                    $(Function::$variant => &self.$name,)*
                }
            }
        }
    };
}

functions! {
    InverseDynamics inverse_dynamics, Interface::WithTangent("InverseDynamics"),
        (Coordinates, Velocities, Accelerations) -> Forces,
        "τ = M(q) a + C(q, v) v + g(q), N m or N: the joint forces of the tree.";
    ForwardDynamics forward_dynamics, Interface::WithTangent("ForwardDynamics"),
        (Coordinates, Velocities, Forces) -> Accelerations,
        "a = M(q)⁻¹ (τ − C(q, v) v − g(q)), rad/s² or m/s²: the accelerations of the tree.";
    MassMatrix mass_matrix, Interface::Own("MassMatrix"),
        (Coordinates) -> MassMatrix,
        "M(q), the generalised inertia matrix, symmetric: kg m², kg m or kg.";
    BiasForces bias_forces, Interface::Own("BiasForces"),
        (Coordinates, Velocities) -> Forces,
        "C(q, v) v + g(q), N m or N: the joint forces at zero acceleration.";
    GravityForces gravity_forces, Interface::Own("GravityForces"),
        (Coordinates) -> Forces,
        "g(q), N m or N: the joint forces at rest.";
    Energy energy, Interface::Own("MechanicalEnergy"),
        (Coordinates, Velocities) -> Energy,
        "Kinetic and potential energy, J; the potential is zero at the base frame's origin.";
    CenterOfMass center_of_mass, Interface::Own("MassCenter"),
        (Coordinates, Velocities) -> CenterOfMass,
        "Position (m) and velocity (m/s) of the centre of mass of all links, in the base frame.";
    LinkKinematics link_kinematics, Interface::Own("LinkKinematics"),
        (Coordinates, Velocities) -> Links,
        "Rotation, origin, centre of mass, velocity of the origin (m/s) and angular velocity (rad/s) of every link, in \
         the base frame.";
    LoopResidual loop_residual, Interface::LoopClosure,
        (Coordinates) -> LoopRows,
        "How far the loops are from closed: of each cut, the point of side b minus the point of side a in the base \
         frame, m, then what aligns directions, sines.";
    LoopJacobian loop_jacobian, Interface::LoopClosure,
        (Coordinates) -> LoopJacobian,
        "J(q), by rows: the residual of the loops changes at the rates J v.";
    LoopBias loop_bias, Interface::LoopClosure,
        (Coordinates, Velocities) -> LoopRows,
        "J̇ v: the second derivative of the residual of the loops at zero joint accelerations.";
}

impl Function {
    /// Whether only a mechanism with closed loops has it.
    pub const fn needs_loops(self) -> bool {
        matches!(self.signature().interface, Interface::LoopClosure)
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Function {
    type Err = UnknownFunction;
    fn from_str(name: &str) -> Result<Function, UnknownFunction> {
        Function::ALL.iter().copied().find(|function| function.name() == name).ok_or(UnknownFunction)
    }
}

/// A name that no [`Function`] has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownFunction;

impl fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("not a function of a mechanism; the functions are: ")?;
        for (index, function) in Function::ALL.iter().enumerate() {
            f.write_str(if index == 0 { "" } else { ", " })?;
            function.fmt(f)?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownFunction {}

/// A set of [functions](Function); the default is all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Functions(u64);

impl Functions {
    /// Every function.
    pub const ALL: Functions = Functions((1 << Function::ALL.len()) - 1);

    /// These functions.
    ///
    /// ```
    /// use redysim_runtime::function::{Function, Functions};
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
