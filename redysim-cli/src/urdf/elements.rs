//! The links and joints of a URDF as their elements give them, each number checked where it stands.

use redysim_model::JointKind;
use redysim_model::inertia::Sym3;
use redysim_model::spatial::{Pose, Vec3};
use roxmltree::Node;

use super::document::{
    Document, EXPAND, INFINITE_BY_DEFAULT, WITH_QUATERNIONS, child, children, finite_numbers, read_in,
};
use super::inertial::Inertial;
use super::origin::{Origin, rotation};
use crate::failure::Failure;

/// The elements of a URDF that a model is made of, in the order of the file.
pub struct Elements<'d> {
    /// The name of the robot; empty if the file gives none.
    pub name: &'d str,
    pub links: Vec<LinkElement<'d>>,
    pub joints: Vec<JointElement<'d>>,
}

pub struct LinkElement<'d> {
    pub name: &'d str,
    pub inertial: Inertial,
}

pub struct JointElement<'d> {
    pub name: &'d str,
    pub kind: JointKind,
    /// The link that carries the joint.
    pub parent: &'d str,
    /// The link that the joint carries.
    pub child: &'d str,
    pub origin: Origin,
    pub axis: [f64; 3],
    /// Of a joint that moves about or along an axis.
    pub limit: Option<Limit>,
    pub mimic: Option<Mimic>,
    /// Viscous damping, N m s/rad or N s/m.
    pub damping: f64,
    /// N m or N.
    pub friction: f64,
}

/// The limits of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// rad or m.
    pub lower: f64,
    /// rad or m.
    pub upper: f64,
    /// N m or N.
    pub effort: f64,
    /// rad/s or m/s.
    pub velocity: f64,
    /// rad/s² or m/s².
    pub acceleration: f64,
}

/// A coordinate that is `multiplier` times that of another joint, plus `offset`.
#[derive(Clone, Debug)]
pub struct Mimic {
    pub joint: String,
    pub multiplier: f64,
    /// rad or m.
    pub offset: f64,
}

/// The types of joints in a URDF, and their kinds in a model.
const KINDS: [(&str, JointKind); 7] = [
    ("revolute", JointKind::Revolute),
    ("continuous", JointKind::Revolute),
    ("prismatic", JointKind::Prismatic),
    ("fixed", JointKind::Fixed),
    ("floating", JointKind::Free),
    ("planar", JointKind::Planar),
    ("spherical", JointKind::Spherical),
];

impl<'d, 'a> Document<'a> {
    /// Reads the links and joints.
    ///
    /// # Errors
    /// The first element that is incomplete, or of which an attribute is not a number.
    pub fn elements(&'d self) -> Result<Elements<'d>, Failure> {
        let robot = self.robot();
        Ok(Elements {
            name: robot.attribute("name").unwrap_or_default(),
            links: children(robot, "link").map(|link| Item::new(self, link)?.link()).collect::<Result<_, _>>()?,
            joints: self.joints().map(|joint| Item::new(self, joint)?.joint()).collect::<Result<_, _>>()?,
        })
    }
}

/// A link or joint that is being read.
struct Item<'d, 'a> {
    document: &'d Document<'a>,
    node: Node<'d, 'a>,
    name: &'d str,
}

impl<'d, 'a> Item<'d, 'a> {
    fn new(document: &'d Document<'a>, node: Node<'d, 'a>) -> Result<Self, Failure> {
        match node.attribute("name") {
            Some(name) => Ok(Item { document, node, name }),
            None => Err(document.fault(node, format!("a <{}> has no `name`", node.tag_name().name()))),
        }
    }

    fn link(&self) -> Result<LinkElement<'d>, Failure> {
        self.check_single(self.node)?;
        let inertial = child(self.node, "inertial").map_or(Ok(Inertial::none()), |inertial| self.inertial(inertial))?;
        Ok(LinkElement { name: self.name, inertial })
    }

    fn inertial(&self, inertial: Node<'d, 'a>) -> Result<Inertial, Failure> {
        self.check_single(inertial)?;
        let origin = self.origin(inertial)?;
        let [mass] = self.required_numbers(self.required(inertial, "mass")?, "value")?;
        let inertia = self.required(inertial, "inertia")?;
        let element = |name| self.required_numbers(inertia, name).map(|[element]| element);
        let [xx, xy, xz, yy, yz, zz] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(element);
        let inertia = Sym3 { xx: xx?, xy: xy?, xz: xz?, yy: yy?, yz: yz?, zz: zz? };
        // The inertial frame has the centre of mass as its origin, and its axes are those of the inertia.
        Ok(Inertial { mass, com: Vec3::zero(), inertia }.seen_from(origin.pose()))
    }

    fn joint(&self) -> Result<JointElement<'d>, Failure> {
        self.check_single(self.node)?;
        let (urdf_kind, kind) = self.kind()?;
        let [parent, child_link] = ["parent", "child"].map(|end| {
            let node = self.required(self.node, end)?;
            node.attribute("link").ok_or_else(|| self.fault(node, format!("its <{end}> has no `link`")))
        });
        let (parent, child_link) = (parent?, child_link?);
        let origin = self.origin(self.node)?;
        let axis = child(self.node, "axis").map_or(Ok([1.0, 0.0, 0.0]), |axis| self.axis(axis, kind))?;
        let limit = child(self.node, "limit").map_or(Ok(None), |limit| self.limit(limit))?;
        let limit = limit.filter(|_| kind.has_axis()).map(|limit| match urdf_kind {
            "continuous" => Limit { lower: f64::NEG_INFINITY, upper: f64::INFINITY, ..limit },
            _ => limit,
        });
        let [damping, friction] = ["damping", "friction"].map(|name| {
            let given = child(self.node, "dynamics").map_or(Ok(None), |dynamics| self.numbers(dynamics, name));
            given.map(|given| given.map_or(0.0, |[number]| number))
        });
        let (damping, friction) = (damping?, friction?);
        let mimic = child(self.node, "mimic").map(|mimic| self.mimic(mimic)).transpose()?;
        Ok(JointElement {
            name: self.name,
            kind,
            parent,
            child: child_link,
            origin,
            axis,
            limit,
            mimic,
            damping,
            friction,
        })
    }

    /// The kind, as URDF calls it and as a model does.
    fn kind(&self) -> Result<(&'static str, JointKind), Failure> {
        let Some(found) = self.node.attribute("type") else {
            return Err(self.fault(self.node, "it has no `type`"));
        };
        KINDS.into_iter().find(|(name, _)| *name == found).ok_or_else(|| {
            let kinds = KINDS.map(|(name, _)| name).join(", ");
            let message = format!("its `type` cannot be `{}`", found.escape_debug());
            self.fault(self.node, message).help(format!("the types are: {kinds}"))
        })
    }

    fn axis(&self, axis: Node<'d, 'a>, kind: JointKind) -> Result<[f64; 3], Failure> {
        let direction = self.required_numbers(axis, "xyz")?;
        let what = match kind {
            JointKind::Planar => "its `axis`, the normal of the plane in which it moves,",
            kind if kind.has_axis() => "its `axis`",
            _ => return Ok(direction),
        };
        if direction == [0.0; 3] {
            return Err(self.fault(axis, format!("{what} is zero")).help("give a direction, as in xyz=\"0 0 1\""));
        }
        Ok(direction)
    }

    /// The limits, which may be infinite.
    fn limit(&self, limit: Node<'d, 'a>) -> Result<Option<Limit>, Failure> {
        let is_infinite = self.document.version() >= INFINITE_BY_DEFAULT;
        let default = if is_infinite { f64::INFINITY } else { 0.0 };
        let given = |name: &str, default: f64| match limit.attribute(name) {
            None => Ok(default),
            Some(text) => {
                let number = text.trim().parse().ok().filter(|number: &f64| !number.is_nan());
                number.ok_or_else(|| self.wrong(limit, name, "a number", text))
            }
        };
        let acceleration = given("acceleration", f64::INFINITY)?;
        let read = Limit {
            lower: given("lower", -default)?,
            upper: given("upper", default)?,
            effort: given("effort", default)?,
            velocity: given("velocity", default)?,
            acceleration: if is_infinite { acceleration } else { f64::INFINITY },
        };
        // These appear in comments of the model alone.
        given("deceleration", f64::INFINITY)?;
        given("jerk", f64::INFINITY)?;
        Ok(self.document.is_complete(limit).then_some(read))
    }

    fn mimic(&self, mimic: Node<'d, 'a>) -> Result<Mimic, Failure> {
        let joint = mimic.attribute("joint").ok_or_else(|| self.fault(mimic, "its <mimic> has no `joint`"))?;
        let [multiplier] = self.numbers(mimic, "multiplier")?.unwrap_or([1.0]);
        let [offset] = self.numbers(mimic, "offset")?.unwrap_or([0.0]);
        Ok(Mimic { joint: joint.to_owned(), multiplier, offset })
    }

    fn origin(&self, owner: Node<'d, 'a>) -> Result<Origin, Failure> {
        let Some(origin) = child(owner, "origin") else { return Ok(Origin::identity()) };
        let xyz = self.numbers(origin, "xyz")?.unwrap_or([0.0; 3]);
        let rpy = self.numbers(origin, "rpy")?;
        if !origin.has_attribute("quat_xyzw") {
            return Ok(Origin { xyz, rpy: rpy.unwrap_or([0.0; 3]) });
        }
        let fault = |message: &str| self.fault(origin, format!("`quat_xyzw` of its <origin> {message}"));
        if rpy.is_some() {
            return Err(fault("conflicts with `rpy`").help("keep one of them"));
        }
        if self.document.version() < WITH_QUATERNIONS {
            let fault = fault("requires URDF 1.1, but the file has an earlier version");
            return Err(fault.help("give `rpy` instead, or set version=\"1.1\" in the <robot>"));
        }
        let quaternion = self.required_numbers(origin, "quat_xyzw")?;
        let Some(rotation) = rotation(quaternion) else {
            return Err(fault("is zero, which is not a rotation").help("the identity is quat_xyzw=\"0 0 0 1\""));
        };
        Ok(Origin::of(Pose { rotation, position: Vec3(xyz) }))
    }

    /// Fails if `owner` has two elements of a name that is read.
    fn check_single(&self, owner: Node) -> Result<(), Failure> {
        match read_in(owner).iter().find_map(|read| children(owner, read).nth(1)) {
            None => Ok(()),
            Some(again) => {
                let [tag, again_tag] = [owner, again].map(|node| node.tag_name().name());
                Err(self.fault(again, format!("its <{tag}> has a second <{again_tag}>")).help("keep one of them"))
            }
        }
    }

    fn required(&self, owner: Node<'d, 'a>, tag: &str) -> Result<Node<'d, 'a>, Failure> {
        let missing = || self.fault(owner, format!("its <{}> has no <{tag}>", owner.tag_name().name()));
        child(owner, tag).ok_or_else(missing)
    }

    fn required_numbers<const N: usize>(&self, node: Node, attribute: &str) -> Result<[f64; N], Failure> {
        let missing = || self.fault(node, format!("its <{}> has no `{attribute}`", node.tag_name().name()));
        self.numbers(node, attribute)?.ok_or_else(missing)
    }

    /// The finite numbers of an attribute, if it is there.
    fn numbers<const N: usize>(&self, node: Node, attribute: &str) -> Result<Option<[f64; N]>, Failure> {
        let Some(text) = node.attribute(attribute) else { return Ok(None) };
        if let Some(numbers) = finite_numbers(text) {
            return Ok(Some(numbers));
        }
        let wanted = if N == 1 { "a finite number".into() } else { format!("{N} finite numbers") };
        let wrong = self.wrong(node, attribute, &wanted, text);
        Err(if text.contains("${") { wrong.help(EXPAND) } else { wrong })
    }

    fn wrong(&self, node: Node, attribute: &str, wanted: &str, found: &str) -> Failure {
        let (tag, found) = (node.tag_name().name(), found.escape_debug());
        self.fault(node, format!("`{attribute}` of its <{tag}> must be {wanted}, found \"{found}\""))
    }

    /// A fault of the link or joint at one of its elements.
    fn fault(&self, node: Node, message: impl std::fmt::Display) -> Failure {
        let tag = self.node.tag_name().name();
        self.document.fault(node, format!("{tag} `{}`: {message}", self.name.escape_debug()))
    }
}
