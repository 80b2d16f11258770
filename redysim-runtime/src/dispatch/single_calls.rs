//! One state at a time, by AVX2 and fused multiply-add where the processor has them.

use super::Instructions;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2F32, Avx2F64};
#[cfg(target_arch = "x86_64")]
use crate::Vector;
use crate::mechanism::Arguments;
use crate::wrapper::{coordinates_of, names_and_sizes_of};
use crate::{
    BiasForces, CenterOfMass, ConfigurationSpace, CoriolisMatrix, Energy, ForwardDynamics, Frames, GravityForces,
    HybridDynamics, HybridMotion, InverseDynamics, LinkKinematics, LoopClosure, LoopRows, MassCenter, MassMatrix,
    MechanicalEnergy, Mechanism, Momentum, PassiveForces, Scalar, TotalMomentum,
};

/// A mechanism that, called for one state, chooses at run time between the code that the program is compiled for and
/// code for AVX2 with fused multiply-add (`x86-64-v3`): made by [`dispatched`](Dispatch::dispatched).
///
/// It implements the traits of the mechanism for `f64` and `f32`. With fused multiply-add the last places of a result
/// differ from those of the mechanism itself, unless the feature `deterministic` is set; they are those of
/// [`batch`](crate::batch) on the same processor. Where the program is compiled for AVX2 and FMA, and on processors
/// other than x86-64, it does the same as the mechanism. Link kinematics, frames, loops and derivatives stay with the code that
/// the program is compiled for.
///
/// In generic code, ask for the traits that `Dispatched<M>` is to have, as in `Dispatched<M>: InverseDynamics<f64>`.
#[derive(Clone, Copy, Debug)]
pub struct Dispatched<M> {
    mechanism: M,
    instructions: Instructions,
}

/// Finds at run time what the processor has. Every type has it; it is of use to mechanisms.
pub trait Dispatch: Sized {
    /// The same mechanism, whose functions use AVX2 and fused multiply-add where the processor has them.
    ///
    /// The processor is asked here, once; a call then costs a branch more, and the way of its arguments through memory.
    /// ```text
    /// let kr5 = Kr5.dispatched();
    /// let torques: [f64; 6] = kr5.inverse_dynamics(&q, &v, &a);
    /// ```
    fn dispatched(self) -> Dispatched<Self> {
        Dispatched { mechanism: self, instructions: Instructions::detected() }
    }
}

impl<M> Dispatch for M {}

impl<M> Dispatched<M> {
    /// The instructions that were found; of AVX-512, which only [`batch`](crate::batch) uses, calls for one state take
    /// what AVX2 has.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }

    /// Whether code for AVX2 is there and is not what the program is compiled for anyway.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn chooses_avx2(&self) -> bool {
        let compiled_for_it = cfg!(all(target_feature = "avx2", target_feature = "fma"));
        !compiled_for_it && self.instructions >= Instructions::Avx2
    }
}

/// `numbers` as numbers of another type.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn each<A: Scalar, B: Scalar, V: Vector<A>, W: Vector<B>>(numbers: &V, convert: impl Fn(A) -> B) -> W {
    W::from_fn(numbers.as_ref().len(), |index| convert(crate::vector::entry(numbers, index)))
}

impl<M: Mechanism> Mechanism for Dispatched<M> {
    names_and_sizes_of!(mechanism);
}

impl<S: Scalar, M: ConfigurationSpace<S>> ConfigurationSpace<S> for Dispatched<M> {
    coordinates_of!(mechanism);

    fn dissipated_power(&self, q: &M::Coordinates, v: &M::Velocities) -> S {
        self.mechanism.dissipated_power(q, v)
    }
}

impl<S: Scalar, M: LinkKinematics<S>> LinkKinematics<S> for Dispatched<M> {
    fn link_kinematics(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Links {
        self.mechanism.link_kinematics(q, v)
    }
}

impl<S: Scalar, M: Frames<S>> Frames<S> for Dispatched<M> {
    type States = M::States;
    type Jacobians = M::Jacobians;
    type Accelerations = M::Accelerations;
    type Wrenches = M::Wrenches;

    fn frame_kinematics(&self, q: &M::Coordinates, v: &M::Velocities) -> M::States {
        self.mechanism.frame_kinematics(q, v)
    }
    fn frame_jacobians(&self, q: &M::Coordinates) -> M::Jacobians {
        self.mechanism.frame_jacobians(q)
    }
    fn frame_bias(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Accelerations {
        self.mechanism.frame_bias(q, v)
    }
    fn frame_forces(&self, q: &M::Coordinates, wrenches: &M::Wrenches) -> M::Velocities {
        self.mechanism.frame_forces(q, wrenches)
    }
}

impl<M: LoopRows> LoopRows for Dispatched<M> {
    fn nc(&self) -> usize {
        self.mechanism.nc()
    }
    fn loop_name(&self, row: usize) -> Option<&str> {
        self.mechanism.loop_name(row)
    }
}

impl<S: Scalar, M: ConfigurationSpace<S> + LoopClosure<S, M>> LoopClosure<S, Dispatched<M>> for Dispatched<M> {
    type Rows = M::Rows;
    type Jacobian = M::Jacobian;
    type Gram = M::Gram;

    fn loop_residual(&self, q: &M::Coordinates) -> M::Rows {
        self.mechanism.loop_residual(q)
    }
    fn loop_jacobian(&self, q: &M::Coordinates) -> M::Jacobian {
        self.mechanism.loop_jacobian(q)
    }
    fn loop_bias(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Rows {
        self.mechanism.loop_bias(q, v)
    }
}

/// A function of one state: as compiled, or, for AVX2, over `$number`, with the result `$found`, which `$plain` brings
/// back to `$float`. The derivative, where the trait has one, is as compiled.
macro_rules! function {
    (
        $float:ident, $number:ident: $trait:ident $function:ident($($argument:ident: $kind:ident),*) -> $result:ty
        $(, $tangent:ident)? => |$found:ident| $plain:expr
    ) => {
        impl<M: $trait<$float> + $trait<$number>> $trait<$float> for Dispatched<M> {
            #[inline]
            fn $function(&self, $($argument: &<M as ConfigurationSpace<$float>>::$kind),*) -> $result {
                #[cfg(target_arch = "x86_64")]
                if self.chooses_avx2() {
                    return $number::with_target_features(
                        #[inline(always)]
                        || {
                            $(let $argument: <M as ConfigurationSpace<$number>>::$kind = each($argument, $number);)*
                            let $found = $trait::<$number>::$function(&self.mechanism, $(&$argument),*);
                            $plain
                        },
                    );
                }
                $trait::<$float>::$function(&self.mechanism, $($argument),*)
            }

            $(fn $tangent(
                &self,
                at: Arguments<'_, $float, Self>,
                slopes: Arguments<'_, $float, Self>,
            ) -> Option<<M as ConfigurationSpace<$float>>::Velocities> {
                $trait::<$float>::$tangent(&self.mechanism, at, slopes)
            })?
        }
    };
}

/// A function whose result is a vector.
macro_rules! vector_function {
    ($float:ident, $number:ident: $trait:ident $function:ident $arguments:tt $($tangent:ident)?) => {
        function! { $float, $number:
            $trait $function $arguments -> <M as ConfigurationSpace<$float>>::Velocities $(, $tangent)?
            => |found| each(&found, |number: $number| number.0)
        }
    };
}

/// A function whose result is a square matrix.
macro_rules! matrix_function {
    ($float:ident, $number:ident: $trait:ident $function:ident $arguments:tt) => {
        function! { $float, $number:
            $trait $function $arguments -> <M as ConfigurationSpace<$float>>::Matrix => |found| {
                let mut rows = found.as_ref().iter();
                let size = rows.len();
                Vector::from_fn(size, |_| match rows.next() {
                    Some(row) => each(row, |number: $number| number.0),
                    None => Vector::from_fn(size, |_| $float::NAN),
                })
            }
        }
    };
}

/// All functions of one state for numbers `$float`: as compiled, or, for AVX2, as numbers `$number`.
macro_rules! functions {
    ($float:ident, $number:ident) => {
        vector_function! { $float, $number:
            InverseDynamics inverse_dynamics(q: Coordinates, v: Velocities, a: Velocities) inverse_dynamics_tangent
        }
        vector_function! { $float, $number:
            ForwardDynamics forward_dynamics(q: Coordinates, v: Velocities, tau: Velocities) forward_dynamics_tangent
        }
        vector_function! { $float, $number: BiasForces bias_forces(q: Coordinates, v: Velocities) }
        vector_function! { $float, $number: GravityForces gravity_forces(q: Coordinates) }
        vector_function! { $float, $number: PassiveForces passive_forces(q: Coordinates, v: Velocities) }
        matrix_function! { $float, $number: MassMatrix mass_matrix(q: Coordinates) }
        matrix_function! { $float, $number: CoriolisMatrix coriolis_matrix(q: Coordinates, v: Velocities) }
        function! { $float, $number:
            MechanicalEnergy energy(q: Coordinates, v: Velocities) -> Energy<$float>
            => |found| Energy { kinetic: found.kinetic.0, potential: found.potential.0 }
        }
        function! { $float, $number:
            MassCenter center_of_mass(q: Coordinates, v: Velocities) -> CenterOfMass<$float>
            => |found| CenterOfMass {
                position: found.position.map(|number| number.0),
                velocity: found.velocity.map(|number| number.0),
            }
        }
        function! { $float, $number:
            TotalMomentum momentum(q: Coordinates, v: Velocities) -> Momentum<$float>
            => |found| Momentum {
                linear: found.linear.map(|number| number.0),
                angular: found.angular.map(|number| number.0),
            }
        }
        function! { $float, $number:
            HybridDynamics hybrid_dynamics(q: Coordinates, v: Velocities, u: Velocities)
                -> HybridMotion<<M as ConfigurationSpace<$float>>::Velocities>
            => |found| HybridMotion {
                a: each(&found.a, |number: $number| number.0),
                tau: each(&found.tau, |number: $number| number.0),
            }
        }
    };
}

/// Other processors have one kind of code.
#[cfg(not(target_arch = "x86_64"))]
use core::primitive::{f32 as Avx2F32, f64 as Avx2F64};

functions!(f64, Avx2F64);
functions!(f32, Avx2F32);
