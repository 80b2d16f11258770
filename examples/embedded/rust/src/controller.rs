//! The KR5 under computed torque, and the motion that it follows.

use redysim::{ComputedTorque, Motion, TorqueLaw, redysim};

redysim! {
    /// The KUKA KR5 of the ReDySim paper.
    pub struct Kr5("../../../../models/kr5.toml", functions = [inverse_dynamics, forward_dynamics]);
}

#[cfg(not(feature = "double"))]
pub type Real = f32;
#[cfg(feature = "double")]
pub type Real = f64;

pub type Joints = [Real; Kr5::NV];

/// From rest to rest in one second, with the least jerk: every joint turns by π/3 times 10 t³ − 15 t⁴ + 6 t⁵.
pub fn desired_motion(t: Real) -> Motion<Joints, Joints> {
    const WAY: Real = core::f64::consts::FRAC_PI_3 as Real;
    let s = t.clamp(0.0, 1.0);
    let rest = 1.0 - s;
    Motion {
        q: [WAY * (s * s * s * (10.0 + s * (6.0 * s - 15.0))); Kr5::NV],
        v: [WAY * (30.0 * (s * s * (rest * rest))); Kr5::NV],
        a: [WAY * (60.0 * (s * (rest * (rest - s)))); Kr5::NV],
    }
}

/// The joint torques at time t, N m, which lead onto the desired motion: the error e obeys ë + 40 ė + 400 e = 0.
pub fn control(t: Real, q: &Joints, v: &Joints) -> Joints {
    let mut law =
        ComputedTorque { mechanism: &Kr5, trajectory: desired_motion, kp: [400.0; Kr5::NV], kd: [40.0; Kr5::NV] };
    law.torque(&Kr5, t, q, v)
}
