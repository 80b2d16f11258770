//! On random trees with random loops, residual, Jacobian and bias are those of plain homogeneous transforms.
//!
//! The other formulation knows the model alone: it multiplies 4×4 matrices from the base to each side of a cut, and
//! gets Jacobian and bias by differentiating its own residual with dual numbers. From the library it takes only which
//! rows it keeps and which two directions across the axis of a revolute cut it measures along; both are checked on the
//! way. Held against it are the generic functions and the expressions of which compiled ones are written.
#![cfg(feature = "generic")]

use crate::common::call::{constants, loop_bias, loop_jacobian, loop_residual};
use crate::common::dual::{Dual, moving};
use crate::common::random::Random;
use crate::common::styles::{link, offset, placed};
use crate::common::traced::traced;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim::Real;
use redysim::generic::{GenericMechanism, Model};
use redysim::{ConfigurationSpace, Scalar};
use redysim_codegen::functions::TracedFunction;
use redysim_model::spatial::{Mat3, Vec3};
use redysim_model::{CutKind, CutSide, Function, Inertia, JointKind, Link, Loop};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;

const MODELS: u64 = 150;
const STATES: usize = 3;

/// A homogeneous transform, by rows.
type Transform<S> = [[S; 4]; 4];

fn constant<S: Scalar>(rotation: &[[f64; 3]; 3], position: [f64; 3]) -> Transform<S> {
    let at = |i: usize, j: usize| match (i, j) {
        (3, _) => f64::from(u8::from(j == 3)),
        (_, 3) => position[i],
        _ => rotation[i][j],
    };
    std::array::from_fn(|i| std::array::from_fn(|j| S::from_f64(at(i, j))))
}

fn product<S: Scalar>(a: &Transform<S>, b: &Transform<S>) -> Transform<S> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).fold(S::zero(), |sum, k| sum + a[i][k] * b[k][j])))
}

/// What the coordinates of a joint do.
fn joint<S: Scalar>(link: &Link, q: &[S]) -> Transform<S> {
    let steps = steps(link);
    if !steps.is_empty() {
        let each = steps.iter().zip(q).map(|(&(kind, axis), &q)| on_axis(kind, 0.0, axis, q));
        return each.fold(unit(), |moved, step| product(&moved, &step));
    }
    match (link.joint, q) {
        (JointKind::Spherical, &[x, y, z, w]) => turned([x, y, z, w], [S::zero(); 3]),
        (JointKind::Free, &[x, y, z, qx, qy, qz, qw]) => turned([qx, qy, qz, qw], [x, y, z]),
        (kind, &[q]) => on_axis(kind, link.pitch, link.axis.0, q + S::from_f64(link.offset)),
        _ => unit(),
    }
}

/// The motions about and along axes, one after the other, of a universal, cylindrical or planar joint.
fn steps(link: &Link) -> Vec<(JointKind, [f64; 3])> {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    match link.joint {
        JointKind::Universal => vec![(JointKind::Revolute, x), (JointKind::Revolute, y)],
        JointKind::Cylindrical => vec![(JointKind::Prismatic, link.axis.0), (JointKind::Revolute, link.axis.0)],
        JointKind::Planar => vec![(JointKind::Prismatic, x), (JointKind::Prismatic, y), (JointKind::Revolute, z)],
        _ => vec![],
    }
}

fn unit<S: Scalar>() -> Transform<S> {
    constant(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3])
}

/// The rotation by a quaternion (x, y, z, w), whose columns are those of a unit quaternion divided by its square, and a
/// shift.
fn turned<S: Scalar>([x, y, z, w]: [S; 4], position: [S; 3]) -> Transform<S> {
    let twice = |a: S| a + a;
    let columns = [
        [x * x - y * y - z * z + w * w, twice(x * y + z * w), twice(z * x - y * w)],
        [twice(x * y - z * w), y * y - z * z - x * x + w * w, twice(y * z + x * w)],
        [twice(z * x + y * w), twice(y * z - x * w), z * z - x * x - y * y + w * w],
    ];
    let square = x * x + y * y + z * z + w * w;
    let mut transform = unit();
    for (i, row) in transform.iter_mut().enumerate().take(3) {
        *row = [columns[0][i] / square, columns[1][i] / square, columns[2][i] / square, position[i]];
    }
    transform
}

/// What a joint variable does: Rodrigues' rotation 1 + sin q [u] + (1 − cos q) [u]² about, or a shift along, the axis.
fn on_axis<S: Scalar>(kind: JointKind, pitch: f64, u: [f64; 3], q: S) -> Transform<S> {
    let mut transform = unit::<S>();
    let cross = [[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]];
    let (sin, cos) = q.sin_cos();
    for (i, row) in transform.iter_mut().enumerate().take(3) {
        match kind {
            JointKind::Fixed => {}
            JointKind::Prismatic => row[3] = S::from_f64(u[i]) * q,
            JointKind::Revolute | JointKind::Helical => {
                if kind == JointKind::Helical {
                    row[3] = S::from_f64(pitch * u[i]) * q;
                }
                for (j, element) in row.iter_mut().enumerate().take(3) {
                    let square: f64 = (0..3).map(|k| cross[i][k] * cross[k][j]).sum();
                    *element += S::from_f64(cross[i][j]) * sin + S::from_f64(square) * (S::one() - cos);
                }
            }
            other => panic!("{other:?} joints are not among the random ones"),
        }
    }
    transform
}

/// How many coordinates a joint has.
fn coordinates(link: &Link) -> usize {
    match link.joint {
        _ if !steps(link).is_empty() => steps(link).len(),
        JointKind::Fixed => 0,
        JointKind::Spherical => 4,
        JointKind::Free => 7,
        _ => 1,
    }
}

/// The rates q̇ = N(q) v of the coordinates at the velocities `v`.
fn rates<S: Scalar>(mechanism: &GenericMechanism, q: &[S], v: &[f64]) -> Vec<S> {
    mechanism.coordinate_rates(&q.to_vec(), &constants(v))
}

/// Link `link` in the base frame; without a link, the base.
fn place<S: Scalar>(model: &Model, link: Option<usize>, q: &[S]) -> Transform<S> {
    let Some(index) = link else { return unit() };
    let link = &model.links[index];
    let first = model.links[..index].iter().map(coordinates).sum::<usize>();
    let own = &q[first..first + coordinates(link)];
    let placement = constant(&link.placement.rotation.0, link.placement.position.0);
    let parent = place(model, link.parent, q);
    let moved = product(&product(&parent, &placement), &joint(link, own));
    product(&moved, &constant(&link.frame.rotation.0, link.frame.position.0))
}

/// All rows of all loops, whether they vanish or not. `frames` are the axes of side a, as columns in its link's frame.
fn residual<S: Scalar>(model: &Model, frames: &[Matrix3<f64>], q: &[S]) -> Vec<S> {
    let mut rows = Vec::new();
    for (cut, frame) in model.loops.iter().zip(frames) {
        // Frames that align have the same axes on both sides.
        let axes_of_b = if cut.joint == CutKind::Prismatic { *frame } else { cut_axes(cut.joint, cut.b.axis.0) };
        let [a, b] = [(&cut.a, frame), (&cut.b, &axes_of_b)].map(|(side, axes)| {
            let axes = std::array::from_fn(|i| std::array::from_fn(|j| axes[(i, j)]));
            product(&place(model, side.link, q), &constant(&axes, side.point.0))
        });
        let way: [S; 3] = std::array::from_fn(|i| b[i][3] - a[i][3]);
        let along = |i: usize| (0..3).fold(S::zero(), |sum, k| sum + a[k][i] * way[k]);
        match cut.joint {
            CutKind::Prismatic | CutKind::Cylindrical => rows.extend([along(0), along(1)]),
            CutKind::Planar => rows.push(along(2)),
            _ => rows.extend(way),
        }
        let dot = |i: usize, j: usize| (0..3).fold(S::zero(), |sum, k| sum + a[k][i] * b[k][j]);
        let half = S::from_f64(0.5);
        match cut.joint {
            CutKind::Spherical => {}
            CutKind::Universal => rows.push(dot(2, 2)),
            CutKind::Revolute | CutKind::Cylindrical | CutKind::Planar => rows.extend([dot(0, 2), dot(1, 2)]),
            // R is the rotation from a to b; its antisymmetric part has the sine of its angle times its axis.
            CutKind::Weld | CutKind::Prismatic => {
                rows.extend([(2, 1), (0, 2), (1, 0)].map(|(i, j)| half * (dot(i, j) - dot(j, i))));
            }
            other => panic!("{other:?} cuts are not among the random ones"),
        }
    }
    rows
}

/// A frame with the axis as z; for a weld, the link's own.
fn cut_axes(joint: CutKind, axis: [f64; 3]) -> Matrix3<f64> {
    let z = Vector3::from(axis);
    match joint {
        CutKind::Weld => Matrix3::identity(),
        _ => {
            let x = z.cross(&Vector3::new(0.3, -0.5, 0.8)).normalize();
            Matrix3::from_columns(&[x, z.cross(&x), z])
        }
    }
}

fn unit_vector(random: &mut Random) -> Vector3<f64> {
    match random.below(3) {
        0 => [Vector3::x(), -Vector3::y(), Vector3::z()][random.below(3)],
        _ => Vector3::from_fn(|_, _| random.within(1.0)).normalize(),
    }
}

/// A tree of links on joints of these kinds, and one to three loops, cut in these ways, between any two of them or the base.
fn random_model(random: &mut Random, kinds: &[JointKind], cuts: &[CutKind]) -> Model {
    let count = 2 + random.below(8);
    let links = random.tree(count, |random, grown, parent| {
        let axis = Unit::new_normalize(unit_vector(random));
        let turned = Rotation3::from_axis_angle(&axis, random.within(3.0));
        let joint = kinds[random.below(kinds.len())];
        let at = Vec3::from_fn(|_| random.within(0.5));
        let tilt = Rotation3::from_axis_angle(&axis, random.within(3.0));
        let inertia = Inertia { xx: 1.0, yy: 1.0, zz: 1.0, ..Inertia::default() };
        let body = Link { mass: 1.0, inertia, ..link(grown, parent, joint, placed(turned.matrix(), at)) };
        let axis = Vec3(unit_vector(random).into());
        let frame = placed(tilt.matrix(), Vec3::from_fn(|_| random.within(0.3)));
        let offset = offset(random);
        // Spherical and free joints have none of these, others some.
        if matches!(joint, JointKind::Spherical | JointKind::Free) {
            return body;
        }
        match joint {
            JointKind::Universal | JointKind::Planar => Link { frame, ..body },
            JointKind::Cylindrical => Link { axis, frame, ..body },
            _ => Link { axis, frame, offset, pitch: 0.2, ..body },
        }
    });
    let mut loops = Vec::new();
    for number in 0..=random.below(3) {
        let a = random.below(count + 1);
        let b = (a + 1 + random.below(count)) % (count + 1);
        let mut side = |link: usize| CutSide {
            link: link.checked_sub(1),
            point: Vec3::from_fn(|_| random.within(0.3)),
            axis: Vec3(unit_vector(random).into()),
        };
        let (a, b) = (side(a), side(b));
        let joint = cuts[random.below(cuts.len())];
        loops.push(Loop { name: format!("loop{number}"), joint, a, b });
    }
    Model {
        name: "random".into(),
        gravity: Vec3::from_fn(|_| random.within(10.0)),
        links,
        loops,
        frames: Vec::new(),
        springs: Vec::new(),
    }
}

/// The axes of side a of each cut as the library has chosen them, in the link's frame.
fn frames(mechanism: &GenericMechanism) -> Vec<Matrix3<f64>> {
    let tree = mechanism.tree();
    let cuts = tree.cuts.iter().zip(&mechanism.model().loops);
    cuts.map(|(cut, model)| {
        let link = model.a.link.map_or(Mat3::identity(), |link| tree.links[link].pose.rotation);
        let frame = link.transpose() * cut.a.axes;
        let frame = Matrix3::from_fn(|i, j| frame.0[i][j]);
        assert!((frame.transpose() * frame - Matrix3::identity()).amax() < 1e-14, "axes are at right angles");
        match cut.joint {
            CutKind::Weld => assert!((frame - Matrix3::identity()).amax() < 1e-14, "the link's own axes"),
            _ => assert!((frame.column(2) - Vector3::from(model.a.axis.0)).amax() < 1e-14, "z is the axis"),
        }
        frame
    })
    .collect()
}

/// The largest error of each function.
#[derive(Default)]
struct Errors(BTreeMap<&'static str, f64>);

impl Errors {
    /// Against the largest component expected, or against one where that is less.
    fn add(&mut self, what: &'static str, computed: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(computed.len(), expected.len(), "{what}");
        let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for (x, y) in computed.iter().zip(expected) {
            let error = (x - y).abs() / size;
            assert!(error <= tolerance, "{what}: error {error:.1e}\n{computed:?}\n{expected:?}");
            let worst = self.0.entry(what).or_default();
            *worst = Real::maximum(*worst, error);
        }
    }
}

/// The outputs of a traced function.
fn evaluated(functions: &[TracedFunction], name: &str, arguments: &[&[f64]]) -> Vec<f64> {
    let function = functions.iter().find(|function| function.function.name() == name).expect("a function");
    function.expressions.evaluate(arguments)
}

const OF_ONE_FREEDOM: [JointKind; 4] =
    [JointKind::Revolute, JointKind::Helical, JointKind::Prismatic, JointKind::Fixed];
const LOOP_FUNCTIONS: [Function; 3] = [Function::LoopResidual, Function::LoopJacobian, Function::LoopBias];
const WITHOUT_STROKE: [CutKind; 3] = [CutKind::Revolute, CutKind::Spherical, CutKind::Weld];

#[test]
fn loops_agree_with_homogeneous_transforms() {
    loops_agree(1000..1000 + MODELS, &OF_ONE_FREEDOM, &WITHOUT_STROKE, 1e-13);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn loops_through_joints_of_several_freedoms_agree_with_homogeneous_transforms() {
    let kinds = [&OF_ONE_FREEDOM[..], &[JointKind::Spherical, JointKind::Free]].concat();
    loops_agree(2000..2000 + MODELS, &kinds, &WITHOUT_STROKE, 1e-13);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn loops_cut_in_every_way_through_joints_of_every_kind_agree_with_homogeneous_transforms() {
    let several = [JointKind::Spherical, JointKind::Universal, JointKind::Cylindrical, JointKind::Planar];
    let kinds = [&OF_ONE_FREEDOM[..], &several].concat();
    // Points are tens of metres apart on several strokes in a row, and a component along an axis is what their many terms
    // leave.
    loops_agree(3000..3080, &kinds, &CutKind::ALL.map(|(_, kind)| kind), 1e-12);
}

fn loops_agree(seeds: Range<u64>, kinds: &[JointKind], cuts: &[CutKind], of_bias: f64) {
    let mut errors = Errors::default();
    let (mut kept_rows, mut all_rows, mut with_common_ancestor, mut on_the_base) = (0, 0, 0, 0);
    for seed in seeds {
        let mut random = Random::new(seed);
        let mechanism = GenericMechanism::new(random_model(&mut random, kinds, cuts));
        let (model, tree) = (mechanism.model(), mechanism.tree());
        let (frames, traced) = (frames(&mechanism), traced(tree, &LOOP_FUNCTIONS));
        let kept: Vec<bool> = tree.cuts.iter().flat_map(|cut| cut.rows.clone()).collect();
        let select = |rows: Vec<f64>| -> Vec<f64> {
            assert_eq!(rows.len(), kept.len());
            for (row, kept) in rows.iter().zip(&kept) {
                assert!(*kept || row.abs() < 1e-12, "model {seed}: a row of {row:e} was left out");
            }
            rows.into_iter().zip(&kept).filter(|(_, kept)| **kept).map(|(row, _)| row).collect()
        };
        kept_rows += kept.iter().filter(|kept| **kept).count();
        all_rows += kept.len();
        on_the_base += model.loops.iter().filter(|cut| cut.a.link.is_none() || cut.b.link.is_none()).count();
        with_common_ancestor += model.loops.iter().filter(|cut| share_a_joint(model, cut)).count();
        for _ in 0..STATES {
            // Quaternions within ±π are of any length.
            let (q, v) = (&random.vector(tree.nq(), PI)[..], &random.vector(tree.nv(), 3.0)[..]);
            let expected = select(residual(model, &frames, q));
            errors.add("residual", &loop_residual(&mechanism, q), &expected, 1e-13);
            errors.add("traced residual", &evaluated(&traced, "loop_residual", &[q]), &expected, 1e-13);
            let jacobian = loop_jacobian(&mechanism, q);
            let by_expressions = evaluated(&traced, "loop_jacobian", &[q]);
            for coordinate in 0..tree.nv() {
                let mut direction = vec![0.0; tree.nv()];
                direction[coordinate] = 1.0;
                let rows = residual(model, &frames, &moving(q, &rates(&mechanism, q, &direction)));
                let expected = select(rows.iter().map(|row| row.rate).collect());
                let column: Vec<f64> = jacobian.iter().map(|row| row[coordinate]).collect();
                errors.add("jacobian", &column, &expected, 1e-13);
                let column: Vec<f64> = by_expressions.iter().skip(coordinate).step_by(tree.nv()).copied().collect();
                errors.add("traced jacobian", &column, &expected, 1e-13);
            }
            // Along q̇ = N(q) v at constant v, the second derivative of the residual is J̇ v.
            let inner: Vec<Dual<f64>> = moving(q, &rates(&mechanism, q, v));
            let twice = moving(&inner, &rates(&mechanism, &inner, v));
            let rows = residual(model, &frames, &twice);
            let expected = select(rows.iter().map(|row| row.rate.rate).collect());
            errors.add("bias", &loop_bias(&mechanism, q, v), &expected, of_bias);
            errors.add("traced bias", &evaluated(&traced, "loop_bias", &[q, v]), &expected, of_bias);
        }
    }
    println!("{:?}", errors.0);
    println!(
        "{kept_rows} of {all_rows} rows kept; {on_the_base} sides on the base; {with_common_ancestor} share a joint"
    );
    // The draw has what the test is about.
    assert!(kept_rows > 500 && on_the_base > 30 && with_common_ancestor > 50);
}

/// Whether a moving joint carries both sides of the cut.
fn share_a_joint(model: &Model, cut: &Loop) -> bool {
    let joints = |side: &CutSide| -> Vec<usize> {
        let ancestors = std::iter::successors(side.link, |&link| model.links[link].parent);
        ancestors.filter(|&link| model.links[link].joint != JointKind::Fixed).collect()
    };
    let of_b = joints(&cut.b);
    joints(&cut.a).iter().any(|joint| of_b.contains(joint))
}
