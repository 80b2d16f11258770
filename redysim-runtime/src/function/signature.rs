//! What functions take and return.

/// What a function takes and returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The trait that has it.
    pub interface: Interface,
    /// Its arguments, in order.
    pub arguments: &'static [Argument],
    /// What it returns.
    pub result: Shape,
    /// What it computes, with formula and units.
    pub summary: &'static str,
}

/// The trait that has a function.
///
/// The enumeration is exhaustive, so that the compiler shows where a new kind of trait is to be handled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// A trait of this name that has the function alone.
    Own(&'static str),
    /// A trait of this name that has the function and its tangent, the derivative in a direction.
    WithTangent(&'static str),
    /// The trait `LoopClosure`, of mechanisms with closed loops.
    LoopClosure,
    /// The trait `Frames`, of mechanisms with frames of interest.
    Frames,
    /// The trait `ConfigurationSpace`, which every mechanism has, whatever functions are selected.
    ConfigurationSpace,
}

/// An argument: its name, and how long the array is and what it is made of.
///
/// The enumeration is exhaustive, so that the compiler shows where a new argument is to be handled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Joint coordinates `q`, rad or m.
    Coordinates,
    /// Joint coordinates `q0` from which a displacement leads, rad or m.
    Start,
    /// Joint coordinates `q1` to which a displacement leads, rad or m.
    End,
    /// Joint velocities `v`, rad/s or m/s.
    Velocities,
    /// A displacement `dv`: joint velocities, constant over a unit of time, rad or m.
    Displacement,
    /// Joint accelerations `a`, rad/s² or m/s².
    Accelerations,
    /// Joint forces `tau`, N m or N.
    Forces,
    /// What is given of each joint velocity, `u`: the acceleration where the joint has an actuator, else the force.
    Given,
    /// A [`Wrench`](crate::Wrench) at each frame, `wrenches`, N and N m.
    Wrenches,
}

impl Argument {
    /// All arguments.
    pub const ALL: [Argument; 9] = [
        Argument::Coordinates,
        Argument::Start,
        Argument::End,
        Argument::Velocities,
        Argument::Displacement,
        Argument::Accelerations,
        Argument::Forces,
        Argument::Given,
        Argument::Wrenches,
    ];

    /// Its name in generated code.
    pub const fn name(self) -> &'static str {
        match self {
            Argument::Coordinates => "q",
            Argument::Start => "q0",
            Argument::End => "q1",
            Argument::Velocities => "v",
            Argument::Displacement => "dv",
            Argument::Accelerations => "a",
            Argument::Forces => "tau",
            Argument::Given => "u",
            Argument::Wrenches => "wrenches",
        }
    }

    /// Number of its elements.
    pub const fn dimension(self) -> Dimension {
        match self {
            Argument::Coordinates | Argument::Start | Argument::End => Dimension::Coordinates,
            Argument::Velocities
            | Argument::Displacement
            | Argument::Accelerations
            | Argument::Forces
            | Argument::Given => Dimension::Velocities,
            Argument::Wrenches => Dimension::Frames,
        }
    }

    /// How many numbers an element has: one, or six of a wrench, the force before the moment.
    pub const fn numbers(self) -> usize {
        match self {
            Argument::Wrenches => 6,
            _ => 1,
        }
    }
}

/// A size of a mechanism.
///
/// The enumeration is exhaustive, so that the compiler shows where a new dimension is to be handled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Joint coordinates, NQ.
    Coordinates,
    /// Joint velocities, NV.
    Velocities,
    /// Links, NL.
    Links,
    /// Rows of the loop constraints, NC.
    LoopRows,
    /// Frames of interest, NF.
    Frames,
}

/// What a function returns, and so in what order its values stand.
///
/// The enumeration is exhaustive, so that the compiler shows where a new shape is to be handled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Joint forces, `[S; NV]`.
    Forces,
    /// Joint accelerations, `[S; NV]`.
    Accelerations,
    /// The generalised inertia matrix, `[[S; NV]; NV]`, by rows.
    MassMatrix,
    /// The Coriolis matrix, `[[S; NV]; NV]`, by rows.
    CoriolisMatrix,
    /// `Energy<S>`: kinetic, potential.
    Energy,
    /// Power, `S`.
    Power,
    /// `CenterOfMass<S>`: position, velocity.
    CenterOfMass,
    /// `Momentum<S>`: linear, angular.
    Momentum,
    /// `HybridMotion<[S; NV]>`: accelerations, forces.
    HybridMotion,
    /// `[LinkState<S>; NL]`: rotation by rows, origin, centre of mass, velocity, angular velocity.
    Links,
    /// Rows of the loop constraints, `[S; NC]`.
    LoopRows,
    /// The Jacobian of the loop constraints, `[[S; NV]; NC]`, by rows.
    LoopJacobian,
    /// Joint coordinates, rad or m, or their rates, rad/s or m/s: `[S; NQ]`.
    Coordinates,
    /// A displacement: joint velocities, constant over a unit of time, rad or m: `[S; NV]`.
    Displacement,
    /// `[FrameState<S>; NF]`: rotation by rows, origin, velocity, angular velocity.
    Frames,
    /// `[FrameJacobian<[S; NV]>; NF]`: linear by rows, angular by rows.
    FrameJacobians,
    /// `[FrameAcceleration<S>; NF]`: linear, angular.
    FrameAccelerations,
}
