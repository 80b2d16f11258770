//! Names in a URDF that are nearly those of what is read, but not read themselves.

use redysim_toml::words::nearest;
use roxmltree::Node;

use super::document::{Document, attributes_of, read_in};

impl Document<'_> {
    /// Each attribute and element that is not read for its name, which is nearly one that is, with its line.
    pub fn misspelled(&self) -> Vec<String> {
        let (mut found, mut open) = (Vec::new(), vec![self.robot()]);
        while let Some(owner) = open.pop() {
            let read = read_in(owner);
            for node in owner.children().filter(Node::is_element) {
                let tag = node.tag_name().name();
                if read.contains(&tag) {
                    found.extend(self.misspelled_attributes(node));
                    open.push(node);
                } else if let Some(meant) = nearest(tag, read.iter().copied()) {
                    found.push((self.line(node), format!("<{tag}> is unknown: did you mean <{meant}>?")));
                }
            }
        }
        found.sort();
        found.into_iter().map(|(line, what)| format!("{}:{line}: {what}", self.file())).collect()
    }

    fn misspelled_attributes(&self, node: Node) -> Vec<(u32, String)> {
        let tag = node.tag_name().name();
        let known = attributes_of(tag);
        let unread = node.attributes().map(|attribute| attribute.name().to_owned());
        let meant = unread.filter(|name| !known.contains(&name.as_str())).filter_map(|name| {
            let meant = nearest(&name, known.iter().copied())?;
            Some((self.line(node), format!("<{tag}> has the unknown attribute `{name}`: did you mean `{meant}`?")))
        });
        meant.collect()
    }
}
