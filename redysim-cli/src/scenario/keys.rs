//! The keys of a scenario. All that is known of a key stands here: the reader, the messages and the key documentation
//! (`docs/scenario_keys.md`) take it from here.

use redysim_toml::{Key, Keys};

use super::hints;

pub const SCENARIO: Keys =
    Keys::new("A scenario", &[NAME, MODEL, INITIAL, TRAJECTORY, INVERSE, FORWARD, GROUND, CONTACT, RUN])
        .with_hints(hints::SCENARIO);
pub const NAME: Key = Key::new("name", "\"swing\"", "what the results are called").with_default("the name of the file");
pub const MODEL: Key =
    Key::new("model", "\"../models/kr5.toml\"", "a model file or a URDF, from the folder of the scenario")
        .with_default("required");
pub const RUN: Key =
    Key::new("run", "{ redysim = \"0.1.0\" }", "written by a run into the copy in its results; ignored")
        .with_default("none");

pub const INITIAL: Key = Key::of_table("initial", "{ q = [0, \"60 deg\"], v = [0, 0] }", "", &[&INITIAL_KEYS])
    .with_default("the neutral position at rest");
const INITIAL_KEYS: Keys = Keys::new("`initial`", &[Q, V, ASSEMBLE, HELD]).with_hints(hints::INITIAL);
pub const Q: Key = Key::of_table(
    "q",
    "[0, \"60 deg\"]",
    "rad or m, or an angle with a unit; or by name: q = { joint2 = \"60 deg\" }; a spherical joint has the coordinates \
     qx, qy, qz, qw (a quaternion of any length) or the Euler angles phi, theta, psi, a free one x, y, z before them, and by \
     name a table: q = { base = { xyz = [0, 0, 1], rpy = [0, \"10 deg\", 0] } }",
    &[&FREE_POSITION, &SPHERICAL_POSITION],
)
.with_default("the neutral position");
pub const V: Key = Key::new(
    "v",
    "[0, \"60 deg/s\"]",
    "rad/s or m/s; a spherical joint has the velocities wx, wy, wz, a free one vx, vy, vz before them, in the link's \
     frame; by name: v = { base = [0, 0, 0, 0, 0, 1], \"pivot.wz\" = 2 }",
)
.with_default("0");
pub const FREE_POSITION: Keys =
    Keys::new("The position of a free joint", &[JOINT_XYZ, QUATERNION, JOINT_RPY, AXIS, ANGLE]);
pub const SPHERICAL_POSITION: Keys =
    Keys::new("The position of a spherical joint", &[QUATERNION, JOINT_RPY, AXIS, ANGLE]);
pub const JOINT_XYZ: Key = Key::new("xyz", "[0.0, 0.0, 1.0]", "m").with_default("[0, 0, 0]");
pub const QUATERNION: Key = Key::new("quaternion", "[0.0, 0.0, 0.0, 1.0]", "x, y, z, w, of any length")
    .with_default("[0, 0, 0, 1]; or the orientation is given by angles");
pub const JOINT_RPY: Key =
    Key::new("rpy", "[0, \"10 deg\", 0]", "roll, pitch, yaw; without a unit in rad").with_default("no rotation");
pub const AXIS: Key =
    Key::new("axis", "[0.0, 0.0, 1.0]", "of a rotation by `angle`, of any length").with_default("no rotation");
pub const ANGLE: Key =
    Key::new("angle", "\"90 deg\"", "about `axis`; without a unit in rad").with_default("required with `axis`");
pub const ASSEMBLE: Key =
    Key::new("assemble", "false", "start as given, though loops may not be closed").with_default("true");
pub const HELD: Key =
    Key::new("held", "[\"crank\"]", "what stays where it is while loops are closed: joints, or velocities")
        .with_default("the actuated velocities, or those of `forward.prescribed`, which always stay");

pub const TRAJECTORY: Key = Key::of_table(
    "trajectory",
    "{ from = [0, 0], to = [\"60 deg\", 1], duration = 2.0 }",
    "",
    &[&CYCLOID, &CONSTANT_SPEED, &VIA_POINTS, &MOTION_TABLE],
)
.with_default("none");
pub const CYCLOID: Keys = Keys::new("A cycloid", &[MOTION_KIND, PRESCRIBED, FROM, TO, DURATION]);
pub const CONSTANT_SPEED: Keys = Keys::new("A motion of constant speed", &[MOTION_KIND, PRESCRIBED, FROM, SPEED]);
pub const VIA_POINTS: Keys = Keys::new("A motion through points", &[MOTION_KIND, PRESCRIBED, TIMES, POINTS]);
pub const MOTION_TABLE: Keys = Keys::new("A motion from a table", &[MOTION_KIND, PRESCRIBED, MOTION_FILE, THROUGH]);
pub const MOTION_KIND: Key =
    Key::new("kind", "\"cycloid\"", "or constant-speed, minimum-jerk, cubic, csv").with_default("`cycloid`");
pub const PRESCRIBED: Key =
    Key::new("joints", "[\"crank\"]", "which are prescribed; or single velocities of them: [\"swivel.phi\"]")
        .with_default("all joints; of closed loops the actuated velocities");
pub const FROM: Key = Key::new("from", "[0, 0]", "rad or m").with_default("required");
pub const TO: Key = Key::new("to", "[\"60 deg\", 1]", "rad or m").with_default("required");
pub const DURATION: Key = Key::new("duration", "2.0", "s").with_default("required");
pub const SPEED: Key = Key::new("speed", "[\"270 deg/s\"]", "rad/s or m/s").with_default("required");
pub const TIMES: Key = Key::new("times", "[0.0, 1.0, 3.0]", "s").with_default("required");
pub const POINTS: Key = Key::new("points", "[[0, 0], [\"30 deg\", 1], [0, 0]]", "the coordinates at each of the times")
    .with_default("required");
pub const MOTION_FILE: Key =
    Key::new("file", "\"motion.csv\"", "from the folder of the scenario").with_default("required");
pub const THROUGH: Key =
    Key::new("through", "\"minimum-jerk\"", "or cubic: how a table without velocities and accelerations is passed")
        .with_default("`minimum-jerk`");

pub const INVERSE: Key = Key::of_table("inverse", "{ end = 1.0, step = 0.01 }", "s", &[&INVERSE_KEYS])
    .with_default("required by `redysim inverse`");
const INVERSE_KEYS: Keys = Keys::new("`inverse`", &[START, END, STEP]).with_hints(hints::INVERSE);
pub const START: Key = Key::new("start", "0.0", "s").with_default("0");
pub const END: Key = Key::new("end", "1.0", "s").with_default("required");
pub const STEP: Key = Key::new("step", "0.01", "s, from one row of the results to the next").with_default("required");

pub const FORWARD: Key = Key::of_table("forward", "{ end = 1.0, step = 0.01 }", "s", &[&FORWARD_KEYS])
    .with_default("required by `redysim forward`");
const FORWARD_KEYS: Keys = Keys::new("`forward`", &[START, END, STEP, INTEGRATOR, FOLLOWING, TORQUE, STABILISATION])
    .with_hints(hints::FORWARD);
pub const FOLLOWING: Key = Key::new(
    "prescribed",
    "[\"joint1\"]",
    "joints, or velocities of them, that follow the trajectory whatever force it takes, while the others are free or driven",
)
.with_default("none");

pub const INTEGRATOR: Key =
    Key::of_table("integrator", "{ method = \"Ode45\", rtol = 1e-6, atol = 1e-8 }", "", &[&FIXED_STEP, &ADAPTIVE_STEP])
        .with_default("`Ode45`");
pub const FIXED_STEP: Keys =
    Keys::new("An integrator with steps of one size", &[METHOD, INTEGRATOR_STEP]).with_hints(hints::FIXED_STEP);
pub const ADAPTIVE_STEP: Keys = Keys::new("An integrator with steps from tolerances", &[METHOD, RTOL, ATOL, MAX_STEP])
    .with_hints(hints::ADAPTIVE_STEP);
pub const METHOD: Key = Key::new("method", "\"Ode45\"", "").with_default("`Ode45`");
pub const INTEGRATOR_STEP: Key = Key::new("step", "0.001", "s, of the integration").with_default("required");
pub const RTOL: Key = Key::new("rtol", "1e-6", "").with_default("1e-3");
pub const ATOL: Key = Key::of_table(
    "atol",
    "1e-8",
    "in the units of the state; or atol = { position = 1e-8, velocity = 1e-6, work = 1e-3 }",
    &[&ATOL_KEYS],
)
.with_default("1e-6");
const ATOL_KEYS: Keys = Keys::new("`atol`", &[POSITION, VELOCITY, WORK]);
pub const POSITION: Key = Key::new("position", "1e-8", "rad or m").with_default("1e-6");
pub const VELOCITY: Key = Key::new("velocity", "1e-6", "rad/s or m/s").with_default("1e-6");
pub const WORK: Key = Key::new("work", "1e-3", "J; also of integral actions, N m or N").with_default("1e-6");
pub const MAX_STEP: Key = Key::new("max_step", "0.01", "s").with_default("a tenth of the run");

pub const TORQUE: Key = Key::of_table(
    "torque",
    "{ law = \"pd\", target = [0, 0], kp = 49.0, kd = 14.0 }",
    "",
    &[&ZERO_TORQUE, &P, &PD, &PID, &PD_GRAVITY, &TRACKING_PD, &COMPUTED_TORQUE, &IMPEDANCE, &FORCE_TABLE],
)
.with_default("`free`");
pub const ZERO_TORQUE: Keys = Keys::new("The law `free`", &[LAW]).with_hints(hints::LAW);
pub const P: Keys = Keys::new("The law `p`", &[LAW, DRIVEN, TARGET, KP, LIMITS]).with_hints(hints::FEEDBACK);
pub const PD: Keys = Keys::new("The law `pd`", &[LAW, DRIVEN, TARGET, KP, KD, LIMITS]).with_hints(hints::FEEDBACK);
pub const PID: Keys =
    Keys::new("The law `pid`", &[LAW, DRIVEN, TARGET, KP, KI, KD, TRACKING_RATE, LIMITS]).with_hints(hints::FEEDBACK);
pub const PD_GRAVITY: Keys =
    Keys::new("The law `pd-gravity`", &[LAW, DRIVEN, TARGET, KP, KD, PAYLOAD, LIMITS]).with_hints(hints::FEEDBACK);
pub const TRACKING_PD: Keys = Keys::new("The law `tracking-pd`", &[LAW, DRIVEN, KP, KD, LIMITS]);
pub const COMPUTED_TORQUE: Keys = Keys::new("The law `computed-torque`", &[LAW, KP, KD, LIMITS]);
pub const IMPEDANCE: Keys = Keys::new(
    "The law `impedance`",
    &[
        LAW,
        DRIVEN,
        FRAME,
        POSE,
        STIFFNESS,
        ANGULAR_STIFFNESS,
        DAMPING,
        ANGULAR_DAMPING,
        COMPENSATION,
        NULL_SPACE_DAMPING,
        PAYLOAD,
        LIMITS,
    ],
);
pub const FORCE_TABLE: Keys = Keys::new("The law `csv`", &[LAW, DRIVEN, FORCE_FILE, LIMITS]);
pub const LAW: Key =
    Key::new("law", "\"free\"", "or p, pd, pid, pd-gravity, tracking-pd, computed-torque, impedance, csv")
        .with_default("`free`");
pub const DRIVEN: Key =
    Key::new("joints", "[\"crank\"]", "which are driven; or single velocities of them: [\"swivel.phi\"]")
        .with_default("the actuated velocities; of `tracking-pd` those of them that the trajectory prescribes");
pub const TARGET: Key = Key::new("target", "[0, \"90 deg\"]", "rad or m").with_default("required");
pub const KP: Key = Key::new("kp", "49.0", "of all joints, or one of each: [49.0, 20.0]").with_default("required");
pub const KD: Key = Key::new("kd", "14.0", "of all joints, or one of each: [14.0, 8.0]").with_default("required");
pub const KI: Key = Key::new("ki", "60.0", "of all joints, or one of each: [60.0, 20.0]").with_default("required");
pub const TRACKING_RATE: Key =
    Key::new("tracking_rate", "2.0", "1/s, of anti-windup").with_default("√(ki/kd), or ki/kp where kd is 0");
pub const LIMITS: Key = Key::new(
    "limits",
    "100.0",
    "N m or N, the largest forces, of all joints or one of each; or \"range\": the `force` of the `range` of each",
)
.with_default("none");
pub const PAYLOAD: Key = Key::of_table(
    "payload",
    "{ link = \"link6\", mass = 5.0, com = [0.0, 0.0, 0.1] }",
    "a mass that the law assumes at a point of a link, beyond those of the model",
    &[&PAYLOAD_KEYS],
)
.with_default("none");
const PAYLOAD_KEYS: Keys = Keys::new("`payload`", &[PAYLOAD_LINK, PAYLOAD_MASS, PAYLOAD_COM]);
pub const PAYLOAD_LINK: Key = Key::new("link", "\"link6\"", "which link carries it").with_default("required");
pub const PAYLOAD_MASS: Key =
    Key::new("mass", "5.0", "kg; negative for a link that is lighter than in the model").with_default("required");
pub const PAYLOAD_COM: Key =
    Key::new("com", "[0.0, 0.0, 0.1]", "m, where it is in the link's frame").with_default("[0, 0, 0]");
pub const FRAME: Key = Key::new("frame", "\"tool\"", "which `[[frame]]` of the model is held").with_default("required");
pub const POSE: Key = Key::of_table(
    "target",
    "{ xyz = [0.5, 0.0, 0.3], rpy = [0, \"90 deg\", 0] }",
    "where the frame should be in the base frame",
    &[&POSE_KEYS],
)
.with_default("where the frame starts");
const POSE_KEYS: Keys = Keys::new("`target`", &[XYZ, RPY]);
pub const XYZ: Key = Key::new("xyz", "[0.5, 0.0, 0.3]", "m").with_default("where the frame starts");
pub const RPY: Key = Key::new("rpy", "[0, \"90 deg\", 0]", "roll, pitch, yaw; without a unit in rad")
    .with_default("where the frame starts");
pub const STIFFNESS: Key =
    Key::new("stiffness", "[900.0, 900.0, 400.0]", "N/m, along the axes of the desired frame; or one number for all")
        .with_default("required");
pub const ANGULAR_STIFFNESS: Key = Key::new("angular_stiffness", "50.0", "N m/rad, about these axes").with_default("0");
pub const DAMPING: Key = Key::new("damping", "60.0", "N s/m, along these axes").with_default("required");
pub const ANGULAR_DAMPING: Key = Key::new("angular_damping", "5.0", "N m s/rad, about these axes").with_default("0");
pub const COMPENSATION: Key =
    Key::new("compensation", "\"gravity\"", "or bias: Coriolis forces and the joints' own too")
        .with_default("`gravity`");
pub const NULL_SPACE_DAMPING: Key =
    Key::new("null_space_damping", "2.0", "1/s, of what leaves the frame alone").with_default("0");
pub const FORCE_FILE: Key =
    Key::new("file", "\"forces.csv\"", "from the folder of the scenario").with_default("required");

pub const GROUND: Key = Key::of_table(
    "ground",
    "{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }",
    "the plane that contacts without a `ground` of their own meet, in the base frame",
    &[&GROUND_KEYS],
)
.with_default("the plane z = 0, with the free side above");
pub const CONTACT_GROUND: Key = Key::of_table(
    "ground",
    "{ point = [2.0, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }",
    "the plane that the contact meets, such as a wall",
    &[&GROUND_KEYS],
)
.with_default("`ground` of the scenario");
const GROUND_KEYS: Keys = Keys::new("`ground`", &[POINT, NORMAL]);
pub const POINT: Key = Key::new("point", "[0.0, 0.0, 0.0]", "m, of the plane").with_default("[0, 0, 0]");
pub const NORMAL: Key =
    Key::new("normal", "[0.0, 0.0, 1.0]", "out of the ground, of any length").with_default("[0, 0, 1]");
pub const CONTACT: Key = Key::of_tables(
    "contact",
    "a frame that may touch the ground, or several of them, in forward dynamics",
    &[&REDYSIM_CONTACT, &HUNT_CROSSLEY],
)
.with_default("none");
pub const REDYSIM_CONTACT: Keys = Keys::new(
    "A contact with ReDySim's law",
    &[
        CONTACT_LAW,
        CONTACT_NAME,
        CONTACT_FRAME,
        CONTACT_GROUND,
        CONTACT_STIFFNESS,
        CONTACT_DAMPING,
        LEAVING_SPEED,
        FRICTION,
        SLIDING_DAMPING,
    ],
);
pub const HUNT_CROSSLEY: Keys = Keys::new(
    "A contact with the law of Hunt and Crossley",
    &[
        CONTACT_LAW,
        CONTACT_NAME,
        CONTACT_FRAME,
        CONTACT_GROUND,
        HUNT_CROSSLEY_STIFFNESS,
        EXPONENT,
        HUNT_CROSSLEY_DAMPING,
        FRICTION,
        SLIP_VELOCITY,
    ],
);
pub const CONTACT_LAW: Key = Key::new("law", "\"redysim\"", "or hunt-crossley").with_default("required");
pub const CONTACT_NAME: Key =
    Key::new("name", "\"left foot\"", "what it is called in the results").with_default("the name of its frame");
pub const CONTACT_FRAME: Key =
    Key::new("frame", "\"foot\"", "the `[[frame]]` of the model, or several: [\"left\", \"right\"]")
        .with_default("required");
pub const CONTACT_STIFFNESS: Key = Key::new("stiffness", "2500.0", "K, N/m").with_default("required");
pub const CONTACT_DAMPING: Key = Key::new("damping", "3464.0", "C_v, N s/m").with_default("required");
pub const LEAVING_SPEED: Key =
    Key::new("leaving_speed", "4.5", "v_max, m/s, up to which a frame that leaves is not held back")
        .with_default("required");
pub const FRICTION: Key = Key::new("friction", "0.7", "μ").with_default("required");
pub const SLIDING_DAMPING: Key =
    Key::new("sliding_damping", "1500.0", "C_h, N s/m, of friction at small speeds").with_default("required");
pub const HUNT_CROSSLEY_STIFFNESS: Key =
    Key::new("stiffness", "100000.0", "k, N/m^n, of N = k p^n (1 + d dp/dt)").with_default("required");
pub const EXPONENT: Key = Key::new("exponent", "1.5", "n").with_default("1.5");
pub const HUNT_CROSSLEY_DAMPING: Key = Key::new("damping", "0.5", "d, s/m").with_default("required");
pub const SLIP_VELOCITY: Key =
    Key::new("slip_velocity", "0.01", "m/s: friction reaches 1/√2 of μ N at this speed; it is a damper at lower ones")
        .with_default("required");

pub const STABILISATION: Key = Key::of_table(
    "stabilisation",
    "{ kind = \"baumgarte\", alpha = 20.0 }",
    "or projection, none",
    &[&PLAIN_STABILISATION, &BAUMGARTE],
)
.with_default("`projection`");
pub const PLAIN_STABILISATION: Keys = Keys::new("This stabilisation", &[STABILISATION_KIND]);
pub const BAUMGARTE: Keys = Keys::new("Baumgarte's stabilisation", &[STABILISATION_KIND, ALPHA]);
pub const STABILISATION_KIND: Key =
    Key::new("kind", "\"projection\"", "or baumgarte, none").with_default("`projection`");
pub const ALPHA: Key = Key::new("alpha", "20.0", "1/s").with_default("required");

#[cfg(test)]
mod tests {
    use redysim_toml::Keys;

    #[test]
    fn every_key_states_its_default_or_that_it_is_required() {
        fn check(keys: &Keys) {
            for key in keys.keys {
                assert!(!key.default.is_empty(), "`{}` of {}", key.name, keys.owner);
                key.tables.iter().for_each(|table| check(table));
            }
        }
        check(&super::SCENARIO);
    }

    #[test]
    fn hints_are_about_names_that_are_not_keys_and_lead_to_keys_that_are() {
        fn check(keys: &Keys) {
            for hint in keys.hints {
                let is_other = hint.names.iter().all(|name| keys.names().all(|key| key != *name));
                assert!(is_other, "{hint:?} of {}", keys.owner);
                let is_key = hint.key.is_none_or(|meant| keys.names().any(|key| key == meant));
                assert!(is_key, "{hint:?} of {}", keys.owner);
                assert!(hint.key.is_some() || !hint.help.is_empty(), "{hint:?} of {}", keys.owner);
            }
            keys.keys.iter().flat_map(|key| key.tables).for_each(|table| check(table));
        }
        check(&super::SCENARIO);
    }

    #[test]
    fn the_documentation_lists_every_key_with_its_example_and_meaning() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scenario_keys.md");
        let documentation = format!("# Keys of a scenario\n\n{}", super::SCENARIO.documentation());
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(path, &documentation).unwrap();
        }
        assert!(std::fs::read_to_string(path).unwrap() == documentation, "BLESS=1 writes docs/scenario_keys.md anew");
    }
}
