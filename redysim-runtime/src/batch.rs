//! One function of a mechanism for many states, on all cores, with several states side by side in lanes: for sampling
//! controllers, learning and identification. Needs the feature `std`.
//!
//! Each call finds out what the processor has and runs code for AVX-512, for AVX2 with fused multiply-add, or, where it
//! has neither, for what the program is compiled for. So no compiler flag is needed: a batch is the same code in a
//! program compiled for any x86-64 and in one compiled natively. [`map`] alone, whose function has lanes of one kind,
//! takes those that the program is compiled for.
//!
//! States and results are slices of arrays that the caller owns. Any number of states will do, and each result is the
//! same on however many threads. It has the bits that [`Dispatched`](crate::Dispatched) gives for its state, whatever
//! the program is compiled for. Those of the mechanism itself differ in the last places where the processor can fuse
//! products and sums and the program is compiled for one that cannot; with the feature `deterministic` nothing is
//! fused, and all are the same. Nothing is allocated beyond what the thread pool of `rayon` does when it is handed
//! work; up to [`SERIAL`] states stay on the caller's thread. To choose the number of threads, call these functions
//! within `rayon::ThreadPool::install`.
//!
//! Code that is generic over mechanisms cannot name the lanes that these functions choose among, and so cannot call
//! them; code for one mechanism can, and [`evaluate`] takes any function of any scalar.
//!
//! A rollout over many time steps is best done in one [`map`], whose function takes all the steps, so that threads are
//! handed work once and not at every step.
#![allow(private_bounds, reason = "no other crate may name numbers for instructions that the processor may lack")]

use crate::dispatch::Instructions;
use crate::lanes::{self, Lanes};
use crate::{BiasForces, ForwardDynamics, GravityForces, InverseDynamics, LengthMismatch, MassMatrix, Real, Scalar};
use rayon::prelude::*;

/// As many states as are not worth a second thread.
pub const SERIAL: usize = 512;
/// States that one thread takes at a time: enough to make up for taking them, few enough that cores finish together.
const TASK: usize = 256;

/// A plain number with lanes to work on several at once: `f64` and `f32`, and no other.
pub trait Batched: Real + Send + Sync + Wider {
    /// As many numbers as a vector holds of the target that the program is compiled for.
    type Lanes: Packed<Self>;
    /// How many those are.
    const WIDTH: usize = <Self::Lanes as Packed<Self>>::WIDTH;
}

/// The lanes for instructions that the processor may have beyond those that the program is compiled for.
pub(crate) trait Wider: Real {
    /// Those of AVX2.
    type Avx2: Packed<Self>;
    /// Those of AVX-512.
    type Avx512: Packed<Self>;
}

/// Lanes to which states are brought, and from which results are.
pub trait Packed<T: Real>: Scalar + sealed::Sealed {
    /// How many there are.
    const WIDTH: usize;

    /// Up to [`WIDTH`](Self::WIDTH) states in lanes; what is missing is filled with the last.
    fn pack<const N: usize>(states: &[[T; N]]) -> [Self; N];

    /// Writes as many states as `states` has.
    fn unpack<const N: usize>(lanes: [Self; N], states: &mut [[T; N]]);

    /// Writes one element of as many matrices as there are.
    fn spread<const N: usize>(self, matrices: &mut [[[T; N]; N]], row: usize, column: usize);
}

mod sealed {
    /// Keeps other types from being lanes.
    pub trait Sealed {}
}

macro_rules! packed {
    ($($lanes:path: $width:literal of $float:ident;)*) => {$(
        impl sealed::Sealed for $lanes {}

        impl Packed<$float> for $lanes {
            const WIDTH: usize = $width;

            #[inline(always)]
            fn pack<const N: usize>(states: &[[$float; N]]) -> [Self; N] {
                pack::<_, _, $width, N>(states)
            }

            #[inline(always)]
            fn unpack<const N: usize>(lanes: [Self; N], states: &mut [[$float; N]]) {
                unpack::<_, _, $width, N>(lanes, states);
            }

            #[inline(always)]
            fn spread<const N: usize>(self, matrices: &mut [[[$float; N]; N]], row: usize, column: usize) {
                let numbers: [$float; $width] = self.into();
                if let Some(matrices) = matrices.first_chunk_mut::<$width>() {
                    // As many as there are lanes: no loop is left.
                    matrices.iter_mut().zip(numbers).for_each(|(matrix, number)| matrix[row][column] = number);
                } else {
                    matrices.iter_mut().zip(numbers).for_each(|(matrix, number)| matrix[row][column] = number);
                }
            }
        }
    )*};
}

packed! {
    lanes::F64x2: 2 of f64;
    lanes::F64x4: 4 of f64;
    lanes::F64x8: 8 of f64;
    lanes::F32x8: 8 of f32;
    lanes::F32x16: 16 of f32;
}

#[cfg(target_arch = "x86_64")]
mod wider {
    use super::{Packed, Wider, pack, sealed, unpack};
    use crate::dispatch::x86;

    packed! {
        x86::Avx2F64x4: 4 of f64;
        x86::Avx512F64x8: 8 of f64;
        x86::Avx2F32x8: 8 of f32;
        x86::Avx512F32x16: 16 of f32;
    }

    impl Wider for f64 {
        type Avx2 = x86::Avx2F64x4;
        type Avx512 = x86::Avx512F64x8;
    }

    impl Wider for f32 {
        type Avx2 = x86::Avx2F32x8;
        type Avx512 = x86::Avx512F32x16;
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl<T: Batched> Wider for T {
    type Avx2 = T::Lanes;
    type Avx512 = T::Lanes;
}

// Wider lanes than the target's vectors do not fit its registers: forward dynamics then takes half as long again.
impl Batched for f64 {
    #[cfg(target_feature = "avx512f")]
    type Lanes = lanes::F64x8;
    #[cfg(all(target_feature = "avx", not(target_feature = "avx512f")))]
    type Lanes = lanes::F64x4;
    #[cfg(not(target_feature = "avx"))]
    type Lanes = lanes::F64x2;
}

impl Batched for f32 {
    #[cfg(target_feature = "avx512f")]
    type Lanes = lanes::F32x16;
    #[cfg(not(target_feature = "avx512f"))]
    type Lanes = lanes::F32x8;
}

#[inline(always)]
fn pack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(states: &[[T; N]]) -> [L; N] {
    if let Some(states) = states.first_chunk::<W>() {
        return lanes::pack(states);
    }
    let last = states.last().copied().unwrap_or([T::default(); N]);
    let mut filled = [last; W];
    filled.iter_mut().zip(states).for_each(|(filled, state)| *filled = *state);
    lanes::pack(&filled)
}

#[inline(always)]
fn unpack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(lanes: [L; N], states: &mut [[T; N]]) {
    let found: [[T; N]; W] = lanes::unpack(lanes);
    if let Some(states) = states.first_chunk_mut::<W>() {
        *states = found;
    } else {
        states.iter_mut().zip(found).for_each(|(state, found)| *state = found);
    }
}

/// Calls the form of `group` for the best instructions that the processor has, for each group of up to as many results
/// as its lanes hold, with the index of the first.
fn in_groups<T: Batched, R: Send>(
    results: &mut [R],
    compiled: impl Fn(usize, &mut [R]) + Sync,
    avx2: impl Fn(usize, &mut [R]) + Sync,
    avx512: impl Fn(usize, &mut [R]) + Sync,
) {
    match Instructions::of_processor() {
        Instructions::Compiled => in_lanes::<T, T::Lanes, R>(results, compiled),
        Instructions::Avx2 => in_lanes::<T, T::Avx2, R>(results, avx2),
        Instructions::Avx512 => in_lanes::<T, T::Avx512, R>(results, avx512),
    }
}

/// Calls `group` for each group of up to as many results as the lanes hold, with the index of its first.
fn in_lanes<T: Real, L: Packed<T>, R: Send>(results: &mut [R], group: impl Fn(usize, &mut [R]) + Sync) {
    let one_by_one = |start: usize, results: &mut [R]| {
        L::with_target_features(
            #[inline(always)]
            || {
                for (index, results) in results.chunks_mut(L::WIDTH).enumerate() {
                    group(start + index * L::WIDTH, results);
                }
            },
        );
    };
    if results.len() <= SERIAL {
        one_by_one(0, results);
    } else {
        let tasks = results.par_chunks_mut(TASK).enumerate();
        tasks.for_each(|(task, results)| one_by_one(task * TASK, results));
    }
}

/// The part of `entries` that belongs to a group of `count` from `start` on.
#[inline(always)]
fn part<T>(entries: &[T], start: usize, count: usize) -> &[T] {
    entries.get(start..start + count).unwrap_or_default()
}

/// `results[i] = function(inputs[i])`, for every `i`.
///
/// # Errors
///
/// If `results` is not as long as `inputs`; then nothing is written.
///
/// ```
/// use redysim_runtime::batch::{self, Batched};
/// use redysim_runtime::Scalar;
///
/// type S = <f64 as Batched>::Lanes;
///
/// /// Angle and speed of a pendulum after a second: a hundred semi-implicit Euler steps.
/// fn swung([mut angle, mut speed]: [S; 2]) -> [S; 2] {
///     for _ in 0..100 {
///         speed -= S::from_f64(0.0981) * angle.sin_cos().0;
///         angle = speed.mul_add(S::from_f64(0.01), angle);
///     }
///     [angle, speed]
/// }
///
/// let starts: Vec<[f64; 2]> = (0..1000).map(|i| [0.001 * f64::from(i), 0.0]).collect();
/// let mut ends = vec![[0.0; 2]; starts.len()];
/// batch::map(&starts, &mut ends, swung)?;
/// assert_eq!(ends[0], [0.0, 0.0]);
/// # Ok::<(), redysim_runtime::LengthMismatch>(())
/// ```
pub fn map<T: Batched, const I: usize, const O: usize>(
    inputs: &[[T; I]],
    results: &mut [[T; O]],
    function: impl Fn([T::Lanes; I]) -> [T::Lanes; O] + Sync,
) -> Result<(), LengthMismatch> {
    LengthMismatch::check("results", results, inputs.len())?;
    in_lanes::<T, T::Lanes, _>(results, |start, results| {
        Packed::unpack(function(Packed::pack(part(inputs, start, results.len()))), results);
    });
    Ok(())
}

/// A function of numbers for [`evaluate`], written once for any scalar.
pub trait Function<const I: usize, const O: usize> {
    /// Outputs from inputs. Mark it `#[inline(always)]`, and with it what it calls: code that does not become part of
    /// the loop over the states is not compiled for the instructions that the processor has. The functions of compiled
    /// mechanisms see to that themselves.
    fn evaluate<S: Scalar>(&self, inputs: [S; I]) -> [S; O];
}

/// `results[i] = function(inputs[i])`, for every `i`, like [`map`] and by the best instructions that the processor has.
/// Since the lanes are chosen at run time, the function is a type that implements [`Function`] for any scalar.
///
/// # Errors
///
/// If `results` is not as long as `inputs`; then nothing is written.
///
/// ```
/// use redysim_runtime::batch;
/// use redysim_runtime::Scalar;
///
/// /// Angle and speed of a pendulum after a second: a hundred semi-implicit Euler steps.
/// struct Swung;
///
/// impl batch::Function<2, 2> for Swung {
///     #[inline(always)]
///     fn evaluate<S: Scalar>(&self, [mut angle, mut speed]: [S; 2]) -> [S; 2] {
///         for _ in 0..100 {
///             speed -= S::from_f64(0.0981) * angle.sin_cos().0;
///             angle = speed.mul_add(S::from_f64(0.01), angle);
///         }
///         [angle, speed]
///     }
/// }
///
/// let starts: Vec<[f64; 2]> = (0..1000).map(|i| [0.001 * f64::from(i), 0.0]).collect();
/// let mut ends = vec![[0.0; 2]; starts.len()];
/// batch::evaluate(&Swung, &starts, &mut ends)?;
/// assert_eq!(ends[0], [0.0, 0.0]);
/// # Ok::<(), redysim_runtime::LengthMismatch>(())
/// ```
pub fn evaluate<T: Batched, F: Function<I, O> + Sync, const I: usize, const O: usize>(
    function: &F,
    inputs: &[[T; I]],
    results: &mut [[T; O]],
) -> Result<(), LengthMismatch> {
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, F: Function<I, O>, const I: usize, const O: usize>(
        function: &F,
        inputs: &[[T; I]],
        start: usize,
        results: &mut [[T; O]],
    ) {
        L::unpack(function.evaluate::<L>(L::pack(part(inputs, start, results.len()))), results);
    }
    LengthMismatch::check("results", results, inputs.len())?;
    in_groups::<T, _>(
        results,
        #[inline(always)]
        |start, results| group::<T, T::Lanes, F, I, O>(function, inputs, start, results),
        #[inline(always)]
        |start, results| group::<T, T::Avx2, F, I, O>(function, inputs, start, results),
        #[inline(always)]
        |start, results| group::<T, T::Avx512, F, I, O>(function, inputs, start, results),
    );
    Ok(())
}

/// `tau[i]` = M(`q[i]`) `a[i]` + C(`q[i]`, `v[i]`) `v[i]` + g(`q[i]`), for every state `i`: N m or N.
///
/// # Errors
///
/// If `v`, `a` or `tau` is not as long as `q`; then nothing is written.
pub fn inverse_dynamics<T: Batched, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &[[T; NQ]],
    v: &[[T; NV]],
    a: &[[T; NV]],
    tau: &mut [[T; NV]],
) -> Result<(), LengthMismatch>
where
    M: Sync
        + InverseDynamics<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]>
        + InverseDynamics<T::Avx2, Coordinates = [T::Avx2; NQ], Velocities = [T::Avx2; NV]>
        + InverseDynamics<T::Avx512, Coordinates = [T::Avx512; NQ], Velocities = [T::Avx512; NV]>,
{
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, M, const NQ: usize, const NV: usize>(
        mechanism: &M,
        q: &[[T; NQ]],
        v: &[[T; NV]],
        a: &[[T; NV]],
        start: usize,
        tau: &mut [[T; NV]],
    ) where
        M: InverseDynamics<L, Coordinates = [L; NQ], Velocities = [L; NV]>,
    {
        let q = L::pack(part(q, start, tau.len()));
        let v = L::pack(part(v, start, tau.len()));
        let a = L::pack(part(a, start, tau.len()));
        L::unpack(mechanism.inverse_dynamics(&q, &v, &a), tau);
    }
    LengthMismatch::check("v", v, q.len())?;
    LengthMismatch::check("a", a, q.len())?;
    LengthMismatch::check("tau", tau, q.len())?;
    in_groups::<T, _>(
        tau,
        #[inline(always)]
        |start, tau| group::<T, T::Lanes, M, NQ, NV>(mechanism, q, v, a, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx2, M, NQ, NV>(mechanism, q, v, a, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx512, M, NQ, NV>(mechanism, q, v, a, start, tau),
    );
    Ok(())
}

/// `a[i]` = M(`q[i]`)⁻¹ (`tau[i]` − C(`q[i]`, `v[i]`) `v[i]` − g(`q[i]`)), for every state `i`: rad/s² or m/s².
///
/// # Errors
///
/// If `v`, `tau` or `a` is not as long as `q`; then nothing is written.
pub fn forward_dynamics<T: Batched, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &[[T; NQ]],
    v: &[[T; NV]],
    tau: &[[T; NV]],
    a: &mut [[T; NV]],
) -> Result<(), LengthMismatch>
where
    M: Sync
        + ForwardDynamics<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]>
        + ForwardDynamics<T::Avx2, Coordinates = [T::Avx2; NQ], Velocities = [T::Avx2; NV]>
        + ForwardDynamics<T::Avx512, Coordinates = [T::Avx512; NQ], Velocities = [T::Avx512; NV]>,
{
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, M, const NQ: usize, const NV: usize>(
        mechanism: &M,
        q: &[[T; NQ]],
        v: &[[T; NV]],
        tau: &[[T; NV]],
        start: usize,
        a: &mut [[T; NV]],
    ) where
        M: ForwardDynamics<L, Coordinates = [L; NQ], Velocities = [L; NV]>,
    {
        let q = L::pack(part(q, start, a.len()));
        let v = L::pack(part(v, start, a.len()));
        let tau = L::pack(part(tau, start, a.len()));
        L::unpack(mechanism.forward_dynamics(&q, &v, &tau), a);
    }
    LengthMismatch::check("v", v, q.len())?;
    LengthMismatch::check("tau", tau, q.len())?;
    LengthMismatch::check("a", a, q.len())?;
    in_groups::<T, _>(
        a,
        #[inline(always)]
        |start, a| group::<T, T::Lanes, M, NQ, NV>(mechanism, q, v, tau, start, a),
        #[inline(always)]
        |start, a| group::<T, T::Avx2, M, NQ, NV>(mechanism, q, v, tau, start, a),
        #[inline(always)]
        |start, a| group::<T, T::Avx512, M, NQ, NV>(mechanism, q, v, tau, start, a),
    );
    Ok(())
}

/// `tau[i]` = C(`q[i]`, `v[i]`) `v[i]` + g(`q[i]`), for every state `i`: N m or N.
///
/// # Errors
///
/// If `v` or `tau` is not as long as `q`; then nothing is written.
pub fn bias_forces<T: Batched, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &[[T; NQ]],
    v: &[[T; NV]],
    tau: &mut [[T; NV]],
) -> Result<(), LengthMismatch>
where
    M: Sync
        + BiasForces<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]>
        + BiasForces<T::Avx2, Coordinates = [T::Avx2; NQ], Velocities = [T::Avx2; NV]>
        + BiasForces<T::Avx512, Coordinates = [T::Avx512; NQ], Velocities = [T::Avx512; NV]>,
{
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, M, const NQ: usize, const NV: usize>(
        mechanism: &M,
        q: &[[T; NQ]],
        v: &[[T; NV]],
        start: usize,
        tau: &mut [[T; NV]],
    ) where
        M: BiasForces<L, Coordinates = [L; NQ], Velocities = [L; NV]>,
    {
        let q = L::pack(part(q, start, tau.len()));
        let v = L::pack(part(v, start, tau.len()));
        L::unpack(mechanism.bias_forces(&q, &v), tau);
    }
    LengthMismatch::check("v", v, q.len())?;
    LengthMismatch::check("tau", tau, q.len())?;
    in_groups::<T, _>(
        tau,
        #[inline(always)]
        |start, tau| group::<T, T::Lanes, M, NQ, NV>(mechanism, q, v, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx2, M, NQ, NV>(mechanism, q, v, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx512, M, NQ, NV>(mechanism, q, v, start, tau),
    );
    Ok(())
}

/// `tau[i]` = g(`q[i]`), for every state `i`: N m or N.
///
/// # Errors
///
/// If `tau` is not as long as `q`; then nothing is written.
pub fn gravity_forces<T: Batched, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &[[T; NQ]],
    tau: &mut [[T; NV]],
) -> Result<(), LengthMismatch>
where
    M: Sync
        + GravityForces<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]>
        + GravityForces<T::Avx2, Coordinates = [T::Avx2; NQ], Velocities = [T::Avx2; NV]>
        + GravityForces<T::Avx512, Coordinates = [T::Avx512; NQ], Velocities = [T::Avx512; NV]>,
{
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, M, const NQ: usize, const NV: usize>(
        mechanism: &M,
        q: &[[T; NQ]],
        start: usize,
        tau: &mut [[T; NV]],
    ) where
        M: GravityForces<L, Coordinates = [L; NQ], Velocities = [L; NV]>,
    {
        let q = L::pack(part(q, start, tau.len()));
        L::unpack(mechanism.gravity_forces(&q), tau);
    }
    LengthMismatch::check("tau", tau, q.len())?;
    in_groups::<T, _>(
        tau,
        #[inline(always)]
        |start, tau| group::<T, T::Lanes, M, NQ, NV>(mechanism, q, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx2, M, NQ, NV>(mechanism, q, start, tau),
        #[inline(always)]
        |start, tau| group::<T, T::Avx512, M, NQ, NV>(mechanism, q, start, tau),
    );
    Ok(())
}

/// `matrices[i]` = M(`q[i]`), by rows, for every state `i`: kg m², kg m or kg.
///
/// # Errors
///
/// If `matrices` is not as long as `q`; then nothing is written.
pub fn mass_matrix<T: Batched, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &[[T; NQ]],
    matrices: &mut [[[T; NV]; NV]],
) -> Result<(), LengthMismatch>
where
    M: Sync
        + MassMatrix<T::Lanes, Coordinates = [T::Lanes; NQ], Matrix = [[T::Lanes; NV]; NV]>
        + MassMatrix<T::Avx2, Coordinates = [T::Avx2; NQ], Matrix = [[T::Avx2; NV]; NV]>
        + MassMatrix<T::Avx512, Coordinates = [T::Avx512; NQ], Matrix = [[T::Avx512; NV]; NV]>,
{
    #[inline(always)]
    fn group<T: Real, L: Packed<T>, M, const NQ: usize, const NV: usize>(
        mechanism: &M,
        q: &[[T; NQ]],
        start: usize,
        matrices: &mut [[[T; NV]; NV]],
    ) where
        M: MassMatrix<L, Coordinates = [L; NQ], Matrix = [[L; NV]; NV]>,
    {
        let q = L::pack(part(q, start, matrices.len()));
        let found = mechanism.mass_matrix(&q);
        for (row, found) in found.into_iter().enumerate() {
            for (column, lanes) in found.into_iter().enumerate() {
                L::spread(lanes, matrices, row, column);
            }
        }
    }
    LengthMismatch::check("matrices", matrices, q.len())?;
    in_groups::<T, _>(
        matrices,
        #[inline(always)]
        |start, matrices| group::<T, T::Lanes, M, NQ, NV>(mechanism, q, start, matrices),
        #[inline(always)]
        |start, matrices| group::<T, T::Avx2, M, NQ, NV>(mechanism, q, start, matrices),
        #[inline(always)]
        |start, matrices| group::<T, T::Avx512, M, NQ, NV>(mechanism, q, start, matrices),
    );
    Ok(())
}
