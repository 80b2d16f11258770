//! A `[[link]]` table.

use super::reader::{Reader, Shape};
use super::{Field, Table, item};
use crate::diagnostic::Findings;
use crate::model::{Inertia, JointKind, JointRange};
use std::ops::Range;
use toml::Spanned;

/// What a `[[link]]` table says.
#[derive(Debug)]
pub(crate) struct LinkTable {
    /// What messages call the link.
    pub(crate) item: String,
    /// The place of `[[link]]`.
    pub(crate) header: Range<usize>,
    pub(crate) name: Field<String>,
    pub(crate) joint_name: Field<String>,
    pub(crate) parent: Field<String>,
    pub(crate) joint: Field<JointKind>,
    pub(crate) dh: Field<Dh>,
    pub(crate) origin: Field<Origin>,
    pub(crate) axis: Field<[f64; 3]>,
    pub(crate) pitch: Field<f64>,
    pub(crate) mass: Field<f64>,
    pub(crate) com: Field<[f64; 3]>,
    pub(crate) inertia: Field<Inertia>,
    pub(crate) actuated: Field<bool>,
    pub(crate) range: Field<JointRange>,
    /// The value at which the scene holds the joint.
    pub(crate) locked: Option<f64>,
}

/// Khalil-Kleinfinger parameters: the link's frame stands in its parent's at Rx(alpha) Tx(a) Rz(theta) Tz(b).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Dh {
    pub(crate) a: f64,
    pub(crate) alpha: f64,
    pub(crate) b: f64,
    pub(crate) theta: f64,
}

/// Place of the link's frame in its parent's, as URDF has it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Origin {
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
}

const LINK: Shape = Shape {
    owner: "A link",
    keys: &[
        "name",
        "joint_name",
        "parent",
        "joint",
        "dh",
        "origin",
        "axis",
        "pitch",
        "mass",
        "com",
        "inertia",
        "actuated",
        "range",
    ],
};
const DH: Shape = Shape { owner: "`dh`", keys: &["a", "alpha", "b", "theta"] };
const ORIGIN: Shape = Shape { owner: "`origin`", keys: &["xyz", "rpy"] };
const RANGE: Shape = Shape { owner: "`range`", keys: &["position", "velocity", "acceleration", "force"] };
const INERTIA: Shape = Shape { owner: "`inertia`", keys: &["xx", "yy", "zz", "xy", "yz", "xz"] };

/// Kinds of joint that are planned.
const UNSUPPORTED: &[&str] = &["universal", "spherical", "free"];

impl LinkTable {
    /// Reads the `number`-th link of the file.
    pub(super) fn read((table, header): Table<'_>, number: usize, findings: &mut Findings) -> LinkTable {
        let item = item("link", table, number);
        let mut reader = Reader::new(table, header.clone(), &item, &LINK, findings);
        let name = reader.text("name");
        let parent = reader.text("parent");
        let joint = reader.choice("joint", &JointKind::ALL, UNSUPPORTED);
        let pitch = reader.number("pitch");
        let helical = joint.value() == Some(&JointKind::Helical);
        let mass = reader.number("mass");
        let turns = joint.value() != Some(&JointKind::Prismatic);
        LinkTable {
            name: reader.required("name", name),
            joint_name: reader.text("joint_name"),
            parent: reader.required("parent", parent),
            joint: reader.required("joint", joint),
            dh: reader.table("dh", &DH, dh),
            origin: reader.table("origin", &ORIGIN, origin),
            axis: reader.vector("axis"),
            pitch: if helical { reader.required("pitch", pitch) } else { pitch },
            mass: reader.required("mass", mass),
            com: reader.vector("com"),
            inertia: reader.table("inertia", &INERTIA, inertia),
            actuated: reader.flag("actuated"),
            range: reader.table("range", &RANGE, |reader| range(reader, turns)),
            locked: None,
            item,
            header,
        }
    }

    /// Whether the link is part of its parent's body; a joint of unreadable kind is taken for one that moves.
    pub(crate) fn is_rigid(&self) -> bool {
        self.locked.is_some() || self.joint.value() == Some(&JointKind::Fixed)
    }

    /// Where faults of the link as a whole are shown.
    pub(crate) fn place(&self) -> Range<usize> {
        self.name.spanned().map_or(self.header.clone(), Spanned::span)
    }

    /// The joint's name: the link's unless the file gives one.
    pub(crate) fn joint_name(&self) -> Option<&Spanned<String>> {
        if self.joint_name.is_missing() { self.name.spanned() } else { self.joint_name.spanned() }
    }
}

// Faulty entries become zero here; the fault that was reported makes the whole table faulty.

fn dh(mut reader: Reader<'_, '_>) -> Dh {
    Dh {
        a: reader.number("a").value_or(0.0).unwrap_or_default(),
        alpha: reader.angle("alpha").value_or(0.0).unwrap_or_default(),
        b: reader.number("b").value_or(0.0).unwrap_or_default(),
        theta: reader.angle("theta").value_or(0.0).unwrap_or_default(),
    }
}

fn origin(mut reader: Reader<'_, '_>) -> Origin {
    Origin {
        xyz: reader.vector("xyz").value_or([0.0; 3]).unwrap_or_default(),
        rpy: reader.angles("rpy").value_or([0.0; 3]).unwrap_or_default(),
    }
}

/// Of a joint that turns, in radians.
fn range(mut reader: Reader<'_, '_>, turns: bool) -> JointRange {
    let position = reader.bounds("position", turns);
    let [velocity, acceleration] = [("velocity", "/s"), ("acceleration", "/s^2")].map(|(key, per)| {
        let largest = reader.largest(key, turns, per);
        reader.required(key, largest).value_or(0.0).unwrap_or_default()
    });
    let position = reader.required("position", position).value_or([0.0; 2]).unwrap_or_default();
    let force = reader.positive("force");
    JointRange { position, velocity, acceleration, force: force.value().copied() }
}

fn inertia(mut reader: Reader<'_, '_>) -> Inertia {
    let mut element = |key| reader.number(key).value_or(0.0).unwrap_or_default();
    Inertia {
        xx: element("xx"),
        yy: element("yy"),
        zz: element("zz"),
        xy: element("xy"),
        yz: element("yz"),
        xz: element("xz"),
    }
}
