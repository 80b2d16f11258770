//! One function of a mechanism for many states, on all cores, with several states side by side in lanes: for sampling
//! controllers, learning and identification. Needs the feature `std`.
//!
//! Each call finds out what the processor has and runs code for AVX-512, for AVX2 with fused multiply-add, or, where it
//! has neither, for what the program is compiled for. So no compiler flag is needed: a batch is the same code in a
//! program compiled for any x86-64 and in one compiled natively. [`map`] alone, whose function has lanes of one kind,
//! takes those that the program is compiled for.
//!
//! States and results are slices of arrays that the caller owns. The number of states is arbitrary, and each result is
//! the same on however many threads. It has the bits that [`Dispatched`](crate::Dispatched) gives for its state,
//! whatever the program is compiled for. Those of the mechanism itself differ in the last places where the processor
//! can fuse products and sums and the program is compiled for one that cannot; with the feature `deterministic` nothing
//! is fused, and all are the same. Nothing is allocated beyond what the thread pool of `rayon` does when it is handed
//! work; up to [`SERIAL`] states stay on the caller's thread. To choose the number of threads, call these functions
//! within `rayon::ThreadPool::install`.
//!
//! Code that is generic over mechanisms cannot name the lanes that these functions choose among, and so cannot call
//! them; code for one mechanism can, and [`evaluate`] takes any function of any scalar.
//!
//! A rollout over many time steps is best done in one [`map`], whose function takes all the steps, so that threads are
//! handed work once and not at every step.
#![allow(private_bounds, reason = "no other crate may name numbers for instructions that the processor may lack")]

mod groups;
mod packed;

pub use packed::{Batched, Packed};

use crate::{BiasForces, ForwardDynamics, GravityForces, InverseDynamics, LengthMismatch, MassMatrix, Real, Scalar};
use groups::{in_groups, in_lanes, part};

/// The largest number of states that the caller's thread computes alone.
pub const SERIAL: usize = 512;

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
