//! Frames of closed loops: their Jacobians by the independent velocities, by differences along the assembled motion.
#![cfg(feature = "generic")]

use crate::linkages::Fourbar;
use redysim::generic::{GenericMechanism, Model};
use redysim::{ClosedLoop, FrameState, IndependentMotion, InverseDynamics, LoopClosure, LoopError, Wrench};

/// A model of loops with a frame on one link, out of line with everything.
fn mechanism(name: &str, link: &str) -> GenericMechanism {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let frame = format!(
        "\n[[frame]]\nname = \"point\"\nlink = \"{link}\"\norigin = {{ xyz = [0.03, 0.02, -0.01], rpy = [0.4, -0.2, 0.7] }}\n\
         [[frame]]\nname = \"ground\"\nlink = \"base\"\norigin = {{ xyz = [1, 0, 0] }}\n"
    );
    let text = std::fs::read_to_string(path).expect("a model file") + &frame;
    GenericMechanism::new(Model::from_toml(&text, "model.toml").expect("a good model").model)
}

/// A mechanism with a frame, a guess of its position, its independent velocities and some values of these.
struct Case {
    mechanism: GenericMechanism,
    guess: Vec<f64>,
    independent: Vec<usize>,
    velocities: Vec<f64>,
}

fn cases() -> Vec<Case> {
    let case = |name, link, guess: &[f64], independent: &[usize], velocities: &[f64]| Case {
        mechanism: mechanism(name, link),
        guess: guess.to_vec(),
        independent: independent.to_vec(),
        velocities: velocities.to_vec(),
    };
    let three_rrr = [1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869];
    vec![
        case("fourbar", "coupler", &[0.3, 0.9844, 4.3144], &[0], &[1.3]),
        // The rocker drives the crank.
        case("fourbar", "crank", &[0.3, 0.9844, 4.3144], &[1], &[-0.7]),
        case("three_rrr", "platform", &three_rrr, &[0, 3, 5], &[0.8, -0.5, 0.3]),
        case("three_rrr", "rod3", &three_rrr, &[5, 0, 3], &[0.8, -0.5, 0.3]),
        // In space; its rows are redundant.
        case("test/bricard", "rod3", &[0.5; 5], &[0], &[0.9]),
    ]
}

impl Case {
    fn loops(&self) -> ClosedLoop<'_, GenericMechanism> {
        ClosedLoop::new(&self.mechanism)
    }

    /// The closed position where each independent coordinate has moved on by its velocity for the time `s`.
    fn position(&self, s: f64) -> Vec<f64> {
        let none = vec![0.0; self.guess.len()];
        let start = self.loops().assemble(&self.guess, &none, &self.independent).expect("it closes").q;
        let mut q = start;
        for (&index, velocity) in self.independent.iter().zip(&self.velocities) {
            q[index] += s * velocity;
        }
        self.loops().assemble(&q, &none, &self.independent).expect("it closes").q
    }

    fn motion(&self, q: &Vec<f64>) -> IndependentMotion<'_, f64, GenericMechanism, GenericMechanism, Vec<f64>> {
        self.loops().independent_motion(q, &self.independent).expect("they determine the others")
    }

    /// The frame's state at the time `s` of a motion at constant independent velocities.
    fn frame(&self, s: f64) -> FrameState<f64> {
        self.motion(&self.position(s)).frame_kinematics(&self.velocities)[0]
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn close(what: &str, found: [f64; 3], expected: [f64; 3], tolerance: f64) {
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() < tolerance * scale, "{what}: {found:?} instead of {expected:?}");
    }
}

/// Central differences of the fourth order: (8 (f(h) − f(−h)) − (f(2 h) − f(−2 h)))/12 h.
fn slope<const N: usize>(f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    const H: f64 = 2e-3;
    let [ahead, behind, far_ahead, far_behind] = [H, -H, 2.0 * H, -2.0 * H].map(f);
    std::array::from_fn(|i| (8.0 * (ahead[i] - behind[i]) - (far_ahead[i] - far_behind[i])) / (12.0 * H))
}

#[test]
fn the_velocity_of_a_frame_is_the_difference_of_its_assembled_positions_and_its_jacobian_times_the_speeds() {
    for case in cases() {
        let name = &case.mechanism.model().name;
        let q = case.position(0.0);
        let motion = case.motion(&q);
        let state = motion.frame_kinematics(&case.velocities)[0];
        close(name, state.velocity, slope(|s| case.frame(s).origin), 1e-9);
        // Ṙ Rᵀ = ω ×
        let rotation: [f64; 9] = slope(|s| case.frame(s).rotation.concat().try_into().expect("nine elements"));
        let spin = |i: usize, j: usize| (0..3).map(|k| rotation[3 * i + k] * state.rotation[j][k]).sum();
        close(name, state.angular_velocity, [spin(2, 1), spin(0, 2), spin(1, 0)], 1e-9);
        let jacobian = &motion.frame_jacobians()[0];
        assert!(jacobian.linear.iter().all(|row| row.len() == case.independent.len()));
        let times = |rows: &[Vec<f64>; 3]| rows.each_ref().map(|row| dot(row, &case.velocities));
        close(name, times(&jacobian.linear), state.velocity, 1e-13);
        close(name, times(&jacobian.angular), state.angular_velocity, 1e-13);
        assert!(dot(&state.velocity, &state.velocity) > 1e-6, "{name} moves: {state:?}");
    }
}

#[test]
fn the_bias_of_a_frame_is_the_rate_of_its_velocity_at_constant_independent_velocities() {
    for case in cases() {
        let name = &case.mechanism.model().name;
        let bias = case.motion(&case.position(0.0)).frame_bias(&case.velocities).expect("closed");
        close(name, bias[0].linear, slope(|s| case.frame(s).velocity), 1e-8);
        close(name, bias[0].angular, slope(|s| case.frame(s).angular_velocity), 1e-8);
        assert!(dot(&bias[0].linear, &bias[0].linear) > 1e-6, "{name}: {bias:?}");
        assert_eq!((bias[1].linear, bias[1].angular), ([0.0; 3], [0.0; 3]), "the ground rests");
    }
}

#[test]
fn velocities_and_accelerations_keep_the_loops_closed_and_have_the_independent_ones_that_are_given() {
    for case in cases() {
        let q = case.position(0.0);
        let motion = case.motion(&q);
        let v = motion.velocities(&case.velocities);
        let given: Vec<f64> = case.velocities.iter().map(|v| 2.0 - v).collect();
        let a = motion.accelerations(&case.velocities, &given).expect("closed");
        let jacobian = case.mechanism.loop_jacobian(&q);
        let bias: Vec<f64> = case.mechanism.loop_bias(&q, &v);
        for (row, bias) in jacobian.iter().zip(&bias) {
            assert!(dot(row, &v).abs() < 1e-12 && (dot(row, &a) + bias).abs() < 1e-11, "{a:?}");
        }
        for (i, &index) in case.independent.iter().enumerate() {
            assert!((v[index] - case.velocities[i]).abs() < 1e-15 && (a[index] - given[i]).abs() < 1e-15);
        }
    }
}

#[test]
fn forces_of_wrenches_on_the_independent_velocities_have_the_power_of_the_wrenches() {
    let wrench = Wrench { force: [3.0, -2.0, 5.0], moment: [0.4, 0.7, -0.6] };
    for case in cases() {
        let motion = case.motion(&case.position(0.0));
        let forces = motion.frame_forces(&vec![wrench, wrench]);
        let state = motion.frame_kinematics(&case.velocities)[0];
        let power = dot(&wrench.force, &state.velocity) + dot(&wrench.moment, &state.angular_velocity);
        assert!((dot(&forces, &case.velocities) - power).abs() < 1e-12 * (1.0 + power.abs()));
    }
}

#[test]
fn independent_velocities_that_do_not_fit_the_loops_are_refused() {
    let fourbar = mechanism("fourbar", "coupler");
    let loops = ClosedLoop::new(&fourbar);
    let q = loops.assemble(&vec![0.3, 0.9844, 4.3144], &vec![0.0; 3], &[0]).unwrap().q;
    let refused = |independent: &[usize]| {
        let motion: Result<IndependentMotion<'_, f64, _, _, Vec<f64>>, _> = loops.independent_motion(&q, independent);
        motion.err().expect("refused")
    };
    assert!(matches!(refused(&[]), LoopError::RankDeficient { rank: 2, needed: 3, .. }), "{:?}", refused(&[]));
    assert!(matches!(refused(&[0, 1]), LoopError::InconsistentVelocity { .. }), "{:?}", refused(&[0, 1]));
    assert_eq!(refused(&[0, 0]), LoopError::RepeatedVelocity { velocity: 0 });
    assert_eq!(refused(&[3]), LoopError::VelocityOutOfRange { velocity: 3, count: 3 });
}

/// Bᵀ τ: with the loops' multipliers gone, what the crank needs for a motion.
#[test]
fn joint_forces_of_a_compiled_tree_are_restricted_to_the_crank() {
    let loops = ClosedLoop::new(&Fourbar);
    let q = loops.assemble(&[0.3, 0.9844, 4.3144], &[0.0; 3], &[0]).unwrap().q;
    let motion: IndependentMotion<'_, f64, _, _, [f64; 1]> = loops.independent_motion(&q, &[0]).unwrap();
    let (v, a) = ([1.3], [0.4]);
    let of_tree = Fourbar.inverse_dynamics(&q, &motion.velocities(&v), &motion.accelerations(&v, &a).unwrap());
    let crank = move |t: f64| redysim::Motion { q: [q[0] + t * v[0]], v, a };
    let expected = redysim::ClosedLoopInverse::new(loops, &[0], q).at(0.0, &crank).unwrap().forces[0];
    let [found] = motion.restricted(&of_tree);
    assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} instead of {expected}");
}
