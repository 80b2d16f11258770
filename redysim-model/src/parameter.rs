//! The numbers of a mechanism that may be given at run time: inertias, gravity and what acts in joints.

use redysim_runtime::{Dual, Lift, Scalar};

/// An inertial parameter, a component of gravity or a number of a joint: a constant of the model or a value that is given
/// at run time.
///
/// A [`Tree`](crate::tree::Tree) has its geometry in `f64` and these in `P`. What is linear in inertias, such as
/// [regrouping](crate::regroup), holds for any `P`. A pass that compares numbers reads [`number`](Self::number) and
/// skips parameters that are not known before run time.
pub trait Parameter: Scalar {
    /// The number, where it is known before run time.
    fn number(self) -> Option<f64>;
}

/// A parameter in a computation over the scalar `S`, into which it is [lifted](Lift).
pub trait ParameterIn<S>: Parameter + Lift<S> {
    /// The parameter as a scalar.
    #[inline]
    fn value(self) -> S {
        self.lift()
    }
}

impl<S, P: Parameter + Lift<S>> ParameterIn<S> for P {}

/// A parameter that may not be zero.
#[inline]
pub(crate) fn acting<S: Scalar, P: ParameterIn<S>>(parameter: P) -> Option<S> {
    (parameter.number() != Some(0.0)).then(|| parameter.value())
}

/// 1 / `mass`, the factor of first moments in the centre of mass; zero for a mechanism without mass, whose first moments are
/// zero, so that its centre of mass is the origin of the base frame.
#[inline]
pub(crate) fn per_mass<S: Scalar, P: ParameterIn<S>>(mass: P) -> S {
    if mass.number() == Some(0.0) { S::zero() } else { (P::one() / mass).value() }
}

impl Parameter for f64 {
    #[inline]
    fn number(self) -> Option<f64> {
        Some(self)
    }
}

/// A number with its derivative, for derivatives by inertial parameters.
impl<S: Scalar> Parameter for Dual<S> {
    #[inline]
    fn number(self) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::denoc::{Untraced, evaluate};
    use crate::joint::Vanishing;
    use crate::model::Model;
    use crate::regroup::base_parameters;
    use crate::tree::Tree;
    use redysim_runtime::Function;

    /// The functions that do not depend on how inertia is shared between bodies.
    const FUNCTIONS: [Function; 5] = [
        Function::InverseDynamics,
        Function::ForwardDynamics,
        Function::MassMatrix,
        Function::GravityForces,
        Function::Energy,
    ];

    /// The numbers of a body's inertia and one of gravity, to be changed one at a time.
    fn parameter(tree: &mut Tree<Dual<f64>>, body: usize, index: usize) -> &mut Dual<f64> {
        let inertia = &mut tree.bodies[body].inertia;
        match index {
            0 => &mut inertia.mass,
            1..4 => &mut inertia.moment.0[index - 1],
            4 => &mut inertia.second.xx,
            5 => &mut inertia.second.yy,
            6 => &mut inertia.second.zz,
            7 => &mut inertia.second.xy,
            8 => &mut inertia.second.yz,
            9 => &mut inertia.second.xz,
            _ => &mut tree.gravity.0[index - 10],
        }
    }

    /// Coordinates, velocities, and accelerations or joint forces.
    fn arguments(tree: &Tree<Dual<f64>>) -> [Vec<Dual<f64>>; 3] {
        [0.7, 1.3, -0.4].map(|x| (1..=tree.nv()).map(|i| Dual::from_f64((x * i as f64).sin())).collect())
    }

    fn outputs(function: Function, tree: &Tree<Dual<f64>>) -> Vec<Dual<f64>> {
        let arguments = arguments(tree);
        let arguments: Vec<&[Dual<f64>]> = arguments.iter().map(Vec::as_slice).collect();
        evaluate(function, tree, &Untraced, &arguments)
    }

    /// KR5 with one parameter of one body, of which the result is the derivative: `change` is added to the parameter.
    fn robots() -> impl Iterator<Item = impl Fn(f64) -> Tree<Dual<f64>>> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/kr5.toml");
        let numbers = Tree::new(&Model::load(path).expect("a valid model").model);
        let numbers = numbers.map(|value| Dual { value, slope: 0.0 });
        let last = numbers.bodies.len() - 1;
        let parameters = (0..13).map(move |index| (last, index)).chain([(1, 0), (2, 5)]);
        parameters.map(move |(body, index)| {
            let numbers = numbers.clone();
            move |change: f64| {
                let mut tree = numbers.clone();
                let parameter = parameter(&mut tree, body, index);
                *parameter = Dual { value: parameter.value + change, slope: 1.0 };
                tree
            }
        })
    }

    fn largest(values: &[Dual<f64>], of: fn(&Dual<f64>) -> f64) -> f64 {
        values.iter().map(of).fold(1.0, |most: f64, x| most.max(x.abs()))
    }

    #[test]
    fn joint_forces_and_energies_are_linear_in_inertias_and_gravity() {
        for robot in robots() {
            for function in FUNCTIONS.into_iter().filter(|function| *function != Function::ForwardDynamics) {
                let [before, after] = [-0.5, 0.5].map(|change| outputs(function, &robot(change)));
                let (value, slope) = (largest(&before, |x| x.value), largest(&before, |x| x.slope));
                for (before, after) in before.iter().zip(&after) {
                    let difference = after.value - before.value;
                    assert!((before.slope - difference).abs() < 1e-12 * (value + slope), "{function:?}");
                }
            }
        }
    }

    /// So the accelerations' derivatives are right if those of joint forces are.
    #[test]
    fn derivatives_of_inverse_and_forward_dynamics_undo_each_other() {
        for robot in robots() {
            let tree = robot(0.0);
            let [q, v, tau] = arguments(&tree);
            let a = evaluate(Function::ForwardDynamics, &tree, &Untraced, &[&q, &v, &tau]);
            let scale = 1.0 + largest(&a, |x| x.value) + largest(&a, |x| x.slope);
            let found = evaluate(Function::InverseDynamics, &tree, &Untraced, &[&q, &v, &a]);
            for (found, tau) in found.iter().zip(&tau) {
                assert!((found.value - tau.value).abs() < 1e-11 * scale);
                assert!(found.slope.abs() < 1e-11 * scale, "{}", found.slope);
            }
        }
    }

    #[test]
    fn regrouping_keeps_values_and_derivatives() {
        for robot in robots() {
            let regrouped = base_parameters(&robot(0.0), Vanishing::SecondMomentZz);
            for function in FUNCTIONS {
                let [plain, regrouped] = [&robot(0.0), &regrouped].map(|tree| outputs(function, tree));
                for of in [|x: &Dual<f64>| x.value, |x: &Dual<f64>| x.slope] {
                    let bound = 1e-9 * largest(&plain, of);
                    for (plain, regrouped) in plain.iter().zip(&regrouped) {
                        assert!((of(plain) - of(regrouped)).abs() < bound, "{function:?}");
                    }
                }
            }
        }
    }
}
