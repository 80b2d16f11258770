//! The keys of a model file. Each is defined once, for the reader, the messages and the key documentation
//! (`docs/models.md`).

use super::hints;
use redysim_toml::{Key, Keys};

pub(crate) const MODEL: Keys = Keys::new(
    "A model",
    &[NAME, GRAVITY, LINKS, LOOPS, FRAMES, SPRINGS, FUNCTIONS, LOCKED, TOLERANCE, FORWARD_DYNAMICS, PARAMETERS, ALLOW],
)
.with_hints(hints::MODEL);
pub(crate) const NAME: Key = Key::new("name", "\"arm\"", "").with_default("required");
pub(crate) const OPTIONAL_NAME: Key = NAME.with_default("none");
pub(crate) const GRAVITY: Key =
    Key::new("gravity", "[0.0, 0.0, -9.81]", "m/s², in the base frame").with_default("required");
pub(crate) const LINKS: Key = Key::of_tables("link", "one such table for each link", &[&LINK]).with_default("required");
pub(crate) const LOOPS: Key =
    Key::of_tables("loop", "one such table for each cut joint", &[&LOOP]).with_default("none");
pub(crate) const FRAMES: Key =
    Key::of_tables("frame", "one such table for each frame of interest on a link", &[&FRAME]).with_default("none");
pub(crate) const SPRINGS: Key =
    Key::of_tables("spring", "one such table for each spring between two points", &[&SPRING]).with_default("none");

pub(crate) const ALLOW: Key =
    Key::new("allow", "[\"gravity-up\"]", "names of lints that are not reported").with_default("none");

pub(crate) const OPTIONS: Keys =
    Keys::new("A declaration", &[FUNCTIONS, LOCKED, TOLERANCE, FORWARD_DYNAMICS, PARAMETERS]);
pub(crate) const FUNCTIONS: Key =
    Key::new("functions", "[\"inverse_dynamics\", \"mass_matrix\"]", "only these are generated").with_default("all");
pub(crate) const LOCKED: Key =
    Key::new("locked", "{ joint6 = \"90 deg\" }", "joints and the coordinates at which they are held")
        .with_default("none");
pub(crate) const TOLERANCE: Key =
    Key::new("tolerance", "1e-3", "the error allowed, as a share of each joint's largest force")
        .with_default("none: nothing is left out");
pub(crate) const FORWARD_DYNAMICS: Key =
    Key::new("forward_dynamics", "\"recursion\"", "`auto`, `recursion` or `factorisation`").with_default("`auto`");
pub(crate) const PARAMETERS: Key = Key::new(
    "parameters",
    "[\"gravity\", \"tool.mass\", \"tool.com\", \"tool.inertia\", \"joint2.damping\"]",
    "numbers that compiled code is given at run time; of links `mass`, `com`, `inertia`, of joints `armature`, `damping`, \
     `friction`, `friction_velocity`, `stiffness`, `rest`",
)
.with_default("none");

pub(crate) const LINK: Keys = Keys::new(
    "A link",
    &[
        NAME,
        JOINT_NAME,
        PARENT,
        JOINT,
        DH,
        DH_STANDARD,
        ORIGIN,
        AXIS,
        OFFSET,
        FAR_END,
        PITCH,
        COORDINATES,
        MASS,
        COM,
        INERTIA,
        ARMATURE,
        DAMPING,
        FRICTION,
        FRICTION_VELOCITY,
        STIFFNESS,
        REST,
        MIMIC,
        ACTUATED,
        RANGE,
    ],
)
.with_hints(hints::LINK);
pub(crate) const JOINT_NAME: Key =
    Key::new("joint_name", "\"elbow\"", "name of the joint in results, `locked` and `parameters`")
        .with_default("the name of the link");
pub(crate) const PARENT: Key =
    Key::new("parent", "\"base\"", "the link that carries this one; `base` is the ground").with_default("required");
pub(crate) const JOINT: Key = Key::new(
    "joint",
    "\"revolute\"",
    "revolute, prismatic, helical, universal, cylindrical, planar, spherical, free or fixed",
)
.with_default("required");
pub(crate) const AXIS: Key = Key::new(
    "axis",
    "[0.0, 0.0, 1.0]",
    "the direction of the joint, in the frame that it moves; universal, planar, spherical and free joints have none",
)
.with_default("z; required beside `origin`");
pub(crate) const OFFSET: Key =
    Key::new("offset", "\"90 deg\"", "added to the coordinate, beside `origin` or `axis`; without a unit rad or m")
        .with_default("0");
pub(crate) const FAR_END: Key = Key::of_table(
    "far_end",
    "{ xyz = [0.18, 0.0, 0.0], rpy = [\"90 deg\", 0, 0] }",
    "the link's frame in the one that the joint moves, beside `origin` or `axis`; m and angles",
    &[&ORIGIN_KEYS],
)
.with_default("the frame that the joint moves");
pub(crate) const PITCH: Key = Key::new("pitch", "0.005", "m/rad: the translation for a unit of rotation")
    .with_default("required of helical joints");
pub(crate) const COORDINATES: Key = Key::new(
    "coordinates",
    "\"zxy\"",
    "Euler angles of a spherical or free joint: axes of the link about which it turns, one after the other",
)
.with_default("a quaternion");
pub(crate) const MASS: Key = Key::new("mass", "1.5", "kg").with_default("required");
pub(crate) const COM: Key = Key::new("com", "[0.0, 0.0, 0.1]", "m, in the link's frame").with_default("[0, 0, 0]");
pub(crate) const ARMATURE: Key = Key::new(
    "armature",
    "0.3",
    "kg m² or kg: inertia of the rotor times the square of the gear ratio, on the diagonal of the mass matrix; of this and \
     the next four an array for each of several velocities",
)
.with_default("0");
pub(crate) const DAMPING: Key = Key::new("damping", "0.5", "N m s/rad or N s/m").with_default("0");
pub(crate) const FRICTION: Key =
    Key::new("friction", "2.0", "N m or N: f v/√(v² + ε²), which approaches f and does not stick").with_default("0");
pub(crate) const FRICTION_VELOCITY: Key =
    Key::new("friction_velocity", "0.02", "ε of the friction; without a unit rad/s or m/s").with_default("0.01");
pub(crate) const STIFFNESS: Key =
    Key::new("stiffness", "20.0", "N m/rad or N/m, of a spring in the joint").with_default("0");
pub(crate) const REST: Key =
    Key::new("rest", "0.5", "where the spring is relaxed; without a unit rad or m; an array of several coordinates")
        .with_default("the zero position");
pub(crate) const ACTUATED: Key =
    Key::new("actuated", "false", "whether an actuator moves the joint; an array for each of several velocities")
        .with_default("true");

pub(crate) const DH: Key = Key::of_table(
    "dh",
    "{ a = 0.18, alpha = \"90 deg\", b = 0.4, theta = \"0 deg\" }",
    "m and angles; Khalil-Kleinfinger (modified): Rx(alpha) Tx(a) Rz(theta) Tz(b)",
    &[&DH_KEYS],
)
.with_default("one of these three");
const DH_KEYS: Keys = Keys::new("`dh`", &[DH_A, DH_ALPHA, DH_B, DH_THETA]).with_hints(hints::DH_TABLE);
pub(crate) const DH_A: Key = Key::new("a", "0.18", "m").with_default("0");
pub(crate) const DH_ALPHA: Key = Key::new("alpha", "\"90 deg\"", "without a unit in rad").with_default("0");
pub(crate) const DH_B: Key = Key::new("b", "0.4", "m").with_default("0");
pub(crate) const DH_THETA: Key = Key::new("theta", "\"90 deg\"", "without a unit in rad").with_default("0");

pub(crate) const DH_STANDARD: Key = Key::of_table(
    "dh_standard",
    "{ a = 0.18, alpha = \"90 deg\", d = 0.4, theta = \"0 deg\" }",
    "m and angles; standard (distal): Rz(theta) Tz(d) Tx(a) Rx(alpha), the link's frame at its far end",
    &[&DH_STANDARD_KEYS],
)
.with_default("one of these three");
const DH_STANDARD_KEYS: Keys =
    Keys::new("`dh_standard`", &[DH_A, DH_ALPHA, DH_D, DH_THETA]).with_hints(hints::DH_STANDARD_TABLE);
pub(crate) const DH_D: Key = Key::new("d", "0.4", "m").with_default("0");

pub(crate) const ORIGIN: Key =
    Key::of_table("origin", "{ xyz = [0.0, 0.0, 0.4], rpy = [\"90 deg\", 0, 0] }", "m and angles", &[&ORIGIN_KEYS])
        .with_default("one of these three");
const ORIGIN_KEYS: Keys = Keys::new("`origin`", &[XYZ, RPY, ROTATION]).with_hints(hints::ORIGIN_TABLE);
pub(crate) const XYZ: Key =
    Key::new("xyz", "[0.0, 0.0, 0.4]", "m, in the frame of the parent; of a frame of interest, in that of its link")
        .with_default("[0, 0, 0]");
pub(crate) const RPY: Key =
    Key::new("rpy", "[\"90 deg\", 0, 0]", "roll, pitch, yaw; without a unit in rad").with_default("[0, 0, 0]");
pub(crate) const ROTATION: Key = Key::new(
    "rotation",
    "[[1, 0, 0], [0, 0, -1], [0, 1, 0]]",
    "the rotation matrix by rows, in place of `rpy`: its columns are the axes of the frame",
)
.with_default("by `rpy`");

pub(crate) const INERTIA: Key = Key::of_table(
    "inertia",
    "{ xx = 0.1, yy = 0.1, zz = 0.02 }",
    "kg m², about the centre of mass, in the link's axes",
    &[&INERTIA_KEYS],
)
.with_default("0: a mass point");
const INERTIA_KEYS: Keys = Keys::new("`inertia`", &[XX, YY, ZZ, XY, YZ, XZ]).with_hints(hints::INERTIA_TABLE);
pub(crate) const XX: Key = Key::new("xx", "0.1", "kg m²").with_default("0");
pub(crate) const YY: Key = Key::new("yy", "0.1", "kg m²").with_default("0");
pub(crate) const ZZ: Key = Key::new("zz", "0.1", "kg m²").with_default("0");
pub(crate) const XY: Key = Key::new("xy", "0.001", "kg m²").with_default("0");
pub(crate) const YZ: Key = Key::new("yz", "0.001", "kg m²").with_default("0");
pub(crate) const XZ: Key = Key::new("xz", "0.001", "kg m²").with_default("0");

pub(crate) const RANGE: Key = Key::of_table(
    "range",
    "{ position = [\"-170 deg\", \"170 deg\"], velocity = \"150 deg\", acceleration = 10.0 }",
    "rad or m, rad/s or m/s, rad/s² or m/s²; an array of such tables for each of several velocities",
    &[&RANGE_KEYS],
)
.with_default("none");
pub(crate) const RANGE_KEYS: Keys =
    Keys::new("`range`", &[POSITION, VELOCITY, ACCELERATION, FORCE]).with_hints(hints::RANGE_TABLE);
pub(crate) const POSITION: Key =
    Key::new("position", "[\"-170 deg\", \"170 deg\"]", "rad or m").with_default("required");
pub(crate) const VELOCITY: Key =
    Key::new("velocity", "\"150 deg\"", "the largest in either direction; without a unit rad/s or m/s")
        .with_default("required");
pub(crate) const ACCELERATION: Key = Key::new(
    "acceleration",
    "10.0",
    "the largest in either direction, which a tolerance needs; without a unit rad/s² or m/s²",
)
.with_default("none");
pub(crate) const FORCE: Key =
    Key::new("force", "40.0", "N m or N, of which the tolerance is a share").with_default("the largest that occurs");

pub(crate) const MIMIC: Key = Key::of_table(
    "mimic",
    "{ joint = \"left_finger\", multiplier = -1.0 }",
    "the joint that this one follows; its forces act on that joint",
    &[&MIMIC_KEYS],
)
.with_default("none: the joint moves by itself");
const MIMIC_KEYS: Keys = Keys::new("`mimic`", &[MIMIC_JOINT, MULTIPLIER, MIMIC_OFFSET]).with_hints(hints::MIMIC_TABLE);
pub(crate) const MIMIC_JOINT: Key =
    Key::new("joint", "\"left_finger\"", "a revolute, prismatic or helical joint").with_default("required");
pub(crate) const MULTIPLIER: Key = Key::new(
    "multiplier",
    "-1.0",
    "coordinate for a unit of that joint's; m/rad or rad/m if one of the two turns and the other slides",
)
.with_default("1");
pub(crate) const MIMIC_OFFSET: Key =
    Key::new("offset", "\"10 deg\"", "coordinate where that joint's is zero; without a unit rad or m")
        .with_default("0");

pub(crate) const LOOP: Keys =
    Keys::new("A loop", &[NAME, CUT_JOINT, LINK_A, POINT_A, AXIS_A, LINK_B, POINT_B, AXIS_B]).with_hints(hints::LOOP);
pub(crate) const CUT_JOINT: Key =
    Key::new("joint", "\"revolute\"", "revolute, prismatic, universal, cylindrical, planar, spherical or weld")
        .with_default("required");
pub(crate) const LINK_A: Key = Key::new("link_a", "\"crank\"", "a link, or `base`").with_default("required");
pub(crate) const POINT_A: Key =
    Key::new("point_a", "[0.1, 0.0, 0.0]", "m, in the frame of link a").with_default("[0, 0, 0]");
pub(crate) const AXIS_A: Key =
    Key::new("axis_a", "[0.0, 0.0, 1.0]", "of all cuts but spherical ones and welds, in the frame of link a")
        .with_default("z");
pub(crate) const LINK_B: Key = Key::new("link_b", "\"base\"", "a link, or `base`").with_default("required");
pub(crate) const POINT_B: Key =
    Key::new("point_b", "[0.1, 0.0, 0.0]", "m, in the frame of link b").with_default("[0, 0, 0]");
pub(crate) const AXIS_B: Key =
    Key::new("axis_b", "[0.0, 0.0, 1.0]", "as `axis_a`, in the frame of link b; prismatic cuts have none")
        .with_default("z");

pub(crate) const FRAME: Keys = Keys::new("A frame", &[NAME, FRAME_LINK, FRAME_ORIGIN]).with_hints(hints::FRAME);
pub(crate) const FRAME_LINK: Key =
    Key::new("link", "\"link6\"", "the link on which it stands, or `base`").with_default("required");
pub(crate) const FRAME_ORIGIN: Key = ORIGIN.with_default("the frame of its link");

pub(crate) const SPRING: Keys =
    Keys::new("A spring", &[OPTIONAL_NAME, LINK_A, POINT_A, LINK_B, POINT_B, SPRING_STIFFNESS, SPRING_DAMPING, LENGTH])
        .with_hints(hints::SPRING);
pub(crate) const SPRING_STIFFNESS: Key =
    Key::new("stiffness", "1000.0", "N/m, along the line between the points").with_default("0");
pub(crate) const SPRING_DAMPING: Key =
    Key::new("damping", "20.0", "N s/m, along the line between the points").with_default("0");
pub(crate) const LENGTH: Key =
    Key::new("length", "0.2", "m: the distance of the points at which the spring is relaxed")
        .with_default("required beside `stiffness`");
