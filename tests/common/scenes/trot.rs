//! ReDySim's quadruped lands on its feet and trots for a stride: legs follow a smooth motion, contacts move the trunk.

use std::f64::consts::{PI, TAU};

use redysim::integrate::Ends;
use redysim::{
    AnyContactLaw, ConfigurationSpace, Contact, ContactEvent, GroundPlane, Grounded, HuntCrossleyContact,
    HybridSimulation, IntegrationError, Integrator, Motion, ReDySimContact, Solution, ZeroTorque, redysim,
};

redysim! {
    /// A trunk on a free joint and four legs of three joints.
    pub struct Quadruped(
        "../../../models/quadruped.toml",
        functions = [hybrid_dynamics, frame_kinematics, frame_jacobians, frame_bias, frame_forces],
    );
}

pub type Coordinates = [f64; Quadruped::NQ];
pub type Velocities = [f64; Quadruped::NV];
pub type State = [f64; Quadruped::NQ + Quadruped::NV + 1];

/// Length of the motion, s: a stride.
pub const DURATION: f64 = 1.0;

/// The ground of ReDySim's quadruped: soft and so much damped that feet creep in and out.
pub const SOFT: AnyContactLaw<f64> = AnyContactLaw::ReDySim(ReDySimContact {
    stiffness: 2500.0,
    damping: 3464.1016151377544,
    leaving_speed: 4.5,
    friction: 0.7,
    sliding_damping: 1500.0,
});

/// Hard ground: two feet that carry the robot sink by 1.5 mm.
pub const HARD: AnyContactLaw<f64> = AnyContactLaw::HuntCrossley(HuntCrossleyContact {
    stiffness: 1e6,
    exponent: 1.5,
    damping: 2.0,
    friction: 0.7,
    slip_velocity: 0.01,
});

/// Angles of the knees with a foot on the ground, rad.
const BENT: f64 = -1.137;
/// How much more the knee of a lifted leg is bent, rad: the foot rises by 9 cm.
const LIFT: f64 = 0.46;
/// How far the thighs swing, rad.
const SWING: f64 = 0.15;

/// The motion of the legs: two that stand diagonally step together, the other two half a second later. Knees bend by
/// sin⁴(π t), thighs swing by sin(2 π t): every derivative is continuous.
pub fn motion(t: f64) -> Motion<Coordinates, Velocities> {
    let mut motion = Motion { q: [0.0; Quadruped::NQ], v: [0.0; Quadruped::NV], a: [0.0; Quadruped::NV] };
    motion.q[6] = 1.0;
    // Rear right, rear left, front right, front left.
    for (leg, phase) in [0.0, 0.5, 0.5, 0.0].into_iter().enumerate() {
        let ((sin, cos), (sin_twice, cos_twice)) = ((TAU * (t + phase)).sin_cos(), (2.0 * TAU * (t + phase)).sin_cos());
        let lift = [(3.0 - 4.0 * cos + cos_twice) / 8.0, PI * (sin - 0.5 * sin_twice), TAU * PI * (cos - cos_twice)];
        let swing = [-sin, -TAU * cos, TAU * TAU * sin];
        let knee = [BENT - LIFT * lift[0], -LIFT * lift[1], -LIFT * lift[2]];
        // The foot of a thigh that does not swing stays below the hip.
        let [q, v, a] = [0, 1, 2].map(|order| [0.0, SWING * swing[order] - 0.5 * knee[order], knee[order]]);
        motion.q[7 + 3 * leg..][..3].copy_from_slice(&q);
        motion.v[6 + 3 * leg..][..3].copy_from_slice(&v);
        motion.a[6 + 3 * leg..][..3].copy_from_slice(&a);
    }
    motion
}

/// The feet on ground of the given law.
pub fn feet(law: AnyContactLaw<f64>) -> Vec<Contact<f64, AnyContactLaw<f64>>> {
    let ground = GroundPlane::new([0.0; 3], [0.0, 1.0, 0.0]).expect("a plane");
    (0..4).map(|foot| Contact::new(foot, ground, law).expect("a law")).collect()
}

/// The stride by one method, with events at touch-down and lift-off or without.
pub fn stride(
    law: AnyContactLaw<f64>,
    method: &impl Integrator<f64>,
    with_events: bool,
    on_event: impl FnMut(ContactEvent<f64>),
) -> Result<Solution<f64, State>, IntegrationError<f64>> {
    let feet = feet(law);
    let grounded = Grounded::new(&Quadruped, &feet).expect("frames of the quadruped");
    let mut simulation = HybridSimulation::new(&grounded, motion, ZeroTorque);
    let mut q = motion(0.0).q;
    // A centimetre above the ground.
    q[1] = 0.6 * (0.5 * BENT).cos() + 0.01;
    let start = simulation.state(0.0, &q, &[0.0; Quadruped::NV]);
    if with_events {
        grounded.run(method, &mut simulation, (0.0, DURATION), start, &mut Ends, on_event)
    } else {
        method.integrate(&mut simulation, (0.0, DURATION), start)
    }
}

/// The largest component of the difference of two configurations on the tangent, rad or m.
pub fn apart(one: &State, other: &State) -> f64 {
    let [one, other] = [one, other].map(|state| std::array::from_fn(|i| state[i]));
    Quadruped.difference(&one, &other).iter().fold(0.0, |most, part| part.abs().max(most))
}
