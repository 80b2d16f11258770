//! Every function that a mechanism can have, on one state, for `vectors`: of robots with legs that are computed side by side
//! on a free base, with rotors, friction and springs, with frames, with a closed loop, and with run-time parameters.

use redysim::{ConfigurationSpace, Wrench, redysim};
use std::hint::black_box;

redysim! {
    /// Four legs that are alike.
    pub struct Quadruped("../../../models/quadruped.toml");
}

redysim! {
    /// Six legs that are alike.
    pub struct Hexapod("../../../models/hexapod.toml");
}

redysim! {
    /// Rotors, damping, friction and springs.
    #[allow(deprecated)]
    pub struct Drives("../../../models/kr5_drives.toml");
}

redysim! {
    /// Joints of several kinds, and frames.
    pub struct Frames("../../../models/test/frames.toml");
}

redysim! {
    /// A closed loop.
    pub struct Fourbar("../../../models/fourbar.toml");
}

redysim! {
    /// A payload that is given at run time.
    pub struct Payload("../../../models/gripper.toml", parameters = ["link4.mass", "link4.com", "link4.inertia"]);
}

/// Functions under the names `single_<robot>_<scalar>_<function>`, whose results stay where they are computed.
macro_rules! exported {
    ($name:literal $scalar:literal: $($function:ident($($argument:ident: $given:ty),*) $call:expr;)*) => {$(
        #[doc = concat!("`", stringify!($function), "`.")]
        #[unsafe(export_name = concat!("single_", $name, "_", $scalar, "_", stringify!($function)))]
        #[inline(never)]
        pub fn $function($($argument: $given),*) {
            black_box(&$call);
        }
    )*};
}

/// The functions of every mechanism, in `f64` and `f32`, and `$more` in these.
macro_rules! robots {
    ($($module:ident $name:literal $robot:ident $more:ident;)*) => {$(
        #[doc = concat!("The functions of `", stringify!($robot), "`.")]
        pub mod $module {
            robots!(in double "f64" f64 $name $robot $more);
            robots!(in float "f32" f32 $name $robot $more);
        }
    )*};
    (in $module:ident $text:literal $scalar:ident $name:literal $robot:ident $more:ident) => {
        #[doc = concat!("In `", $text, "`.")]
        pub mod $module {
            use super::super::{$robot as Robot, *};
            /// Coordinates.
            pub type Q = [$scalar; $robot::NQ];
            /// Velocities, accelerations or forces.
            pub type V = [$scalar; $robot::NV];
            exported! { $name $text:
                inverse_dynamics(q: &Q, v: &V, a: &V) Robot::inverse_dynamics(q, v, a);
                forward_dynamics(q: &Q, v: &V, tau: &V) Robot::forward_dynamics(q, v, tau);
                mass_matrix(q: &Q) Robot::mass_matrix(q);
                bias_forces(q: &Q, v: &V) Robot::bias_forces(q, v);
                coriolis_matrix(q: &Q, v: &V) Robot::coriolis_matrix(q, v);
                gravity_forces(q: &Q) Robot::gravity_forces(q);
                passive_forces(q: &Q, v: &V) Robot::passive_forces(q, v);
                energy(q: &Q, v: &V) Robot::energy(q, v);
                center_of_mass(q: &Q, v: &V) Robot::center_of_mass(q, v);
                momentum(q: &Q, v: &V) Robot::momentum(q, v);
                link_kinematics(q: &Q, v: &V) Robot::link_kinematics(q, v);
                joint_trig(q: &Q) Robot::joint_trig(q);
                coordinate_rates(q: &Q, v: &V) Robot.coordinate_rates(q, v);
                integrate(q: &Q, dv: &V) Robot.integrate(q, dv);
                difference(q0: &Q, q1: &Q) Robot.difference(q0, q1);
                dissipated_power(q: &Q, v: &V) Robot.dissipated_power(q, v);
            }
            $more!($name $text $scalar);
        }
    };
}

macro_rules! nothing_more {
    ($name:literal $text:literal $scalar:ident) => {};
}

macro_rules! hybrid_dynamics {
    ($name:literal $text:literal $scalar:ident) => {
        exported! { $name $text: hybrid_dynamics(q: &Q, v: &V, u: &V) Robot::hybrid_dynamics(q, v, u); }
    };
}

macro_rules! frames {
    ($name:literal $text:literal $scalar:ident) => {
        exported! { $name $text:
            frame_kinematics(q: &Q, v: &V) Robot::frame_kinematics(q, v);
            frame_jacobians(q: &Q) Robot::frame_jacobians(q);
            frame_bias(q: &Q, v: &V) Robot::frame_bias(q, v);
            frame_forces(q: &Q, wrenches: &[Wrench<$scalar>; Robot::NF]) Robot::frame_forces(q, wrenches);
        }
    };
}

macro_rules! loops {
    ($name:literal $text:literal $scalar:ident) => {
        exported! { $name $text:
            loop_residual(q: &Q) Robot::loop_residual(q);
            loop_jacobian(q: &Q) Robot::loop_jacobian(q);
            loop_bias(q: &Q, v: &V) Robot::loop_bias(q, v);
        }
    };
}

robots! {
    quadruped "quadruped" Quadruped hybrid_dynamics;
    hexapod "hexapod" Hexapod hybrid_dynamics;
    drives "drives" Drives nothing_more;
    frames "frames" Frames frames;
    fourbar "fourbar" Fourbar loops;
}

/// The functions of a robot with run-time parameters.
macro_rules! with_parameters {
    ($($module:ident $text:literal $scalar:ident;)*) => {$(
        #[doc = concat!("In `", $text, "`.")]
        pub mod $module {
            use super::*;
            type Robot = Payload<$scalar>;
            /// A number for each joint.
            pub type Row = [$scalar; Payload::<f64>::NV];
            exported! { "payload" $text:
                new(parameters: &[$scalar; Payload::<f64>::NP]) Robot::new(parameters);
                inverse_dynamics(robot: &Robot, q: &Row, v: &Row, a: &Row) robot.inverse_dynamics(q, v, a);
                forward_dynamics(robot: &Robot, q: &Row, v: &Row, tau: &Row) robot.forward_dynamics(q, v, tau);
                mass_matrix(robot: &Robot, q: &Row) robot.mass_matrix(q);
                energy(robot: &Robot, q: &Row, v: &Row) robot.energy(q, v);
            }
        }
    )*};
}

with_parameters! {
    payload_double "f64" f64;
    payload_float "f32" f32;
}
