//! Every function of a few robots, each under a name by which it is found in the machine code:
//! `single_<robot>_<scalar>_<function>` for one state, `lanes_…` for the states of a vector, and
//! `single_sin_cos_all_<scalar>_<number of angles>`; `batch_<robot>_<scalar>_<function>` for many states.

#[cfg(feature = "every")]
pub mod every;
#[cfg(feature = "every")]
pub mod run_time;

use redysim::redysim;

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    pub struct Kr5("../../../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    pub struct Gripper("../../../models/peers/gripper.toml");
}

#[cfg(feature = "all")]
redysim! {
    /// Ten general joints in a row.
    pub struct Chain10("../../../models/peers/chain10.toml");
}

/// One function under the name `prefix_robot_scalar_function`.
macro_rules! exported {
    ($prefix:literal $name:literal $robot:ident $scalar:ident $function:ident($($argument:ident: $given:ty),*) -> $found:ty) => {
        #[unsafe(export_name = concat!($prefix, "_", $name, "_", stringify!($scalar), "_", stringify!($function)))]
        #[inline(never)]
        pub fn $function($($argument: $given),*) -> $found {
            $robot::$function($($argument),*)
        }
    };
}

/// A module with the functions that are timed.
macro_rules! main_functions {
    ($prefix:literal $name:literal $robot:ident $scalar:ident) => {
        /// A number for each joint.
        pub type Row = [$scalar; $robot::NQ];
        /// A number for each pair of joints.
        pub type Matrix = [Row; $robot::NV];

        exported!($prefix $name $robot $scalar inverse_dynamics(q: &Row, v: &Row, a: &Row) -> Row);
        exported!($prefix $name $robot $scalar forward_dynamics(q: &Row, v: &Row, tau: &Row) -> Row);
        exported!($prefix $name $robot $scalar mass_matrix(q: &Row) -> Matrix);
    };
}

/// A module with all functions of a robot with `angles` angles.
macro_rules! all_functions {
    ($name:literal $robot:ident $scalar:ident $angles:literal) => {
        main_functions!("single" $name $robot $scalar);
        type At = redysim::JointTrig<$scalar, { $robot::NQ }, $angles>;
        type Energy = redysim::Energy<$scalar>;
        type Links = [redysim::LinkState<$scalar>; $robot::NL];

        exported!("single" $name $robot $scalar bias_forces(q: &Row, v: &Row) -> Row);
        exported!("single" $name $robot $scalar gravity_forces(q: &Row) -> Row);
        exported!("single" $name $robot $scalar energy(q: &Row, v: &Row) -> Energy);
        exported!("single" $name $robot $scalar link_kinematics(q: &Row, v: &Row) -> Links);
        exported!("single" $name $robot $scalar joint_trig(q: &Row) -> At);
        exported!("single" $name $robot $scalar inverse_dynamics_with_trig(at: &At, v: &Row, a: &Row) -> Row);
        exported!("single" $name $robot $scalar forward_dynamics_with_trig(at: &At, v: &Row, tau: &Row) -> Row);
        exported!("single" $name $robot $scalar mass_matrix_with_trig(at: &At) -> Matrix);
        exported!("single" $name $robot $scalar bias_forces_with_trig(at: &At, v: &Row) -> Row);
        exported!("single" $name $robot $scalar gravity_forces_with_trig(at: &At) -> Row);
        exported!("single" $name $robot $scalar energy_with_trig(at: &At, v: &Row) -> Energy);
        exported!("single" $name $robot $scalar link_kinematics_with_trig(at: &At, v: &Row) -> Links);
    };
}

macro_rules! robots {
    ($($(#[$attribute:meta])* $module:ident $name:literal $robot:ident $angles:literal;)*) => {$(
        $(#[$attribute])*
        #[doc = concat!("The functions of ", stringify!($robot), ".")]
        pub mod $module {
            /// On one state in `f64`.
            pub mod double {
                use crate::$robot;
                all_functions!($name $robot f64 $angles);
            }

            /// On one state in `f32`.
            pub mod float {
                use crate::$robot;
                all_functions!($name $robot f32 $angles);
            }
        }
    )*};
}

robots! {
    kr5 "kr5" Kr5 7;
    gripper "gripper" Gripper 7;
    #[cfg(feature = "all")]
    chain10 "chain10" Chain10 11;
}

/// Several states at once, for which wide vectors are.
pub mod lanes {
    macro_rules! lanes {
        ($($module:ident $name:literal $robot:ident $scalar:ident;)*) => {$(
            #[doc = concat!(stringify!($robot), " in ", stringify!($scalar), ".")]
            pub mod $module {
                use crate::$robot;
                use redysim::lanes::$scalar;
                main_functions!("lanes" $name $robot $scalar);
            }
        )*};
    }

    lanes! {
        kr5_four "kr5" Kr5 F64x4;
        kr5_eight "kr5" Kr5 F64x8;
        gripper_four "gripper" Gripper F64x4;
        gripper_eight "gripper" Gripper F64x8;
    }
}

/// Many states, by the instructions that the processor has.
#[cfg(feature = "all")]
pub mod batches {
    /// One function under the name `batch_robot_scalar_function`.
    macro_rules! exported {
        ($name:literal $robot:ident $scalar:ident $function:ident($($argument:ident),*) -> $found:ty) => {
            #[unsafe(export_name = concat!("batch_", $name, "_", stringify!($scalar), "_", stringify!($function)))]
            #[inline(never)]
            pub fn $function($($argument: &[Row],)* found: &mut [$found]) -> Result<(), LengthMismatch> {
                batch::$function(&$robot, $($argument,)* found)
            }
        };
    }

    macro_rules! batches {
        ($($module:ident $name:literal $robot:ident $scalar:ident;)*) => {$(
            #[doc = concat!(stringify!($robot), " in ", stringify!($scalar), ".")]
            pub mod $module {
                use crate::$robot;
                use redysim::{LengthMismatch, batch};
                /// A number for each joint.
                pub type Row = [$scalar; $robot::NQ];

                exported!($name $robot $scalar inverse_dynamics(q, v, a) -> Row);
                exported!($name $robot $scalar forward_dynamics(q, v, tau) -> Row);
                exported!($name $robot $scalar mass_matrix(q) -> [Row; $robot::NV]);
            }
        )*};
    }

    batches! {
        kr5_double "kr5" Kr5 f64;
        kr5_float "kr5" Kr5 f32;
        gripper_double "gripper" Gripper f64;
        gripper_float "gripper" Gripper f32;
        chain10_double "chain10" Chain10 f64;
        chain10_float "chain10" Chain10 f32;
    }
}

/// Lists of angles.
#[cfg(feature = "all")]
pub mod angles {
    macro_rules! sin_cos_all {
        ($($name:ident $scalar:ident $count:literal;)*) => {$(
            #[unsafe(export_name = concat!("single_sin_cos_all_", stringify!($scalar), "_", $count))]
            #[inline(never)]
            pub fn $name(angles: [$scalar; $count]) -> ([$scalar; $count], [$scalar; $count]) {
                redysim::Scalar::sin_cos_all(angles)
            }
        )*};
    }

    sin_cos_all! {
        double_1 f64 1; double_2 f64 2; double_3 f64 3; double_4 f64 4; double_5 f64 5; double_6 f64 6;
        double_7 f64 7; double_8 f64 8; double_9 f64 9; double_10 f64 10; double_11 f64 11; double_12 f64 12;
        float_1 f32 1; float_2 f32 2; float_3 f32 3; float_4 f32 4; float_5 f32 5; float_6 f32 6;
        float_7 f32 7; float_8 f32 8; float_9 f32 9; float_10 f32 10; float_11 f32 11; float_12 f32 12;
    }
}
