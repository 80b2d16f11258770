//! The functions that a mechanism can have, and what each costs.

use super::{Argument, Interface, Shape, Signature};
use crate::OperationCount;
use core::fmt;
use core::ops::Index;
use core::str::FromStr;

/// The enumeration and the counts of the functions, from one table.
macro_rules! functions {
    ($($variant:ident $name:ident, $interface:expr, ($($argument:ident),*) -> $shape:ident, $summary:literal;)*) => {
        /// A function of a mechanism.
        ///
        /// The enumeration is exhaustive, so that the compiler shows where a new function is to be handled.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
        pub enum Function {
            $(#[doc = $summary] $variant,)*
        }

        impl Function {
            /// Every function, in the order in which generated code has them.
            pub const ALL: &'static [Function] = &[$(Function::$variant),*];

            /// Its name.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Function::$variant => stringify!($name),)*
                }
            }

            /// What it takes and returns.
            pub const fn signature(self) -> Signature {
                match self {
                    $(Function::$variant => Signature {
                        interface: $interface,
                        arguments: &[$(Argument::$argument),*],
                        result: Shape::$shape,
                        summary: $summary,
                    },)*
                }
            }
        }

        /// Operations of all generated functions of one mechanism; zero for what it does not have.
        ///
        /// Each function has a field of its name, and `operations[Function::MassMatrix]` is the same as
        /// `operations.mass_matrix`.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Operations {
            $(
                #[doc = concat!("Of `", stringify!($name), "`.")]
                pub $name: OperationCount,
            )*
        }

        impl Operations {
            /// No operations.
            pub const NONE: Operations = Operations { $($name: OperationCount::NONE,)* };
        }

        impl Index<Function> for Operations {
            type Output = OperationCount;
            fn index(&self, function: Function) -> &OperationCount {
                match function {
                    $(Function::$variant => &self.$name,)*
                }
            }
        }
    };
}

functions! {
    InverseDynamics inverse_dynamics, Interface::WithTangent("InverseDynamics"),
        (Coordinates, Velocities, Accelerations) -> Forces,
        "τ = M(q) a + bias(q, v), N m or N: the joint forces of the tree.";
    ForwardDynamics forward_dynamics, Interface::WithTangent("ForwardDynamics"),
        (Coordinates, Velocities, Forces) -> Accelerations,
        "a = M(q)⁻¹ (τ − bias(q, v)), rad/s² or m/s²: the accelerations of the tree.";
    MassMatrix mass_matrix, Interface::Own("MassMatrix"),
        (Coordinates) -> MassMatrix,
        "M(q), the generalised inertia matrix, symmetric: kg m², kg m or kg.";
    BiasForces bias_forces, Interface::Own("BiasForces"),
        (Coordinates, Velocities) -> Forces,
        "C(q, v) v + g(q) and the passive forces, N m or N: the joint forces at zero acceleration.";
    CoriolisMatrix coriolis_matrix, Interface::Own("CoriolisMatrix"),
        (Coordinates, Velocities) -> CoriolisMatrix,
        "C(q, v) of the Christoffel symbols: C v are the joint forces of the velocities, without gravity and passive \
         forces; Ṁ − 2 C is skew-symmetric.";
    GravityForces gravity_forces, Interface::Own("GravityForces"),
        (Coordinates) -> Forces,
        "g(q), N m or N: the joint forces of gravity alone, at rest.";
    PassiveForces passive_forces, Interface::Own("PassiveForces"),
        (Coordinates, Velocities) -> Forces,
        "The part of the bias that damping, friction and springs take, N m or N.";
    Energy energy, Interface::Own("MechanicalEnergy"),
        (Coordinates, Velocities) -> Energy,
        "Kinetic and potential energy, J, with those of rotors and springs; the potential of gravity is zero at the base \
         frame's origin.";
    CenterOfMass center_of_mass, Interface::Own("MassCenter"),
        (Coordinates, Velocities) -> CenterOfMass,
        "Position (m) and velocity (m/s) of the centre of mass of all links, in the base frame.";
    Momentum momentum, Interface::Own("TotalMomentum"),
        (Coordinates, Velocities) -> Momentum,
        "Linear momentum (N s) and angular momentum about the centre of mass (N m s) of all links, in the axes of the base \
         frame.";
    HybridDynamics hybrid_dynamics, Interface::Own("HybridDynamics"),
        (Coordinates, Velocities, Given) -> HybridMotion,
        "Accelerations and joint forces where u is given: the acceleration of a velocity whose joint has an actuator, else \
         its force.";
    LinkKinematics link_kinematics, Interface::Own("LinkKinematics"),
        (Coordinates, Velocities) -> Links,
        "Rotation, origin, centre of mass, velocity of the origin (m/s) and angular velocity (rad/s) of every link, in \
         the base frame.";
    FrameKinematics frame_kinematics, Interface::Frames,
        (Coordinates, Velocities) -> Frames,
        "Rotation, origin, velocity of the origin (m/s) and angular velocity (rad/s) of every frame of interest, in the \
         base frame.";
    FrameJacobians frame_jacobians, Interface::Frames,
        (Coordinates) -> FrameJacobians,
        "J(q) of every frame of interest, in the axes of the base frame: the velocity of its origin is linear · v, its \
         angular velocity angular · v.";
    FrameBias frame_bias, Interface::Frames,
        (Coordinates, Velocities) -> FrameAccelerations,
        "J̇ v of every frame of interest: the acceleration of its origin (m/s²) and its angular acceleration (rad/s²) at \
         zero joint accelerations, in the base frame.";
    FrameForces frame_forces, Interface::Frames,
        (Coordinates, Wrenches) -> Forces,
        "Σ Jᵀ w, N m or N: the joint forces that do the same work as wrenches on the mechanism at the origins of its \
         frames, in the axes of the base frame.";
    LoopResidual loop_residual, Interface::LoopClosure,
        (Coordinates) -> LoopRows,
        "How far the loops are from closed: of each cut, the point of side b minus the point of side a in the base \
         frame, m, then what aligns directions, sines.";
    LoopJacobian loop_jacobian, Interface::LoopClosure,
        (Coordinates) -> LoopJacobian,
        "J(q), by rows: the residual of the loops changes at the rates J v.";
    LoopBias loop_bias, Interface::LoopClosure,
        (Coordinates, Velocities) -> LoopRows,
        "J̇ v: the second derivative of the residual of the loops at zero joint accelerations.";
    CoordinateRates coordinate_rates, Interface::ConfigurationSpace,
        (Coordinates, Velocities) -> Coordinates,
        "q̇ = N(q) v, rad/s or m/s: the rates of the coordinates.";
    Integrate integrate, Interface::ConfigurationSpace,
        (Coordinates, Displacement) -> Coordinates,
        "q ⊞ dv, rad or m: the coordinates that the velocities dv, constant over a unit of time, lead to from q.";
    Difference difference, Interface::ConfigurationSpace,
        (Start, End) -> Displacement,
        "q₁ ⊟ q₀, rad or m: the velocities that lead from q0 to q1 in a unit of time, the inverse of `integrate`.";
    DissipatedPower dissipated_power, Interface::ConfigurationSpace,
        (Coordinates, Velocities) -> Power,
        "The power that damping and friction take, W; never negative.";
    Neutral neutral, Interface::ConfigurationSpace,
        () -> Coordinates,
        "The coordinates at which every joint is at its zero position, rad or m.";
}

impl Function {
    /// Whether only a mechanism with closed loops has it.
    pub const fn needs_loops(self) -> bool {
        matches!(self.signature().interface, Interface::LoopClosure)
    }

    /// Whether only a mechanism with frames of interest has it.
    pub const fn needs_frames(self) -> bool {
        matches!(self.signature().interface, Interface::Frames)
    }

    /// Whether only a mechanism without loops has it of which some joints have an actuator and some do not.
    pub const fn needs_passive_joints(self) -> bool {
        matches!(self, Function::HybridDynamics)
    }

    /// Whether every mechanism has it, whatever functions are selected.
    pub const fn is_always_present(self) -> bool {
        matches!(self.signature().interface, Interface::ConfigurationSpace)
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Function {
    type Err = UnknownFunction;
    fn from_str(name: &str) -> Result<Function, UnknownFunction> {
        Function::ALL.iter().copied().find(|function| function.name() == name).ok_or(UnknownFunction)
    }
}

/// A name that no [`Function`] has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownFunction;

impl fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("not a function of a mechanism; the functions are: ")?;
        for (index, function) in Function::ALL.iter().enumerate() {
            f.write_str(if index == 0 { "" } else { ", " })?;
            function.fmt(f)?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownFunction {}
