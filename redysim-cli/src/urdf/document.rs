//! The URDF as XML: on which line things stand, and what of it a model has no place for.

use std::collections::BTreeMap;

use roxmltree::{Document as Xml, Node};

use crate::failure::{Failure, Fault};

/// A version of URDF: major, minor.
pub type Version = (u32, u32);

/// The version of a file that does not state one.
const FIRST: Version = (1, 0);
/// The first version in which an origin may have a quaternion.
pub const WITH_QUATERNIONS: Version = (1, 1);
/// The first version in which limits are infinite by default, and not zero, and in which accelerations have limits.
pub const INFINITE_BY_DEFAULT: Version = (1, 2);
/// The versions of URDF, in order.
const VERSIONS: [Version; 3] = [FIRST, WITH_QUATERNIONS, INFINITE_BY_DEFAULT];

/// A URDF file that is well-formed.
pub struct Document<'a> {
    file: &'a str,
    xml: Xml<'a>,
    version: Version,
}

/// What is read inside of each element, and of others nothing.
const READ: [(&str, &[&str]); 4] = [
    ("robot", &["link", "joint"]),
    ("link", &["inertial"]),
    ("inertial", &["origin", "mass", "inertia"]),
    ("joint", &["origin", "parent", "child", "axis", "limit", "mimic", "dynamics"]),
];

/// The attributes that are read of these elements, but for `quat_xyzw` of an origin: of a misspelled one, the order of the
/// components is not known.
const ATTRIBUTES: [(&str, &[&str]); 11] = [
    ("link", &["name"]),
    ("joint", &["name", "type"]),
    ("origin", &["xyz", "rpy"]),
    ("parent", &["link"]),
    ("child", &["link"]),
    ("axis", &["xyz"]),
    ("limit", &["lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"]),
    ("mimic", &["joint", "multiplier", "offset"]),
    ("dynamics", &["damping", "friction"]),
    ("mass", &["value"]),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]),
];

impl<'a> Document<'a> {
    /// Parses the text of the file.
    ///
    /// # Errors
    /// If it is not well-formed, or not a URDF.
    pub fn parse(text: &'a str, file: &'a str) -> Result<Self, Failure> {
        let xml = Xml::parse(text).map_err(|error| broken(file, &error))?;
        let version = version(xml.root_element().attribute("version"));
        let document = Document { file, xml, version };
        let robot = document.robot();
        if robot.tag_name().name() != "robot" {
            let message = format!("the file has a <{}>, not a <robot>", robot.tag_name().name());
            return Err(document.fault(robot, message).help("give a URDF; other formats are not read"));
        }
        if let Some(node) = document.xml.descendants().find(is_xacro) {
            let message = format!("<xacro:{}> is a macro that is not expanded", node.tag_name().name());
            return Err(document.fault(node, message).help(EXPAND));
        }
        Ok(document)
    }

    /// A fault at an element, with its line.
    pub fn fault(&self, node: Node, message: impl std::fmt::Display) -> Failure {
        fault_in(self.file, (self.line(node), None), message)
    }

    /// A fault at the link or joint of this name.
    pub fn fault_at(&self, tag: &str, name: &str, message: impl std::fmt::Display) -> Failure {
        fault_in(self.file, (self.line_of(tag, name), None), message)
    }

    /// What messages call the file.
    pub fn file(&self) -> &str {
        self.file
    }

    /// The robot, of which everything else is a part.
    pub fn robot(&self) -> Node<'_, 'a> {
        self.xml.root_element()
    }

    /// The version of URDF by which the file is read.
    pub fn version(&self) -> Version {
        self.version
    }

    /// The warning that the file states a version that is not one of URDF.
    pub fn unknown_version(&self) -> Option<String> {
        let stated = self.robot().attribute("version")?;
        let (major, minor) = self.version;
        let (file, line, shown) = (self.file, self.line(self.robot()), stated.escape_debug());
        (stated.trim() != format!("{major}.{minor}")).then(|| {
            format!("{file}:{line}: unknown URDF version `{shown}`: the file is read as version {major}.{minor}")
        })
    }

    /// The line on which an element begins.
    pub fn line(&self, node: Node) -> u32 {
        self.xml.text_pos_at(node.range().start).row
    }

    /// The line of the last link or joint with this name, or 1 if no element has it.
    pub fn line_of(&self, tag: &str, name: &str) -> u32 {
        let named = children(self.xml.root_element(), tag).filter(|node| node.attribute("name") == Some(name));
        named.last().map_or(1, |node| self.line(node))
    }

    /// The joints, in the order of the file.
    pub fn joints(&self) -> impl Iterator<Item = Node<'_, 'a>> {
        children(self.xml.root_element(), "joint")
    }

    /// The joint of this name.
    pub fn joint(&self, name: &str) -> Option<Node<'_, 'a>> {
        self.joints().find(|joint| joint.attribute("name") == Some(name))
    }

    /// Whether an element has its required attributes: before version 1.2 a limit requires a velocity.
    pub fn is_complete(&self, node: Node) -> bool {
        node.tag_name().name() != "limit" || node.has_attribute("velocity") || self.version >= INFINITE_BY_DEFAULT
    }

    /// The elements that nothing is read of; what is inside them counts as one with them.
    pub fn unread(&self) -> Vec<Node<'_, 'a>> {
        let (mut unread, mut open) = (Vec::new(), vec![self.xml.root_element()]);
        while let Some(owner) = open.pop() {
            let read = read_in(owner);
            for node in owner.children().filter(Node::is_element) {
                let is_read = read.contains(&node.tag_name().name()) && self.is_complete(node);
                if is_read { open.push(node) } else { unread.push(node) }
            }
        }
        unread
    }

    /// What is left out, in words: `<visual> in a <link>, 12 of them, the first on line 7`, or `in_words` of its
    /// own. What `is_kept` as a comment is not.
    pub fn left_out(
        &self,
        is_kept: impl Fn(&Document, Node) -> bool,
        in_words: impl Fn(Node) -> Option<String>,
    ) -> Vec<String> {
        let mut found = BTreeMap::<String, (usize, u32)>::new();
        for node in self.unread().into_iter().filter(|node| !is_kept(self, *node)) {
            let line = self.line(node);
            let (count, first) = found.entry(in_words(node).unwrap_or_else(|| described(node))).or_insert((0, line));
            (*count, *first) = (*count + 1, line.min(*first));
        }
        let text = |(what, (count, line))| match count {
            1 => format!("{what}, on line {line}"),
            _ => format!("{what}, {count} of them, the first on line {line}"),
        };
        found.into_iter().map(text).collect()
    }
}

/// The last version that is not later than the one that is stated.
fn version(stated: Option<&str>) -> Version {
    let numbers = |text: &str| {
        let mut numbers = text.trim().split('.').map(|number| number.parse().ok());
        Some((numbers.next()??, numbers.next()??))
    };
    let stated = stated.and_then(numbers).unwrap_or(FIRST);
    VERSIONS.into_iter().rfind(|version| *version <= stated).unwrap_or(FIRST)
}

fn described(node: Node) -> String {
    let (tag, owner) = (node.tag_name().name(), node.parent().map_or("", |owner| owner.tag_name().name()));
    match (owner, tag) {
        ("robot", _) => format!("<{tag}>"),
        _ => format!("<{tag}> in a <{owner}>"),
    }
}

/// What is read inside of an element.
pub fn read_in(owner: Node) -> &'static [&'static str] {
    READ.iter().find(|(tag, _)| *tag == owner.tag_name().name()).map_or(&[], |(_, read)| read)
}

/// What is read of an element by its attributes.
pub fn attributes_of(tag: &str) -> &'static [&'static str] {
    ATTRIBUTES.iter().find(|(other, _)| *other == tag).map_or(&[], |(_, attributes)| attributes)
}

/// What to do with a file of macros.
pub const EXPAND: &str = "expand it first: xacro robot.urdf.xacro > robot.urdf";

fn is_xacro(node: &Node) -> bool {
    node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"))
}

/// The elements of a name in an element.
pub fn children<'n, 'a>(node: Node<'n, 'a>, tag: &str) -> impl Iterator<Item = Node<'n, 'a>> {
    node.children().filter(move |child| child.tag_name().name() == tag)
}

/// The first element of a name inside another.
pub fn child<'n, 'a>(node: Node<'n, 'a>, tag: &str) -> Option<Node<'n, 'a>> {
    children(node, tag).next()
}

/// The `N` finite numbers of a text; `None` if it has anything else.
pub fn finite_numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
    text.split_whitespace().map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
}

fn broken(file: &str, error: &roxmltree::Error) -> Failure {
    // The parser's message ends with the position that stands in front here.
    let (message, place) = (error.to_string(), error.pos());
    let message = message.strip_suffix(&format!(" at {place}")).unwrap_or(&message);
    let help = if file.ends_with(".toml") {
        "a URDF is an XML file, and this is TOML: models in TOML are not imported"
    } else if message.contains("'xacro'") {
        EXPAND
    } else {
        "a URDF is an XML file: correct it first"
    };
    fault_in(file, (place.row, Some(place.col)), format!("XML: {message}")).help(help)
}

fn fault_in(file: &str, (line, column): (u32, Option<u32>), message: impl std::fmt::Display) -> Failure {
    Failure::faults_of(file, vec![Fault { line, column, title: message.to_string(), help: String::new() }], &[])
}
