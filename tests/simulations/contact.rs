//! A parcel thrown onto the ground, compiled and on the generic path.

use crate::common::models::generic;
use redysim::integrate::Ends;
use redysim::{
    AnyContactLaw, Contact, ContactEvent, ForwardDynamics, ForwardSimulation, Frames, GroundPlane, Grounded,
    HuntCrossleyContact, MechanicalEnergy, Ode45, ReDySimContact, Vector, ZeroTorque, redysim,
};

redysim! { struct Parcel("models/parcel.toml"); }

const HUNT_CROSSLEY: AnyContactLaw<f64> = AnyContactLaw::HuntCrossley(HuntCrossleyContact {
    stiffness: 2e4,
    exponent: 1.5,
    damping: 0.8,
    friction: 0.5,
    slip_velocity: 0.01,
});
const REDYSIM: AnyContactLaw<f64> = AnyContactLaw::ReDySim(ReDySimContact {
    stiffness: 5e3,
    damping: 40.0,
    leaving_speed: 5.0,
    friction: 0.5,
    sliding_damping: 100.0,
});

/// State and events of 0.6 s, in which the parcel lands on a corner and turns over, with the two laws on opposite
/// sides of it; and the largest error of the energy balance, J.
fn thrown<M>(parcel: &M) -> (Vec<f64>, Vec<ContactEvent<f64>>, f64)
where
    M: Frames<f64> + ForwardDynamics<f64> + MechanicalEnergy<f64>,
{
    let ground = GroundPlane::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let law = |frame: usize| if frame.is_multiple_of(2) { HUNT_CROSSLEY } else { REDYSIM };
    let contacts: Vec<_> = (0..8).map(|frame| Contact::new(frame, ground, law(frame)).unwrap()).collect();
    let grounded = Grounded::new(parcel, &contacts).unwrap();
    let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    let q = [0.0, 0.0, 0.5, 0.2, 0.1, 0.0, 0.97];
    let v = [1.5, 0.0, 0.0, 1.0, -3.5, 1.5];
    let (q, v) = (M::Coordinates::from_fn(7, |i| q[i]), M::Velocities::from_fn(6, |i| v[i]));
    let start = simulation.state(&q, &v);
    let total = |y: &M::State| {
        let state = ForwardSimulation::new(&grounded, ZeroTorque).split(y);
        grounded.energy(&state.q, &state.v).total() - state.actuator_energy
    };
    let before = total(&start);
    let mut events = vec![];
    let method = Ode45::new().rtol(1e-10).atol(1e-12);
    let end = grounded.run(&method, &mut simulation, (0.0, 0.6), start, &mut Ends, |event| events.push(event));
    let y = end.unwrap().y;
    (y.as_ref().to_vec(), events, (total(&y) - before).abs())
}

/// Tumbling multiplies the difference of roundings by some thousands.
#[test]
fn a_parcel_tumbles_over_the_ground_compiled_as_on_the_generic_path() {
    let (compiled, events, imbalance) = thrown(&Parcel);
    let (other, other_events, _) = thrown(&generic("parcel"));
    for (compiled, generic) in compiled.iter().zip(&other) {
        assert!((compiled - generic).abs() < 1e-9, "{compiled} {generic}");
    }
    assert_eq!(events.len(), other_events.len());
    assert!(events.iter().filter(|event| event.touching).count() >= 3, "{events:?}");
    assert!(imbalance < 1e-8, "{imbalance}");
}
