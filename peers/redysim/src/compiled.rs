//! The compiled functions of every robot, in `f64` and `f32`, and over SIMD scalars where redysim has them.

use crate::call::{State, export};
use crate::robots::*;

macro_rules! compiled {
    ($name:literal $Robot:ident, $scalar:literal $Scalar:ty) => {
        export!(
            concat!($name, "_inverse_", $scalar),
            State<[$Scalar; $Robot::NQ], [$Scalar; $Robot::NV]> => [$Scalar; $Robot::NV],
            |state| $Robot::inverse_dynamics(&state.q, &state.v, &state.input)
        );
        export!(
            concat!($name, "_forward_", $scalar),
            State<[$Scalar; $Robot::NQ], [$Scalar; $Robot::NV]> => [$Scalar; $Robot::NV],
            |state| $Robot::forward_dynamics(&state.q, &state.v, &state.input)
        );
        export!(
            concat!($name, "_mass_", $scalar),
            State<[$Scalar; $Robot::NQ], [$Scalar; $Robot::NV]> => [[$Scalar; $Robot::NV]; $Robot::NV],
            |state| $Robot::mass_matrix(&state.q)
        );
    };
}

macro_rules! scalars {
    ($($name:literal $Robot:ident),*) => {
        $(
            compiled!($name $Robot, "f64" f64);
            compiled!($name $Robot, "f32" f32);
        )*
    };
}

scalars!(
    "kr5" Kr5, "gripper" Gripper, "humanoid30" Humanoid30,
    "chain10" Chain10, "chain20" Chain20, "chain40" Chain40, "chain80" Chain80,
    "anymal" Anymal, "talos" Talos
);

/// As many states per call as the target's vectors have lanes. They lie value by value (the first coordinate of all states,
/// then the second), so that a lane is a state and the timer's memory holds lanes as they are.
#[cfg(feature = "lanes")]
mod lanes {
    use super::*;
    #[cfg(not(target_feature = "avx512f"))]
    use redysim::lanes::{F32x8, F64x4};
    #[cfg(target_feature = "avx512f")]
    use redysim::lanes::{F32x16, F64x8};

    macro_rules! lanes {
        ($($name:literal $Robot:ident),*) => {
            $(
                #[cfg(target_feature = "avx512f")]
                compiled!($name $Robot, "f64x8" F64x8);
                #[cfg(target_feature = "avx512f")]
                compiled!($name $Robot, "f32x16" F32x16);
                #[cfg(not(target_feature = "avx512f"))]
                compiled!($name $Robot, "f64x4" F64x4);
                #[cfg(not(target_feature = "avx512f"))]
                compiled!($name $Robot, "f32x8" F32x8);
            )*
        };
    }

    lanes!("kr5" Kr5, "gripper" Gripper, "humanoid30" Humanoid30, "anymal" Anymal, "talos" Talos);
}
