//! One function of a mechanism for many states, on all cores, with several states side by side in lanes: for sampling
//! controllers, learning and identification. Needs the feature `std`.
//!
//! States and results are slices of arrays that the caller owns. Any number of states will do; each result has the bits
//! that [`Scalar`] lanes of any width, and so plain numbers too, give for its state, on however many threads. Nothing
//! is allocated beyond what the thread pool of `rayon` does when it is handed work; up to [`SERIAL`] states stay on the
//! caller's thread. To choose the number of threads, call these functions within `rayon::ThreadPool::install`.
//!
//! A rollout over many time steps is best done in one [`map`], whose function takes all the steps, so that threads are
//! handed work once and not at every step.

use crate::lanes::{self, Lanes};
use crate::{BiasForces, ForwardDynamics, GravityForces, InverseDynamics, MassMatrix, Real, Scalar};
use core::fmt;
use rayon::prelude::*;

/// As many states as are not worth a second thread.
pub const SERIAL: usize = 512;
/// States that one thread takes at a time: enough to make up for taking them, few enough that cores finish together.
const TASK: usize = 256;

/// A plain number with lanes to work on several at once: `f64` and `f32`, and no other.
pub trait Batched: Real + Send + Sync + sealed::Sealed {
    /// As many numbers as a vector of the target holds.
    type Lanes: Scalar;
    /// How many those are.
    const WIDTH: usize;

    /// Up to [`WIDTH`](Self::WIDTH) states in lanes; what is missing is filled with the last.
    fn pack<const N: usize>(states: &[[Self; N]]) -> [Self::Lanes; N];

    /// Writes as many states as `states` has.
    fn unpack<const N: usize>(lanes: [Self::Lanes; N], states: &mut [[Self; N]]);
}

mod sealed {
    /// Keeps other types from saying how many lanes they have.
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

macro_rules! batched {
    ($float:ident, $lanes:ident, $width:literal) => {
        impl Batched for $float {
            type Lanes = lanes::$lanes;
            const WIDTH: usize = $width;

            #[inline(always)]
            fn pack<const N: usize>(states: &[[Self; N]]) -> [Self::Lanes; N] {
                pack::<_, _, $width, N>(states)
            }

            #[inline(always)]
            fn unpack<const N: usize>(lanes: [Self::Lanes; N], states: &mut [[Self; N]]) {
                unpack::<_, _, $width, N>(lanes, states);
            }
        }
    };
}

// Wider lanes than the target's vectors do not fit its registers: forward dynamics then takes half as long again.
#[cfg(target_feature = "avx512f")]
batched!(f64, F64x8, 8);
#[cfg(target_feature = "avx512f")]
batched!(f32, F32x16, 16);
#[cfg(all(target_feature = "avx", not(target_feature = "avx512f")))]
batched!(f64, F64x4, 4);
#[cfg(not(target_feature = "avx"))]
batched!(f64, F64x2, 2);
#[cfg(not(target_feature = "avx512f"))]
batched!(f32, F32x8, 8);

#[inline(always)]
fn pack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(states: &[[T; N]]) -> [L; N] {
    if let Some(states) = states.first_chunk::<W>() {
        return lanes::pack(states);
    }
    let last = states.last().copied().unwrap_or([T::default(); N]);
    lanes::pack::<L, T, W, N>(&core::array::from_fn(|lane| states.get(lane).copied().unwrap_or(last)))
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

/// A slice that has not one entry for each state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthMismatch {
    /// The name of the slice, as the function calls it.
    pub slice: &'static str,
    /// Its length.
    pub length: usize,
    /// The number of states, which is the length of the function's first slice.
    pub states: usize,
}

impl fmt::Display for LengthMismatch {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { slice, length, states } = self;
        write!(formatter, "`{slice}` has {length} entries for {states} states")
    }
}

impl core::error::Error for LengthMismatch {}

fn same_length<T>(states: usize, slice: &'static str, entries: &[T]) -> Result<(), LengthMismatch> {
    let length = entries.len();
    if length == states { Ok(()) } else { Err(LengthMismatch { slice, length, states }) }
}

/// Calls `group` for each group of up to `width` results, with the index of its first.
fn in_groups<R: Send>(results: &mut [R], width: usize, group: impl Fn(usize, &mut [R]) + Sync) {
    let one_by_one = |start: usize, results: &mut [R]| {
        for (index, results) in results.chunks_mut(width).enumerate() {
            group(start + index * width, results);
        }
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
/// # Ok::<(), batch::LengthMismatch>(())
/// ```
pub fn map<T: Batched, const I: usize, const O: usize>(
    inputs: &[[T; I]],
    results: &mut [[T; O]],
    function: impl Fn([T::Lanes; I]) -> [T::Lanes; O] + Sync,
) -> Result<(), LengthMismatch> {
    same_length(inputs.len(), "results", results)?;
    in_groups(results, T::WIDTH, |start, results| {
        T::unpack(function(T::pack(part(inputs, start, results.len()))), results);
    });
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
    M: InverseDynamics<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]> + Sync,
{
    same_length(q.len(), "v", v)?;
    same_length(q.len(), "a", a)?;
    same_length(q.len(), "tau", tau)?;
    in_groups(tau, T::WIDTH, |start, tau| {
        let [v, a] = [v, a].map(|entries| T::pack(part(entries, start, tau.len())));
        T::unpack(mechanism.inverse_dynamics(&T::pack(part(q, start, tau.len())), &v, &a), tau);
    });
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
    M: ForwardDynamics<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]> + Sync,
{
    same_length(q.len(), "v", v)?;
    same_length(q.len(), "tau", tau)?;
    same_length(q.len(), "a", a)?;
    in_groups(a, T::WIDTH, |start, a| {
        let [v, tau] = [v, tau].map(|entries| T::pack(part(entries, start, a.len())));
        T::unpack(mechanism.forward_dynamics(&T::pack(part(q, start, a.len())), &v, &tau), a);
    });
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
    M: BiasForces<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]> + Sync,
{
    same_length(q.len(), "v", v)?;
    same_length(q.len(), "tau", tau)?;
    in_groups(tau, T::WIDTH, |start, tau| {
        let v = T::pack(part(v, start, tau.len()));
        T::unpack(mechanism.bias_forces(&T::pack(part(q, start, tau.len())), &v), tau);
    });
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
    M: GravityForces<T::Lanes, Coordinates = [T::Lanes; NQ], Velocities = [T::Lanes; NV]> + Sync,
{
    same_length(q.len(), "tau", tau)?;
    in_groups(tau, T::WIDTH, |start, tau| {
        T::unpack(mechanism.gravity_forces(&T::pack(part(q, start, tau.len()))), tau);
    });
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
    M: MassMatrix<T::Lanes, Coordinates = [T::Lanes; NQ], Matrix = [[T::Lanes; NV]; NV]> + Sync,
{
    same_length(q.len(), "matrices", matrices)?;
    in_groups(matrices, T::WIDTH, |start, matrices| {
        let found = mechanism.mass_matrix(&T::pack(part(q, start, matrices.len())));
        for (row, found) in found.into_iter().enumerate() {
            // No vector has more than sixteen lanes.
            let mut rows = [[T::default(); NV]; 16];
            let rows = &mut rows[..matrices.len()];
            T::unpack(found, rows);
            matrices.iter_mut().zip(rows).for_each(|(matrix, found)| matrix[row] = *found);
        }
    });
    Ok(())
}
