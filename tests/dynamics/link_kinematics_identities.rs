//! Positions and velocities of links agree with each other and with the energies.
//!
//! In double-double and with dual numbers, as in `identities.rs`.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::dual::{Dual, moving};
use crate::common::models::generic;
use crate::common::random::{Random, State};
use crate::common::traced::traced;
use crate::robots::{Gantry, Gripper, Kr5};
use redysim::generic::{GenericMechanism, Model};
use redysim::{CenterOfMass, LinkState, Momentum, Scalar, TreeDynamics};
use redysim_model::inertia::Sym3;
use redysim_model::{Function, Tree};

const STATES: usize = 300;

type Number = DoubleDouble;
type Vector = [Number; 3];

trait Smooth: TreeDynamics<Number> + TreeDynamics<Dual<Number>> {}
impl<M: TreeDynamics<Number> + TreeDynamics<Dual<Number>>> Smooth for M {}

/// A check of a mechanism: its name, its model, and where its links are at a state.
type Check = fn(&str, &GenericMechanism, &dyn Fn(&State) -> Links);

/// Runs a check on every model, compiled and generic.
fn on_every_mechanism(check: Check) {
    let [kr5, gripper, gantry] = ["kr5", "gripper", "test/gantry"].map(generic);
    check("compiled kr5", &kr5, &|state| Links::new(&Kr5, state));
    check("compiled gripper", &gripper, &|state| Links::new(&Gripper, state));
    check("compiled gantry", &gantry, &|state| Links::new(&Gantry, state));
    for (name, generic) in [("generic kr5", &kr5), ("generic gripper", &gripper), ("generic gantry", &gantry)] {
        check(name, generic, &|state| Links::new(generic, state));
    }
}

/// The links of a mechanism at one state, and how their positions change at its velocities.
struct Links {
    links: Vec<LinkState<Number>>,
    moving: Vec<LinkState<Dual<Number>>>,
    center_of_mass: CenterOfMass<Number>,
    momentum: Momentum<Number>,
    potential: Number,
}

impl Links {
    fn new(m: &impl Smooth, state: &State) -> Self {
        let (q, v, a) = (exact(&state.q), exact(&state.v), exact(&state.a));
        Links {
            links: link_kinematics(m, &q, &v),
            moving: link_kinematics(m, &moving(&q, &v), &moving(&v, &a)),
            center_of_mass: center_of_mass(m, &q, &v),
            momentum: momentum(m, &q, &v),
            potential: energy::<Number>(m, &q, &v).potential,
        }
    }
}

fn states(model: &Model) -> impl Iterator<Item = State> {
    let (mut random, dof) = (Random::new(4), model.dof());
    (0..STATES).map(move |_| random.state(dof))
}

fn dot(a: Vector, b: Vector) -> Number {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[test]
fn rotations_are_orthonormal_and_right_handed() {
    on_every_mechanism(|name, generic, links_at| {
        let mut products = Comparison::new(format!("{name}: Rᵀ R = 1"));
        let mut thirds = Comparison::new(format!("{name}: x × y = z"));
        for link in states(generic.model()).flat_map(|state| links_at(&state).links) {
            let axis = |j: usize| link.rotation.map(|row| row[j]);
            let element = |k: usize| dot(axis(k / 3), axis(k % 3));
            // One is added, so that the zeros are held against numbers of size one as well.
            let product: Vec<Number> = (0..9).map(|k| element(k) + Number::one()).collect();
            products.add(&rounded(product), &[2.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 2.0]);
            let third = cross(axis(0), axis(1)).map(|x| x + Number::from_f64(2.0));
            thirds.add(&rounded(third), &rounded(axis(2).map(|x| x + Number::from_f64(2.0))));
        }
        products.assert_within(1e-15);
        thirds.assert_within(1e-15);
    });
}

#[test]
fn velocity_is_the_derivative_of_the_origin() {
    on_every_mechanism(|name, generic, links_at| {
        let mut velocities = Comparison::new(format!("{name}: velocity = d(origin)/dt"));
        for links in states(generic.model()).map(|state| links_at(&state)) {
            for (link, moving) in links.links.iter().zip(&links.moving) {
                velocities.add(&rounded(link.velocity), &rounded(moving.origin.map(|x| x.rate)));
            }
        }
        // The gantry's oblique rotations are constants, orthonormal to 1e-16 only.
        velocities.assert_within(if name.ends_with("gantry") { 1e-11 } else { 1e-12 });
    });
}

#[test]
fn angular_velocity_is_that_of_the_rotation() {
    on_every_mechanism(|name, generic, links_at| {
        let mut velocities = Comparison::new(format!("{name}: ω× = Ṙ Rᵀ"));
        for links in states(generic.model()).map(|state| links_at(&state)) {
            for (link, moving) in links.links.iter().zip(&links.moving) {
                let spin = |i: usize, j: usize| dot(moving.rotation[i].map(|x| x.rate), link.rotation[j]);
                velocities.add(&rounded(link.angular_velocity), &rounded([spin(2, 1), spin(0, 2), spin(1, 0)]));
            }
        }
        velocities.assert_within(1e-12);
    });
}

#[test]
fn the_centre_of_mass_of_a_link_is_where_the_model_has_it() {
    on_every_mechanism(|name, generic, links_at| {
        let mut centres = Comparison::new(format!("{name}: com = origin + R com"));
        for links in states(generic.model()).map(|state| links_at(&state)) {
            for (link, given) in links.links.iter().zip(&generic.model().links) {
                let com = given.com.0.map(Number::from_f64);
                let at = |i: usize| link.origin[i] + dot(link.rotation[i], com);
                centres.add(&rounded(link.com), &rounded([at(0), at(1), at(2)]));
            }
        }
        centres.assert_within(1e-12);
    });
}

#[test]
fn the_centre_of_mass_of_a_mechanism_is_the_mean_of_its_links_and_moves_as_it_does() {
    on_every_mechanism(|name, generic, links_at| {
        let mut positions = Comparison::new(format!("{name}: M p = Σ m c"));
        let mut velocities = Comparison::new(format!("{name}: M ṗ = Σ m ċ"));
        let model = generic.model();
        for links in states(model).map(|state| links_at(&state)) {
            let mut moments = [[Number::zero(); 3]; 2];
            for (link, moving) in model.links.iter().zip(&links.moving) {
                for (axis, com) in moving.com.into_iter().enumerate() {
                    moments[0][axis] += Number::from_f64(link.mass) * com.value;
                    moments[1][axis] += Number::from_f64(link.mass) * com.rate;
                }
            }
            let CenterOfMass { position, velocity } = links.center_of_mass;
            let of_mass = |vector: Vector| rounded(vector.map(|x| Number::from_f64(model.mass()) * x));
            positions.add(&of_mass(position), &rounded(moments[0]));
            velocities.add(&of_mass(velocity), &rounded(moments[1]));
        }
        // The gantry's oblique rotations are constants, orthonormal to 1e-16 only.
        positions.assert_within(if name.ends_with("gantry") { 1e-11 } else { 1e-12 });
        velocities.assert_within(if name.ends_with("gantry") { 1e-11 } else { 1e-12 });
    });
}

#[test]
fn the_momentum_of_a_mechanism_is_the_sum_of_those_of_its_links() {
    on_every_mechanism(|name, generic, links_at| {
        let mut linear = Comparison::new(format!("{name}: p = Σ m ċ"));
        let mut angular = Comparison::new(format!("{name}: L = Σ I ω + m (c − c₀) × ċ"));
        let model = generic.model();
        for links in states(model).map(|state| links_at(&state)) {
            let center = links.center_of_mass.position;
            let mut sums = [[Number::zero(); 3]; 2];
            for ((link, at), moving) in model.links.iter().zip(&links.links).zip(&links.moving) {
                let (mass, inertia) = (Number::from_f64(link.mass), Sym3::from(link.inertia).full().0);
                let velocity = moving.com.map(|com| com.rate);
                let arm = [0, 1, 2].map(|axis| at.com[axis] - center[axis]);
                let columns = [0, 1, 2].map(|j| at.rotation.map(|row| row[j]));
                let own_axes = columns.map(|column| dot(column, at.angular_velocity));
                let own = inertia.map(|row| dot(row.map(Number::from_f64), own_axes));
                let orbital = cross(arm, velocity);
                for axis in 0..3 {
                    sums[0][axis] += mass * velocity[axis];
                    sums[1][axis] += dot(at.rotation[axis], own) + mass * orbital[axis];
                }
            }
            linear.add(&rounded(links.momentum.linear), &rounded(sums[0]));
            angular.add(&rounded(links.momentum.angular), &rounded(sums[1]));
        }
        // The gantry's oblique rotations are constants, orthonormal to 1e-16 only.
        linear.assert_within(if name.ends_with("gantry") { 1e-11 } else { 1e-12 });
        angular.assert_within(if name.ends_with("gantry") { 1e-11 } else { 1e-12 });
    });
}

#[test]
fn potential_energy_is_that_of_the_centres_of_mass() {
    on_every_mechanism(|name, generic, links_at| {
        let mut potentials = Comparison::new(format!("{name}: V = −Σ m g·c"));
        let model = generic.model();
        let gravity = model.gravity.0.map(Number::from_f64);
        for links in states(model).map(|state| links_at(&state)) {
            let masses = model.links.iter().map(|link| Number::from_f64(link.mass));
            let weights = links.links.iter().zip(masses).map(|(link, mass)| mass * dot(gravity, link.com));
            potentials.add(&rounded([links.potential]), &rounded([-weights.fold(Number::zero(), |sum, w| sum + w)]));
        }
        potentials.assert_within(1e-12);
    });
}

/// Two flywheels: without mass, angular momentum is the same about every point, and Σ m c is zero.
#[test]
fn a_mechanism_without_mass_has_the_momentum_of_its_inertias_and_its_centre_of_mass_at_the_origin() {
    let link = |name: &str, parent: &str| {
        format!(
            "[[link]]\nname = '{name}'\nparent = '{parent}'\njoint = 'revolute'\norigin = {{ xyz = [0.3, 0, 0.1] }}\n\
             axis = [0, 0, 1]\nmass = 0.0\ninertia = {{ xx = 0.02, yy = 0.03, zz = 0.04 }}\n"
        )
    };
    let links = link("inner", "base") + &link("outer", "inner");
    let text = format!("name = 'wheels'\ngravity = [0, 0, -9.81]\n{links}");
    let model = Model::from_toml(text, "wheels.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
    let (q, v) = (vec![0.4, -1.1], vec![2.0, 3.0]);
    let spin = 0.04 * 2.0 + 0.04 * (2.0 + 3.0);

    let wheels = GenericMechanism::new(model.clone());
    let at_the_origin = CenterOfMass { position: [0.0; 3], velocity: [0.0; 3] };
    assert_eq!(redysim::MassCenter::center_of_mass(&wheels, &q, &v), at_the_origin);
    let Momentum { linear, angular } = redysim::TotalMomentum::momentum(&wheels, &q, &v);
    let found = [linear, angular].concat();

    let functions = traced(&Tree::new(&model), &[Function::CenterOfMass, Function::Momentum]);
    let [center, momentum] = [0, 1].map(|index| functions[index].expressions.evaluate(&[&q, &v]));
    assert_eq!(center, [0.0; 6]);
    for found in [found, momentum] {
        let apart = found.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, spin]).map(|(found, expected)| (found - expected).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-15, "{found:?}");
    }
}
