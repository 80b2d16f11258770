//! Which joints are shown together, such as those of a leg or an arm, and where each stands among them.

use std::collections::HashMap;

use redysim_model::{JointKind, Model};

use crate::carriers::carriers;
use crate::layout::Layout;

/// Curves that can be followed in one coordinate system: arms have up to seven joints, and there are as many colours
/// that can be told apart.
const MOST: usize = 7;

/// Where a coordinate or a velocity stands, the same for both of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The number of its group.
    pub group: usize,
    /// Its number in the group, less than [`MOST`].
    pub number: usize,
}

/// The places of coordinates and velocities.
#[derive(Debug, Default)]
pub struct Groups {
    places: HashMap<String, Place>,
    /// Of free joints, the names of the velocities without an actuator.
    floating: Vec<String>,
}

/// A joint: its coordinates and velocities with their numbers in it, and how many numbers there are.
struct Joint {
    parts: Vec<(String, usize)>,
    width: usize,
}

impl Groups {
    /// The groups of the joints of a model. A moving link continues the branch of the moving link that carries it, if
    /// that carries no other; a free joint is alone. A branch is a group, or several if it has many joints. Branches that
    /// a closed loop ties to each other share groups as far as there is room, and so do all if there are few joints.
    /// `names` that the model does not know are a branch for themselves.
    pub fn of<'a>(model: Option<&Model>, names: impl Iterator<Item = &'a str>) -> Groups {
        let mut groups = Groups::default();
        let clusters = model.map(|model| groups.clusters(model)).unwrap_or_default();
        let known: Vec<String> = clusters.iter().flatten().flatten().flat_map(Joint::names).collect();
        let mut unknown: Vec<&str> = Vec::new();
        for name in names {
            if !known.iter().any(|known| known == name) && !unknown.contains(&name) {
                unknown.push(name);
            }
        }
        let unknown = unknown.into_iter().map(|name| Joint { parts: vec![(name.to_owned(), 0)], width: 1 }).collect();
        let sections = clusters.into_iter().chain([vec![unknown]]).flat_map(sections);
        for (group, joints) in sections.enumerate() {
            let mut first = 0;
            for Joint { parts, width } in joints {
                groups
                    .places
                    .extend(parts.into_iter().map(|(name, part)| (name, Place { group, number: first + part })));
                first += width;
            }
        }
        groups
    }

    /// The place of the coordinate or velocity `name`, which the model or the names have.
    pub fn place(&self, name: &str) -> Place {
        self.places.get(name).copied().unwrap_or_default()
    }

    /// Whether `name` is a velocity without an actuator of a free joint.
    pub fn floats(&self, name: &str) -> bool {
        self.floating.iter().any(|floating| floating == name)
    }

    /// The branches of a model, those together that are tied to each other.
    fn clusters(&mut self, model: &Model) -> Vec<Vec<Vec<Joint>>> {
        let layout = Layout::of(model);
        let links: Vec<usize> = (0..model.links.len()).filter(|&link| model.links[link].dof() > 0).collect();
        let mut cluster: Vec<usize> = links.iter().map(|&link| first_of_branch(model, link)).collect();
        let branches = cluster.clone();
        let is_free = |link: usize| model.links[link].joint == JointKind::Free;
        for each in &model.loops {
            let [a, b] = [each.a.link, each.b.link].map(|link| moving_carriers(model, link));
            let tied = a.iter().filter(|link| !b.contains(link)).chain(b.iter().filter(|link| !a.contains(link)));
            tie(&mut cluster, &links, &tied.copied().filter(|&link| !is_free(link)).collect::<Vec<_>>());
        }
        let on_branches: Vec<usize> = links.iter().copied().filter(|&link| !is_free(link)).collect();
        if on_branches.iter().map(|&link| model.links[link].dof()).sum::<usize>() <= MOST {
            tie(&mut cluster, &links, &on_branches);
        }
        let mut clusters: Ordered<Ordered<Vec<Joint>>> = Vec::new();
        for (index, joint) in layout.joints.iter().enumerate() {
            let names = |components: &[crate::layout::Component]| -> Vec<(String, usize)> {
                components.iter().map(|component| component.name.clone()).zip(0..).collect()
            };
            let (q, v) = (names(&layout.coordinates[joint.q.clone()]), names(&layout.velocities[joint.v.clone()]));
            if is_free(links[index]) {
                let passive = layout.velocities[joint.v.clone()].iter().filter(|velocity| !velocity.actuated);
                self.floating.extend(passive.map(|velocity| velocity.name.clone()));
            }
            let joint = Joint { width: q.len().max(v.len()), parts: [q, v].concat() };
            let branches_of = entry(&mut clusters, cluster[index]);
            entry(branches_of, branches[index]).push(joint);
        }
        clusters.into_iter().map(|(_, branches)| branches.into_iter().map(|(_, joints)| joints).collect()).collect()
    }
}

impl Joint {
    fn names(&self) -> impl Iterator<Item = String> {
        self.parts.iter().map(|(name, _)| name.clone())
    }
}

/// Values by key, in the order of insertion.
type Ordered<T> = Vec<(usize, T)>;

/// The value of a key, which is inserted if it is missing.
fn entry<T: Default>(all: &mut Ordered<T>, key: usize) -> &mut T {
    let index = all.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
        all.push((key, T::default()));
        all.len() - 1
    });
    &mut all[index].1
}

/// Makes the clusters of these links one, of all that moves.
fn tie(cluster: &mut [usize], links: &[usize], tied: &[usize]) {
    let of_tied: Vec<usize> =
        links.iter().zip(&*cluster).filter(|(link, _)| tied.contains(link)).map(|of| *of.1).collect();
    if let Some(&first) = of_tied.first() {
        cluster.iter_mut().filter(|number| of_tied.contains(number)).for_each(|number| *number = first);
    }
}

/// A link and those that carry it, as far as they move, up to the ground.
fn moving_carriers(model: &Model, link: Option<usize>) -> Vec<usize> {
    carriers(model, link).filter(|&link| model.links[link].dof() > 0).collect()
}

/// The moving link with which the branch of a moving link begins.
fn first_of_branch(model: &Model, link: usize) -> usize {
    let carrier = |link: usize| moving_carriers(model, Some(link)).get(1).copied();
    let carried = |by: usize| {
        (0..model.links.len()).filter(|&other| model.links[other].dof() > 0 && carrier(other) == Some(by)).count()
    };
    let continues =
        |link: &usize| carrier(*link).filter(|&by| model.links[by].joint != JointKind::Free && carried(by) == 1);
    std::iter::successors(Some(link), continues).last().unwrap_or(link)
}

/// Branches that are tied to each other, in sections of at most [`MOST`] numbers: whole branches one after the other,
/// and a branch that is wider for itself, in even parts.
fn sections(branches: Vec<Vec<Joint>>) -> Vec<Vec<Joint>> {
    let width = |joints: &[Joint]| joints.iter().map(|joint| joint.width).sum::<usize>();
    let mut sections: Vec<Vec<Joint>> = Vec::new();
    for branch in branches {
        if let Some(last) = sections.last_mut().filter(|last| width(last) + width(&branch) <= MOST) {
            last.extend(branch);
            continue;
        }
        let most = width(&branch).div_ceil(width(&branch).div_ceil(MOST).max(1));
        sections.push(Vec::new());
        for joint in branch {
            let last = sections.last_mut().expect("there is one");
            if last.is_empty() || width(last) + joint.width <= most {
                last.push(joint);
            } else {
                sections.push(vec![joint]);
            }
        }
    }
    sections.retain(|section| !section.is_empty());
    sections
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The groups of a model of this repository: for each the names of its coordinates and velocities, by number.
    fn groups(model: &str) -> Vec<String> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(model);
        let model = Model::load(path).unwrap().model;
        shown(&Groups::of(Some(&model), std::iter::empty()))
    }

    fn shown(groups: &Groups) -> Vec<String> {
        let mut places: Vec<(usize, usize, &str)> =
            groups.places.iter().map(|(name, place)| (place.group, place.number, name.as_str())).collect();
        places.sort_unstable();
        assert!(places.iter().all(|(_, number, _)| *number < MOST), "{places:?}");
        let of_group =
            |places: &[(usize, usize, &str)]| places.iter().map(|place| place.2).collect::<Vec<_>>().join(" ");
        places.chunk_by(|a, b| a.0 == b.0).map(of_group).collect()
    }

    /// `link1` to `link30` without those before `from` and after `to`.
    fn links(from: usize, to: usize) -> String {
        (from..=to).map(|k| format!("link{k}")).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_leg_and_an_arm_are_groups() {
        let legs = ["rear_right", "rear_left", "front_right", "front_left"];
        let base =
            "base.vx base.x base.vy base.y base.vz base.z base.qx base.wx base.qy base.wy base.qz base.wz base.qw";
        let legs = legs.map(|leg| format!("{leg}_hip {leg}_thigh {leg}_knee"));
        let groups_of_quadruped = groups("quadruped.toml");
        assert_eq!(groups_of_quadruped[0], base);
        assert_eq!(groups_of_quadruped[1..], legs);
        let of_humanoid = [(1, 6), (7, 12), (13, 14), (15, 21), (22, 28), (29, 30)];
        assert_eq!(groups("peers/humanoid30.toml"), of_humanoid.map(|(from, to)| links(from, to)));
        assert_eq!(groups("kr5_floating.toml").len(), 2, "a free joint and an arm");
        assert_eq!(groups("kr5.toml").len(), 1);
    }

    #[test]
    fn a_long_chain_is_cut_evenly_and_what_has_few_joints_or_is_tied_by_loops_is_not_cut_in_small_pieces() {
        assert_eq!(groups("peers/chain20.toml"), [links(1, 7), links(8, 14), links(15, 20)]);
        assert_eq!(groups("fourbar.toml").len(), 1);
        assert_eq!(groups("gripper.toml").len(), 1);
        assert!(groups("n_fourbar_40.toml").len() < 25, "{:?}", groups("n_fourbar_40.toml"));
    }

    #[test]
    fn names_that_no_model_has_are_one_branch_in_their_order() {
        let names: Vec<String> = (0..8).map(|k| format!("j{k}")).collect();
        let groups = Groups::of(None, names.iter().chain(&names).map(String::as_str));
        assert_eq!(shown(&groups), ["j0 j1 j2 j3", "j4 j5 j6 j7"]);
    }
}
