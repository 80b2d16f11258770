//! Observers of recursions: none for numbers, the code generator for symbols.

use crate::inertia::Sym3;
use crate::spatial::{Mat3, Twist, Vec3, Wrench};

/// Observes a recursion over scalars `S`: which of its operations belong to which body, and what its values are called.
///
/// Recursions call it; code generation implements it, to find uniform bodies and to name the values of the generated
/// code. Every function has a default that observes nothing, so that a recursion over numbers costs what it would
/// without. [`Untraced`] has these defaults.
pub trait Trace<S: Copy> {
    /// Whether the product of the rotations between a body and its parent is computed once for each body. This is
    /// faster for numbers. Expressions take fewer operations without it: the zeros and ones of each rotation fold, but
    /// its product with the others has no zeros or ones.
    const WHOLE_ROTATIONS: bool = false;

    /// Does the `work` of body `body` in the sweep `sweep` over all bodies.
    #[inline]
    fn step<R>(&self, sweep: &'static str, body: usize, work: impl FnOnce() -> R) -> R {
        let _ = (sweep, body);
        work()
    }

    /// `value` is component `component` of `quantity` of body `body`; a scalar has the component "".
    #[inline]
    fn name(&self, value: S, quantity: &'static str, body: usize, component: &'static str) {
        let _ = (value, quantity, body, component);
    }

    /// A sweep over bodies, in the given order.
    #[inline]
    fn sweep(&self, sweep: &'static str, bodies: impl IntoIterator<Item = usize>, mut work: impl FnMut(usize)) {
        for body in bodies {
            self.step(sweep, body, || work(body));
        }
    }

    /// Names the components of a vector.
    #[inline]
    fn name_vector(&self, value: Vec3<S>, quantity: &'static str, body: usize) {
        for (element, component) in value.0.into_iter().zip(["x", "y", "z"]) {
            self.name(element, quantity, body, component);
        }
    }

    /// Names the components of a twist.
    #[inline]
    fn name_twist(&self, value: Twist<S>, [angular, linear]: [&'static str; 2], body: usize) {
        self.name_vector(value.angular, angular, body);
        self.name_vector(value.linear, linear, body);
    }

    /// Names the components of a wrench.
    #[inline]
    fn name_wrench(&self, value: Wrench<S>, [moment, force]: [&'static str; 2], body: usize) {
        self.name_vector(value.moment, moment, body);
        self.name_vector(value.force, force, body);
    }

    /// Names the elements of a matrix.
    #[inline]
    fn name_matrix(&self, value: Mat3<S>, quantity: &'static str, body: usize) {
        const ELEMENTS: [[&str; 3]; 3] = [["xx", "xy", "xz"], ["yx", "yy", "yz"], ["zx", "zy", "zz"]];
        for (row, components) in value.0.into_iter().zip(ELEMENTS) {
            for (element, component) in row.into_iter().zip(components) {
                self.name(element, quantity, body, component);
            }
        }
    }

    /// Names the elements of a symmetric matrix.
    #[inline]
    fn name_symmetric(&self, value: Sym3<S>, quantity: &'static str, body: usize) {
        let Sym3 { xx, yy, zz, xy, yz, xz } = value;
        let elements = [(xx, "xx"), (yy, "yy"), (zz, "zz"), (xy, "xy"), (yz, "yz"), (xz, "xz")];
        for (element, component) in elements {
            self.name(element, quantity, body, component);
        }
    }
}

/// Observes nothing: for recursions over numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Untraced;

impl<S: Copy> Trace<S> for Untraced {
    const WHOLE_ROTATIONS: bool = true;
}
