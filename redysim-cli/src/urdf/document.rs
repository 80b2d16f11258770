//! The URDF as XML: on which line things stand, and what of it a model has no place for.

use std::collections::BTreeMap;

use roxmltree::{Document as Xml, Node};

use crate::failure::{Failure, Fault};

/// A URDF file whose form is right: well-formed, with the elements and numbers that a robot needs.
pub struct Document<'a> {
    file: &'a str,
    text: &'a str,
    xml: Xml<'a>,
}

/// What is read inside of each element, and of others nothing. Limits are read where they have a velocity.
const READ: [(&str, &[&str]); 4] = [
    ("robot", &["link", "joint"]),
    ("link", &["inertial"]),
    ("inertial", &["origin", "mass", "inertia"]),
    ("joint", &["origin", "parent", "child", "axis", "limit", "mimic", "dynamics"]),
];

/// The attributes that are read of these elements.
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

/// The joints of URDF.
const KINDS: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];

impl<'a> Document<'a> {
    /// Parses the text of the file.
    ///
    /// # Errors
    /// The first fault of form, with its line.
    pub fn parse(text: &'a str, file: &'a str) -> Result<Self, Failure> {
        let xml = Xml::parse(text).map_err(|error| broken(file, &error))?;
        let document = Document { file, text, xml };
        let robot = document.xml.root_element();
        if robot.tag_name().name() != "robot" {
            let message = format!("the file has a <{}>, not a <robot>", robot.tag_name().name());
            return Err(document.fault(robot, message).help("give a URDF; other formats are not read"));
        }
        if let Some(node) = document.xml.descendants().find(is_xacro) {
            let message = format!("<xacro:{}> is a macro that is not expanded", node.tag_name().name());
            return Err(document.fault(node, message).help(EXPAND));
        }
        children(robot, "link").try_for_each(|link| document.check_link(link))?;
        children(robot, "joint").try_for_each(|joint| document.check_joint(joint))?;
        Ok(document)
    }

    /// A fault at an element, with its line.
    fn fault(&self, node: Node, message: impl std::fmt::Display) -> Failure {
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

    /// The line on which an element begins.
    pub fn line(&self, node: Node) -> u32 {
        self.xml.text_pos_at(node.range().start).row
    }

    /// The line of the last link or joint with this name, or 1 if no element has it.
    pub fn line_of(&self, tag: &str, name: &str) -> u32 {
        let named = children(self.xml.root_element(), tag).filter(|node| node.attribute("name") == Some(name));
        named.last().map_or(1, |node| self.line(node))
    }

    fn check_link(&self, link: Node) -> Result<(), Failure> {
        let item = self.item(link)?;
        self.check_single(&item, link)?;
        let Some(inertial) = child(link, "inertial") else { return Ok(()) };
        self.check_single(&item, inertial)?;
        self.check_origin(&item, inertial)?;
        let mass = self.required(&item, inertial, "mass")?;
        self.numbers(&item, mass, "value", 1, true)?;
        let inertia = self.required(&item, inertial, "inertia")?;
        attributes_of("inertia").iter().try_for_each(|element| self.numbers(&item, inertia, element, 1, true))
    }

    fn check_joint(&self, joint: Node) -> Result<(), Failure> {
        let item = self.item(joint)?;
        self.check_single(&item, joint)?;
        match joint.attribute("type") {
            None => return Err(self.fault(joint, format!("{item}: it has no `type`"))),
            Some(kind) if !KINDS.contains(&kind) => {
                let message = format!("{item}: its `type` cannot be `{}`", kind.escape_debug());
                return Err(self.fault(joint, message).help(format!("the types are: {}", KINDS.join(", "))));
            }
            Some(_) => {}
        }
        for end in ["parent", "child"] {
            let node = self.required(&item, joint, end)?;
            if node.attribute("link").is_none() {
                return Err(self.fault(node, format!("{item}: its <{end}> has no `link`")));
            }
        }
        self.check_origin(&item, joint)?;
        child(joint, "axis").map_or(Ok(()), |axis| self.check_axis(&item, joint, axis))?;
        child(joint, "limit").map_or(Ok(()), |limit| self.check_limit(&item, limit))?;
        child(joint, "dynamics").map_or(Ok(()), |dynamics| self.check_dynamics(&item, dynamics))?;
        child(joint, "mimic").map_or(Ok(()), |mimic| self.check_mimic(&item, mimic))
    }

    fn check_axis(&self, item: &str, joint: Node, axis: Node) -> Result<(), Failure> {
        self.numbers(item, axis, "xyz", 3, true)?;
        let is_zero = |text: &str| text.split_whitespace().all(|word| word.parse::<f64>().is_ok_and(|x| x == 0.0));
        let what = match joint.attribute("type") {
            Some("revolute" | "continuous" | "prismatic") => "its `axis`",
            Some("planar") => "its `axis`, the normal of the plane in which it moves,",
            _ => return Ok(()),
        };
        if axis.attribute("xyz").is_some_and(is_zero) {
            let message = format!("{item}: {what} is zero");
            return Err(self.fault(axis, message).help("give a direction, as in xyz=\"0 0 1\""));
        }
        Ok(())
    }

    /// Limits may be infinite.
    fn check_limit(&self, item: &str, limit: Node) -> Result<(), Failure> {
        let number = |text: &str| text.trim().parse::<f64>().is_ok_and(|value| !value.is_nan());
        let read = |name: &str| attributes_of("limit").contains(&name);
        match limit.attributes().find(|limit| read(limit.name()) && !number(limit.value())) {
            None => Ok(()),
            Some(wrong) => Err(self.wrong(item, limit, wrong.name(), "a number", wrong.value())),
        }
    }

    fn check_dynamics(&self, item: &str, dynamics: Node) -> Result<(), Failure> {
        attributes_of("dynamics").iter().try_for_each(|name| self.numbers(item, dynamics, name, 1, false))
    }

    fn check_mimic(&self, item: &str, mimic: Node) -> Result<(), Failure> {
        if mimic.attribute("joint").is_none() {
            return Err(self.fault(mimic, format!("{item}: its <mimic> has no `joint`")));
        }
        ["multiplier", "offset"].iter().try_for_each(|name| self.numbers(item, mimic, name, 1, false))
    }

    /// What is read inside of an element stands there once.
    fn check_single(&self, item: &str, owner: Node) -> Result<(), Failure> {
        let tag = owner.tag_name().name();
        match read_in(owner).iter().find_map(|read| children(owner, read).nth(1)) {
            None => Ok(()),
            Some(again) => {
                let message = format!("{item}: its <{tag}> has a second <{}>", again.tag_name().name());
                Err(self.fault(again, message).help("keep one of them"))
            }
        }
    }

    /// "link `arm`".
    fn item(&self, node: Node) -> Result<String, Failure> {
        let tag = node.tag_name().name();
        match node.attribute("name") {
            Some(name) => Ok(format!("{tag} `{}`", name.escape_debug())),
            None => Err(self.fault(node, format!("a <{tag}> has no `name`"))),
        }
    }

    fn check_origin(&self, item: &str, owner: Node) -> Result<(), Failure> {
        let Some(origin) = child(owner, "origin") else { return Ok(()) };
        self.numbers(item, origin, "xyz", 3, false)?;
        self.numbers(item, origin, "rpy", 3, false)
    }

    fn required<'n>(&self, item: &str, owner: Node<'n, 'a>, tag: &str) -> Result<Node<'n, 'a>, Failure> {
        let owner_tag = owner.tag_name().name();
        child(owner, tag).ok_or_else(|| self.fault(owner, format!("{item}: its <{owner_tag}> has no <{tag}>")))
    }

    /// An attribute that is `count` finite numbers.
    fn numbers(&self, item: &str, node: Node, attribute: &str, count: usize, needed: bool) -> Result<(), Failure> {
        let tag = node.tag_name().name();
        let Some(text) = node.attribute(attribute) else {
            let missing = || self.fault(node, format!("{item}: its <{tag}> has no `{attribute}`"));
            return if needed { Err(missing()) } else { Ok(()) };
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        let finite = |word: &&str| word.parse::<f64>().is_ok_and(f64::is_finite);
        if words.len() == count && words.iter().all(finite) {
            return Ok(());
        }
        let wanted = if count == 1 { "a finite number".into() } else { format!("{count} finite numbers") };
        let wrong = self.wrong(item, node, attribute, &wanted, text);
        Err(if text.contains("${") { wrong.help(EXPAND) } else { wrong })
    }

    fn wrong(&self, item: &str, node: Node, attribute: &str, wanted: &str, found: &str) -> Failure {
        let (tag, found) = (node.tag_name().name(), found.escape_debug());
        self.fault(node, format!("{item}: `{attribute}` of its <{tag}> must be {wanted}, found \"{found}\""))
    }

    /// The joints, in the order of the file.
    pub fn joints(&self) -> impl Iterator<Item = Node<'_, 'a>> {
        children(self.xml.root_element(), "joint")
    }

    /// The joint of this name.
    pub fn joint(&self, name: &str) -> Option<Node<'_, 'a>> {
        self.joints().find(|joint| joint.attribute("name") == Some(name))
    }

    /// The elements that nothing is read of; what is inside them counts as one with them.
    pub fn unread(&self) -> Vec<Node<'_, 'a>> {
        let (mut unread, mut open) = (Vec::new(), vec![self.xml.root_element()]);
        while let Some(owner) = open.pop() {
            let read = read_in(owner);
            for node in owner.children().filter(Node::is_element) {
                let is_read = read.contains(&node.tag_name().name()) && !is_partial_limit(node);
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

    /// The text with spaces for what is left out, so that no fault in it stands in the way.
    pub fn text_to_read(&self) -> String {
        let mut bytes = self.text.as_bytes().to_vec();
        for node in self.unread() {
            bytes[node.range()].iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
        }
        // Elements begin and end with ASCII, so that whole characters are replaced.
        String::from_utf8(bytes).unwrap_or_default()
    }
}

fn described(node: Node) -> String {
    let (tag, owner) = (node.tag_name().name(), node.parent().map_or("", |owner| owner.tag_name().name()));
    match (owner, tag) {
        ("robot", _) => format!("<{tag}>"),
        _ => format!("<{tag}> in a <{owner}>"),
    }
}

/// A limit that cannot be read, for want of what a limit must have.
fn is_partial_limit(node: Node) -> bool {
    node.tag_name().name() == "limit" && node.attribute("velocity").is_none()
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
const EXPAND: &str = "expand it first: xacro robot.urdf.xacro > robot.urdf";

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
