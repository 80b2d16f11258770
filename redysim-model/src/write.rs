//! Models as the text of model files.

use crate::check::BASE;
use crate::faults::Faults;
use crate::joint::{FRICTION_VELOCITY, JointPhysics};
use crate::load::Loaded;
use crate::model::{CutSide, Frame, Inertia, JointKind, JointRange, Link, Loop, Mimic, Model, Spring};
use crate::options::{AccelerationMethod, CodegenOptions};
use crate::per_velocity::PerVelocity;
use crate::schema::keys;
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_runtime::Functions;
use redysim_toml::Key;
use toml_writer::{ToTomlValue, TomlStringBuilder};

impl Model {
    /// The text of a model file that reads back to this model, to the same bits.
    ///
    /// Every joint is placed by `origin` with the rotation matrix, `axis`, `offset` and `far_end`, which are the numbers
    /// of [`Link`]: the Denavit-Hartenberg parameters or angles that a model was read from are not kept. What the file
    /// may leave out is left out. A model with a fault is written as well, so that [`check`](Self::check) shows where
    /// the fault is.
    ///
    /// # Example
    ///
    /// ```
    /// # use redysim_model::Model;
    /// # let text = "name = 'arm'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'upper'\nparent = 'base'\n\
    /// #     joint = 'revolute'\ndh = { alpha = '30 deg', theta = 0.1 }\nmass = 1.0\ncom = [0.5, 0, 0]";
    /// let arm = Model::from_toml(text, "arm.toml")?.model;
    /// let text = arm.to_toml();
    /// assert!(text.contains("offset = 0.1\n") && text.contains("com = [0.5, 0.0, 0.0]\n"));
    /// assert_eq!(Model::from_toml(text, "arm.toml")?.model, arm);
    /// # Ok::<(), redysim_model::Faults>(())
    /// ```
    pub fn to_toml(&self) -> String {
        let mut file = Text::default();
        file.entry(&keys::NAME, string(&self.name));
        file.entry(&keys::GRAVITY, vector(self.gravity));
        self.links.iter().for_each(|link| self.write_link(link, &mut file));
        self.loops.iter().for_each(|cut| self.write_loop(cut, &mut file));
        self.frames.iter().for_each(|frame| self.write_frame(frame, &mut file));
        self.springs.iter().for_each(|spring| self.write_spring(spring, &mut file));
        file.0
    }

    /// Checks a model that was built in Rust by the rules for files.
    ///
    /// The model that is returned has what was left open: a joint without a name has that of its link, and axes have
    /// length 1.
    ///
    /// # Errors
    ///
    /// Every fault, each shown in [the text](Self::to_toml) of the model's file.
    ///
    /// # Example
    ///
    /// ```
    /// use redysim_model::spatial::Vec3;
    /// use redysim_model::{JointKind, Link, Model};
    ///
    /// let mut pendulum = Model::new("pendulum", Vec3([0.0, 0.0, -9.81]));
    /// pendulum.links.push(Link {
    ///     axis: Vec3([0.0, 1.0, 0.0]),
    ///     com: Vec3([0.5, 0.0, 0.0]),
    ///     mass: 1.0,
    ///     ..Link::new("rod", None, JointKind::Revolute)
    /// });
    /// let checked = pendulum.check()?;
    /// assert_eq!(checked.model.links[0].joint_name, "rod");
    ///
    /// pendulum.links[0].mass = -1.0;
    /// println!("{}", pendulum.check().unwrap_err()); // link `rod`: its mass is -1.0 kg, and a mass is not negative
    /// # Ok::<(), redysim_model::Faults>(())
    /// ```
    pub fn check(&self) -> Result<Loaded, Faults> {
        Model::from_toml(self.to_toml(), "the model, written as TOML")
    }

    fn write_link(&self, link: &Link, file: &mut Text) {
        file.table(&keys::LINKS);
        file.entry(&keys::NAME, string(&link.name));
        if !link.joint_name.is_empty() && link.joint_name != link.name {
            file.entry(&keys::JOINT_NAME, string(&link.joint_name));
        }
        file.entry(&keys::PARENT, self.carrier(link.parent));
        file.entry(&keys::JOINT, string(link.joint.name()));
        file.entry(&keys::ORIGIN, pose(link.placement));
        if link.joint.has_axis() {
            file.entry(&keys::AXIS, vector(link.axis));
        }
        file.number_unless(&keys::OFFSET, link.offset, 0.0);
        if link.frame != Pose::identity() {
            file.entry(&keys::FAR_END, pose(link.frame));
        }
        if link.joint == JointKind::Helical {
            file.entry(&keys::PITCH, number(link.pitch));
        } else {
            file.number_unless(&keys::PITCH, link.pitch, 0.0);
        }
        if let Some(sequence) = link.coordinates {
            file.entry(&keys::COORDINATES, string(sequence.name()));
        }
        file.entry(&keys::MASS, number(link.mass));
        file.vector_unless_zero(&keys::COM, link.com);
        file.inertia(link.inertia);
        file.physics(&link.physics);
        if let Some(mimic) = link.mimic {
            file.entry(&keys::MIMIC, self.mimic(mimic));
        }
        match &link.actuated {
            PerVelocity::Uniform(true) => {}
            PerVelocity::Uniform(false) => file.entry(&keys::ACTUATED, "false"),
            PerVelocity::Each(each) => file.entry(&keys::ACTUATED, format!("{each:?}")),
        }
        match &link.range[..] {
            [] => {}
            [only] if link.joint.dof() == 1 => file.entry(&keys::RANGE, range(*only)),
            each => file
                .entry(&keys::RANGE, format!("[{}]", each.iter().copied().map(range).collect::<Vec<_>>().join(", "))),
        }
    }

    fn write_loop(&self, Loop { name, joint, a, b }: &Loop, file: &mut Text) {
        file.table(&keys::LOOPS);
        file.entry(&keys::NAME, string(name));
        file.entry(&keys::CUT_JOINT, string(joint.name()));
        let sides =
            [(a, [&keys::LINK_A, &keys::POINT_A, &keys::AXIS_A]), (b, [&keys::LINK_B, &keys::POINT_B, &keys::AXIS_B])];
        for ((CutSide { link, point, axis }, [link_key, point_key, axis_key]), has_axis) in
            sides.into_iter().zip(joint.has_axes())
        {
            file.entry(link_key, self.carrier(*link));
            file.vector_unless_zero(point_key, *point);
            if has_axis {
                file.entry(axis_key, vector(*axis));
            }
        }
    }

    fn write_frame(&self, Frame { name, link, placement }: &Frame, file: &mut Text) {
        file.table(&keys::FRAMES);
        file.entry(&keys::NAME, string(name));
        file.entry(&keys::FRAME_LINK, self.carrier(*link));
        file.entry(&keys::FRAME_ORIGIN, pose(*placement));
    }

    fn write_spring(&self, Spring { name, a, b, stiffness, damping, length }: &Spring, file: &mut Text) {
        file.table(&keys::SPRINGS);
        if let Some(name) = name {
            file.entry(&keys::NAME, string(name));
        }
        for (point, link_key, point_key) in [(a, &keys::LINK_A, &keys::POINT_A), (b, &keys::LINK_B, &keys::POINT_B)] {
            file.entry(link_key, self.carrier(point.link));
            file.vector_unless_zero(point_key, point.point);
        }
        // A length needs a stiffness beside it, even of zero.
        for (key, value) in
            [(&keys::SPRING_STIFFNESS, stiffness), (&keys::SPRING_DAMPING, damping), (&keys::LENGTH, length)]
        {
            file.entry(key, number(*value));
        }
    }

    /// The joint that is mimicked, by its name. One that is not there gets a name that no joint has.
    fn mimic(&self, Mimic { link, multiplier, offset }: Mimic) -> String {
        let name = self.links.get(link).map_or(format!("links[{link}]"), |link| {
            if link.joint_name.is_empty() { link.name.clone() } else { link.joint_name.clone() }
        });
        let entries = [
            (&keys::MIMIC_JOINT, string(&name)),
            (&keys::MULTIPLIER, number(multiplier)),
            (&keys::MIMIC_OFFSET, number(offset)),
        ];
        inline(entries)
    }

    /// The name of a link, or of the ground. One that is not there gets a name that no link has.
    fn carrier(&self, link: Option<usize>) -> String {
        let name = link.map(|link| self.links.get(link).map_or(format!("links[{link}]"), |link| link.name.clone()));
        string(name.as_deref().unwrap_or(BASE))
    }
}

impl CodegenOptions {
    /// The options as they stand beside a model file: for [`Model::from_toml_with`], or in front of the model's own text.
    ///
    /// Of functions those are named that `model` has.
    pub fn to_toml(&self, model: &Model) -> String {
        let CodegenOptions { functions, tolerance, forward_dynamics, parameters } = self;
        let mut text = Text::default();
        if *functions != Functions::ALL {
            let of_model = functions
                .with_frames(model.frames.len())
                .with_loops(model.loops.len())
                .with_passive_joints(model.has_passive_joints());
            text.entry(&keys::FUNCTIONS, array(of_model.iter().map(|function| string(function.name()))));
        }
        if let Some(tolerance) = tolerance {
            text.entry(&keys::TOLERANCE, number(*tolerance));
        }
        if *forward_dynamics != AccelerationMethod::Auto {
            text.entry(&keys::FORWARD_DYNAMICS, string(forward_dynamics.name()));
        }
        if !parameters.is_empty() {
            text.entry(&keys::PARAMETERS, array(parameters.iter().map(|parameter| string(&parameter.name(model)))));
        }
        text.0
    }
}

/// A text that grows.
#[derive(Default)]
struct Text(String);

impl Text {
    fn entry(&mut self, key: &Key, value: impl AsRef<str>) {
        self.0 += &format!("{} = {}\n", key.name, value.as_ref());
    }

    fn table(&mut self, key: &Key) {
        self.0 += &format!("\n[[{}]]\n", key.name);
    }

    fn number_unless(&mut self, key: &Key, value: f64, default: f64) {
        if !same(value, default) {
            self.entry(key, number(value));
        }
    }

    fn vector_unless_zero(&mut self, key: &Key, value: Vec3<f64>) {
        if value.0.iter().any(|x| !same(*x, 0.0)) {
            self.entry(key, vector(value));
        }
    }

    fn inertia(&mut self, Inertia { xx, yy, zz, xy, yz, xz }: Inertia) {
        let elements =
            [(&keys::XX, xx), (&keys::YY, yy), (&keys::ZZ, zz), (&keys::XY, xy), (&keys::YZ, yz), (&keys::XZ, xz)];
        let given = elements.into_iter().filter(|(_, value)| !same(*value, 0.0));
        let given: Vec<_> = given.map(|(key, value)| (key, number(value))).collect();
        if !given.is_empty() {
            self.entry(&keys::INERTIA, inline(given));
        }
    }

    fn physics(&mut self, physics: &JointPhysics) {
        let JointPhysics { armature, damping, friction, friction_velocity, stiffness, rest } = physics;
        self.numbers_unless(&keys::ARMATURE, armature, 0.0);
        self.numbers_unless(&keys::DAMPING, damping, 0.0);
        // The second of each pair needs the first beside it.
        if !is_uniformly(friction, 0.0) || !is_uniformly(friction_velocity, FRICTION_VELOCITY) {
            self.entry(&keys::FRICTION, per_velocity(friction));
            self.numbers_unless(&keys::FRICTION_VELOCITY, friction_velocity, FRICTION_VELOCITY);
        }
        if !is_uniformly(stiffness, 0.0) || !rest.is_empty() {
            self.entry(&keys::STIFFNESS, per_velocity(stiffness));
        }
        match &rest[..] {
            [] => {}
            [only] => self.entry(&keys::REST, number(*only)),
            several => self.entry(&keys::REST, array(several.iter().copied().map(number))),
        }
    }

    fn numbers_unless(&mut self, key: &Key, numbers: &PerVelocity<f64>, default: f64) {
        if !is_uniformly(numbers, default) {
            self.entry(key, per_velocity(numbers));
        }
    }
}

/// Whether a number is the same for all velocities, and this one.
fn is_uniformly(numbers: &PerVelocity<f64>, value: f64) -> bool {
    matches!(numbers, PerVelocity::Uniform(number) if same(*number, value))
}

fn per_velocity(numbers: &PerVelocity<f64>) -> String {
    match numbers {
        PerVelocity::Uniform(one) => number(*one),
        PerVelocity::Each(each) => array(each.iter().copied().map(number)),
    }
}

/// The range of one velocity.
fn range(JointRange { position, velocity, acceleration, force }: JointRange) -> String {
    let mut entries = vec![(&keys::POSITION, array(position.map(number))), (&keys::VELOCITY, number(velocity))];
    entries.extend(acceleration.map(|acceleration| (&keys::ACCELERATION, number(acceleration))));
    entries.extend(force.map(|force| (&keys::FORCE, number(force))));
    inline(entries)
}

/// A pose as `origin` has it.
fn pose(Pose { rotation, position }: Pose<f64>) -> String {
    let mut entries = Vec::new();
    if position.0.iter().any(|x| !same(*x, 0.0)) {
        entries.push((&keys::XYZ, vector(position)));
    }
    if rotation != Mat3::identity() {
        entries.push((&keys::ROTATION, array(rotation.0.map(|row| vector(Vec3(row))))));
    }
    inline(entries)
}

fn inline<'k>(entries: impl IntoIterator<Item = (&'k Key, String)>) -> String {
    let entries: Vec<_> = entries.into_iter().map(|(key, value)| format!("{} = {value}", key.name)).collect();
    if entries.is_empty() { "{}".into() } else { format!("{{ {} }}", entries.join(", ")) }
}

fn array(elements: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", elements.into_iter().collect::<Vec<_>>().join(", "))
}

fn vector(vector: Vec3<f64>) -> String {
    array(vector.0.map(number))
}

/// With the digits that tell it from its neighbours, which read back to the same bits.
fn number(number: f64) -> String {
    if number.is_nan() { "nan".into() } else { format!("{number:?}") }
}

fn string(text: &str) -> String {
    TomlStringBuilder::new(text).as_basic().to_toml_value()
}

/// Whether two numbers have the same bits: unlike `==`, this tells -0.0 from 0.0.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits()
}
