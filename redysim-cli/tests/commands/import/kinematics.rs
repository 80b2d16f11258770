//! Random trees as URDFs, and where their links are: by nalgebra's quaternions, so that nothing is shared with
//! what is tested.

use std::fmt::Write;

use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};

/// A joint and the link it carries.
pub struct Joint {
    pub link: String,
    /// Index of the parent; `None` is the root.
    pub parent: Option<usize>,
    pub kind: &'static str,
    pub xyz: [f64; 3],
    pub rpy: [f64; 3],
    pub axis: [f64; 3],
    pub mass: f64,
    pub com: [f64; 3],
}

/// Numbers by a fixed rule (xorshift).
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Between −size and size.
    pub fn within(&mut self, size: f64) -> f64 {
        ((self.next() >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0) * size
    }

    fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(size))
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() >> 33) as usize % count
    }
}

/// A tree of `count` links, the first of which moves; some angles are quarter turns, pitches of 90° among them.
pub fn tree(numbers: &mut Numbers, count: usize) -> Vec<Joint> {
    let quarter = std::f64::consts::FRAC_PI_2;
    let joint = |index: usize| {
        let kind = ["revolute", "continuous", "prismatic", "fixed", "fixed"][numbers.below(5)];
        let turned = numbers.vector(3.0);
        Joint {
            link: format!("link{index}"),
            parent: (0..index).nth(numbers.below(index + 1)),
            kind: if index == 0 { "continuous" } else { kind },
            xyz: numbers.vector(1.0),
            rpy: if numbers.below(3) == 0 { [0; 3].map(|_| quarter * (numbers.below(5) as f64 - 2.0)) } else { turned },
            axis: numbers.vector(2.0),
            mass: 0.1 + numbers.within(0.05),
            com: numbers.vector(0.3),
        }
    };
    (0..count).map(joint).collect()
}

/// The tree as a URDF; the inertia of each link is that of a body, turned against the link.
pub fn urdf(joints: &[Joint]) -> String {
    let words = |v: [f64; 3]| format!("{:?} {:?} {:?}", v[0], v[1], v[2]);
    let mut text = String::from("<robot name=\"tree\">\n<link name=\"root\"/>\n");
    for joint in joints {
        let Joint { link, kind, mass, .. } = joint;
        let parent = joint.parent.map_or("root", |parent| &joints[parent].link);
        let (com, rpy) = (words(joint.com), words([joint.mass, -2.0 * joint.mass, 20.0 * joint.mass]));
        let (xyz, turn, axis) = (words(joint.xyz), words(joint.rpy), words(joint.axis));
        write!(
            text,
            "<link name=\"{link}\"><inertial><origin xyz=\"{com}\" rpy=\"{rpy}\"/><mass value=\"{mass:?}\"/>\
             <inertia ixx=\"0.03\" iyy=\"0.02\" izz=\"0.04\" ixy=\"0.001\" ixz=\"-0.002\" iyz=\"0.003\"/></inertial></link>\n\
             <joint name=\"to_{link}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{link}\"/>\
             <origin xyz=\"{xyz}\" rpy=\"{turn}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint>\n"
        )
        .unwrap();
    }
    text + "</robot>\n"
}

/// Origin and centre of mass of every link, at a coordinate for each joint.
pub fn positions(joints: &[Joint], q: &[f64]) -> Vec<([f64; 3], [f64; 3])> {
    let mut frames: Vec<Isometry3<f64>> = Vec::new();
    for (joint, &q) in joints.iter().zip(q) {
        let parent = joint.parent.map_or(Isometry3::identity(), |parent| frames[parent]);
        let [roll, pitch, yaw] = joint.rpy;
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let axis = Unit::new_normalize(Vector3::from(joint.axis));
        let frame = parent * Isometry3::from_parts(joint.xyz.into(), turn);
        frames.push(match joint.kind {
            "prismatic" => frame * Translation3::from(*axis * q),
            "fixed" => frame,
            _ => frame * UnitQuaternion::from_axis_angle(&axis, q),
        });
    }
    let place = |(joint, frame): (&Joint, Isometry3<f64>)| {
        (frame.translation.vector.into(), (frame * Point3::from(joint.com)).into())
    };
    joints.iter().zip(frames).map(place).collect()
}
