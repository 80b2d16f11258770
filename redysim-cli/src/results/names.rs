//! What the files of a results folder are called.

/// The file that every result has.
pub const RUN_FILE: &str = "run.toml";
/// The key of its table `run` that names the URDF of which the model was made.
pub const URDF: &str = "urdf";
/// The copy of the model.
pub const MODEL: &str = "model.toml";
/// The copies of tables that a scenario names, without their ending.
pub const TRAJECTORY: &str = "trajectory";
pub const TORQUE: &str = "torque";
pub const INPUTS: [&str; 2] = [TRAJECTORY, TORQUE];
/// The page, which by default lies beside the tables it shows.
pub const PAGE: &str = "animation.html";

/// The tables, each with the ending of its format.
pub const TIMEVAR: &str = "timevar";
pub const STATEVAR: &str = "statevar";
pub const TRAJ: &str = "traj";
pub const TOR: &str = "tor";
pub const LAMBDA: &str = "lambda";
pub const ENERGY: &str = "energy";
pub const ENVAR: &str = "envar";
pub const KINEMATICS: &str = "kinematics";
pub const CONTACTS: &str = "contacts";
pub const MOMENTUM: &str = "momentum";
pub const TOUCH_DOWNS: &str = "touch_downs";

/// All tables that there may be.
pub const TABLES: [&str; 11] =
    [TIMEVAR, STATEVAR, TRAJ, TOR, LAMBDA, ENERGY, ENVAR, KINEMATICS, CONTACTS, MOMENTUM, TOUCH_DOWNS];

/// The file of a table in CSV.
pub fn csv(table: &str) -> String {
    format!("{table}.csv")
}

/// What is drawn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Coordinates, velocities and accelerations of the joints.
    Motion,
    /// Joint forces.
    Torques,
    /// Energies, and their drift.
    Energy,
    /// Lagrange multipliers of the loops.
    Multipliers,
}

impl Picture {
    /// Every picture with the name of its files.
    pub const ALL: [(Picture, &'static str); 4] = [
        (Picture::Motion, "motion"),
        (Picture::Torques, "torques"),
        (Picture::Energy, "energy"),
        (Picture::Multipliers, "lambda"),
    ];
}

/// Whether `forward`, `inverse`, `plot` or `animate` writes a file of that name.
pub fn is_written(name: &str) -> bool {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    match ending {
        "csv" | "dat" if TABLES.contains(&stem) => true,
        "csv" if INPUTS.contains(&stem) => true,
        "svg" | "png" => Picture::ALL.iter().any(|(_, picture)| *picture == stem),
        _ => [RUN_FILE, MODEL, PAGE].contains(&name),
    }
}
