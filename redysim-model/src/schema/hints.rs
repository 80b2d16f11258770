//! Hints about names that are not keys of a model file: names from URDF, from toolboxes and textbooks, and keys that
//! stand in another table.

use redysim_toml::Hint;

const RANGE: &str = "the range of a joint is a table, as in `range = { position = [\"-170 deg\", \"170 deg\"], velocity = \
    \"150 deg\", acceleration = 10.0, force = 40.0 }`: it states where the joint works, for `tolerance`, and does not limit its motion";
const LARGEST_FORCE: &str = "the largest force of a joint is `force` of its `range`, as in `range = { position = [\"-170 deg\", \
    \"170 deg\"], velocity = \"150 deg\", force = 40.0 }`, for `tolerance`; what limits a torque in simulation is `limits` of the \
    scenario's torque law";
const DH: &str = "Denavit-Hartenberg parameters are a table: `dh = { a, alpha, b, theta }` if they are Khalil and \
    Kleinfinger's (modified), `dh_standard = { a, alpha, d, theta }` if they are the standard (distal) ones of data sheets \
    and most textbooks";
const DH_IS_MODIFIED: &str = "`dh` has the parameters of Khalil and Kleinfinger (modified), Rx(alpha) Tx(a) Rz(theta) \
    Tz(b). Rows with `d` from a data sheet or textbook are mostly standard (distal): write them under `dh_standard`";
const DH_IS_STANDARD: &str = "`dh_standard` has the standard (distal) parameters, Rz(theta) Tz(d) Tx(a) Rx(alpha). Rows \
    with `b` are mostly those of Khalil and Kleinfinger (modified): write them under `dh`";
const SCENARIO: &str = "a model has no state: initial positions and velocities go into a scenario, under `[initial]`";

/// Keys of the model, below a header of another table.
const OF_MODEL: Hint = Hint::new(
    &["gravity", "allow", "functions", "tolerance", "forward_dynamics", "parameters"],
    "it is a key of the whole model, and a key belongs to the table whose header is above it: write it at the top of the \
     file, before the first [[link]]",
);
const LOCKED: Hint = Hint::new(
    &["locked"],
    "the locked joints are a table at the top of the file, before the first [[link]], as in `locked = { joint6 = \"90 deg\" \
     }`; a joint that never moves is `joint = \"fixed\"`",
);

pub(super) const MODEL: &[Hint] = &[
    Hint::new(
        &["joint", "joints"],
        "a joint has no table of its own: its keys stand in the [[link]] that it carries, as in `joint = \"revolute\"`",
    ),
    Hint::new(&["body", "bodies", "robot", "segment"], "each body is a [[link]], with the joint that carries it"),
    Hint::new(&["unit", "units"], "the units are m, kg, s and rad; angles may be written \"90 deg\""),
    Hint::key(&["damper", "springs", "spring_damper", "force_element"], "spring"),
    Hint::key(&["g"], "gravity").with_help("It is a vector in the base frame, as in `gravity = [0.0, 0.0, -9.81]`"),
    Hint::new(&["initial", "q0", "trajectory", "torque", "controller"], SCENARIO),
];

pub(super) const MIMIC_TABLE: &[Hint] = &[
    Hint::key(&["name", "link", "of", "leader", "follows"], "joint"),
    Hint::key(&["factor", "ratio", "gear", "scale"], "multiplier"),
];

pub(super) const LINK: &[Hint] = &[
    Hint::new(
        &[
            "limit",
            "limits",
            "lower",
            "upper",
            "velocity",
            "acceleration",
            "max_velocity",
            "velocity_limit",
            "position_limits",
        ],
        RANGE,
    ),
    Hint::new(
        &["force", "effort", "torque", "max_effort", "max_torque", "effort_limit", "torque_limit"],
        LARGEST_FORCE,
    ),
    Hint::new(
        &["dynamics"],
        "`damping` and `friction` are keys of the link itself, as in `damping = 0.5` and `friction = 2.0`",
    ),
    Hint::new(
        &["gear_ratio", "gear", "ratio", "reduction", "transmission"],
        "a model has no gears: torques, speeds and the rotor's inertia are those of the joint, so that `armature` is the \
         inertia of the rotor times the square of the gear ratio",
    ),
    Hint::new(
        &["payload"],
        "a payload is a [[link]] of its own on a `fixed` joint, or in the link's mass, com and inertia",
    ),
    Hint::new(
        &["xyz", "rpy", "pose"],
        "the place of a joint is a table, as in `origin = { xyz = [0.0, 0.0, 0.4], rpy = [\"90 deg\", 0, 0] }`, with \
         `axis` beside it",
    ),
    Hint::new(&["a", "alpha", "b", "d", "theta", "DH", "denavit_hartenberg"], DH),
    Hint::key(
        &["mu", "mu_c", "coulomb", "coulomb_friction", "friction_coefficient", "friction_loss", "frictionloss"],
        "friction",
    )
    .with_help("It is the largest friction force in the joint, N m or N, not a coefficient"),
    Hint::key(&["viscous", "viscous_friction", "viscous_damping", "mu_v"], "damping"),
    Hint::key(&["rotor_inertia", "motor_inertia", "reflected_inertia", "jm"], "armature")
        .with_help("It is the inertia of the rotor times the square of the gear ratio"),
    Hint::key(&["mdh", "dh_modified", "modified_dh", "craig"], "dh"),
    Hint::key(&["sdh", "standard_dh", "dh_distal", "distal_dh"], "dh_standard"),
    Hint::key(&["type", "kind", "joint_type"], "joint"),
    Hint::key(&["cog", "cm", "center_of_mass", "centre_of_mass", "center_of_gravity"], "com"),
    Hint::key(&["moment_of_inertia", "inertia_tensor", "moi", "I"], "inertia"),
    Hint::new(
        &["xx", "yy", "zz", "xy", "yz", "xz", "ixx", "iyy", "izz", "ixy", "iyz", "ixz"],
        "the elements of an inertia are a table, as in `inertia = { xx = 0.1, yy = 0.1, zz = 0.02 }`",
    ),
    Hint::new(&["inertial"], "`mass`, `com` and `inertia` are keys of the link itself"),
    Hint::new(&["child"], "a link names its `parent`; the joint between the two is that of the link"),
    Hint::new(
        &["visual", "collision", "geometry", "mesh", "material", "color", "colour"],
        "a model has no shapes, which dynamics do not need: leave it out",
    ),
    Hint::key(&["passive", "motor", "motorised"], "actuated")
        .with_help("A joint without a motor has `actuated = false`"),
    Hint::new(&["q", "q0", "initial", "home"], SCENARIO),
    OF_MODEL,
    LOCKED,
];

pub(super) const LOOP: &[Hint] = &[OF_MODEL, LOCKED];

pub(super) const FRAME: &[Hint] = &[OF_MODEL, LOCKED];

/// What other formats and textbooks call joints, with the kind, or what to write for it.
pub(super) const JOINT_KINDS: &[(&[&str], &str)] = &[
    (
        &["hinge", "continuous", "rotary", "rotational", "rotation", "pin", "turning", "r", "rot", "swivel"],
        "write `revolute`, whose turns have no bounds",
    ),
    (&["slider", "linear", "translational", "translation", "sliding", "p", "t", "slide"], "write `prismatic`"),
    (&["screw", "h"], "write `helical`, with its `pitch` beside it"),
    (&["ball", "balljoint", "ball_joint", "ball-and-socket", "socket", "s", "quaternion"], "write `spherical`"),
    (&["cardan", "hooke", "u"], "write `universal`"),
    (&["c"], "write `cylindrical`"),
    (&["floating", "float", "6dof", "freeflyer", "free-flyer", "six_dof"], "write `free`"),
    (&["weld", "rigid", "none", "static"], "write `fixed`"),
];

pub(super) const DH_TABLE: &[Hint] = &[
    Hint::key(&["d", "r"], "b").with_help(DH_IS_MODIFIED),
    Hint::key(&["offset"], "theta")
        .with_help("The variable of a revolute joint is added to `theta`, of a prismatic one to `b`"),
];

pub(super) const DH_STANDARD_TABLE: &[Hint] = &[
    Hint::key(&["b"], "d").with_help(DH_IS_STANDARD),
    Hint::key(&["r"], "a"),
    Hint::key(&["offset"], "theta")
        .with_help("The variable of a revolute joint is added to `theta`, of a prismatic one to `d`"),
];

pub(super) const ORIGIN_TABLE: &[Hint] = &[
    Hint::key(&["position", "translation", "pos"], "xyz"),
    Hint::key(&["matrix", "R", "rotation_matrix"], "rotation"),
    Hint::key(&["orientation", "euler", "rot"], "rpy")
        .with_help("Roll, pitch and yaw are angles about the parent's x, y and z axes, in this order"),
    Hint::new(&["axis"], "`axis` stands beside `origin`, as a key of the link"),
];

pub(super) const INERTIA_TABLE: &[Hint] =
    &[Hint::key(&["yx", "iyx"], "xy"), Hint::key(&["zy", "izy"], "yz"), Hint::key(&["zx", "izx"], "xz")];

pub(super) const RANGE_TABLE: &[Hint] = &[
    Hint::key(&["lower", "upper", "min", "max", "limits", "q", "angle", "positions"], "position")
        .with_help("It has both ends, as in `position = [\"-170 deg\", \"170 deg\"]`"),
    Hint::key(&["effort", "torque", "max_effort", "max_torque"], "force"),
    Hint::key(&["speed", "max_velocity", "v", "qd", "dq", "qdot"], "velocity"),
    Hint::key(&["a", "qdd", "ddq", "max_acceleration"], "acceleration"),
];

pub(super) const SPRING: &[Hint] = &[
    OF_MODEL,
    LOCKED,
    Hint::key(&["k", "spring_constant", "rate"], "stiffness"),
    Hint::key(&["c", "d", "damping_coefficient"], "damping"),
    Hint::key(&["rest_length", "free_length", "natural_length", "l0", "rest"], "length"),
];

#[cfg(test)]
mod tests {
    use super::super::keys;
    use redysim_toml::Keys;

    fn check(keys: &Keys) {
        for hint in keys.hints {
            assert!(hint.names.iter().all(|name| keys.names().all(|key| key != *name)), "{hint:?} of {}", keys.owner);
            assert!(hint.key.is_none_or(|meant| keys.names().any(|key| key == meant)), "{hint:?} of {}", keys.owner);
            assert!(hint.key.is_some() || !hint.help.is_empty(), "{hint:?} of {}", keys.owner);
        }
        keys.keys.iter().flat_map(|key| key.tables).for_each(|table| check(table));
    }

    #[test]
    fn hints_are_about_names_that_are_not_keys_and_lead_to_keys_that_are() {
        check(&keys::MODEL);
    }
}
