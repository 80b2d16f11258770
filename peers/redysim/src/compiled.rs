//! The compiled functions of every robot, in `f64` and `f32`.

use crate::call::{State, export};
use crate::robots::*;

macro_rules! compiled {
    ($name:literal, $Robot:ident, $scalar:ident) => {
        export!(
            concat!($name, "_inverse_", stringify!($scalar)),
            State<[$scalar; $Robot::NV]> => [$scalar; $Robot::NV],
            |state| $Robot::inverse_dynamics(&state.q, &state.v, &state.input)
        );
        export!(
            concat!($name, "_forward_", stringify!($scalar)),
            State<[$scalar; $Robot::NV]> => [$scalar; $Robot::NV],
            |state| $Robot::forward_dynamics(&state.q, &state.v, &state.input)
        );
        export!(
            concat!($name, "_mass_", stringify!($scalar)),
            State<[$scalar; $Robot::NV]> => [[$scalar; $Robot::NV]; $Robot::NV],
            |state| $Robot::mass_matrix(&state.q)
        );
    };
    ($($name:literal $Robot:ident),*) => {
        $(
            compiled!($name, $Robot, f64);
            compiled!($name, $Robot, f32);
        )*
    };
}

compiled!(
    "kr5" Kr5, "gripper" Gripper, "humanoid30" Humanoid30,
    "chain10" Chain10, "chain20" Chain20, "chain40" Chain40, "chain80" Chain80
);
