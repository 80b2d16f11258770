//! A model that is not there is the only error, whatever the program does with the type.

use redysim::{ClosedLoop, ComputedTorque, Cycloid, ForwardSimulation, Integrator, Mechanism, Ode45, batch, redysim};

redysim! {
    pub struct Robot("../../../models/kr6.toml");
}

redysim! {
    pub struct Elsewhere("./modles/kr5.toml");
}

#[derive(redysim::Mechanism)]
#[mechanism("./centipede.toml", functions = [inverse_dynamics])]
pub struct Derived;

redysim! {
    pub struct Loaded("./centipede.toml", parameters = ["gravity", "link6.mass"]);
}

const JOINTS: usize = Robot::NV;
const _: () = assert!(JOINTS == 6 && Robot::NC == 0 && Robot::MASS > 1.0 && Robot::OPS.inverse_dynamics.flops() > 0);

struct Follower {
    q: [f64; Robot::NQ],
    v: [f64; 6],
}

fn weight(q: &[f64; 6]) -> [f64; 6] {
    Robot::gravity_forces(q)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let trajectory = Cycloid::new([0.0; 6], [1.0; 6], 1.0)?;
    let law = ComputedTorque { mechanism: &Robot, trajectory, kp: [400.0; 6], kd: [40.0; 6] };
    let mut robot = ForwardSimulation::new(&Robot, law);
    let start = robot.state(&[0.05; 6], &[0.0; JOINTS]);
    let end = Ode45::new().rtol(1e-8).integrate(&mut robot, (0.0, 1.0), start)?;
    let follower = Follower { q: [0.0; 6], v: [0.0; Robot::NV] };
    let [first, _] = Robot::JOINT_NAMES;
    println!("{first} {:?} {:?} {:?}", &end.y[..6], weight(&follower.q), Robot::mass_matrix(&follower.v)[5][5]);
    let trig = Elsewhere::joint_trig(&[0.0; 6]);
    let with_trig: [f64; 6] = Elsewhere::inverse_dynamics_with_trig(&trig, &[0.0; 6], &[0.0; 6]);
    let state = [with_trig; 2];
    let mut torques = vec![[0.0; Elsewhere::NV]; 2];
    batch::inverse_dynamics(&Elsewhere, &state, &state, &state, &mut torques)?;
    let closed = ClosedLoop::new(&Elsewhere).assemble(&[0.0; 3], &[0.0; 3], &[0])?;
    let [x, y] = Elsewhere::loop_residual(&closed.q);
    let tool = Elsewhere::frame_kinematics(&[0.0; 6], &[0.0; 6])[0].origin;
    println!("{x} {y} {tool:?} {:?}", Derived::inverse_dynamics(&[0.0; 2], &[0.0; 2], &[0.0; 2]).map(f64::abs));
    let loaded = Loaded::new(&[0.0, 0.0, -9.81, 5.0]);
    let forces: [f64; 6] = loaded.inverse_dynamics(&[0.0; 6], &[0.0; 6], &[0.0; 6]);
    println!("{forces:?} {} {:?}", loaded.name(), Loaded::<f64>::try_new(&Loaded::PARAMETERS).is_ok());
    Ok(())
}
