//! The compiled functions over SIMD scalars: eight or sixteen states per call.
//!
//! States lie value by value (the first coordinate of all states, then the second), so that a lane is a state.

use redysim::lanes::{F32x16, F64x8};

use crate::call::{State, export};
use crate::robots::*;

macro_rules! lanes {
    ($name:literal, $Robot:ident, $Scalar:ident = [$float:ident; $width:literal]) => {
        export!(
            concat!($name, "_inverse_", stringify!($float), "x", stringify!($width)),
            State<[[$float; $width]; $Robot::NV]> => [[$float; $width]; $Robot::NV],
            |state| {
                let [q, v, a] = [&state.q, &state.v, &state.input].map(|values| values.map($Scalar::from));
                $Robot::inverse_dynamics(&q, &v, &a).map(Into::into)
            }
        );
        export!(
            concat!($name, "_forward_", stringify!($float), "x", stringify!($width)),
            State<[[$float; $width]; $Robot::NV]> => [[$float; $width]; $Robot::NV],
            |state| {
                let [q, v, tau] = [&state.q, &state.v, &state.input].map(|values| values.map($Scalar::from));
                $Robot::forward_dynamics(&q, &v, &tau).map(Into::into)
            }
        );
        export!(
            concat!($name, "_mass_", stringify!($float), "x", stringify!($width)),
            State<[[$float; $width]; $Robot::NV]> => [[[$float; $width]; $Robot::NV]; $Robot::NV],
            |state| $Robot::mass_matrix(&state.q.map($Scalar::from)).map(|row| row.map(Into::into))
        );
    };
    ($($name:literal $Robot:ident),*) => {
        $(
            lanes!($name, $Robot, F64x8 = [f64; 8]);
            lanes!($name, $Robot, F32x16 = [f32; 16]);
        )*
    };
}

lanes!("kr5" Kr5, "gripper" Gripper, "humanoid30" Humanoid30);
