//! Links that do not move against their parents: those without mass further out, and fixed ones as parts of their
//! parents.

use std::collections::HashSet;

use redysim_model::JointKind;
use redysim_model::spatial::Pose;

use super::inertial::Inertial;
use super::model_file::origin;
use super::notation::inertial;
use super::origin::Origin;
use super::robot::{Link, Robot};

impl Robot {
    /// Joints that move no mass are fixed: they would make the mass matrix singular. Joints that mimic one another move what
    /// each of them does.
    pub fn without_massless_motion(mut self) -> Self {
        let mut carries = vec![false; self.links.len()];
        for (index, _) in self.links.iter().enumerate().filter(|(_, link)| !link.inertial.is_none()) {
            let chain = std::iter::successors(Some(index), |&link| self.links[link].parent);
            chain.for_each(|link| carries[link] = true);
        }
        let moved: Vec<usize> = (0..self.links.len()).map(|link| self.followed(link)).collect();
        let move_mass: HashSet<usize> =
            moved.iter().zip(carries).filter(|(_, carries)| *carries).map(|(moved, _)| *moved).collect();
        let links = self.links.iter_mut().zip(moved);
        let idle = links.filter(|(link, moved)| !move_mass.contains(moved) && link.kind != JointKind::Fixed);
        for (link, _) in idle {
            let Link { name, joint_name, .. } = &link;
            let remark = format!(
                "joint `{joint_name}` moves no mass, for neither `{name}` nor a link further out has any: it is fixed \
                 at zero here"
            );
            (link.kind, link.limit, link.resistance) = (JointKind::Fixed, None, [0.0; 2]);
            if let Some(far_end) = link.far_end.take() {
                link.origin = Origin::of(link.origin.pose() * far_end.pose());
            }
            link.remarks.push(remark);
        }
        self
    }

    /// Fixed links are parts of the links that carry them.
    pub fn fused(self) -> Self {
        let Robot { name, links, mut notes } = self;
        let order = parents_first(&links);
        // The moving link of which each link is a part (none: the ground), and where it stands on it.
        let mut carriers: Vec<(Option<usize>, Pose<f64>)> = vec![(None, Pose::identity()); links.len()];
        let mut fused = links.clone();
        for &index in &order {
            let link = &links[index];
            let (carrier, pose) = link.parent.map_or((None, Pose::identity()), |parent| carriers[parent]);
            let placed = pose * link.origin.pose();
            if link.kind != JointKind::Fixed {
                // The file's own digits stay where nothing stands in between.
                let direct = carrier == link.parent && pose == Pose::identity();
                fused[index].origin = if direct { link.origin } else { Origin::of(placed) };
                fused[index].parent = carrier;
                carriers[index] = (Some(index), Pose::identity());
                continue;
            }
            carriers[index] = (carrier, placed);
            let part = link.inertial.seen_from(placed);
            let whole = carrier.map_or("the ground".into(), |carrier| format!("`{}`", links[carrier].name));
            match carrier {
                Some(carrier) if !part.is_none() => {
                    fused[carrier].inertial = fused[carrier].inertial.and(part);
                }
                None if part.mass != 0.0 => {
                    notes.push(format!(
                        "link `{}` is fixed to the ground: its {} kg never move: {}",
                        link.name,
                        part.mass,
                        inertial(part)
                    ));
                }
                _ => {}
            }
            let at = origin(Origin::of(placed));
            let fuse = format!("link `{}` is a part of {whole}: origin = {at}", link.name);
            let remarks = link.remarks.iter().cloned().chain([fuse]);
            let comments = link.comments.iter().map(|comment| format!("joint `{}`: {comment}", link.joint_name));
            match carrier {
                Some(carrier) => {
                    fused[carrier].remarks.extend(remarks);
                    fused[carrier].comments.extend(comments);
                }
                None => notes.extend(remarks.chain(comments)),
            }
        }
        let mut places = vec![None; links.len()];
        let moving: Vec<usize> = (0..links.len()).filter(|&index| links[index].kind != JointKind::Fixed).collect();
        moving.iter().enumerate().for_each(|(place, &index)| places[index] = Some(place));
        let renumbered = moving.into_iter().map(|index| {
            let link = fused[index].clone();
            Link { parent: link.parent.and_then(|parent| places[parent]), ..link }
        });
        Robot { name, links: renumbered.collect(), notes }
    }

    /// The mass that the links have together, kg.
    pub fn mass(&self) -> f64 {
        self.links.iter().map(|link| link.inertial).map(|Inertial { mass, .. }| mass).sum()
    }
}

/// The links' indices with parents before children: the reader has made sure that they are a tree.
fn parents_first(links: &[Link]) -> Vec<usize> {
    let depth = |index: usize| std::iter::successors(links[index].parent, |&parent| links[parent].parent).count();
    let mut order: Vec<usize> = (0..links.len()).collect();
    order.sort_by_key(|&index| depth(index));
    order
}
