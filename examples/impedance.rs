//! KR5's tool pressed against a wall: impedance control lets the force be what stiffness and depth make it.
//!
//! The tool is to move 40 mm along x in a second, and 10 mm before it stands a wall. Springs and dampers tie the tool to
//! where it should be: the deeper that lies in the wall, and the stiffer they are, the larger the force. At rest it is that
//! of two springs in series, k k_wall/(k + k_wall) times the depth. The wall pushes back as Hunt and Crossley's contact
//! does, with a force that begins at zero and never pulls.
//!
//! `cargo run --release --example impedance`

mod common;

use common::csv::Csv;
use common::figure::{Figure, Panel};
use common::table::{Table, headline, remark};
use common::{Context, Failure, Outputs, Rows, instants, peak};
use redysim::{
    Compensation, Cycloid, ForwardSimulation, FrameGains, FrameState, Impedance, Integrator, Ode45, OperationalSpace,
    TaskStatus, TorqueLaw, Trajectory, Wrench, redysim,
};

redysim! {
    /// The robot with its rotors and the frame of its tool.
    pub struct Kr5("../models/kr5_tool.toml");
}

type Joints = [f64; Kr5::NV];

/// The start: the elbow up, and the wrist bent.
const START: Joints = [0.0, 1.0, -0.5, 0.0, 0.9, 0.0];
/// How far the tool is to move along x, m, and when it is there, s.
const WAY: f64 = 0.04;
const ARRIVAL: f64 = 1.0;
/// How far before the tool the wall stands, m; its stiffness, N/m, and its damping, s/m.
const GAP: f64 = 0.01;
const WALL: f64 = 5e4;
const WALL_DAMPING: f64 = 2.0;
/// The stiffnesses of the runs, N/m, and that against rotation, N m/rad.
const STIFFNESS: [f64; 2] = [1000.0, 4000.0];
const ANGULAR_STIFFNESS: f64 = 300.0;
const END: f64 = 2.5;
const ROWS: usize = 2500;

fn main() -> Result<(), Failure> {
    let [start] = Kr5::frame_kinematics(&START, &[0.0; Kr5::NV]);
    let runs = [Run::of("soft", STIFFNESS[0], &start)?, Run::of("stiff", STIFFNESS[1], &start)?];
    report(&runs);
    let mut outputs = Outputs::of("impedance")?;
    outputs.picture("contact", "position of the tool along x, force on the wall, and torques", &figure(&runs))?;
    for run in &runs {
        outputs.numbers(run.name, "positions, force and torques, each 1 ms", &run.csv())?;
    }
    outputs.print();
    Ok(())
}

/// Where the tool should be: on its way along x, turned as at the start.
fn target(t: f64, start: &FrameState<f64>) -> FrameState<f64> {
    // The ends are those of a cycloid that is made of constants.
    let way = Cycloid::new([0.0], [WAY], ARRIVAL).map(|way| way.at(t));
    let (x, v) = way.map_or((f64::NAN, f64::NAN), |way| (way.q[0], way.v[0]));
    let [x0, y, z] = start.origin;
    FrameState { origin: [x0 + x, y, z], velocity: [v, 0.0, 0.0], ..*start }
}

/// The force of the wall on the tool, which is in it by GAP less than it has moved.
fn wall(state: &FrameState<f64>, start: &FrameState<f64>) -> f64 {
    let depth = state.origin[0] - start.origin[0] - GAP;
    if depth > 0.0 { -(WALL * depth * (1.0 + WALL_DAMPING * state.velocity[0])).max(0.0) } else { 0.0 }
}

/// What the robot did with springs of one stiffness.
struct Run {
    name: &'static str,
    stiffness: f64,
    t: Vec<f64>,
    /// How far the tool should have moved and has moved along x, m.
    desired: Vec<f64>,
    moved: Vec<f64>,
    /// The force on the wall, N.
    force: Vec<f64>,
    tau: Rows,
}

impl Run {
    fn of(name: &'static str, stiffness: f64, start: &FrameState<f64>) -> Result<Self, Failure> {
        let mut law = Impedance {
            mechanism: &Kr5,
            frame: 0,
            target: |t: f64| target(t, start),
            stiffness: FrameGains { linear: [stiffness; 3], angular: [ANGULAR_STIFFNESS; 3] },
            damping: critical(stiffness)?,
            compensation: Compensation::Bias,
            null_space_damping: 0.0,
        };
        let mut torques = law;
        let mut robot = ForwardSimulation::new(&Kr5, |t: f64, q: &Joints, v: &Joints| {
            let by_law: Joints = law.torque(&Kr5, t, q, v);
            let [state] = Kr5::frame_kinematics(q, v);
            let contact = Wrench { force: [wall(&state, start), 0.0, 0.0], moment: [0.0; 3] };
            let by_wall = Kr5::frame_forces(q, &[contact]);
            std::array::from_fn(|i| by_law[i] + by_wall[i])
        });
        let from = robot.state(&START, &[0.0; Kr5::NV]);
        let mut run =
            Run { name, stiffness, t: instants(END, ROWS), desired: vec![], moved: vec![], force: vec![], tau: vec![] };
        let mut states = Vec::new();
        let method = Ode45::new().rtol(1e-8).atol(1e-10);
        let times = run.t.iter().copied();
        method
            .solve(&mut robot, (0.0, END), from, times, |t, y: &[f64; 13]| states.push((t, *y)))
            .context(|| format!("the {name} robot"))?;
        for (t, y) in states {
            let parts = robot.split(&y);
            let [state] = Kr5::frame_kinematics(&parts.q, &parts.v);
            run.desired.push(target(t, start).origin[0] - start.origin[0]);
            run.moved.push(state.origin[0] - start.origin[0]);
            run.force.push(-wall(&state, start));
            run.tau.push(torques.torque(&Kr5, t, &parts.q, &parts.v).to_vec());
        }
        Ok(run)
    }

    /// The force at rest: that of the springs of robot and wall in series, N.
    fn force_at_rest(&self) -> f64 {
        self.stiffness * WALL / (self.stiffness + WALL) * (WAY - GAP)
    }

    fn csv(&self) -> Csv {
        let mut headers: Vec<String> =
            ["t [s]", "x desired [m]", "x [m]", "force [N]"].into_iter().map(str::to_owned).collect();
        headers.extend((1..=Kr5::NV).map(|joint| format!("tau{joint} [N m]")));
        let mut csv = Csv::new(&headers);
        for (k, &t) in self.t.iter().enumerate() {
            let values = [t, self.desired[k], self.moved[k], self.force[k]];
            csv.row(values.into_iter().chain(self.tau[k].iter().copied()));
        }
        csv
    }
}

/// Damping that is critical for the largest inertia that the tool has in any direction at the start: d = 2 √(k Λ).
fn critical(stiffness: f64) -> Result<FrameGains<f64>, Failure> {
    let [jacobian] = Kr5::frame_jacobians(&START);
    let space = OperationalSpace::new(Kr5::mass_matrix(&START), jacobian.rows()).context(|| "the start".to_owned())?;
    if space.status() != TaskStatus::Full {
        return Err(Failure("the robot is singular at its start: give another".to_owned()));
    }
    let inertia = space.inertia();
    let largest = |axes: std::ops::Range<usize>| axes.map(|axis| inertia[axis][axis]).fold(0.0, f64::max);
    let damping = |stiffness: f64, inertia: f64| 2.0 * (stiffness * inertia).sqrt();
    Ok(FrameGains {
        linear: [damping(stiffness, largest(0..3)); 3],
        angular: [damping(ANGULAR_STIFFNESS, largest(3..6)); 3],
    })
}

fn report(runs: &[Run; 2]) {
    headline("KR5 presses against a wall: force at the end, that of springs in series, and the largest");
    let mut table = Table::new(&["\nrun", "stiffness\nN/m", "force\nN", "in series\nN", "largest\nN", "moved\nmm"]);
    for run in runs {
        let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        table.row([
            run.name.to_owned(),
            format!("{:.0}", run.stiffness),
            format!("{:.4}", last(&run.force)),
            format!("{:.4}", run.force_at_rest()),
            format!("{:.2}", peak(run.force.iter().copied())),
            format!("{:.3}", 1e3 * last(&run.moved)),
        ]);
    }
    table.print();
    remark(&format!(
        "The tool should move {} mm; the wall stands after {} mm. Position control alone has no such force to set.",
        1e3 * WAY,
        1e3 * GAP
    ));
}

fn figure(runs: &[Run; 2]) -> Figure {
    let t = &runs[0].t;
    let millimetres = |values: &[f64]| values.iter().map(|x| 1e3 * x).collect::<Vec<f64>>();
    let mut position = Panel::new("Tool", "way along x", "mm").line("wall", 5, t, &vec![1e3 * GAP; t.len()]).circles(
        "to follow",
        t,
        &millimetres(&runs[0].desired),
    );
    let mut force = Panel::new("Force on the wall", "force", "N");
    for (colour, run) in (1..).zip(runs) {
        let name = format!("{}: {:.0} N/m", run.name, run.stiffness);
        position = position.line(&name, colour, t, &millimetres(&run.moved));
        force = force.line(&name, colour, t, &run.force);
    }
    for (name, run) in ["springs in series", ""].into_iter().zip(runs) {
        force = force.circles(name, t, &vec![run.force_at_rest(); t.len()]);
    }
    let torques = Panel::new("Torques of the stiff robot", "torque", "N m").joints(t, &runs[1].tau);
    Figure { columns: 1, panels: vec![position, force, torques], shared_legend: false }
}
