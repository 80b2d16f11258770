//! Hints about names that are not keys of a scenario: names from other tools, and keys that stand in another table.

use redysim_toml::Hint;

const GRAVITY: Hint =
    Hint::new(&["gravity", "g"], "gravity is that of the model: change it there, as in `gravity = [0.0, 0.0, -9.81]`");
const INTEGRATOR: &[&str] =
    &["solver", "method", "integration", "ode", "rtol", "atol", "tolerance", "tolerances", "max_step"];
const LAW_NAMES: &[&str] = &["law", "kp", "ki", "kd", "target", "limits"];
const DRIVE: &[&str] = &["control", "controller", "tau", "torques", "law_of_torque", "input"];

pub const SCENARIO: &[Hint] = &[
    Hint::key(&["robot", "urdf", "mechanism", "file", "system"], "model"),
    Hint::key(&["simulation", "simulate", "dynamics"], "forward"),
    Hint::key(&["motion", "path"], "trajectory"),
    Hint::key(&["start_state", "initial_state", "state"], "initial"),
    Hint::new(
        &["dt", "h", "T", "tf", "t_end", "step", "end", "start", "duration", "time"],
        "the times of a run are keys of its table, as in `forward = { end = 1.0, step = 0.01 }`",
    ),
    Hint::new(
        &["integrator", "solver", "method"],
        "the integrator belongs to `forward`: forward = { end = 1.0, step = 0.01, integrator = \"Ode45\" }",
    ),
    Hint::new(
        &["torque", "law", "control", "controller", "kp", "kd", "ki"],
        "the law that drives the joints belongs to `forward`: torque = { law = \"pd\", target = [0, 0], kp = 49.0, kd = 14.0 }",
    ),
    Hint::new(
        &["q", "v", "q0", "v0", "qd", "dq"],
        "the start is a table: initial = { q = [0, \"60 deg\"], v = [0, 0] }",
    ),
    GRAVITY,
];

pub const INITIAL: &[Hint] = &[
    Hint::key(&["q0", "position", "positions", "theta", "angles"], "q"),
    Hint::key(&["v0", "qd", "qdot", "dq", "velocity", "velocities", "omega"], "v"),
];

pub const INVERSE: &[Hint] = &[END, STEP, TRAJECTORY, GRAVITY];

const END: Hint = Hint::key(&["T", "tf", "t_end", "duration", "time", "stop", "tmax", "t1", "final"], "end");
const STEP: Hint = Hint::key(&["dt", "h", "output_step", "sample_time", "timestep", "interval"], "step")
    .with_help("It is the time from one row of the results to the next");
const TRAJECTORY: Hint = Hint::new(
    &["trajectory", "from", "to"],
    "the motion is a table of the scenario itself: write [trajectory] above its keys",
);

pub const FORWARD: &[Hint] = &[
    END,
    Hint::key(&["dt", "h", "output_step", "sample_time", "timestep", "interval"], "step").with_help(
        "It is the time from one row of the results to the next; the step of the integration is that of the integrator, as in \
         `integrator = { method = \"Ode4\", step = 0.001 }`",
    ),
    Hint::key(INTEGRATOR, "integrator")
        .with_help("It has its method and tolerances, as in `integrator = { method = \"Ode45\", rtol = 1e-6, atol = 1e-8 }`"),
    Hint::key(LAW_NAMES, "torque")
        .with_help("It has the law and its keys, as in `torque = { law = \"pd\", target = [0, 0], kp = 49.0, kd = 14.0 }`"),
    Hint::key(DRIVE, "torque"),
    Hint::new(&["q", "v", "q0", "initial"], "the start is a table of the scenario itself: initial = { q = [0, \"60 deg\"] }"),
    TRAJECTORY,
    GRAVITY,
];

pub const FIXED_STEP: &[Hint] = &[
    Hint::key(&["dt", "h", "size"], "step"),
    METHOD,
    Hint::new(
        &["rtol", "atol", "max_step"],
        "this method has steps of one size; a method with tolerances is for example `Ode45`",
    ),
];

pub const ADAPTIVE_STEP: &[Hint] = &[
    METHOD,
    Hint::new(
        &["step", "dt", "h"],
        "this method chooses its steps from `rtol` and `atol`, up to `max_step`; one with steps of one size is for example \
         `Ode4`",
    ),
    Hint::key(&["tolerance", "tol", "reltol"], "rtol"),
    Hint::key(&["abstol"], "atol"),
];

const METHOD: Hint = Hint::key(&["solver", "name", "kind", "type"], "method");
const KIND_OF_LAW: Hint = Hint::key(&["type", "kind", "name", "mode", "control", "controller"], "law");

pub const LAW: &[Hint] = &[KIND_OF_LAW];

pub const FEEDBACK: &[Hint] = &[
    KIND_OF_LAW,
    Hint::key(&["q", "qd", "q_d", "qdes", "setpoint", "reference", "desired", "goal"], "target"),
    Hint::key(&["stiffness", "p_gain"], "kp"),
    Hint::key(&["limit", "max", "saturation", "effort", "max_torque"], "limits"),
];
