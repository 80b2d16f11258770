//! The tree of moving bodies: the model as the recursions want it.
//!
//! Links joined rigidly become one body, parents stand before their children, and each body's frame is turned so that
//! its joint axis is z. All of this happens in numbers, before any recursion runs, so it costs the recursions nothing.

use crate::denoc;
use crate::inertia::Sym3;
use crate::model::{CutKind, CutSide, JointKind, Link, Model};
use crate::pseudo::PseudoInertia;
use crate::rotation;
use crate::spatial::{Mat3, Pose, Vec3};

/// Moving bodies, parents first, and where the model's links stand on them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: Vec3<f64>,
    /// Everything that does not move, about the base frame.
    pub ground: PseudoInertia<f64>,
    /// The moving bodies; each parent has a smaller index.
    pub bodies: Vec<Body>,
    /// Where each of [`Model::links`] stands, in the model's order.
    pub links: Vec<Attachment>,
    /// The cut joints, in the model's order.
    pub cuts: Vec<Cut>,
}

/// A moving body with one joint about or along its z axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The parent's index in [`Tree::bodies`]; `None` is the ground.
    pub parent: Option<usize>,
    /// The body's frame in its parent's where `q + offset` is zero.
    pub placement: Pose<f64>,
    /// What the joint does.
    pub joint: Joint,
    /// What is added to the joint variable, rad.
    pub offset: f64,
    /// Whether the body's quantities are computed in axes that do not turn with its joint: those of the parent, by the
    /// fixed rotation. What is fixed to the body then turns against them, and a child with a parallel axis turns by the
    /// sum of angles.
    pub still: bool,
    /// Index of the joint's variable, velocity and force in the model's order.
    pub coordinate: usize,
    /// Moments of its mass about the origin of its frame.
    pub inertia: PseudoInertia<f64>,
}

impl Body {
    /// Whether the joint's axis is parallel to the z axis of the parent's frame.
    pub fn is_parallel(&self) -> bool {
        // The cosine of a tilt of 1e-8 is 1 already.
        let [x, y, _] = self.placement.rotation.column(2).0;
        x == 0.0 && y == 0.0
    }
}

/// What a joint of the tree does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// Turns the body about its z axis.
    Revolute,
    /// Moves the body along its z axis.
    Prismatic,
}

/// Where a link stands on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// The body in [`Tree::bodies`]; `None` is the ground.
    pub body: Option<usize>,
    /// The link's frame in the body's.
    pub pose: Pose<f64>,
    /// Centre of mass in the link's frame, m.
    pub com: Vec3<f64>,
}

/// A cut joint between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// What the cut joint holds together.
    pub joint: CutKind,
    /// Side a.
    pub a: CutEnd,
    /// Side b.
    pub b: CutEnd,
    /// Which of its rows are kept: three for the point, then those of [`CutKind::alignments`]. The others vanish at
    /// every position.
    pub rows: Vec<bool>,
}

/// One side of a cut joint.
#[derive(Clone, Debug, PartialEq)]
pub struct CutEnd {
    /// The body in [`Tree::bodies`]; `None` is the ground.
    pub body: Option<usize>,
    /// The point, in the body's frame, m.
    pub point: Vec3<f64>,
    /// What is to be aligned with the other side, as columns in the body's frame: the cut's axis is z for a revolute
    /// cut; the axes are the link's for a weld.
    pub axes: Mat3<f64>,
}

impl Tree {
    /// The tree of a checked model.
    pub fn new(model: &Model) -> Tree {
        let mut tree = Tree {
            gravity: model.gravity,
            ground: PseudoInertia::zero(),
            bodies: Vec::new(),
            links: model
                .links
                .iter()
                .map(|link| Attachment { body: None, pose: Pose::identity(), com: link.com })
                .collect(),
            cuts: Vec::new(),
        };
        let coordinates = coordinates(model);
        for index in parents_first(model) {
            let link = &model.links[index];
            let (parent, reference) = match link.parent {
                Some(parent) => (tree.links[parent].body, tree.links[parent].pose),
                None => (None, Pose::identity()),
            };
            let placement = reference * link.placement;
            let (body, pose) = match link.joint {
                JointKind::Fixed => (parent, placement),
                JointKind::Revolute => tree.add_body(parent, placement, link, Joint::Revolute, coordinates[index]),
                JointKind::Prismatic => tree.add_body(parent, placement, link, Joint::Prismatic, coordinates[index]),
            };
            let pose = pose.without_roundoff();
            tree.links[index].body = body;
            tree.links[index].pose = pose;
            let inertia = link_inertia(link).transformed(pose).without_roundoff();
            let carrier = match body {
                Some(body) => &mut tree.bodies[body].inertia,
                None => &mut tree.ground,
            };
            *carrier = *carrier + inertia;
        }
        tree.cut(model);
        tree
    }

    /// Adds the cut joints, with the rows that do not vanish at every position.
    fn cut(&mut self, model: &Model) {
        for each in &model.loops {
            let rows = vec![true; 3 + each.joint.alignments().len()];
            let (a, b) = (self.cut_end(each.joint, &each.a), self.cut_end(each.joint, &each.b));
            self.cuts.push(Cut { joint: each.joint, a, b, rows });
        }
        let mut kept = denoc::rows_that_vary(self).into_iter();
        for row in self.cuts.iter_mut().flat_map(|cut| &mut cut.rows) {
            *row = kept.next().unwrap_or(true);
        }
    }

    fn cut_end(&self, joint: CutKind, side: &CutSide) -> CutEnd {
        let (body, pose) =
            side.link.map_or((None, Pose::identity()), |link| (self.links[link].body, self.links[link].pose));
        let axes = match joint {
            CutKind::Weld => Mat3::identity(),
            CutKind::Revolute | CutKind::Spherical => align_z(side.axis),
        };
        let end = (pose * Pose { rotation: axes, position: side.point }).without_roundoff();
        CutEnd { body, point: end.position, axes: end.rotation }
    }

    /// Adds a body for a moving link; returns its index and the link's frame on it.
    fn add_body(
        &mut self,
        parent: Option<usize>,
        placement: Pose<f64>,
        link: &Link,
        joint: Joint,
        coordinate: usize,
    ) -> (Option<usize>, Pose<f64>) {
        let aligned = align_z(link.axis);
        let mut placement = placement * Pose { rotation: aligned, position: Vec3::zero() };
        let mut offset = 0.0;
        match joint {
            Joint::Revolute => {
                let (sin, cos) = rotation::sin_cos(link.offset);
                if sin == 0.0 || cos == 0.0 {
                    placement.rotation = placement.rotation * rotation::about_z(link.offset);
                } else {
                    offset = link.offset;
                }
            }
            Joint::Prismatic => {
                placement.position = placement.position + placement.rotation.column(2).scale(link.offset);
            }
        }
        self.bodies.push(Body {
            parent,
            placement: placement.without_roundoff(),
            joint,
            offset,
            still: false,
            coordinate,
            inertia: PseudoInertia::zero(),
        });
        let pose = Pose { rotation: aligned.transpose(), position: Vec3::zero() };
        (Some(self.bodies.len() - 1), pose)
    }

    /// Number of joint velocities.
    pub fn dof(&self) -> usize {
        self.bodies.len()
    }

    /// For each row of the loops, the index of its cut; NC of them.
    pub fn loops_of_rows(&self) -> impl Iterator<Item = usize> {
        self.cuts.iter().enumerate().flat_map(|(index, cut)| cut.rows.iter().filter(|kept| **kept).map(move |_| index))
    }

    /// The bodies from the ground outwards: parents before their children.
    pub fn outward(&self) -> std::ops::Range<usize> {
        0..self.bodies.len()
    }

    /// The bodies from the tips inwards: children before their parents.
    pub fn inward(&self) -> std::iter::Rev<std::ops::Range<usize>> {
        self.outward().rev()
    }

    /// The bodies whose parent is `body`.
    pub fn children(&self, body: usize) -> impl Iterator<Item = usize> {
        let later = self.bodies.iter().enumerate().skip(body + 1);
        later.filter(move |(_, child)| child.parent == Some(body)).map(|(index, _)| index)
    }

    /// The largest number of joints between the ground and a body.
    pub fn depth(&self) -> usize {
        let mut depths = vec![0; self.bodies.len()];
        for (index, body) in self.bodies.iter().enumerate() {
            depths[index] = body.parent.map_or(0, |parent| depths[parent]) + 1;
        }
        depths.into_iter().max().unwrap_or(0)
    }

    /// Coordinates spread over ±3 by a fixed rule, the same for every `position`: what holds at a few of them holds,
    /// but for freak coincidences, at all.
    pub fn sample(&self, position: usize) -> Vec<f64> {
        let golden = 0.618_033_988_749_895;
        (0..self.dof()).map(|joint| (golden * (position * self.dof() + joint + 1) as f64).fract() * 6.0 - 3.0).collect()
    }

    /// The index of the body whose joint has coordinate `coordinate`, for every coordinate in order.
    pub fn bodies_by_coordinate(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.bodies.len()).collect();
        order.sort_by_key(|&body| self.bodies[body].coordinate);
        order
    }
}

/// A rotation that takes z to the unit vector `axis`: a signed permutation where the axis is one of the frame's.
pub(crate) fn align_z(axis: Vec3<f64>) -> Mat3<f64> {
    let least = (0..3).fold(0, |least, i| if axis[i].abs() < axis[least].abs() { i } else { least });
    let mut y = axis.cross(Mat3::identity().column(least));
    y = y.scale(1.0 / y.dot(y).sqrt());
    let x = y.cross(axis);
    Mat3::from_fn(|i, j| [x, y, axis][j][i])
}

/// For each link, the index of its joint variable (for fixed links, of the next one).
fn coordinates(model: &Model) -> Vec<usize> {
    model
        .links
        .iter()
        .scan(0, |next, link| {
            let coordinate = *next;
            *next += link.joint.dof();
            Some(coordinate)
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

fn link_inertia(link: &Link) -> PseudoInertia<f64> {
    let i = link.inertia;
    let central = Sym3 { xx: i.xx, yy: i.yy, zz: i.zz, xy: i.xy, yz: i.yz, xz: i.xz };
    PseudoInertia::from_central(link.mass, link.com, central)
}

/// Sets to zero what is smaller than the roundoff of the largest element, so that the noise of a fixed rotation never
/// becomes a term of a recursion.
fn without_noise(values: &mut [&mut f64]) {
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    for value in values {
        if value.abs() < 4.0 * f64::EPSILON * largest {
            **value = 0.0;
        }
    }
}

impl Pose<f64> {
    /// -0.0 is nobody's coordinate: it comes from products with zero, and would be printed.
    pub(crate) fn without_negative_zeros(self) -> Self {
        Pose {
            rotation: Mat3::from_fn(|i, j| self.rotation.0[i][j] + 0.0),
            position: Vec3::from_fn(|i| self.position[i] + 0.0),
        }
    }

    pub(crate) fn without_roundoff(mut self) -> Self {
        let Mat3(rows) = &mut self.rotation;
        for element in rows.iter_mut().flatten() {
            let nearest = element.round();
            if (*element - nearest).abs() < 4.0 * f64::EPSILON {
                *element = nearest;
            }
        }
        let [x, y, z] = &mut self.position.0;
        without_noise(&mut [x, y, z]);
        self
    }
}

impl PseudoInertia<f64> {
    pub(crate) fn without_roundoff(mut self) -> Self {
        let [x, y, z] = &mut self.moment.0;
        without_noise(&mut [x, y, z]);
        let Sym3 { xx, yy, zz, xy, yz, xz } = &mut self.second;
        without_noise(&mut [xx, yy, zz, xy, yz, xz]);
        self
    }
}
