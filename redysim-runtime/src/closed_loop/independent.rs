//! The motions that closed loops allow, by the independent velocities.

use super::constraints::{LoopDecomposition, zero_columns};
use super::{ClosedLoop, LoopError};
use crate::linear_algebra::{add_scaled, difference, dot, largest, product, rank_tolerance, zeros};
use crate::vector::entry;
use crate::{ConfigurationSpace, FrameAcceleration, FrameJacobian, Frames, LoopClosure, Real, Vector};

/// The largest residual of prescribed velocities that counts as rounding, as a part of the largest velocity; likewise
/// for a force without an actuator.
const SMALL: f64 = 1e-9;
/// The same for the scalar `S`.
pub(in crate::closed_loop) fn roundoff_tolerance<S: Real>() -> S {
    S::from_f64(SMALL).maximum(S::from_f64(1000.0) * S::EPSILON)
}

/// Checks that all independent velocities exist, and that none is repeated.
pub(super) fn check_independent<S>(independent: &[usize], count: usize) -> Result<(), LoopError<S>> {
    if let Some(&velocity) = independent.iter().find(|&&index| index >= count) {
        return Err(LoopError::VelocityOutOfRange { velocity, count });
    }
    match independent.iter().enumerate().find(|(i, a)| independent.iter().take(*i).any(|b| b == *a)) {
        Some((_, &velocity)) => Err(LoopError::RepeatedVelocity { velocity }),
        None => Ok(()),
    }
}

/// The rows of J without the columns of the velocities `known`.
pub(super) fn without_columns<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>>(
    mechanism: &M,
    jacobian: &C::Jacobian,
    known: &[usize],
) -> Result<LoopDecomposition<S, M, C>, LoopError<S>> {
    let mut rows = jacobian.clone();
    for row in rows.as_mut() {
        zero_columns(row, known);
    }
    Ok(LoopDecomposition::<S, M, C>::new(rows, mechanism.nv(), rank_tolerance())?)
}

/// How all velocities follow from the independent ones at one position.
pub(super) struct Completion<'a, S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    loops: ClosedLoop<'a, M, C>,
    independent: &'a [usize],
    pub jacobian: C::Jacobian,
    /// J without the columns of the independent velocities.
    dependent: LoopDecomposition<S, M, C>,
}

impl<'a, S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> Completion<'a, S, M, C> {
    /// Fails unless the loops determine all other velocities.
    pub fn new(
        loops: ClosedLoop<'a, M, C>,
        q: &M::Coordinates,
        independent: &'a [usize],
    ) -> Result<Self, LoopError<S>> {
        let jacobian = loops.closure.loop_jacobian(q);
        let dependent = without_columns::<S, M, C>(loops.mechanism, &jacobian, independent)?;
        let needed = loops.mechanism.nv().saturating_sub(independent.len());
        if dependent.rank() < needed {
            return Err(LoopError::RankDeficient { rank: dependent.rank(), needed, rows: dependent.dependent_rows() });
        }
        Ok(Completion { loops, independent, jacobian, dependent })
    }

    /// The x with J x = −bias whose independent components are `given`: J_d x_d = −bias − J_i x_i.
    pub fn complete<I: Vector<S>>(&self, given: &I, bias: &C::Rows) -> Result<M::Velocities, LoopError<S>> {
        let mut x: M::Velocities = zeros(self.loops.mechanism.nv());
        for (i, &index) in self.independent.iter().enumerate() {
            if let Some(element) = x.as_mut().get_mut(index) {
                *element = entry(given, i);
            }
        }
        let missing = |x: &M::Velocities| {
            let rates: C::Rows = product(self.jacobian.as_ref(), x.as_ref());
            C::Rows::from_fn(self.loops.closure.nc(), |row| entry(&rates, row) + entry(bias, row))
        };
        // The second time takes away what rounding left of the first.
        for _ in 0..2 {
            x = difference(&x, &self.dependent.combination(&self.dependent.solve(&missing(&x))));
        }
        let (residual, row) = largest(missing(&x).as_ref().iter().copied());
        let small = roundoff_tolerance::<S>();
        if residual > small * (S::one() + largest(x.as_ref().iter().chain(bias.as_ref()).copied()).0) {
            return Err(LoopError::InconsistentVelocity { residual, row });
        }
        Ok(x)
    }
}

/// The motions that closed loops allow at one position, v = B v_i, with the independent velocities v_i and
/// B = ∂v/∂v_i: what is left of a tree's Jacobians and forces when its loops are closed.
///
/// `I` has a component for each independent velocity: an array, or a `Vec`.
///
/// ```
/// use redysim_runtime::{ClosedLoop, Frames, IndependentMotion, LoopClosure, LoopError};
///
/// /// How fast the first frame moves along x with the crank, m/rad.
/// fn gear<M>(loops: ClosedLoop<'_, M>, q: &M::Coordinates, crank: usize) -> Result<f64, LoopError<f64>>
/// where
///     M: Frames<f64> + LoopClosure<f64, M>,
/// {
///     let independent = [crank];
///     let motion: IndependentMotion<f64, M, M, [f64; 1]> = loops.independent_motion(q, &independent)?;
///     Ok(motion.frame_jacobians().as_ref().first().map_or(0.0, |frame| frame.linear[0][0]))
/// }
/// ```
pub struct IndependentMotion<'a, S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>, I: Vector<S>> {
    completion: Completion<'a, S, M, C>,
    q: M::Coordinates,
    /// The columns of B.
    basis: I::Of<M::Velocities>,
}

impl<'m, M, C> ClosedLoop<'m, M, C> {
    /// The motions that the loops allow at the closed position `q` (see [`assemble`](Self::assemble)), by the velocities
    /// `independent`, which determine all others.
    ///
    /// # Errors
    /// [`LoopError::RankDeficient`] if they do not, as in a singular position; [`LoopError::InconsistentVelocity`] if
    /// they are too many; [`LoopError::VelocityOutOfRange`], [`LoopError::RepeatedVelocity`] and
    /// [`LoopError::NotFinite`].
    pub fn independent_motion<'a, S: Real, I: Vector<S>>(
        &self,
        q: &M::Coordinates,
        independent: &'a [usize],
    ) -> Result<IndependentMotion<'a, S, M, C, I>, LoopError<S>>
    where
        'm: 'a,
        M: ConfigurationSpace<S>,
        C: LoopClosure<S, M>,
    {
        check_independent(independent, self.mechanism.nv())?;
        let completion = Completion::new(*self, q, independent)?;
        let (count, none) = (independent.len(), zeros(self.closure.nc()));
        let mut failed = None;
        let basis = I::Of::<M::Velocities>::from_fn(count, |column| {
            let unit = I::from_fn(count, |i| if i == column { S::one() } else { S::zero() });
            completion.complete(&unit, &none).unwrap_or_else(|error| {
                failed = Some(error);
                zeros(self.mechanism.nv())
            })
        });
        match failed {
            Some(error) => Err(error),
            None => Ok(IndependentMotion { completion, q: q.clone(), basis }),
        }
    }
}

impl<S, M, C, I> IndependentMotion<'_, S, M, C, I>
where
    S: Real,
    M: ConfigurationSpace<S>,
    C: LoopClosure<S, M>,
    I: Vector<S>,
{
    /// v = B v_i: all velocities.
    pub fn velocities(&self, independent: &I) -> M::Velocities {
        let mut v: M::Velocities = zeros(self.completion.loops.mechanism.nv());
        for (column, &velocity) in self.basis.as_ref().iter().zip(independent.as_ref()) {
            add_scaled(v.as_mut(), velocity, column.as_ref());
        }
        v
    }

    /// a = B a_i + Ḃ v_i: all accelerations, for the independent velocities and accelerations.
    ///
    /// # Errors
    /// [`LoopError::InconsistentVelocity`] if the loops do not permit such accelerations, as where they are open.
    pub fn accelerations(&self, velocities: &I, accelerations: &I) -> Result<M::Velocities, LoopError<S>> {
        let bias = self.completion.loops.closure.loop_bias(&self.q, &self.velocities(velocities));
        self.completion.complete(accelerations, &bias)
    }

    /// Bᵀ f: the forces on the independent velocities with the power of the joint forces `forces`. Of a row of a Jacobian,
    /// it is the row of the Jacobian by the independent velocities.
    pub fn restricted(&self, forces: &M::Velocities) -> I {
        I::from_fn(self.basis.as_ref().len(), |i| match self.basis.as_ref().get(i) {
            Some(column) => dot(column.as_ref(), forces.as_ref()),
            None => S::from_f64(f64::NAN),
        })
    }

    /// Position and velocity of every frame, in the base frame.
    pub fn frame_kinematics(&self, independent: &I) -> M::States
    where
        M: Frames<S>,
    {
        self.completion.loops.mechanism.frame_kinematics(&self.q, &self.velocities(independent))
    }

    /// J B of every frame: its Jacobian by the independent velocities.
    pub fn frame_jacobians(&self) -> <M::Jacobians as Vector<FrameJacobian<M::Velocities>>>::Of<FrameJacobian<I>>
    where
        M: Frames<S>,
    {
        let of_tree = self.completion.loops.mechanism.frame_jacobians(&self.q);
        let restricted = |rows: Option<&[M::Velocities; 3]>| {
            let nan = || I::from_fn(self.basis.as_ref().len(), |_| S::from_f64(f64::NAN));
            match rows {
                Some([x, y, z]) => [self.restricted(x), self.restricted(y), self.restricted(z)],
                None => [nan(), nan(), nan()],
            }
        };
        Vector::from_fn(of_tree.as_ref().len(), |frame| {
            let jacobian = of_tree.as_ref().get(frame);
            FrameJacobian {
                linear: restricted(jacobian.map(|jacobian| &jacobian.linear)),
                angular: restricted(jacobian.map(|jacobian| &jacobian.angular)),
            }
        })
    }

    /// The acceleration of every frame at zero independent accelerations, J Ḃ v_i + J̇ v: the rate of its Jacobian by the
    /// independent velocities times these.
    ///
    /// # Errors
    /// As [`accelerations`](Self::accelerations).
    pub fn frame_bias(&self, independent: &I) -> Result<M::Accelerations, LoopError<S>>
    where
        M: Frames<S>,
    {
        let mechanism = self.completion.loops.mechanism;
        let rest = I::from_fn(self.basis.as_ref().len(), |_| S::zero());
        let a = self.accelerations(independent, &rest)?;
        let mut bias = mechanism.frame_bias(&self.q, &self.velocities(independent));
        let jacobians = mechanism.frame_jacobians(&self.q);
        for (FrameAcceleration { linear, angular }, jacobian) in bias.as_mut().iter_mut().zip(jacobians.as_ref()) {
            let rows = jacobian.linear.iter().chain(&jacobian.angular);
            for (element, row) in linear.iter_mut().chain(angular).zip(rows) {
                *element += dot(row.as_ref(), a.as_ref());
            }
        }
        Ok(bias)
    }

    /// Σ Bᵀ Jᵀ w: the forces on the independent velocities that do the same work as `wrenches`, which act on the
    /// mechanism at the frames.
    pub fn frame_forces(&self, wrenches: &M::Wrenches) -> I
    where
        M: Frames<S>,
    {
        self.restricted(&self.completion.loops.mechanism.frame_forces(&self.q, wrenches))
    }
}
