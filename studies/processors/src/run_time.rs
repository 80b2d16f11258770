//! Dynamics of a mechanism that is read at run time, on one state, for `vectors`: `run_time_<scalar>_<function>`.

use redysim::generic::{GenericMechanism, Workspace};

/// The functions of a scalar under names of their own.
macro_rules! run_time {
    ($($module:ident $text:literal $scalar:ident;)*) => {$(
        #[doc = concat!("In `", $text, "`.")]
        pub mod $module {
            use super::*;
            type State = [Vec<$scalar>; 3];

            #[doc = "Inverse dynamics."]
            #[unsafe(export_name = concat!("run_time_", $text, "_inverse_dynamics"))]
            pub fn inverse_dynamics(robot: &GenericMechanism, work: &mut Workspace<$scalar>, [q, v, a]: &State, tau: &mut [$scalar]) {
                robot.inverse_dynamics_in(work, q, v, a, tau);
            }

            #[doc = "Forward dynamics."]
            #[unsafe(export_name = concat!("run_time_", $text, "_forward_dynamics"))]
            pub fn forward_dynamics(robot: &GenericMechanism, work: &mut Workspace<$scalar>, [q, v, tau]: &State, a: &mut [$scalar]) {
                robot.forward_dynamics_in(work, q, v, tau, a);
            }

            #[doc = "Mass matrix."]
            #[unsafe(export_name = concat!("run_time_", $text, "_mass_matrix"))]
            pub fn mass_matrix(robot: &GenericMechanism, work: &mut Workspace<$scalar>, q: &[$scalar], matrix: &mut [$scalar]) {
                robot.mass_matrix_in(work, q, matrix);
            }
        }
    )*};
}

run_time! {
    in_f64 "f64" f64;
    in_f32 "f32" f32;
}
