//! One state at a time, by AVX2 and fused multiply-add where the processor has them.

use super::Instructions;
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2F32, Avx2F64};
use crate::vector::entry;
use crate::{
    BiasForces, Energy, ForwardDynamics, GravityForces, InverseDynamics, MassMatrix, MechanicalEnergy, Mechanism,
    Scalar, Vector,
};

/// A mechanism whose functions, called for one state, choose at run time between the code for which the program is
/// compiled and code for AVX2 with fused multiply-add (`x86-64-v3`): made by [`dispatched`](Dispatch::dispatched).
///
/// It implements the traits of the mechanism for `f64` and `f32`. With fused multiply-add the last places of a result
/// differ from those of the mechanism itself, unless the feature `deterministic` is set. Where the program is compiled
/// for AVX2 and FMA, and on processors other than x86-64, it does the same as the mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Dispatched<M> {
    mechanism: M,
    instructions: Instructions,
}

/// Finds at run time what the processor has.
pub trait Dispatch: Sized {
    /// The same mechanism, whose functions use AVX2 and fused multiply-add where the processor has them.
    ///
    /// ```text
    /// let kr5 = Kr5.dispatched();
    /// let torques = kr5.inverse_dynamics(&q, &v, &a);
    /// ```
    fn dispatched(self) -> Dispatched<Self> {
        Dispatched { mechanism: self, instructions: Instructions::detected() }
    }
}

impl<M> Dispatch for M {}

impl<M> Dispatched<M> {
    /// The instructions that were found.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }
}

/// `numbers` as numbers of another type.
#[inline(always)]
fn each<A: Scalar, B: Clone, V: Vector<A>, W: Vector<B>>(numbers: &V, convert: impl Fn(A) -> B) -> W {
    W::from_fn(numbers.as_ref().len(), |index| convert(entry(numbers, index)))
}

impl<S: Scalar, M: Mechanism<S>> Mechanism<S> for Dispatched<M> {
    type Coordinates = M::Coordinates;
    type Velocities = M::Velocities;
    type State = M::State;
    type Matrix = M::Matrix;
    type Links = M::Links;

    fn name(&self) -> &str {
        self.mechanism.name()
    }
    fn nq(&self) -> usize {
        self.mechanism.nq()
    }
    fn nv(&self) -> usize {
        self.mechanism.nv()
    }
    fn nl(&self) -> usize {
        self.mechanism.nl()
    }
    fn link_name(&self, index: usize) -> Option<&str> {
        self.mechanism.link_name(index)
    }
    fn joint_name(&self, index: usize) -> Option<&str> {
        self.mechanism.joint_name(index)
    }
    fn coordinate_rates(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Coordinates {
        self.mechanism.coordinate_rates(q, v)
    }
}

/// One function of vectors: by the code for AVX2 where it was found.
macro_rules! vectors {
    ($float:ident, $number:ident: $($trait:ident $function:ident($($argument:ident: $kind:ident),*);)*) => {$(
        #[cfg(target_arch = "x86_64")]
        impl<M> $trait<$float> for Dispatched<M>
        where
            M: $trait<$float> + $trait<$number>,
        {
            #[inline]
            fn $function(
                &self,
                $($argument: &<M as Mechanism<$float>>::$kind),*
            ) -> <M as Mechanism<$float>>::Velocities {
                if self.instructions < Instructions::Avx2 {
                    return $trait::<$float>::$function(&self.mechanism, $($argument),*);
                }
                $number::with_target_features(
                    #[inline(always)]
                    || {
                        $(let $argument: <M as Mechanism<$number>>::$kind = each($argument, $number);)*
                        each(&$trait::<$number>::$function(&self.mechanism, $(&$argument),*), |number: $number| number.0)
                    },
                )
            }
        }
    )*};
}

/// All functions for one type of number.
macro_rules! dispatched {
    ($float:ident, $number:ident) => {
        vectors! {
            $float, $number:
            InverseDynamics inverse_dynamics(q: Coordinates, v: Velocities, a: Velocities);
            ForwardDynamics forward_dynamics(q: Coordinates, v: Velocities, tau: Velocities);
            BiasForces bias_forces(q: Coordinates, v: Velocities);
            GravityForces gravity_forces(q: Coordinates);
        }

        #[cfg(target_arch = "x86_64")]
        impl<M> MassMatrix<$float> for Dispatched<M>
        where
            M: MassMatrix<$float> + MassMatrix<$number>,
        {
            #[inline]
            fn mass_matrix(&self, q: &<M as Mechanism<$float>>::Coordinates) -> <M as Mechanism<$float>>::Matrix {
                if self.instructions < Instructions::Avx2 {
                    return MassMatrix::<$float>::mass_matrix(&self.mechanism, q);
                }
                $number::with_target_features(
                    #[inline(always)]
                    || {
                        let q: <M as Mechanism<$number>>::Coordinates = each(q, $number);
                        let matrix = MassMatrix::<$number>::mass_matrix(&self.mechanism, &q);
                        let rows = matrix.as_ref();
                        Vector::from_fn(rows.len(), |row| each(&rows[row], |number: $number| number.0))
                    },
                )
            }
        }

        #[cfg(target_arch = "x86_64")]
        impl<M> MechanicalEnergy<$float> for Dispatched<M>
        where
            M: MechanicalEnergy<$float> + MechanicalEnergy<$number>,
        {
            #[inline]
            fn energy(
                &self,
                q: &<M as Mechanism<$float>>::Coordinates,
                v: &<M as Mechanism<$float>>::Velocities,
            ) -> Energy<$float> {
                if self.instructions < Instructions::Avx2 {
                    return MechanicalEnergy::<$float>::energy(&self.mechanism, q, v);
                }
                $number::with_target_features(
                    #[inline(always)]
                    || {
                        let q: <M as Mechanism<$number>>::Coordinates = each(q, $number);
                        let v: <M as Mechanism<$number>>::Velocities = each(v, $number);
                        let Energy { kinetic, potential } = MechanicalEnergy::energy(&self.mechanism, &q, &v);
                        let (kinetic, potential): ($number, $number) = (kinetic, potential);
                        Energy { kinetic: kinetic.0, potential: potential.0 }
                    },
                )
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
dispatched!(f64, Avx2F64);
#[cfg(target_arch = "x86_64")]
dispatched!(f32, Avx2F32);
