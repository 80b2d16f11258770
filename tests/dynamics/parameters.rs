//! Parameters that are given at run time: a robot that picks up a load, loses gravity, or wears its joints.

use crate::common::call::{coriolis_matrix, mass_matrix};
use crate::common::random::Random;
use nalgebra::DMatrix;
use redysim::Real;
use redysim::generic::{GenericMechanism, Inertia, Model, Vec3};
use redysim::lanes::F64x4;
use redysim::{
    BiasForces, ConfigurationSpace, Dual, ForwardDynamics, Function, InverseDynamics, LoopClosure, MassMatrix,
    MechanicalEnergy, Mechanism, ParameterError, ParameterRule, Scalar, TreeDynamics, batch, redysim,
};

redysim! {
    /// KR5 with constants.
    struct Kr5("models/peers/kr5.toml");
}

redysim! {
    /// KR5 with all that may be given of its last link, and more.
    pub struct Carrying(
        "models/peers/kr5.toml",
        parameters = [
            "gravity", "link6.mass", "link6.com", "link6.inertia", "link2.damping", "link3.friction",
            "link3.friction_velocity", "link1.armature", "link4.stiffness", "link4.rest",
        ]
    );
}

redysim! {
    /// A four-bar linkage whose coupler is given.
    struct Coupled("models/fourbar.toml", parameters = ["coupler.mass", "coupler.com"]);
}

const Q: [f64; 6] = [0.3, -0.8, 1.1, 2.0, -0.4, 0.9];
const V: [f64; 6] = [1.0, -2.0, 0.5, 3.0, -1.5, 0.7];
const A: [f64; 6] = [0.7, 0.1, -4.0, 2.0, 5.0, -3.0];

/// A robot that differs from that of the model in every parameter.
const OTHER: [f64; Carrying::NP] = [
    0.3, -1.2, -9.0, 4.5, 0.02, -0.05, 0.21, 0.031, 0.035, 0.018, 0.002, -0.001, 0.003, 1.7, 2.5, 0.04, 0.8, 30.0, 0.4,
];

/// The same robot as a model.
fn other() -> GenericMechanism {
    let mut model = Model::load("models/peers/kr5.toml").expect("a valid model").model;
    model.gravity = Vec3([0.3, -1.2, -9.0]);
    let tool = &mut model.links[5];
    (tool.mass, tool.com) = (4.5, Vec3([0.02, -0.05, 0.21]));
    tool.inertia = Inertia { xx: 0.031, yy: 0.035, zz: 0.018, xy: 0.002, yz: -0.001, xz: 0.003 };
    model.links[1].physics.damping = 1.7.into();
    (model.links[2].physics.friction, model.links[2].physics.friction_velocity) = (2.5.into(), 0.04.into());
    model.links[0].physics.armature = 0.8.into();
    (model.links[3].physics.stiffness, model.links[3].physics.rest) = (30.0.into(), vec![0.4]);
    GenericMechanism::new(model)
}

fn assert_close(found: &[f64], expected: &[f64], bound: f64) {
    let largest = expected.iter().fold(0.0_f64, |largest, x| Real::maximum(largest, x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= bound * largest, "{found} instead of {expected}");
    }
}

#[test]
fn parameters_have_names_and_the_values_of_the_model() {
    assert_eq!(
        Carrying::PARAMETER_NAMES,
        [
            "gravity.x",
            "gravity.y",
            "gravity.z",
            "link6.mass",
            "link6.com.x",
            "link6.com.y",
            "link6.com.z",
            "link6.inertia.xx",
            "link6.inertia.yy",
            "link6.inertia.zz",
            "link6.inertia.xy",
            "link6.inertia.yz",
            "link6.inertia.xz",
            "link2.damping",
            "link3.friction",
            "link3.friction_velocity",
            "link1.armature",
            "link4.stiffness",
            "link4.rest",
        ]
    );
    assert_eq!(Carrying::PARAMETERS[..4], [0.0, 0.0, -9.81, 0.008]);
    assert_eq!((Carrying::NP, Carrying::NQ, Kr5::NP), (19, 6, 0));
}

#[test]
fn the_default_is_the_robot_of_the_model() {
    let robot = Carrying::<f64>::default();
    assert_close(&robot.inverse_dynamics(&Q, &V, &A), &Kr5::inverse_dynamics(&Q, &V, &A), 1e-14);
    assert_close(&robot.forward_dynamics(&Q, &V, &A), &Kr5::forward_dynamics(&Q, &V, &A), 1e-14);
    assert_close(robot.mass_matrix(&Q).as_flattened(), Kr5::mass_matrix(&Q).as_flattened(), 1e-14);
    assert_eq!(robot.passive_forces(&Q, &V), [0.0; 6]);
}

/// What every function of a robot without loops, frames and passive joints gives at a state.
fn every_function<M>(robot: &M, [q, v, a]: &[[f64; 6]; 3]) -> Vec<(Function, Vec<f64>)>
where
    M: TreeDynamics<f64, Coordinates = [f64; 6], Velocities = [f64; 6]>,
{
    let links = robot.link_kinematics(q, v);
    let places = links.as_ref().iter().flat_map(|link| {
        let vectors = [link.origin, link.com, link.velocity, link.angular_velocity];
        [link.rotation.concat(), vectors.concat()].concat()
    });
    let (energy, center, momentum) = (robot.energy(q, v), robot.center_of_mass(q, v), robot.momentum(q, v));
    vec![
        (Function::InverseDynamics, robot.inverse_dynamics(q, v, a).to_vec()),
        (Function::ForwardDynamics, robot.forward_dynamics(q, v, a).to_vec()),
        (Function::MassMatrix, mass_matrix(robot, q).concat()),
        (Function::BiasForces, robot.bias_forces(q, v).to_vec()),
        (Function::CoriolisMatrix, coriolis_matrix(robot, q, v).concat()),
        (Function::GravityForces, robot.gravity_forces(q).to_vec()),
        (Function::PassiveForces, robot.passive_forces(q, v).to_vec()),
        (Function::Energy, vec![energy.kinetic, energy.potential]),
        (Function::CenterOfMass, [center.position, center.velocity].concat()),
        (Function::Momentum, [momentum.linear, momentum.angular].concat()),
        (Function::LinkKinematics, places.collect()),
        (Function::CoordinateRates, robot.coordinate_rates(q, v).to_vec()),
        (Function::Integrate, robot.integrate(q, v).to_vec()),
        (Function::Difference, robot.difference(q, v).to_vec()),
        (Function::DissipatedPower, vec![robot.dissipated_power(q, v)]),
        (Function::Neutral, robot.neutral().to_vec()),
    ]
}

#[test]
fn every_function_that_a_robot_can_have_is_compared_with_its_parameters() {
    let compared = every_function(&Kr5, &[Q, V, A]).into_iter().map(|(function, _)| function);
    let others =
        |function: &&Function| function.needs_loops() || function.needs_frames() || function.needs_passive_joints();
    let compared: Vec<Function> = compared.chain(Function::ALL.iter().filter(others).copied()).collect();
    assert_eq!(compared.len(), Function::ALL.len());
    assert!(Function::ALL.iter().all(|function| compared.contains(function)), "{compared:?}");
}

fn random_states(count: usize) -> Vec<[[f64; 6]; 3]> {
    let mut random = Random::new(6);
    (0..count).map(|_| [(); 3].map(|()| [(); 6].map(|()| random.within(3.0)))).collect()
}

/// The constants are folded in another order: a few roundings of the largest component; of accelerations, times the condition
/// of the mass matrix.
#[test]
fn every_function_of_the_default_is_that_of_the_model() {
    let robot = Carrying::<f64>::default();
    for state in random_states(100) {
        let rounding = 1e-15 * condition(&Kr5::mass_matrix(&state[0])).max(1e3);
        for ((function, found), (_, expected)) in
            every_function(&robot, &state).iter().zip(every_function(&Kr5, &state))
        {
            let bound = if *function == Function::ForwardDynamics { rounding } else { 1e-14 };
            assert_close(found, &expected, bound);
        }
    }
}

/// The largest by the smallest eigenvalue.
fn condition(matrix: &[[f64; 6]; 6]) -> f64 {
    let eigenvalues = DMatrix::from_fn(6, 6, |i, j| matrix[i][j]).symmetric_eigenvalues();
    assert!(eigenvalues.min() > 0.0, "{eigenvalues}");
    eigenvalues.max() / eigenvalues.min()
}

#[test]
fn a_robot_with_parameters_is_the_generic_robot_with_these_numbers() {
    let (robot, generic) = (Carrying::new(&OTHER), other());
    let [q, v, a] = [Q, V, A].map(Vec::from);
    assert_close(&robot.inverse_dynamics(&Q, &V, &A), &generic.inverse_dynamics(&q, &v, &a), 1e-13);
    assert_close(&robot.forward_dynamics(&Q, &V, &A), &generic.forward_dynamics(&q, &v, &a), 1e-12);
    assert_close(&robot.bias_forces(&Q, &V), &generic.bias_forces(&q, &v), 1e-13);
    for (found, expected) in robot.mass_matrix(&Q).iter().zip(generic.mass_matrix(&q)) {
        assert_close(found, &expected, 1e-13);
    }
    let (found, expected) = (robot.energy(&Q, &V), generic.energy(&q, &v));
    assert_close(&[found.kinetic, found.potential], &[expected.kinetic, expected.potential], 1e-13);
    let (found, expected) = (robot.link_kinematics(&Q, &V), redysim::LinkKinematics::link_kinematics(&generic, &q, &v));
    found.iter().zip(&expected).for_each(|(found, expected)| assert_close(&found.com, &expected.com, 1e-13));
}

/// Whatever the parameters: τ = M a + bias, accelerations give back the forces, the kinetic energy is ½ vᵀ M v, and the power
/// of gravity is what the potential energy loses. Tensors of random numbers are mostly those of no body, which identities do
/// not ask; the mass matrix is kept positive by the rotor and the other links.
#[test]
fn identities_hold_with_parameters_at_random() {
    let mut random = Random::new(5);
    for _ in 0..200 {
        let parameters = OTHER.map(|nominal| nominal * (1.0 + random.within(0.5)));
        let robot = Carrying::new(&parameters);
        let [q, v, a] = [(); 3].map(|()| [(); 6].map(|()| random.within(3.0)));
        let matrix = robot.mass_matrix(&q);
        let times = |x: &[f64; 6]| matrix.map(|row| dot(&row, x));
        let (tau, bias, inertial) = (robot.inverse_dynamics(&q, &v, &a), robot.bias_forces(&q, &v), times(&a));
        assert_close(&std::array::from_fn::<f64, 6, _>(|i| inertial[i] + bias[i]), &tau, 1e-12);
        // A rounding of a force is one of an acceleration times the condition of the matrix.
        let rounding = 1e-15 * condition(&matrix).max(1e3);
        assert_close(&robot.forward_dynamics(&q, &v, &tau), &a, rounding);
        assert_close(&[0.5 * dot(&v, &times(&v))], &[robot.energy(&q, &v).kinetic], 1e-12);
        let constant = |value: f64| Dual { value, slope: 0.0 };
        let along = std::array::from_fn(|i| Dual { value: q[i], slope: v[i] });
        let dual = Carrying::new(&parameters.map(constant));
        let fallen = dual.energy(&along, &v.map(constant)).potential.slope;
        let resting = robot.bias_forces(&q, &[0.0; 6]);
        assert_close(&[dot(&resting, &v)], &[fallen], 1e-11);
    }
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// In between, the robot carries other loads, feels another gravity and wears its joints: each parameter of it is held for a
/// while, beside others.
#[test]
fn every_function_has_the_same_bits_after_a_load_is_added_and_removed() {
    let states = random_states(10);
    let values = |parameters: &[f64; Carrying::NP]| -> Vec<Vec<f64>> {
        let robot = Carrying::new(parameters);
        states.iter().flat_map(|state| every_function(&robot, state)).map(|(_, values)| values).collect()
    };
    let bits = |parameters: &[f64; Carrying::NP]| -> Vec<u64> {
        values(parameters).into_iter().flatten().map(f64::to_bits).collect()
    };
    let mut parameters = Carrying::PARAMETERS;
    let before = bits(&parameters);
    for index in 0..Carrying::NP {
        let (own, next) = (parameters[index], (index + 1) % Carrying::NP);
        parameters[index] = OTHER[index];
        let (alone, carried) = (bits(&parameters), parameters);
        parameters[next] = OTHER[next];
        let both = bits(&parameters);
        parameters[next] = Carrying::PARAMETERS[next];
        assert!(bits(&parameters) == alone, "{} beside another", Carrying::PARAMETER_NAMES[index]);
        parameters[index] = own;
        assert!(bits(&parameters) == before, "{} restored", Carrying::PARAMETER_NAMES[index]);
        // A friction's velocity and a spring's rest matter only with a friction and a stiffness; without, the sign of a zero
        // changes.
        let changed = values(&carried) != values(&Carrying::PARAMETERS);
        let matters = !["link3.friction_velocity", "link4.rest"].contains(&Carrying::PARAMETER_NAMES[index]);
        assert_eq!(changed, matters, "{}", Carrying::PARAMETER_NAMES[index]);
        assert!(both != before);
    }
    let mut loaded = Carrying::PARAMETERS;
    loaded[3] += 5.0;
    let [free, carrying] = [Carrying::PARAMETERS, loaded].map(|x| Carrying::new(&x).inverse_dynamics(&Q, &V, &A));
    assert!((carrying[1] - free[1]).abs() > 10.0, "five kilograms at arm's length");
}

/// What a library that is generic over mechanisms asks for.
fn power<M>(mechanism: &M, q: &M::Coordinates, v: &M::Velocities, a: &M::Velocities) -> f64
where
    M: InverseDynamics<f64> + MassMatrix<f64> + MechanicalEnergy<f64>,
{
    let tau = mechanism.inverse_dynamics(q, v, a);
    tau.as_ref().iter().zip(v.as_ref()).map(|(tau, v)| tau * v).sum()
}

#[test]
fn code_over_mechanisms_takes_a_robot_with_parameters() {
    let robot = Carrying::new(&OTHER);
    let [q, v, a] = [Q, V, A].map(Vec::from);
    let (found, expected) = (power(&robot, &Q, &V, &A), power(&other(), &q, &v, &a));
    assert!((found - expected).abs() < 1e-11 * expected.abs());
    assert_eq!((robot.nq(), robot.joint_name(1), robot.nf()), (6, Some("link2"), 0));
    // Power that damping and friction take: d v² + f v²/√(v² + ε²).
    let dissipated: f64 = ConfigurationSpace::<f64>::dissipated_power(&robot, &Q, &V);
    let expected = 1.7 * V[1] * V[1] + 2.5 * V[2] * V[2] / V[2].hypot(0.04);
    assert!((dissipated - expected).abs() < 1e-12 * expected);
}

#[test]
fn derivatives_of_a_robot_with_parameters_are_limits_of_differences() {
    let (robot, h) = (Carrying::new(&OTHER), 1e-6);
    let shifted = |sign: f64| [Q, V, A].map(|x| std::array::from_fn::<f64, 6, _>(|i| x[i] + sign * h * A[5 - i]));
    let slopes = std::array::from_fn::<f64, 6, _>(|i| A[5 - i]);
    let slopes = (&slopes, &slopes, &slopes);
    let tangent = InverseDynamics::<f64>::inverse_dynamics_tangent(&robot, (&Q, &V, &A), slopes).expect("compiled");
    let [above, below] = [1.0, -1.0].map(|sign| {
        let [q, v, a] = shifted(sign);
        robot.inverse_dynamics(&q, &v, &a)
    });
    let difference: [f64; 6] = std::array::from_fn(|i| (above[i] - below[i]) / (2.0 * h));
    assert_close(&tangent, &difference, 1e-7);
    assert!(ForwardDynamics::<f64>::forward_dynamics_tangent(&robot, (&Q, &V, &A), slopes).is_some());
}

/// ∂τ/∂m of the tool, by parameters that are dual numbers: τ is linear in an inertia about the origin of the link, and
/// with a fixed centre of mass its first moment and its inertia grow with the mass.
#[test]
fn forces_may_be_differentiated_by_parameters() {
    let mut parameters = OTHER.map(|value| Dual { value, slope: 0.0 });
    parameters[3].slope = 1.0;
    let [q, v, a] = [Q, V, A].map(|x| x.map(|value| Dual { value, slope: 0.0 }));
    let found = Carrying::new(&parameters).inverse_dynamics(&q, &v, &a).map(|tau| tau.slope);
    let [heavy, light] = [1.0, -1.0].map(|change| {
        let mut parameters = OTHER;
        parameters[3] += change;
        Carrying::new(&parameters).inverse_dynamics(&Q, &V, &A)
    });
    let expected: [f64; 6] = std::array::from_fn(|i| 0.5 * (heavy[i] - light[i]));
    assert_close(&found, &expected, 1e-12);
}

#[test]
fn each_lane_may_have_a_robot_of_its_own() {
    let masses = [1.0, 2.0, 3.0, 7.0];
    let mut parameters = OTHER.map(F64x4::from_f64);
    parameters[3] = F64x4::from(masses);
    let found = Carrying::new(&parameters).inverse_dynamics(
        &Q.map(F64x4::from_f64),
        &V.map(F64x4::from_f64),
        &A.map(F64x4::from_f64),
    );
    for (lane, mass) in masses.into_iter().enumerate() {
        let mut parameters = OTHER;
        parameters[3] = mass;
        let expected = Carrying::new(&parameters).inverse_dynamics(&Q, &V, &A);
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.to_array()[lane], expected, "a lane has the bits of its robot");
        }
    }
}

/// Inverse dynamics of robots of which each has its own load: mass, then coordinates.
struct Loads;

impl batch::Function<7, 6> for Loads {
    #[inline(always)]
    fn evaluate<S: Scalar>(&self, inputs: [S; 7]) -> [S; 6] {
        let mut parameters = OTHER.map(S::from_f64);
        let [mass, q @ ..] = inputs;
        parameters[3] = mass;
        Carrying::new(&parameters).inverse_dynamics(&q, &V.map(S::from_f64), &A.map(S::from_f64))
    }
}

#[test]
fn a_batch_takes_a_thousand_robots_with_a_thousand_loads() {
    let inputs: Vec<[f64; 7]> = (0..1000)
        .map(|i| std::array::from_fn(|k| if k == 0 { 0.01 * i as f64 } else { (0.3 * (i * k) as f64).sin() }))
        .collect();
    let mut found = vec![[0.0; 6]; inputs.len()];
    batch::evaluate(&Loads, &inputs, &mut found).expect("as many results as robots");
    for (inputs, found) in inputs.iter().zip(&found).step_by(37) {
        let mut parameters = OTHER;
        parameters[3] = inputs[0];
        let q = std::array::from_fn(|k| inputs[k + 1]);
        assert_close(found, &Carrying::new(&parameters).inverse_dynamics(&q, &V, &A), 1e-13);
    }
    // One robot at many states: the batch of its functions.
    let (robot, q) = (Carrying::new(&OTHER), vec![Q; 100]);
    let mut tau = vec![[0.0; 6]; q.len()];
    batch::bias_forces(&robot, &q, &vec![V; 100], &mut tau).expect("as many results as states");
    assert_close(&tau[99], &robot.bias_forces(&Q, &V), 1e-13);
}

#[test]
fn a_closed_loop_may_have_parameters() {
    let q = [0.6, 1.1, -0.7];
    let robot = Coupled::<f64>::default();
    let residual: [f64; Coupled::NC] = LoopClosure::<f64, Coupled>::loop_residual(&robot, &q);
    assert_eq!(residual, robot.loop_residual(&q));
    let parameters = Coupled::PARAMETERS.map(|value| 2.0 * value);
    assert_ne!(Coupled::new(&parameters).gravity_forces(&q), robot.gravity_forces(&q));
}

#[test]
fn invalid_parameters_are_rejected_with_their_rule() {
    let refused = |index: usize, value: f64| {
        let mut parameters = OTHER;
        parameters[index] = value;
        Carrying::try_new(&parameters).map(|_| ()).unwrap_err()
    };
    assert!(Carrying::try_new(&OTHER).is_ok() && Carrying::try_new(&OTHER.map(|x| x as f32)).is_ok());
    let negative = ParameterError { index: 3, name: "link6.mass", value: -1.0, rule: ParameterRule::NotNegative };
    assert_eq!(refused(3, -1.0), negative);
    assert_eq!(negative.to_string(), "parameter `link6.mass` is -1.0: it must not be negative");
    assert_eq!(refused(7, 1.0).rule, ParameterRule::Inertia);
    assert_eq!(refused(15, 0.0).to_string(), "parameter `link3.friction_velocity` is 0.0: it must be positive");
    assert_eq!(refused(2, f64::NAN).to_string(), "parameter `gravity.z` is NaN: give a finite number");
    // `new` is total.
    let mut parameters = OTHER;
    parameters[3] = -1.0;
    assert!(Carrying::new(&parameters).inverse_dynamics(&Q, &V, &A).iter().all(|tau| tau.is_finite()));
}

#[test]
fn single_precision_has_its_own_robots() {
    let robot = Carrying::new(&OTHER.map(|x| x as f32));
    let [q, v, a] = [Q, V, A].map(|x| x.map(|x| x as f32));
    let found = robot.inverse_dynamics(&q, &v, &a).map(f64::from);
    assert_close(&found, &Carrying::new(&OTHER).inverse_dynamics(&Q, &V, &A), 1e-5);
    // And the traits.
    let through: [f32; 6] = BiasForces::<f32>::bias_forces(&robot, &q, &v);
    assert_eq!(through, robot.bias_forces(&q, &v));
}
