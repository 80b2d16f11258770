//! The robot of a URDF as a tree of links that stands on the ground.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

use redysim_model::JointKind;
use redysim_model::rotation::align_z;
use redysim_model::spatial::{Pose, Vec3};
use redysim_toml::rounded_quarter_turns;

use super::Base;
use super::document::Document;
use super::elements::{Elements, JointElement, Limit, Mimic};
use super::inertial::Inertial;
use super::notation::inertial;
use super::origin::{Origin, scaled};
use crate::failure::Failure;
use crate::number::counted;

/// A robot whose root is the ground, or floats.
pub struct Robot {
    /// Its name; empty if the file gives none.
    pub name: String,
    /// All links but a root that is the ground: a root that floats, then the others in the order of the file's joints.
    pub links: Vec<Link>,
    /// What is left out or written otherwise, beside the remarks of the links.
    pub notes: Vec<String>,
}

/// A link and the joint that carries it.
#[derive(Clone, Debug)]
pub struct Link {
    pub name: String,
    pub joint_name: String,
    /// `None` is the ground.
    pub parent: Option<usize>,
    pub kind: JointKind,
    /// Whether it is the root of the URDF, which no joint of it carries.
    pub is_root: bool,
    pub origin: Origin,
    /// Where the link's frame stands on its joint, if elsewhere.
    pub far_end: Option<Origin>,
    pub axis: [f64; 3],
    pub inertial: Inertial,
    /// Of a joint that moves and has limits.
    pub limit: Option<Limit>,
    /// Viscous damping, N m s/rad or N s/m, and friction, N m or N, of a joint that moves.
    pub resistance: [f64; 2],
    /// The joint that this one mimics, and how.
    pub mimic: Option<Mimic>,
    /// What a reader of the model should know.
    pub remarks: Vec<String>,
    /// What of the URDF a model has no place for.
    pub comments: Vec<String>,
}

impl Robot {
    /// The robot of a document.
    ///
    /// # Errors
    /// If an element is incomplete, an attribute is not a number, or the links and joints are not a tree.
    pub fn read(document: &Document, base: Base) -> Result<Robot, Failure> {
        let urdf = document.elements()?;
        unique(document, "link", urdf.links.iter().map(|link| link.name))?;
        unique(document, "joint", urdf.joints.iter().map(|joint| joint.name))?;
        let root = root(document, &urdf, base)?;
        let inertial_of = |name: &str| {
            urdf.links.iter().find(|link| link.name == name).map_or(Inertial::none(), |link| link.inertial)
        };
        let carried_by: HashMap<&str, usize> =
            urdf.joints.iter().enumerate().map(|(index, joint)| (joint.child, index)).collect();
        let mut notes = Vec::new();
        let fixed = inertial_of(root);
        let floats = base == Base::Free;
        notes.push(if floats {
            format!("the root link `{root}` floats on a free joint without an actuator")
        } else if fixed.is_none() {
            format!("the root link `{root}` is the ground, called `base` here")
        } else {
            format!(
                "the root link `{root}` is fixed to the ground, called `base` here: its {} kg never move and are left \
                 out: {}",
                fixed.mass,
                inertial(fixed)
            )
        });
        let link = |joint: &JointElement| {
            let (origin, far_end) = placed(joint);
            Link {
                name: joint.child.to_owned(),
                joint_name: joint.name.to_owned(),
                parent: match carried_by.get(joint.parent) {
                    Some(carrier) => Some(carrier + usize::from(floats)),
                    None => floats.then_some(0),
                },
                kind: joint.kind,
                is_root: false,
                origin,
                far_end,
                axis: joint.axis,
                inertial: inertial_of(joint.child),
                limit: joint.limit,
                resistance: resistance(joint),
                mimic: joint.mimic.clone(),
                remarks: Vec::new(),
                comments: Vec::new(),
            }
        };
        let taken = |name: &str| urdf.joints.iter().any(|joint| joint.name == name);
        let root = floats.then(|| Link::floating(root, free_name("base", taken), inertial_of(root)));
        let links: Vec<Link> = root.into_iter().chain(urdf.joints.iter().map(link)).collect();
        Ok(Robot { name: urdf.name.to_owned(), links, notes }.without_noise())
    }

    /// No inertia is mere roundoff.
    fn without_noise(mut self) -> Self {
        for link in &mut self.links {
            let (clean, noise) = link.inertial.without_noise();
            link.inertial = clean;
            if noise {
                self.notes.push(format!("the inertia of link `{}` is roundoff: it is zero here", link.name));
            }
        }
        self
    }

    /// Angles of joints that are nearly multiples of 90° are made so: their zeros leave the generated code.
    pub fn with_quarter_turns(mut self) -> Self {
        let (mut count, mut largest) = (0, 0.0_f64);
        for angle in self.links.iter_mut().flat_map(|link| &mut link.origin.rpy) {
            let Some(quarters) = rounded_quarter_turns(*angle) else { continue };
            let exact = quarters * FRAC_PI_2;
            (count, largest, *angle) = (count + 1, largest.max((exact - *angle).abs()), exact);
        }
        if count > 0 {
            let angles = counted(count, "angle");
            self.notes.push(format!("{angles} made a multiple of 90°, changed by {largest:.1e} rad at most"));
        }
        self
    }

    /// Joints mimic others that have one coordinate, as they have themselves; each that cannot gets a remark.
    pub fn with_possible_mimics(mut self) -> Self {
        let possible: Vec<bool> = (0..self.links.len()).map(|link| self.followed(link) != link).collect();
        let names: Vec<String> = self.links.iter().map(|link| link.joint_name.clone()).collect();
        for link in self.links.iter_mut().zip(possible).filter(|(_, possible)| !possible).map(|(link, _)| link) {
            let Some(Mimic { joint, multiplier, offset }) = link.mimic.take() else { continue };
            let here = match link.kind {
                JointKind::Fixed => "fixed",
                JointKind::Free | JointKind::Planar => "free here, without an actuator",
                _ => "free here, with an actuator of its own",
            };
            let unit = if link.kind == JointKind::Prismatic { "m" } else { "rad" };
            let why = match &joint {
                own if *own == link.joint_name => ", but a joint cannot mimic itself",
                other if !names.contains(other) => ", but no joint has this name",
                _ => "",
            };
            link.remarks.push(format!(
                "joint `{}` mimics `{joint}` in the URDF ({multiplier} times its value, plus {offset} {unit}){why}: it is {here}",
                link.joint_name
            ));
        }
        self
    }

    /// Joints with a negative limit of effort, velocity or acceleration, or a lower limit above the upper one, get a remark: they have no range.
    pub fn with_possible_limits(mut self) -> Self {
        for link in &mut self.links {
            let Some(&Limit { lower, upper, effort, velocity, acceleration }) = link.limit.as_ref() else { continue };
            let unit = if link.kind == JointKind::Prismatic { "m" } else { "rad" };
            let why = if lower > upper {
                format!("its lower limit, {lower} {unit}, is above its upper one, {upper} {unit}")
            } else if effort < 0.0 {
                format!("its limit of effort is {effort}, which is negative")
            } else if velocity < 0.0 {
                format!("its limit of velocity is {velocity}, which is negative")
            } else if acceleration < 0.0 {
                format!("its limit of acceleration is {acceleration}, which is negative")
            } else {
                continue;
            };
            link.remarks.push(format!("joint `{}` has no range here: {why}", link.joint_name));
        }
        self
    }

    /// The link whose joint moves that of a link in the end: itself, unless its joint can mimic another. Joints that mimic
    /// one another in a circle move themselves.
    pub fn followed(&self, link: usize) -> usize {
        let mut chain = std::iter::successors(Some(link), |&link| self.mimicked(link)).take(self.links.len());
        chain.find(|&link| self.mimicked(link).is_none()).unwrap_or(link)
    }

    /// The link whose joint that of a link mimics, if both move about or along one axis.
    fn mimicked(&self, link: usize) -> Option<usize> {
        let Link { kind, mimic, .. } = &self.links[link];
        let mimic = mimic.as_ref().filter(|mimic| kind.has_axis() && mimic.multiplier != 0.0)?;
        let mimicked = self.links.iter().position(|link| link.joint_name == mimic.joint)?;
        self.links[mimicked].kind.has_axis().then_some(mimicked)
    }

    /// No link has the name of the ground.
    pub fn without_reserved_name(mut self) -> Self {
        let taken = |name: &str| self.links.iter().any(|link| link.name == name);
        let Some(index) = self.links.iter().position(|link| link.name == "base") else { return self };
        let name = free_name("base_link", taken);
        self.notes.push(format!("link `base` is called `{name}` here: `base` is the ground"));
        self.links[index].name = name;
        self
    }
}

impl Link {
    /// The root of a robot, on a free joint.
    fn floating(name: &str, joint_name: String, inertial: Inertial) -> Self {
        Link {
            name: name.to_owned(),
            joint_name,
            parent: None,
            kind: JointKind::Free,
            is_root: true,
            origin: Origin::identity(),
            far_end: None,
            axis: [0.0, 0.0, 1.0],
            inertial,
            limit: None,
            resistance: [0.0; 2],
            mimic: None,
            remarks: Vec::new(),
            comments: Vec::new(),
        }
    }
}

/// The name, or the first with a number that is not taken.
fn free_name(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let names = (0..).map(|n| if n == 0 { name.to_owned() } else { format!("{name}{n}") });
    names.into_iter().find(|name| !taken(name)).unwrap_or_default()
}

/// Where the joint stands, and where the link's frame does on it, if elsewhere: a planar joint has its normal along z here.
fn placed(joint: &JointElement) -> (Origin, Option<Origin>) {
    let (origin, [x, y, z]) = (joint.origin, joint.axis);
    if joint.kind != JointKind::Planar || (x == 0.0 && y == 0.0 && z > 0.0) {
        return (origin, None);
    }
    let normal = Vec3(scaled(joint.axis).unwrap_or(joint.axis));
    let turned = Pose { rotation: align_z(normal.scale(1.0 / normal.dot(normal).sqrt())), position: Vec3::zero() };
    let back = Pose { rotation: turned.rotation.transpose(), position: Vec3::zero() };
    (Origin::of(origin.pose() * turned), Some(Origin::of(back)))
}

/// Whether one number is the damping of a joint of this kind: all its velocities have one unit.
pub fn has_one_damping(kind: JointKind) -> bool {
    kind.has_axis() || kind == JointKind::Spherical
}

/// Damping and friction.
fn resistance(joint: &JointElement) -> [f64; 2] {
    if has_one_damping(joint.kind) { [joint.damping, joint.friction] } else { [0.0; 2] }
}

fn unique<'n>(document: &Document, tag: &str, names: impl Iterator<Item = &'n str>) -> Result<(), Failure> {
    let mut seen = HashMap::new();
    for name in names {
        if seen.insert(name, ()).is_some() {
            let message = format!("there are two {tag}s of the name `{}`", name.escape_debug());
            return Err(document.fault_at(tag, name, message).help("give one of them another name"));
        }
    }
    Ok(())
}

/// The link that no joint carries, if the links and joints are a tree on it that moves.
fn root<'u>(document: &Document, urdf: &Elements<'u>, base: Base) -> Result<&'u str, Failure> {
    let mut carried: HashMap<&str, &str> = HashMap::new();
    for joint in &urdf.joints {
        for end in [joint.parent, joint.child] {
            if !urdf.links.iter().any(|link| link.name == end) {
                let message = format!("joint `{}`: unknown link `{end}`", joint.name);
                return Err(document.fault_at("joint", joint.name, message));
            }
        }
        if let Some(other) = carried.insert(joint.child, joint.name) {
            let message = format!("link `{}` hangs on two joints, `{other}` and `{}`", joint.child, joint.name);
            let help = "a URDF is a tree: leave one of the joints out, and add it to the imported model as a [[loop]]";
            return Err(document.fault_at("joint", joint.name, message).help(help));
        }
    }
    let roots: Vec<&str> = urdf.links.iter().map(|link| link.name).filter(|name| !carried.contains_key(name)).collect();
    if base == Base::Fixed && urdf.joints.is_empty() && !urdf.links.is_empty() {
        return Err(document
            .fault(document.robot(), "the robot has no joints: nothing of it moves")
            .help("with `--base free` its link floats"));
    }
    match roots.as_slice() {
        [root] => {
            on_root(document, urdf, root)?;
            if base == Base::Free {
                floats_with_inertia(document, urdf, root)?
            }
            Ok(*root)
        }
        [] if urdf.links.is_empty() => Err(document.fault(document.robot(), "the robot has no links")),
        [] => Err(document
            .fault(document.robot(), "no link is the root: each hangs on another, in a circle")
            .help("the link that stands on the ground must be no joint's child")),
        [first, others @ ..] => {
            let message = format!("the robot has {} roots: `{first}`, `{}`", roots.len(), others.join("`, `"));
            Err(document.fault_at("link", others[0], message).help("join them: one link carries all others"))
        }
    }
}

/// A root that floats has an inertia, or carries a link that does not float on it.
fn floats_with_inertia(document: &Document, urdf: &Elements, root: &str) -> Result<(), Failure> {
    let has_inertia = urdf.links.iter().any(|link| link.name == root && !link.inertial.is_none());
    let mut joints = urdf.joints.iter().filter(|joint| joint.parent == root).peekable();
    if has_inertia || joints.peek().is_none() || joints.any(|joint| joint.kind != JointKind::Free) {
        return Ok(());
    }
    let message =
        format!("the root link `{root}` has no inertia, and carries nothing but links that float: it cannot float");
    Err(document.fault_at("link", root, message).help("leave out `--base free`: the root is the ground then"))
}

/// Every link hangs on the root in the end.
fn on_root(document: &Document, urdf: &Elements, root: &str) -> Result<(), Failure> {
    let mut reached = vec![root];
    let mut next = 0;
    while let Some(&link) = reached.get(next) {
        reached.extend(urdf.joints.iter().filter(|joint| joint.parent == link).map(|joint| joint.child));
        next += 1;
    }
    match urdf.links.iter().find(|link| !reached.contains(&link.name)) {
        None => Ok(()),
        Some(link) => {
            let message = format!("link `{}` hangs on itself, in a circle, and not on the root `{root}`", link.name);
            Err(document.fault_at("link", link.name, message))
        }
    }
}
