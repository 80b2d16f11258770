//! Prescribed motions.

use serde::{Deserialize, Serialize};

use super::Values;

/// A motion of some joints that is prescribed to inverse dynamics or followed by a torque law.
///
/// `joints` are those that move so, or single velocities of them, such as `swivel.phi`, by default all; of closed loops the
/// actuated ones. Values are in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Trajectory {
    /// A cycloid from rest to rest: [`redysim_runtime::Cycloid`], of spherical and free joints along a constant screw.
    Cycloid {
        /// The joints.
        joints: Option<Vec<String>>,
        /// Where it begins, rad or m.
        from: Values,
        /// Where it ends, rad or m.
        to: Values,
        /// How long it takes, s.
        duration: f64,
    },
    /// q = `from` + `speed` t, of spherical and free joints q = `from` ⊞ `speed` t.
    ConstantSpeed {
        /// The joints.
        joints: Option<Vec<String>>,
        /// Where it is at t = 0, rad or m.
        from: Values,
        /// The speed, rad/s or m/s.
        speed: Values,
    },
    /// A motion of small jerk through points, of least jerk for joints of one coordinate: [`redysim_runtime::ManifoldSpline::minimum_jerk`].
    MinimumJerk {
        /// The joints.
        joints: Option<Vec<String>>,
        /// When it is at each point, s.
        times: Vec<f64>,
        /// The points, rad or m.
        points: Vec<Values>,
    },
    /// A cubic spline through points: [`redysim_runtime::ManifoldSpline::cubic`].
    Cubic {
        /// The joints.
        joints: Option<Vec<String>>,
        /// When it is at each point, s.
        times: Vec<f64>,
        /// The points, rad or m.
        points: Vec<Values>,
    },
    /// The rows of a table.
    Csv {
        /// The joints.
        joints: Option<Vec<String>>,
        /// The path of the table, from the folder of the scenario.
        file: String,
        /// How a table without velocities and accelerations is passed; by default with minimum jerk.
        through: Option<Through>,
    },
}

/// How the rows of a table are passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Through {
    /// With minimum jerk.
    MinimumJerk,
    /// By a cubic spline.
    Cubic,
}
