//! From a checked model to its tree of moving bodies.

use crate::denoc;
use crate::joint::{BodyPhysics, Element, JointPosition, LinkJoint};
use crate::model::{self, CutSide, Frame, Link, LinkPoint, Model, Spring};
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::rotation;
use crate::run_time::{LinkNumbers, Numbers, RunTimeParameter};
use crate::spatial::{Mat3, Pose, Vec3};
use crate::spring::{BodyPoint, BodySpring};
use crate::tree::{Attachment, Body, BodyFrame, Cut, CutEnd, Mimic, Tree};
use std::ops::Range;

impl Tree {
    /// The tree of a checked model.
    pub fn new(model: &Model) -> Tree {
        Tree::with_parameters(model, &[], &[])
    }
}

impl<P: Parameter> Tree<P> {
    /// The tree of a checked model in which `values` stand in place of the numbers of the `parameters`, in the order
    /// of their [names](RunTimeParameter::names).
    pub fn with_parameters(model: &Model, parameters: &[RunTimeParameter], values: &[P]) -> Tree<P> {
        let numbers = Numbers::of(model).with(parameters, values);
        let mut tree = Tree {
            gravity: numbers.gravity,
            ground: PseudoInertia::zero(),
            bodies: Vec::new(),
            links: numbers
                .links
                .iter()
                .map(|link| Attachment { body: None, pose: Pose::identity(), com: link.com })
                .collect(),
            cuts: Vec::new(),
            frames: Vec::new(),
            springs: Vec::new(),
            mimics: Vec::new(),
        };
        let first = first_of_joints(model);
        tree.mimics = mimics(model, &first);
        for index in parents_first(model) {
            let (link, own) = (&model.links[index], &numbers.links[index]);
            let (parent, reference) = tree.on_body(link.parent);
            let placement = reference * link.placement;
            let (body, moved) = match LinkJoint::of(link) {
                None => (parent, placement),
                Some(joint) => {
                    let moving = BodyLink { index, link, physics: &own.physics };
                    tree.add_bodies(parent, placement, moving, joint, first[index])
                }
            };
            let pose = (moved * link.frame).without_roundoff();
            tree.links[index].body = body;
            tree.links[index].pose = pose;
            let inertia = link_inertia(own).transformed(Pose::constant(pose)).without_roundoff();
            let carrier = match body {
                Some(body) => &mut tree.bodies[body].inertia,
                None => &mut tree.ground,
            };
            *carrier = *carrier + inertia;
        }
        tree.cut(model);
        tree.frames = model.frames.iter().map(|frame| tree.body_frame(frame)).collect();
        tree.springs = model.springs.iter().map(|spring| tree.body_spring(spring)).filter(BodySpring::acts).collect();
        tree
    }

    /// Adds the cut joints, with the rows that do not vanish at every position.
    fn cut(&mut self, model: &Model) {
        for each in &model.loops {
            let rows = vec![true; each.joint.rows().len()];
            let [of_a, of_b] = each.axes();
            let (a, b) = (self.cut_end(&each.a, of_a), self.cut_end(&each.b, of_b));
            self.cuts.push(Cut { joint: each.joint, a, b, rows });
        }
        let mut kept = denoc::rows_that_vary(&self.map(|value| value.number().unwrap_or_default())).into_iter();
        for row in self.cuts.iter_mut().flat_map(|cut| &mut cut.rows) {
            *row = kept.next().unwrap_or(true);
        }
    }

    /// The body of a link (`None` is the ground), and the link's frame in the body's.
    fn on_body(&self, link: Option<usize>) -> (Option<usize>, Pose<f64>) {
        link.map_or((None, Pose::identity()), |link| (self.links[link].body, self.links[link].pose))
    }

    fn body_frame(&self, frame: &Frame) -> BodyFrame {
        let (body, pose) = self.on_body(frame.link);
        BodyFrame { body, pose: (pose * frame.placement).without_roundoff() }
    }

    fn body_spring(&self, spring: &Spring) -> BodySpring<P> {
        let &Spring { a, b, stiffness, damping, length, .. } = spring;
        let [stiffness, damping, length] = [stiffness, damping, length].map(P::from_f64);
        BodySpring { a: self.body_point(a), b: self.body_point(b), stiffness, damping, length }
    }

    fn body_point(&self, LinkPoint { link, point }: LinkPoint) -> BodyPoint {
        let (body, pose) = self.on_body(link);
        let end = (pose * Pose { rotation: Mat3::identity(), position: point }).without_roundoff();
        BodyPoint { body, point: end.position }
    }

    fn cut_end(&self, side: &CutSide, axes: Mat3<f64>) -> CutEnd {
        let (body, pose) = self.on_body(side.link);
        let end = (pose * Pose { rotation: axes, position: side.point }).without_roundoff();
        CutEnd { body, point: end.position, axes: end.rotation }
    }

    /// Adds the bodies of a moving link, one for each joint of the tree that its joint is; returns the index of the last
    /// and the frame that the joint moves, on it.
    fn add_bodies(
        &mut self,
        parent: Option<usize>,
        placement: Pose<f64>,
        link: BodyLink<'_, P>,
        joint: LinkJoint,
        first: [usize; 2],
    ) -> (Option<usize>, Pose<f64>) {
        let (elements, actuated) = (joint.elements(link.link.axis), link.link.actuated_velocities());
        // Of several in series, each has one coordinate and one velocity.
        let mut own = [0; 2];
        elements.iter().fold((parent, placement), |moved, &element| {
            let [q, v] = own;
            own = [q + element.joint.nq(), v + element.joint.nv()];
            let ranges = [q..own[0], v..own[1]];
            self.add_body(moved, link, element, first, ranges, &actuated)
        })
    }

    /// Adds a body whose joint stands at a place on its parent and has its z axis in the axes of `element`; returns the
    /// body's index and the frame that the joint moves, on it. The joint has the coordinates `q` and the velocities `v` of
    /// those of its link, of which `first` are the first.
    fn add_body(
        &mut self,
        (parent, placement): (Option<usize>, Pose<f64>),
        BodyLink { index, link, physics }: BodyLink<'_, P>,
        Element { joint, axes }: Element,
        first: [usize; 2],
        [q, v]: [Range<usize>; 2],
        actuated: &[bool],
    ) -> (Option<usize>, Pose<f64>) {
        let mut placement = placement * Pose { rotation: axes, position: Vec3::zero() };
        let mut offset = 0.0;
        if joint.is_on_axis()
            && let JointPosition::OnAxis { angle, displacement } = joint.position(&[link.offset])
        {
            if let Some(angle) = angle {
                let (sin, cos) = rotation::sin_cos(angle);
                if sin == 0.0 || cos == 0.0 {
                    placement.rotation = placement.rotation * rotation::about_z(angle);
                } else {
                    offset = angle;
                }
            }
            if let Some(slide) = displacement {
                placement.position = placement.position + placement.rotation.column(2).scale(slide);
            }
        }
        self.bodies.push(Body {
            parent,
            placement: placement.without_roundoff(),
            joint,
            link: index,
            offset,
            merged_parallel: false,
            physics: Some(physics.part(q.clone(), v.clone())).filter(BodyPhysics::acts),
            actuated: actuated[v.clone()].to_vec(),
            q: first[0] + q.start..first[0] + q.end,
            v: first[1] + v.start..first[1] + v.end,
            inertia: PseudoInertia::zero(),
        });
        let pose = Pose { rotation: axes.transpose(), position: Vec3::zero() };
        (Some(self.bodies.len() - 1), pose)
    }
}

/// A moving link, its index in the model, and what acts in its joint.
#[derive(Clone, Copy)]
struct BodyLink<'m, P> {
    index: usize,
    link: &'m Link,
    physics: &'m BodyPhysics<P>,
}

/// For each link, the first of its joint's coordinates and of its velocities (for fixed links, of the next joint's). Those
/// of joints that mimic others come last.
fn first_of_joints(model: &Model) -> Vec<[usize; 2]> {
    let mut first = vec![[0; 2]; model.links.len()];
    let mut next = [0; 2];
    for mimics in [false, true] {
        for (first, link) in first.iter_mut().zip(&model.links).filter(|(_, link)| link.mimic.is_some() == mimics) {
            *first = next;
            if let Some(joint) = LinkJoint::of(link) {
                next = [next[0] + joint.nq(), next[1] + joint.nv()];
            }
        }
    }
    first
}

/// The joints that mimic others, in the model's order. One that mimics another such joint follows that joint's own.
fn mimics(model: &Model, first: &[[usize; 2]]) -> Vec<Mimic> {
    let mimics = (0..model.links.len()).filter(|&link| model.links[link].mimic.is_some());
    let followed = mimics.map(|link| model.followed(link));
    followed
        .map(|model::Mimic { link, multiplier, offset }| Mimic {
            q: first[link][0],
            v: first[link][1],
            multiplier,
            offset,
        })
        .collect()
}

/// The links' indices with parents before children, else in the model's order.
fn parents_first(model: &Model) -> Vec<usize> {
    let mut order = Vec::with_capacity(model.links.len());
    let mut placed = vec![false; model.links.len()];
    while order.len() < model.links.len() {
        let before = order.len();
        for (index, link) in model.links.iter().enumerate() {
            if !placed[index] && link.parent.is_none_or(|parent| placed[parent]) {
                placed[index] = true;
                order.push(index);
            }
        }
        assert!(order.len() > before, "a checked model has no cycle of parents");
    }
    order
}

fn link_inertia<P: Parameter>(link: &LinkNumbers<P>) -> PseudoInertia<P> {
    PseudoInertia::from_central(link.mass, link.com, link.inertia)
}
