//! What is counted, and with which numbers.

use redysim::{JointTrig, redysim};

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    struct Kr5("../../../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    struct Gripper("../../../models/peers/gripper.toml");
}

/// As many states: enough for both signs and all quadrants of every angle.
pub const CALLS: usize = 64;

/// Takes every function with its arguments.
pub trait Visitor {
    fn visit<I, R: Numbers>(&mut self, name: &str, inputs: &[I; CALLS], function: fn(&I) -> R);
}

/// Coordinates, velocities, and accelerations or forces.
type State<const N: usize> = [[f32; N]; 3];

/// The same with sines and cosines instead of coordinates.
struct At<const N: usize, const A: usize> {
    trig: JointTrig<f32, N, A>,
    v: [f32; N],
    u: [f32; N],
}

fn at<const N: usize, const A: usize>(
    states: &[State<N>; CALLS],
    joint_trig: fn(&[f32; N]) -> JointTrig<f32, N, A>,
) -> [At<N, A>; CALLS] {
    core::array::from_fn(|index| {
        let [q, v, u] = states[index];
        At { trig: joint_trig(&q), v, u }
    })
}

/// Every function of both robots.
pub fn visit_all(visitor: &mut impl Visitor) {
    kr5(visitor, &states());
    gripper(visitor, &states());
}

fn kr5(visitor: &mut impl Visitor, states: &[State<6>; CALLS]) {
    visitor.visit("kr5_inverse_dynamics", states, |[q, v, a]| Kr5::inverse_dynamics(q, v, a));
    visitor.visit("kr5_forward_dynamics", states, |[q, v, tau]| Kr5::forward_dynamics(q, v, tau));
    visitor.visit("kr5_mass_matrix", states, |[q, _, _]| Kr5::mass_matrix(q));
    let states = at(states, Kr5::joint_trig);
    visitor.visit("kr5_inverse_dynamics_with_trig", &states, |s| Kr5::inverse_dynamics_with_trig(&s.trig, &s.v, &s.u));
    visitor.visit("kr5_forward_dynamics_with_trig", &states, |s| Kr5::forward_dynamics_with_trig(&s.trig, &s.v, &s.u));
    visitor.visit("kr5_mass_matrix_with_trig", &states, |s| Kr5::mass_matrix_with_trig(&s.trig));
}

fn gripper(visitor: &mut impl Visitor, states: &[State<4>; CALLS]) {
    visitor.visit("gripper_inverse_dynamics", states, |[q, v, a]| Gripper::inverse_dynamics(q, v, a));
    visitor.visit("gripper_forward_dynamics", states, |[q, v, tau]| Gripper::forward_dynamics(q, v, tau));
    visitor.visit("gripper_mass_matrix", states, |[q, _, _]| Gripper::mass_matrix(q));
    let states = at(states, Gripper::joint_trig);
    visitor.visit("gripper_inverse_dynamics_with_trig", &states, |s| Gripper::inverse_dynamics_with_trig(&s.trig, &s.v, &s.u));
    visitor.visit("gripper_forward_dynamics_with_trig", &states, |s| Gripper::forward_dynamics_with_trig(&s.trig, &s.v, &s.u));
    visitor.visit("gripper_mass_matrix_with_trig", &states, |s| Gripper::mass_matrix_with_trig(&s.trig));
}

/// Numbers that fill intervals evenly: multiples of the golden ratio, without whole parts. Coordinates are up to π.
fn states<const N: usize>() -> [State<N>; CALLS] {
    let mut count = 0_u32;
    core::array::from_fn(|_| {
        [core::f32::consts::PI, 3.0, 10.0].map(|bound| {
            core::array::from_fn(|_| {
                count += 1;
                count.wrapping_mul(0x9e37_79b9) as i32 as f32 * (bound / 2_147_483_648.0)
            })
        })
    })
}

/// What a function returns.
pub trait Numbers {
    fn each(&self, see: &mut impl FnMut(f32));
}

impl Numbers for f32 {
    fn each(&self, see: &mut impl FnMut(f32)) {
        see(*self);
    }
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn each(&self, see: &mut impl FnMut(f32)) {
        self.iter().for_each(|numbers| numbers.each(see));
    }
}

/// All bits of what `function` returns for each of `inputs` (FNV-1a).
pub fn hash<I, R: Numbers>(inputs: &[I; CALLS], function: fn(&I) -> R) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for input in inputs {
        function(input).each(&mut |number| {
            for byte in number.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        });
    }
    hash
}
