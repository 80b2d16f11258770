//! Arguments and results as arrays: lengths, structs with named parts, and units.

use super::{Argument, Dimension, Shape};

/// The length of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// A size of the mechanism.
    Size(Dimension),
    /// A component of a vector in space.
    Three,
}

/// A part of a struct: its name, its lengths, and what it is with units.
pub type Field = (&'static str, &'static [Length], &'static str);

/// An argument or a result as an array, in the memory of which all numbers stand in order: those of a struct after those
/// of the struct before, those of a part after those of the part before, matrices by rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// Its name.
    pub name: &'static str,
    /// What it is, with units.
    pub what: &'static str,
    /// The lengths of the array; empty for one number or struct.
    pub lengths: &'static [Length],
    /// The struct of each element; `None` for numbers.
    pub structure: Option<Structure>,
}

/// A struct of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// The name of its type, as `link_state`.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Its parts, in order.
    pub fields: &'static [Field],
}

const NQ: Length = Length::Size(Dimension::Coordinates);
const NV: Length = Length::Size(Dimension::Velocities);
const NL: Length = Length::Size(Dimension::Links);
const NC: Length = Length::Size(Dimension::LoopRows);
const NF: Length = Length::Size(Dimension::Frames);
const VECTOR: &[Length] = &[Length::Three];
const MATRIX: &[Length] = &[Length::Three, Length::Three];

/// A wrench, the element of an argument.
const WRENCH: Structure = Structure {
    name: "wrench",
    what: "A force and a moment on the mechanism at the origin of a frame, in the axes of the base frame.",
    fields: &[("force", VECTOR, "N"), ("moment", VECTOR, "About the frame's origin, N m")],
};

const fn numbers(name: &'static str, lengths: &'static [Length], what: &'static str) -> Form {
    Form { name, what, lengths, structure: None }
}

const fn one(name: &'static str, what: &'static str, structure: Structure) -> Form {
    Form { name, what, lengths: &[], structure: Some(structure) }
}

const fn many(name: &'static str, lengths: &'static [Length], what: &'static str, structure: Structure) -> Form {
    Form { name, what, lengths, structure: Some(structure) }
}

impl Shape {
    /// The result as an array.
    ///
    /// ```
    /// use redysim_runtime::Function;
    ///
    /// let links = Function::LinkKinematics.signature().result.form();
    /// let parts = links.structure.unwrap().fields.iter().map(|(name, ..)| *name);
    /// assert!(parts.eq(["rotation", "origin", "com", "velocity", "angular_velocity"]));
    /// ```
    pub const fn form(self) -> Form {
        match self {
            Shape::Forces => numbers("tau", &[NV], "Joint forces, N m or N"),
            Shape::Accelerations => numbers("a", &[NV], "Joint accelerations, rad/s² or m/s²"),
            Shape::MassMatrix => numbers("matrix", &[NV, NV], "The matrix by rows, kg m², kg m or kg"),
            Shape::CoriolisMatrix => numbers("matrix", &[NV, NV], "The matrix by rows, kg m²/s, kg m/s or kg/s"),
            Shape::Coordinates => numbers("result", &[NQ], "Joint coordinates, or their rates"),
            Shape::Displacement => numbers("dv", &[NV], "Joint velocities, constant over a unit of time, rad or m"),
            Shape::LoopRows => numbers("result", &[NC], "A number for each row of the loop constraints"),
            Shape::LoopJacobian => numbers("jacobian", &[NC, NV], "The Jacobian by rows"),
            Shape::Power => numbers("power", &[], "Power, W"),
            Shape::Energy => one(
                "energy",
                "Energy of the mechanism",
                Structure {
                    name: "energy",
                    what: "Energy of a mechanism.",
                    fields: &[
                        ("kinetic", &[], "½ vᵀ M v, J"),
                        ("potential", &[], "−Σ m g·c, zero at the origin of the base frame, and that of springs, J"),
                    ],
                },
            ),
            Shape::CenterOfMass => one(
                "center",
                "The centre of mass",
                Structure {
                    name: "center_of_mass",
                    what: "The centre of mass of a mechanism, in the base frame.",
                    fields: &[("position", VECTOR, "m"), ("velocity", VECTOR, "m/s")],
                },
            ),
            Shape::Momentum => one(
                "momentum",
                "Momentum of the mechanism",
                Structure {
                    name: "momentum",
                    what: "Momentum of a mechanism, in the axes of the base frame.",
                    fields: &[("linear", VECTOR, "N s"), ("angular", VECTOR, "About the centre of mass, N m s")],
                },
            ),
            Shape::HybridMotion => one(
                "motion",
                "Accelerations and joint forces",
                Structure {
                    name: "hybrid_motion",
                    what: "Accelerations and joint forces, those that are given and those that are found.",
                    fields: &[
                        ("a", &[NV], "Joint accelerations, rad/s² or m/s²"),
                        ("tau", &[NV], "Joint forces, N m or N"),
                    ],
                },
            ),
            Shape::Links => many(
                "links",
                &[NL],
                "Position and velocity of each link",
                Structure {
                    name: "link_state",
                    what: "Position and velocity of a link, in the base frame.",
                    fields: &[
                        ("rotation", MATRIX, "The link's axes as columns: rotation[row][column]"),
                        ("origin", VECTOR, "Origin of the link's frame, m"),
                        ("com", VECTOR, "Centre of mass, m"),
                        ("velocity", VECTOR, "Velocity of the origin, m/s"),
                        ("angular_velocity", VECTOR, "rad/s"),
                    ],
                },
            ),
            Shape::Frames => many(
                "frames",
                &[NF],
                "Position and velocity of each frame of interest",
                Structure {
                    name: "frame_state",
                    what: "Position and velocity of a frame of interest, in the base frame.",
                    fields: &[
                        ("rotation", MATRIX, "The frame's axes as columns: rotation[row][column]"),
                        ("origin", VECTOR, "m"),
                        ("velocity", VECTOR, "Velocity of the origin, m/s"),
                        ("angular_velocity", VECTOR, "rad/s"),
                    ],
                },
            ),
            Shape::FrameJacobians => many(
                "jacobians",
                &[NF],
                "The Jacobian of each frame of interest",
                Structure {
                    name: "frame_jacobian",
                    what: "The Jacobian of a frame of interest, by rows, in the axes of the base frame.",
                    fields: &[
                        ("linear", &[Length::Three, NV], "linear · v is the velocity of the frame's origin"),
                        ("angular", &[Length::Three, NV], "angular · v is its angular velocity"),
                    ],
                },
            ),
            Shape::FrameAccelerations => many(
                "accelerations",
                &[NF],
                "Accelerations of each frame of interest",
                Structure {
                    name: "frame_acceleration",
                    what: "Acceleration of a frame of interest, in the axes of the base frame.",
                    fields: &[("linear", VECTOR, "Of the origin, m/s²"), ("angular", VECTOR, "rad/s²")],
                },
            ),
        }
    }
}

impl Argument {
    /// The argument as an array.
    pub const fn form(self) -> Form {
        let lengths: &[Length] = match self.dimension() {
            Dimension::Coordinates => &[NQ],
            Dimension::Velocities => &[NV],
            Dimension::Links => &[NL],
            Dimension::LoopRows => &[NC],
            Dimension::Frames => &[NF],
        };
        let structure = match self {
            Argument::Wrenches => Some(WRENCH),
            _ => None,
        };
        Form { name: self.name(), what: self.meaning(), lengths, structure }
    }

    /// What it is, with units.
    const fn meaning(self) -> &'static str {
        match self {
            Argument::Coordinates => "Joint coordinates, rad or m",
            Argument::Start => "Joint coordinates from which the displacement leads, rad or m",
            Argument::End => "Joint coordinates to which the displacement leads, rad or m",
            Argument::Velocities => "Joint velocities, rad/s or m/s",
            Argument::Displacement => "Joint velocities, constant over a unit of time, rad or m",
            Argument::Accelerations => "Joint accelerations, rad/s² or m/s²",
            Argument::Forces => "Joint forces, N m or N",
            Argument::Given => "Of each velocity with an actuator its acceleration, of the others the joint force",
            Argument::Wrenches => "A wrench on each frame, in the axes of the base frame",
        }
    }
}

impl Dimension {
    /// The name of the constant that has it, as `NQ`.
    pub const fn name(self) -> &'static str {
        match self {
            Dimension::Coordinates => "NQ",
            Dimension::Velocities => "NV",
            Dimension::Links => "NL",
            Dimension::LoopRows => "NC",
            Dimension::Frames => "NF",
        }
    }
}
