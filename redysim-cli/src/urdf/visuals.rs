//! The meshes with which a URDF draws its links.

use redysim_model::spatial::Pose;
use roxmltree::Node;

use super::document::{Document, WITH_QUATERNIONS, child, children, finite_numbers};
use super::origin::{Origin, rotation};

/// A mesh of a link.
pub struct Visual {
    /// The link's number among the imported model's; `None` is the root, which is the ground.
    pub link: Option<usize>,
    /// The link's name in the URDF.
    pub name: String,
    /// Where the mesh is named.
    pub line: u32,
    /// The mesh in the link's frame.
    pub pose: Pose<f64>,
    /// Factors along the mesh's axes.
    pub scale: [f64; 3],
    /// The file, as the URDF names it.
    pub file: String,
    /// Red, green, blue and opacity from 0 to 1.
    pub colour: Option<[f64; 4]>,
}

impl Document<'_> {
    /// The meshes of all links. Attributes that are not numbers count as missing: what is drawn moves nothing.
    pub fn visuals(&self) -> Vec<Visual> {
        let robot = self.robot();
        let carried: Vec<Option<&str>> =
            children(robot, "joint").map(|joint| child(joint, "child")?.attribute("link")).collect();
        let of_link = |link: Node| -> Vec<Visual> {
            let name = link.attribute("name").unwrap_or_default();
            let number = carried.iter().position(|carried| *carried == Some(name));
            let visual = |visual: Node| {
                let mesh = child(child(visual, "geometry")?, "mesh")?;
                let origin = child(visual, "origin");
                let of_origin = |key| origin.and_then(|origin| numbers(origin, key)).unwrap_or([0.0; 3]);
                let quaternion = origin.and_then(|origin| numbers(origin, "quat_xyzw"));
                let turned = quaternion.filter(|_| self.version() >= WITH_QUATERNIONS).and_then(rotation);
                let unturned = Origin { xyz: of_origin("xyz"), rpy: of_origin("rpy") }.pose();
                Some(Visual {
                    link: number,
                    name: name.to_owned(),
                    line: self.line(mesh),
                    pose: Pose { rotation: turned.unwrap_or(unturned.rotation), ..unturned },
                    scale: numbers(mesh, "scale").unwrap_or([1.0; 3]),
                    file: mesh.attribute("filename")?.to_owned(),
                    colour: child(visual, "material").and_then(|material| colour(robot, material)),
                })
            };
            children(link, "visual").filter_map(visual).collect()
        };
        children(robot, "link").flat_map(of_link).collect()
    }
}

/// The colour of a material, or of the robot's material of the same name.
fn colour(robot: Node, material: Node) -> Option<[f64; 4]> {
    let own = |material: Node| numbers(child(material, "color")?, "rgba");
    let named = || children(robot, "material").find(|other| other.attribute("name") == material.attribute("name"));
    own(material).or_else(|| own(named()?))
}

fn numbers<const N: usize>(node: Node, attribute: &str) -> Option<[f64; N]> {
    finite_numbers(node.attribute(attribute)?)
}
