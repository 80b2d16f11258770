//! How the table `torque` of a scenario is read.

use redysim_runtime::tracking_rates;
use redysim_toml::{Key, Kind, Message, Reader};

use super::faults::{not_prescribed, nothing_actuated, prescribed, underactuated, unfollowed};
use super::{HeldFrame, Torque, payload};
use crate::layout::Joint;
use crate::scenario::forces::Forces;
use crate::scenario::joints::{Quantity, limits, some, values};
use crate::scenario::keys;
use crate::scenario::subject::{Subject, given};
use crate::scenario::trajectory::Prescribed;

const LAWS: [Kind<ReadLaw>; 9] = [
    Kind::new("free", |_| Some(Torque::Zero), &keys::ZERO_TORQUE),
    Kind::new("p", |law| law.p(), &keys::P),
    Kind::new("pd", |law| law.pd(), &keys::PD),
    Kind::new("pid", |law| law.pid(), &keys::PID),
    Kind::new("pd-gravity", |law| law.pd_gravity(), &keys::PD_GRAVITY),
    Kind::new("tracking-pd", |law| law.tracking_pd(), &keys::TRACKING_PD),
    Kind::new("computed-torque", |law| law.computed_torque(), &keys::COMPUTED_TORQUE),
    Kind::new("impedance", |law| law.impedance(), &keys::IMPEDANCE),
    Kind::new("csv", |law| law.table(), &keys::FORCE_TABLE),
];

/// How the keys of a law are read.
type ReadLaw = fn(Source<'_, '_, '_>) -> Option<Torque>;

/// What a law is read from.
pub(super) struct Source<'s, 'a, 'f> {
    pub(super) reader: Reader<'a, 'f>,
    pub(super) subject: &'s Subject<'s>,
    /// The scenario's trajectory, if it has one; `None` if that is invalid.
    trajectory: Option<Option<&'s Prescribed>>,
    /// The joints that follow it whatever force it takes: no law drives them.
    prescribed: &'s [usize],
}

/// The limits of the forces on some joints.
struct Limits {
    joints: Vec<usize>,
    /// `None` without the key `limits`.
    forces: Option<Vec<f64>>,
}

impl Limits {
    /// The law within these limits.
    fn of(self, law: Torque) -> Torque {
        match self.forces {
            Some(limits) => Torque::Limited { law: Box::new(law), joints: self.joints, limits },
            None => law,
        }
    }
}

impl Torque {
    /// Reads the table `torque`; without one, nothing drives the joints. `trajectory` is `None` if it is invalid, which
    /// has been reported. The joints `prescribed` follow it whatever force it takes.
    pub fn read(
        reader: &mut Reader<'_, '_>,
        subject: &Subject<'_>,
        trajectory: Option<Option<&Prescribed>>,
        prescribed: &[usize],
    ) -> Option<Torque> {
        let read = |reader: Reader<'_, '_>, law: ReadLaw| law(Source { reader, subject, trajectory, prescribed });
        let field = reader.table_of_kind(&keys::TORQUE, &keys::LAW, &LAWS, &LAWS[0], read);
        given(field)?.or(Some(Torque::Zero))
    }
}

impl<'s> Source<'s, '_, '_> {
    fn p(mut self) -> Option<Torque> {
        let joints = self.driven(self.subject.actuated())?;
        let [target, kp] = [self.targets(&joints), self.gains(&keys::KP, &joints)];
        let limits = self.limits(&joints)?;
        Some(limits.of(Torque::P { joints, target: target?, kp: kp? }))
    }

    fn pd(mut self) -> Option<Torque> {
        let joints = self.driven(self.subject.actuated())?;
        let [target, kp, kd] = [self.targets(&joints), self.gains(&keys::KP, &joints), self.gains(&keys::KD, &joints)];
        let limits = self.limits(&joints)?;
        Some(limits.of(Torque::Pd { joints, target: target?, kp: kp?, kd: kd? }))
    }

    fn pid(mut self) -> Option<Torque> {
        let joints = self.driven(self.subject.actuated())?;
        let target = self.targets(&joints);
        let [kp, ki, kd] = [keys::KP, keys::KI, keys::KD].map(|key| self.gains(&key, &joints));
        let layout = self.subject.layout;
        let of = layout.velocities_of(&joints);
        let rate = values(&mut self.reader, &keys::TRACKING_RATE, Quantity::TrackingRate, layout, &of);
        let limits = self.limits(&joints)?;
        let (kp, ki, kd) = (kp?, ki?, kd?);
        let tracking_rate = rate.value_or(tracking_rates(&kp, &ki, &kd))?;
        Some(limits.of(Torque::Pid { joints, target: target?, kp, ki, kd, tracking_rate }))
    }

    fn pd_gravity(mut self) -> Option<Torque> {
        self.expect_tree("pd-gravity")?;
        let joints = self.driven(self.subject.actuated())?;
        let [target, kp, kd] = [self.targets(&joints), self.gains(&keys::KP, &joints), self.gains(&keys::KD, &joints)];
        let laden = payload::read(&mut self.reader, self.subject.model);
        let limits = self.limits(&joints)?;
        Some(limits.of(Torque::PdGravity { joints, target: target?, kp: kp?, kd: kd?, laden: laden? }))
    }

    fn impedance(mut self) -> Option<Torque> {
        self.expect_tree("impedance")?;
        let joints = self.driven(self.subject.actuated())?;
        let limits = self.limits(&joints);
        let held = HeldFrame::read(&mut self.reader, self.subject.model, joints);
        Some(limits?.of(Torque::Impedance(held?)))
    }

    /// Fails for closed loops, on which the law `name` does not act.
    fn expect_tree(&mut self, name: &str) -> Option<()> {
        if !self.subject.loops() {
            return Some(());
        }
        self.reader.error_of_table(Message {
            title: format!("{}: the law `{name}` requires a tree, but the model has closed loops", self.reader.item()),
            label: "not for this model".into(),
            help: "take the law `computed-torque`, which carries the weight of closed loops, or `pid`".into(),
        })
    }

    /// The limits of the forces on `joints`.
    fn limits(&mut self, joints: &[usize]) -> Option<Limits> {
        let force = |joint: usize| self.subject.model.moving_links().nth(joint)?.range.first()?.force;
        let field = limits(&mut self.reader, &keys::LIMITS, self.subject.layout, joints, force);
        let forces = if field.is_missing() { None } else { Some(field.value()?.clone()) };
        Some(Limits { joints: joints.to_vec(), forces })
    }

    fn tracking_pd(mut self) -> Option<Torque> {
        let trajectory = self.followed()?;
        let actuated = self.subject.actuated();
        let usual = trajectory.joints.iter().copied().filter(|joint| actuated.contains(joint)).collect();
        let joints = self.driven(usual)?;
        let [kp, kd] = [self.gains(&keys::KP, &joints), self.gains(&keys::KD, &joints)];
        if let Some(&joint) = joints.iter().find(|joint| !trajectory.joints.contains(joint)) {
            return not_prescribed(&mut self.reader, &self.subject.joints()[joint]);
        }
        if joints.is_empty() {
            return nothing_actuated(&mut self.reader);
        }
        let limits = self.limits(&joints)?;
        Some(limits.of(Torque::TrackingPd { joints, trajectory: trajectory.clone(), kp: kp?, kd: kd? }))
    }

    fn computed_torque(mut self) -> Option<Torque> {
        let trajectory = self.followed()?;
        let [kp, kd] = [keys::KP, keys::KD].map(|key| self.gains(&key, &trajectory.joints));
        let actuated = self.subject.layout.actuated_velocities();
        let joints = self.subject.joints();
        if let Some(&joint) = self.prescribed.first() {
            return prescribed(&mut self.reader, "computed torque moves it too", &joints[joint]);
        }
        if !self.subject.loops() && joints.iter().any(|joint| !joint.actuated) {
            // The joints without an actuator follow from the dynamics.
            let drives = |joint: &Joint| joint.v.clone().any(|velocity| actuated.contains(&velocity));
            let wrong = joints.iter().enumerate().find(|(index, joint)| match trajectory.joints.contains(index) {
                true => !joint.actuated,
                false => drives(joint),
            });
            if let Some((_, joint)) = wrong {
                return underactuated(&mut self.reader, self.subject.layout, joint);
            }
        } else if let Err((fault, help)) = trajectory.check_joints(self.subject) {
            let title = format!("{}: {fault}, and computed torque moves it whole", self.reader.item());
            return self.reader.error_of_table(Message { title, label: "not with this trajectory".into(), help });
        }
        let limits = self.limits(&self.subject.actuated())?;
        Some(limits.of(Torque::Computed { actuated, trajectory: trajectory.clone(), kp: kp?, kd: kd? }))
    }

    fn table(mut self) -> Option<Torque> {
        let joints = self.driven(self.subject.actuated())?;
        let forces = self
            .subject
            .table(&mut self.reader, &keys::FORCE_FILE, |table| Forces::of(table, self.subject.layout, &joints))?;
        let limits = self.limits(&joints)?;
        Some(limits.of(Torque::Table { joints, forces }))
    }

    /// The motion that the law follows.
    fn followed(&mut self) -> Option<&'s Prescribed> {
        self.trajectory?.or_else(|| unfollowed(&mut self.reader))
    }

    /// The joints that the law drives, by default `usual`.
    fn driven(&mut self, usual: Vec<usize>) -> Option<Vec<usize>> {
        let field = some(&mut self.reader, &keys::DRIVEN, self.subject.joints());
        if let Some(joint) = field.value().and_then(|named| named.iter().find(|joint| self.prescribed.contains(joint)))
        {
            return prescribed(&mut self.reader, "the torque law drives it", &self.subject.joints()[*joint]);
        }
        let passive = |joint: &&usize| !self.subject.joints()[**joint].actuated;
        if let Some(named) = field.spanned()
            && let Some(&joint) = named.get_ref().iter().find(passive)
        {
            let joint = &self.subject.joints()[joint];
            let (item, name, lacking) = (self.reader.item(), &joint.name, self.subject.layout.lacking_actuators(joint));
            let message = Message {
                title: format!("{item}: the torque law drives the joint `{name}`, which {lacking}"),
                label: "one of these".into(),
                help: "leave it out, or give it an actuator; keep it if the law stands for a spring or a damper".into(),
            };
            self.reader.warning_at(named.span(), message);
        }
        field.value_or(usual.into_iter().filter(|joint| !self.prescribed.contains(joint)).collect())
    }

    fn targets(&mut self, joints: &[usize]) -> Option<Vec<f64>> {
        self.of(&keys::TARGET, Quantity::Coordinate, &self.subject.layout.coordinates_of(joints))
    }

    fn gains(&mut self, key: &Key, joints: &[usize]) -> Option<Vec<f64>> {
        self.of(key, Quantity::Gain, &self.subject.layout.velocities_of(joints))
    }

    /// What stands under `key` for `of`, indices of coordinates or velocities.
    fn of(&mut self, key: &Key, quantity: Quantity, of: &[usize]) -> Option<Vec<f64>> {
        let layout = self.subject.layout;
        let field = self.reader.required(key, |reader, key| values(reader, key, quantity, layout, of));
        field.value().cloned()
    }
}
