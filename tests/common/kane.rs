//! The dynamics of a model by another way: Jacobians of the centres of mass in the base frame and Kane's equations.
//!
//! Nothing of the recursions is used here: no tree, no spatial vectors, no frames turned to joint axes, no fused links.
//! For each link with Jacobians J_v (of the centre of mass) and J_ω,
//!
//! M = Σ m J_vᵀ J_v + J_ωᵀ I J_ω, h = Σ m J_vᵀ (a − g) + J_ωᵀ (I α + ω × I ω),
//!
//! where a and α are the accelerations at zero joint accelerations. Source: Kane and Levinson, *Dynamics: Theory and
//! Applications*, McGraw-Hill 1985.

use nalgebra::{DMatrix, DVector, Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};
use redysim_model::joint::JointPhysics;
use redysim_model::spatial::{Mat3, Pose};
use redysim_model::{Frame, JointKind, Link, LinkPoint, Loop, Model, PerVelocity};
use std::ops::Range;

/// Everything the tests compare, at one state.
pub struct Kane {
    pub matrix: DMatrix<f64>,
    pub bias: DVector<f64>,
    pub gravity: DVector<f64>,
    /// Of damping, friction and springs, in the joints and between points: part of the bias.
    pub passive: DVector<f64>,
    /// Power of damping and friction.
    pub dissipated: f64,
    pub kinetic: f64,
    pub potential: f64,
    /// In the model's order.
    pub links: Vec<Body>,
    /// The frames of interest, in the model's order.
    pub frames: Vec<Body>,
    /// The points of the sides a and b of each loop, as frames with the axes of their links, in the model's order.
    pub loops: Vec<[Body; 2]>,
}

/// A link or a frame of interest in the base frame. The centre of mass of a frame is its origin.
#[derive(Clone)]
pub struct Body {
    pub rotation: Matrix3<f64>,
    pub origin: Vector3<f64>,
    pub com: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub angular_velocity: Vector3<f64>,
    /// Accelerations at zero joint accelerations, of the origin and of the axes.
    pub acceleration: Vector3<f64>,
    pub angular_acceleration: Vector3<f64>,
    /// What the joints between the ground and the link do, with the number of each velocity.
    joints: Vec<(usize, Screw)>,
}

/// A joint's motion for a unit of one of its velocities.
#[derive(Clone, Copy)]
struct Screw {
    axis: Vector3<f64>,
    /// A point on the axis.
    point: Vector3<f64>,
    turn: f64,
    slide: f64,
}

impl Body {
    fn ground() -> Self {
        let zero = Vector3::zeros();
        Body {
            rotation: Matrix3::identity(),
            origin: zero,
            com: zero,
            velocity: zero,
            angular_velocity: zero,
            acceleration: zero,
            angular_acceleration: zero,
            joints: Vec::new(),
        }
    }

    /// A frame at `placement` that does not move against this one.
    fn fixed(&self, placement: &Pose<f64>) -> Body {
        let rotation = Matrix3::from_fn(|i, j| placement.rotation.0[i][j]);
        let arm = self.rotation * Vector3::from(placement.position.0);
        let (w, dw) = (self.angular_velocity, self.angular_acceleration);
        let origin = self.origin + arm;
        Body {
            rotation: self.rotation * rotation,
            origin,
            com: origin,
            velocity: self.velocity + w.cross(&arm),
            angular_velocity: w,
            acceleration: self.acceleration + dw.cross(&arm) + w.cross(&w.cross(&arm)),
            angular_acceleration: dw,
            joints: self.joints.clone(),
        }
    }

    /// The link that a joint in this state carries on this one.
    fn carry(&self, link: &Link, JointState { q, v, first, rate }: &JointState) -> Body {
        let mut body = self.fixed(&link.placement);
        let (at_zero, axis) = (body.rotation, Vector3::from(link.axis.0));
        let z = at_zero * axis;
        let mut in_series = Vec::new();
        let steps = steps(link);
        for ((&(kind, axis), &q), &v) in steps.iter().zip(q).zip(v.iter()) {
            let (before, z) = (body.clone(), body.rotation * axis);
            let point = body.origin;
            if kind == JointKind::Revolute {
                body.rotation *= Rotation3::from_axis_angle(&Unit::new_normalize(axis), q);
                body.move_on(&before, Vector3::zeros(), Vector3::zeros(), z * v);
                in_series.push(Screw { axis: z, point, turn: 1.0, slide: 0.0 });
            } else {
                body.move_on(&before, z * q, z * v, Vector3::zeros());
                in_series.push(Screw { axis: z, point, turn: 0.0, slide: 1.0 });
            }
        }
        match link.joint {
            _ if !steps.is_empty() => {}
            JointKind::Revolute => {
                body.rotation = at_zero * Rotation3::from_axis_angle(&Unit::new_normalize(axis), link.offset + q[0]);
                body.move_on(self, Vector3::zeros(), Vector3::zeros(), z * v[0]);
            }
            JointKind::Prismatic => body.move_on(self, z * (link.offset + q[0]), z * v[0], Vector3::zeros()),
            JointKind::Helical => {
                let turn = link.offset + q[0];
                body.rotation = at_zero * Rotation3::from_axis_angle(&Unit::new_normalize(axis), turn);
                body.move_on(self, z * (link.pitch * turn), z * (link.pitch * v[0]), z * v[0]);
            }
            JointKind::Spherical => {
                body.rotation = at_zero * orientation(q);
                body.move_on(self, Vector3::zeros(), Vector3::zeros(), body.rotation * vector(v));
            }
            JointKind::Free => {
                body.rotation = at_zero * orientation(&q[3..]);
                let (linear, angular) = (body.rotation * vector(v), body.rotation * vector(&v[3..]));
                body.move_on(self, at_zero * vector(q), linear, angular);
            }
            JointKind::Fixed => {}
            other => panic!("Kane's equations are not written for {other:?} joints"),
        }
        let (point, axes) = (body.origin, body.rotation);
        let about = |axis| Screw { axis, point, turn: 1.0, slide: 0.0 };
        let along = |axis| Screw { axis, point, turn: 0.0, slide: 1.0 };
        let own = |i: usize| axes.column(i).into_owned();
        let screws = match link.joint {
            _ if !steps.is_empty() => in_series,
            JointKind::Revolute => vec![about(z)],
            JointKind::Prismatic => vec![along(z)],
            JointKind::Helical => vec![Screw { slide: link.pitch, ..about(z) }],
            JointKind::Spherical => (0..3).map(|i| about(own(i))).collect(),
            JointKind::Free => (0..3).map(|i| along(own(i))).chain((0..3).map(|i| about(own(i)))).collect(),
            _ => vec![],
        };
        let screws = screws.into_iter();
        let for_a_unit = |screw: Screw| Screw { turn: rate * screw.turn, slide: rate * screw.slide, ..screw };
        body.joints.extend((*first..).zip(screws.map(for_a_unit)));
        body.stand_on(Matrix3::from_fn(|i, j| link.frame.rotation.0[i][j]), Vector3::from(link.frame.position.0));
        body.com = body.origin + body.rotation * Vector3::from(link.com.0);
        body
    }

    /// Moves the origin by `stroke` from where it is at the zero position of its joint on `parent`, against which it has
    /// these velocities. Both are constant in the axes of this body, so that the derivative of each, u, is ω × u with the
    /// whole angular velocity ω of this body.
    fn move_on(&mut self, parent: &Body, stroke: Vector3<f64>, linear: Vector3<f64>, angular: Vector3<f64>) {
        let (w, dw) = (parent.angular_velocity, parent.angular_acceleration);
        self.origin += stroke;
        self.velocity += w.cross(&stroke) + linear;
        self.acceleration += dw.cross(&stroke) + w.cross(&w.cross(&stroke)) + w.cross(&linear);
        self.angular_velocity += angular;
        self.acceleration += self.angular_velocity.cross(&linear);
        self.angular_acceleration += self.angular_velocity.cross(&angular);
    }

    /// Takes a frame fixed to this one, at `position` in it with the axes `rotation`, instead.
    fn stand_on(&mut self, rotation: Matrix3<f64>, position: Vector3<f64>) {
        let arm = self.rotation * position;
        let (w, dw) = (self.angular_velocity, self.angular_acceleration);
        self.acceleration += dw.cross(&arm) + w.cross(&w.cross(&arm));
        self.velocity += w.cross(&arm);
        self.origin += arm;
        self.rotation *= rotation;
    }

    /// Jacobians of the centre of mass and of the axes, a column for each of `dof` velocities.
    pub fn jacobians(&self, dof: usize) -> (DMatrix<f64>, DMatrix<f64>) {
        let (mut linear, mut angular) = (DMatrix::zeros(3, dof), DMatrix::zeros(3, dof));
        for &(coordinate, Screw { axis, point, turn, slide }) in &self.joints {
            let mut column = linear.column_mut(coordinate);
            column += turn * axis.cross(&(self.com - point)) + slide * axis;
            let mut column = angular.column_mut(coordinate);
            column += turn * axis;
        }
        (linear, angular)
    }
}

/// Evaluates the model at coordinates `q` and velocities `v`.
pub fn kane(model: &Model, q: &[f64], v: &[f64]) -> Kane {
    let dof = v.len();
    let links = bodies(model, q, v);
    let ground = Body::ground();
    let on_link = |frame: &Frame| frame.link.map_or(&ground, |link| &links[link]).fixed(&frame.placement);
    let frames = model.frames.iter().map(on_link).collect();
    let at_point = |link: Option<usize>, point| {
        let on = Pose { rotation: Mat3::identity(), position: point };
        link.map_or(&ground, |link| &links[link]).fixed(&on)
    };
    let sides = |cut: &Loop| [&cut.a, &cut.b].map(|side| at_point(side.link, side.point));
    let loops = model.loops.iter().map(sides).collect();
    let g = Vector3::from(model.gravity.0);
    let mut sums = Kane {
        matrix: DMatrix::zeros(dof, dof),
        bias: DVector::zeros(dof),
        gravity: DVector::zeros(dof),
        passive: DVector::zeros(dof),
        dissipated: 0.0,
        kinetic: 0.0,
        potential: 0.0,
        links: Vec::new(),
        frames: Vec::new(),
        loops: Vec::new(),
    };
    for (link, JointState { q, v, first: joint, rate }) in model.links.iter().zip(joint_states(model, q, v)) {
        let nv = v.len();
        let numbers = |numbers: &PerVelocity<f64>| numbers.of_velocities(nv, 0.0);
        let [armature, damping, friction, friction_velocity, stiffness] = {
            let JointPhysics { armature, damping, friction, friction_velocity, stiffness, .. } = &link.physics;
            [armature, damping, friction, friction_velocity, stiffness].map(numbers)
        };
        let (stretch, against_springs) = springs_in_joint(link, &q, &stiffness);
        for i in 0..nv {
            let at = joint + i;
            sums.matrix[(at, at)] += rate * rate * armature[i];
            let dissipative = damping[i] * v[i] + friction[i] * v[i] / v[i].hypot(friction_velocity[i]);
            sums.passive[at] += rate * (dissipative + against_springs[i]);
            sums.dissipated += dissipative * v[i];
            sums.kinetic += 0.5 * armature[i] * v[i].powi(2);
            sums.potential += 0.5 * stiffness[i] * stretch[i].powi(2);
        }
    }
    for spring in &model.springs {
        let end = |LinkPoint { link, point }: LinkPoint| at_point(link, point);
        let (a, b) = (end(spring.a), end(spring.b));
        let line = b.origin - a.origin;
        let (length, direction) = (line.norm(), line.normalize());
        let (stretch, rate) = (length - spring.length, direction.dot(&(b.velocity - a.velocity)));
        let tension = spring.stiffness * stretch + spring.damping * rate;
        sums.passive += (b.jacobians(dof).0 - a.jacobians(dof).0).transpose() * direction * tension;
        sums.dissipated += spring.damping * rate.powi(2);
        sums.potential += 0.5 * spring.stiffness * stretch.powi(2);
    }
    sums.bias += &sums.passive;
    for (link, body) in model.links.iter().zip(&links) {
        let i = link.inertia;
        let central = Matrix3::new(i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz);
        let inertia = body.rotation * central * body.rotation.transpose();
        let (linear, angular) = body.jacobians(dof);
        let (w, dw, arm) = (body.angular_velocity, body.angular_acceleration, body.com - body.origin);
        let acceleration = body.acceleration + dw.cross(&arm) + w.cross(&w.cross(&arm));
        let moment = inertia * dw + w.cross(&(inertia * w));
        let speed = body.velocity + w.cross(&arm);
        sums.matrix += link.mass * linear.transpose() * &linear + angular.transpose() * inertia * &angular;
        sums.bias += link.mass * linear.transpose() * (acceleration - g) + angular.transpose() * moment;
        sums.gravity -= link.mass * linear.transpose() * g;
        sums.kinetic += 0.5 * (link.mass * speed.dot(&speed) + w.dot(&(inertia * w)));
        sums.potential -= link.mass * g.dot(&body.com);
    }
    Kane { links, frames, loops, ..sums }
}

/// All links, whatever their order: a link is placed as soon as its parent is.
fn bodies(model: &Model, q: &[f64], v: &[f64]) -> Vec<Body> {
    let states = joint_states(model, q, v);
    let mut placed: Vec<Option<Body>> = vec![None; model.links.len()];
    while placed.iter().any(Option::is_none) {
        for (index, link) in model.links.iter().enumerate() {
            let parent = match link.parent {
                None => Some(Body::ground()),
                Some(parent) => placed[parent].clone(),
            };
            if let Some(parent) = parent.filter(|_| placed[index].is_none()) {
                placed[index] = Some(parent.carry(link, &states[index]));
            }
        }
    }
    placed.into_iter().flatten().collect()
}

/// How a joint stands and moves.
struct JointState {
    q: Vec<f64>,
    v: Vec<f64>,
    /// The number of the first velocity of the model that moves it.
    first: usize,
    /// Its velocity for a unit of that one: another number than 1 if it mimics a joint.
    rate: f64,
}

/// The state of each link's joint, in the model's order.
fn joint_states(model: &Model, q: &[f64], v: &[f64]) -> Vec<JointState> {
    let numbers = numbers(model);
    let state = |(link, (coordinates, velocities)): (&Link, &(Range<usize>, Range<usize>))| {
        let Some(mut mimic) = link.mimic else {
            let (q, v) = (q[coordinates.clone()].to_vec(), v[velocities.clone()].to_vec());
            return JointState { q, v, first: velocities.start, rate: 1.0 };
        };
        let (mut rate, mut offset) = (mimic.multiplier, mimic.offset);
        while let Some(next) = model.links[mimic.link].mimic {
            offset += rate * next.offset;
            rate *= next.multiplier;
            mimic = next;
        }
        let (coordinates, velocities) = &numbers[mimic.link];
        let first = velocities.start;
        JointState { q: vec![rate * q[coordinates.start] + offset], v: vec![rate * v[first]], first, rate }
    };
    model.links.iter().zip(&numbers).map(state).collect()
}

/// Which coordinates and which velocities the joint of each link has, in the model's order.
fn numbers(model: &Model) -> Vec<(Range<usize>, Range<usize>)> {
    let (mut coordinates, mut velocities) = (0..0, 0..0);
    let next = |(nq, nv)| {
        coordinates = coordinates.end..coordinates.end + nq;
        velocities = velocities.end..velocities.end + nv;
        (coordinates.clone(), velocities.clone())
    };
    model.links.iter().map(sizes).map(next).collect()
}

/// The motions along and about axes that a joint with several degrees of freedom is in series; none of others.
fn steps(link: &Link) -> Vec<(JointKind, Vector3<f64>)> {
    let (slide, turn) = (|axis| (JointKind::Prismatic, axis), |axis| (JointKind::Revolute, axis));
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let angles = link.coordinates.map(|sequence| {
        let axis = |letter| match letter {
            'x' => x,
            'y' => y,
            _ => z,
        };
        sequence.name().chars().map(|letter| turn(axis(letter))).collect::<Vec<_>>()
    });
    let axis = Vector3::from(link.axis.0);
    match (link.joint, angles) {
        (JointKind::Universal, _) => vec![turn(x), turn(y)],
        (JointKind::Cylindrical, _) => vec![slide(axis), turn(axis)],
        (JointKind::Planar, _) => vec![slide(x), slide(y), turn(z)],
        (JointKind::Spherical, Some(angles)) => angles,
        (JointKind::Free, Some(angles)) => [x, y, z].into_iter().map(slide).chain(angles).collect(),
        _ => vec![],
    }
}

/// How far a joint is from where its springs are relaxed, and the forces against them, for each velocity.
///
/// A rotation vector φ has the rate J⁻¹ ω with J⁻¹ = 1 + ½ φ̂ + (1/θ² − cot(θ/2)/2θ) φ̂² at the angular velocity ω in the
/// turned axes. Source: Chirikjian, *Stochastic Models, Information Theory, and Lie Groups*, volume 2, Birkhäuser 2012,
/// section 10.6.
fn springs_in_joint(link: &Link, q: &[f64], stiffness: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (nq, nv) = sizes(link);
    let mut rest = vec![0.0; q.len()];
    if nq > nv {
        rest[nq - 1] = 1.0;
    }
    rest.iter_mut().zip(&link.physics.rest).for_each(|(rest, given)| *rest = *given);
    if nq == nv {
        let stretch: Vec<f64> = q.iter().zip(&rest).map(|(q, rest)| q - rest).collect();
        let forces = stretch.iter().zip(stiffness).map(|(stretch, stiffness)| stretch * stiffness).collect();
        return (stretch, forces);
    }
    let [relaxed, turned] = [&rest, q].map(|q| orientation(&q[nq - 4..]));
    let turn = Rotation3::from_matrix_unchecked(relaxed.transpose() * turned);
    let quaternion =
        UnitQuaternion::new_normalize(Quaternion::new(rest[nq - 1], rest[nq - 4], rest[nq - 3], rest[nq - 2]))
            .inverse()
            * UnitQuaternion::new_normalize(Quaternion::new(q[nq - 1], q[nq - 4], q[nq - 3], q[nq - 2]));
    let vector = quaternion.scaled_axis();
    let (angle, cross) = (vector.norm(), vector.cross_matrix());
    // 1/12 at θ = 0, and 1/12 + θ²/720 near it.
    let second = if angle < 1e-4 { 1.0 / 12.0 } else { 1.0 / angle.powi(2) - 0.5 / (angle * (0.5 * angle).tan()) };
    let rates = Matrix3::identity() + cross * 0.5 + cross * cross * second;
    let times = |k: &[f64], e: &Vector3<f64>| e.component_mul(&Vector3::from_column_slice(k));
    let moment = rates.transpose() * times(&stiffness[nv - 3..], &vector);
    if nv == 3 {
        return (vector.as_slice().to_vec(), moment.as_slice().to_vec());
    }
    let displacement =
        relaxed.transpose() * (Vector3::from_column_slice(&q[..3]) - Vector3::from_column_slice(&rest[..3]));
    let force = turn.matrix().transpose() * times(&stiffness[..3], &displacement);
    (
        [displacement, vector].map(|v| v.as_slice().to_vec()).concat(),
        [force, moment].map(|v| v.as_slice().to_vec()).concat(),
    )
}

/// How many coordinates and velocities a joint has.
fn sizes(link: &Link) -> (usize, usize) {
    match link.joint {
        _ if link.mimic.is_some() => (0, 0),
        _ if !steps(link).is_empty() => (steps(link).len(), steps(link).len()),
        JointKind::Fixed => (0, 0),
        JointKind::Spherical => (4, 3),
        JointKind::Free => (7, 6),
        _ => (1, 1),
    }
}

/// The axes that a quaternion (x, y, z, w) of any length gives, as columns.
fn orientation(q: &[f64]) -> Matrix3<f64> {
    let unit = UnitQuaternion::new_normalize(Quaternion::new(q[3], q[0], q[1], q[2]));
    *unit.to_rotation_matrix().matrix()
}

/// The first three numbers.
fn vector(numbers: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&numbers[..3])
}
