//! PID control of the joints.

use super::{check_gains, check_motion};
use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// PID control of each joint: τ = Kp e + z + Kd (v_d(t) − v), with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference), and the integral action z.
///
/// The integral action changes by
///
/// ż = Ki e + Kt (τ_applied − τ).
///
/// The integral action z, N m or N, is a state of the law (see [`TorqueLaw`]): a simulation integrates it together with
/// the motion, to the same tolerances. Of an orientation it is a moment in the link's axes, which turns with the link.
///
/// # Saturation and anti-windup
///
/// Under [`Limited`](crate::Limited) the forces τ_applied differ from τ, and z follows them by back-calculation with the
/// tracking rate Kt, 1/s, the reciprocal of the tracking time constant T_t (K. J. Åström and T. Hägglund, *Advanced PID
/// Control*, ISA, 2006, § 3.5). In saturation z settles where τ exceeds the limit by Ki e/Kt, instead of growing with
/// time, so that the force leaves the limit soon after the error changes its sign. The rate ż is continuous in the
/// state; with conditional integration it would jump at the limit, where integrators with error control lose their
/// order. A joint with Ki = 0 has no integral action, and nothing follows. [`tracking_rates`] has the usual Kt.
///
/// # Without a simulation
///
/// [`torque`](TorqueLaw::torque) is the force with the integral action in [`integral`](Self::integral);
/// [`advance`](Self::advance) moves that on by a sampling period.
///
/// ```
/// # #[allow(dead_code)]
/// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
/// # use mechanisms::Pendulum;
/// use redysim_runtime::{ForwardSimulation, Integrator, Limited, Ode45, Pid, SetPoint, tracking_rates};
///
/// let pendulum = Pendulum { mass: 1.0, length: 1.0 };
/// let [kp, ki, kd] = [[100.0], [200.0], [20.0]];
/// let pid = Pid {
///     trajectory: SetPoint::new(&pendulum, [1.0]),
///     kp,
///     ki,
///     kd,
///     tracking: tracking_rates(&kp, &ki, &kd),
///     integral: [0.0],
/// };
/// let mut simulation = ForwardSimulation::new(&pendulum, Limited { law: pid, limits: [30.0] });
/// // [q, v, work, z]
/// let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
/// let end = Ode45::new().rtol(1e-8).atol(1e-8).integrate(&mut simulation, (0.0, 20.0), start)?;
/// assert!((end.y[0] - 1.0).abs() < 1e-6, "it stands where it was sent, though it knows nothing of gravity");
/// assert!((end.y[3] - 9.81 * 1.0_f64.sin()).abs() < 1e-4, "z is the weight");
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pid<T, V> {
    /// The motion to follow; a [`SetPoint`](crate::SetPoint) for one position.
    pub trajectory: T,
    /// Kp, one for each velocity, N m/rad or N/m.
    pub kp: V,
    /// Ki, one for each velocity, N m/(rad s) or N/(m s).
    pub ki: V,
    /// Kd, one for each velocity, N m s/rad or N s/m.
    pub kd: V,
    /// Kt, one for each velocity, 1/s; zero for no anti-windup.
    pub tracking: V,
    /// z at the start of a simulation, or now in a sampled controller, N m or N.
    pub integral: V,
}

/// The usual tracking rates Kt of [`Pid`], 1/s, from its gains.
///
/// They are 1/√(Ti Td) = √(Ki/Kd), and 1/Ti = Ki/Kp for a joint with Kd = 0, with the integral and derivative times
/// Ti = Kp/Ki and Td = Kd/Kp. Zero for a joint with Kp = Kd = 0, which has no integral or
/// derivative time; set Kt yourself. Source: Åström and Hägglund, as [`Pid`].
pub fn tracking_rates<S: Real, V: Vector<S>>(kp: &V, ki: &V, kd: &V) -> V {
    V::from_fn(ki.as_ref().len(), |i| {
        let [kp, ki, kd] = [kp, ki, kd].map(|gains| entry(gains, i));
        if ki == S::zero() {
            S::zero()
        } else if kd != S::zero() {
            (ki / kd).abs().sqrt()
        } else if kp != S::zero() {
            (ki / kp).abs()
        } else {
            S::zero()
        }
    })
}

impl<T, V> Pid<T, V> {
    /// Moves [`integral`](Self::integral) on by the sampling period `dt`, s, over which the forces `applied` act instead
    /// of those that [`torque`](TorqueLaw::torque) returns at `t`, `q` and `v`: by dt ż (Euler's method).
    pub fn advance<S, M>(&mut self, mechanism: &M, (t, dt): (S, S), q: &M::Coordinates, v: &V, applied: &V)
    where
        S: Real,
        M: ConfigurationSpace<S, Velocities = V>,
        V: Vector<S>,
        T: Trajectory<S, M::Coordinates, V>,
    {
        let (asked, mut rates) = self.force_and_rates(mechanism, t, (q, v), self.integral.as_ref());
        let saturation_error = V::from_fn(v.as_ref().len(), |i| entry(applied, i) - entry(&asked, i));
        self.follow(&saturation_error, rates.as_mut());
        for (integral, &rate) in self.integral.as_mut().iter_mut().zip(rates.as_ref()) {
            *integral += dt * rate;
        }
    }

    /// τ and Ki e with the integral action z.
    fn force_and_rates<S, M>(&self, mechanism: &M, t: S, (q, v): (&M::Coordinates, &V), z: &[S]) -> (V, V)
    where
        S: Real,
        M: ConfigurationSpace<S, Velocities = V>,
        V: Vector<S>,
        T: Trajectory<S, M::Coordinates, V>,
    {
        let desired = self.trajectory.at(t);
        let count = v.as_ref().len();
        let error = mechanism.difference(q, &desired.q);
        let force = V::from_fn(count, |i| {
            entry(&self.kp, i) * entry(&error, i)
                + z.get(i).copied().unwrap_or(S::from_f64(f64::NAN))
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
        });
        let rates = V::from_fn(count, |i| entry(&self.ki, i) * entry(&error, i));
        (force, rates)
    }

    /// Adds Kt (τ_applied − τ) to the rates of z.
    fn follow<S: Real>(&self, saturation_error: &V, rates: &mut [S])
    where
        V: Vector<S>,
    {
        for (i, rate) in rates.iter_mut().enumerate() {
            if entry(&self.ki, i) != S::zero() {
                *rate += entry(&self.tracking, i) * entry(saturation_error, i);
            }
        }
    }
}

impl<S, M, T> TorqueLaw<S, M> for Pid<T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    /// The force with z in [`integral`](Pid::integral).
    fn torque(&mut self, mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        self.force_and_rates(mechanism, t, (q, v), self.integral.as_ref()).0
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)?;
        LengthMismatch::check("ki", self.ki.as_ref(), mechanism.nv())?;
        LengthMismatch::check("tracking", self.tracking.as_ref(), mechanism.nv())?;
        LengthMismatch::check("integral", self.integral.as_ref(), mechanism.nv())
    }

    fn state_count(&self, mechanism: &M) -> usize {
        mechanism.nv()
    }

    fn initial_state(&self, index: usize) -> S {
        entry(&self.integral, index)
    }

    fn torque_with_state(
        &mut self,
        mechanism: &M,
        t: S,
        at: (&M::Coordinates, &M::Velocities),
        state: &[S],
        rates: &mut [S],
    ) -> M::Velocities {
        let (force, of_error) = self.force_and_rates(mechanism, t, at, state);
        for (rate, &of_error) in rates.iter_mut().zip(of_error.as_ref()) {
            *rate = of_error;
        }
        force
    }

    fn track(&self, saturation_error: &M::Velocities, rates: &mut [S]) {
        self.follow(saturation_error, rates);
    }
}
