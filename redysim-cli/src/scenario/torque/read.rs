//! How the table `torque` of a scenario is read.

use redysim_runtime::tracking_rates;
use redysim_toml::{Key, Kind, Message, Reader};

use super::faults::{not_prescribed, nothing_actuated, prescribed, underactuated, unfollowed};
use super::{HeldFrame, Torque, payload};
use crate::scenario::chosen::chosen;
use crate::scenario::forces::Forces;
use crate::scenario::joints::{Quantity, limits, values};
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
    /// The velocities that follow it whatever force it takes: no law drives them.
    prescribed: &'s [usize],
}

/// The limits of the forces along some velocities.
struct Limits {
    driven: Vec<usize>,
    /// `None` without the key `limits`.
    forces: Option<Vec<f64>>,
}

impl Limits {
    /// The law within these limits.
    fn of(self, law: Torque) -> Torque {
        match self.forces {
            Some(limits) => Torque::Limited { law: Box::new(law), driven: self.driven, limits },
            None => law,
        }
    }
}

impl Torque {
    /// Reads the table `torque`; without one, nothing drives the joints. `trajectory` is `None` if it is invalid, which
    /// has been reported. The velocities `prescribed` follow it whatever force it takes.
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
        let driven = self.driven()?;
        let [target, kp] = [self.targets(&driven), self.gains(&keys::KP, &driven)];
        let limits = self.limits(&driven)?;
        Some(limits.of(Torque::P { driven, target: target?, kp: kp? }))
    }

    fn pd(mut self) -> Option<Torque> {
        let driven = self.driven()?;
        let [target, kp, kd] = [self.targets(&driven), self.gains(&keys::KP, &driven), self.gains(&keys::KD, &driven)];
        let limits = self.limits(&driven)?;
        Some(limits.of(Torque::Pd { driven, target: target?, kp: kp?, kd: kd? }))
    }

    fn pid(mut self) -> Option<Torque> {
        let driven = self.driven()?;
        let target = self.targets(&driven);
        let [kp, ki, kd] = [keys::KP, keys::KI, keys::KD].map(|key| self.gains(&key, &driven));
        let layout = self.subject.layout;
        let rate = values(&mut self.reader, &keys::TRACKING_RATE, Quantity::TrackingRate, layout, &driven);
        let limits = self.limits(&driven)?;
        let (kp, ki, kd) = (kp?, ki?, kd?);
        let tracking_rate = rate.value_or(tracking_rates(&kp, &ki, &kd))?;
        Some(limits.of(Torque::Pid { driven, target: target?, kp, ki, kd, tracking_rate }))
    }

    fn pd_gravity(mut self) -> Option<Torque> {
        self.expect_tree("pd-gravity")?;
        let driven = self.driven()?;
        let [target, kp, kd] = [self.targets(&driven), self.gains(&keys::KP, &driven), self.gains(&keys::KD, &driven)];
        let laden = payload::read(&mut self.reader, self.subject.model);
        let limits = self.limits(&driven)?;
        Some(limits.of(Torque::PdGravity { driven, target: target?, kp: kp?, kd: kd?, laden: laden? }))
    }

    fn impedance(mut self) -> Option<Torque> {
        self.expect_tree("impedance")?;
        let driven = self.driven()?;
        let limits = self.limits(&driven);
        let held = HeldFrame::read(&mut self.reader, self.subject.model, driven);
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

    /// The limits of the forces along the velocities `driven`.
    fn limits(&mut self, driven: &[usize]) -> Option<Limits> {
        let Subject { layout, model, .. } = self.subject;
        let force = |velocity: usize| {
            let link = model.moving_links().nth(layout.velocities[velocity].joint)?;
            link.range.get(velocity - layout.joint_of(velocity).v.start)?.force
        };
        let field = limits(&mut self.reader, &keys::LIMITS, layout, driven, force);
        let forces = if field.is_missing() { None } else { Some(field.value()?.clone()) };
        Some(Limits { driven: driven.to_vec(), forces })
    }

    fn tracking_pd(mut self) -> Option<Torque> {
        let trajectory = self.followed()?;
        let follows = |velocity: &usize| trajectory.velocities.contains(velocity);
        let is_usual = |velocity: &usize| follows(velocity) && !self.prescribed.contains(velocity);
        let usual = self.subject.actuated().into_iter().filter(is_usual).collect();
        let driven = self.driven_among(usual, "no joint that the trajectory prescribes")?;
        let [kp, kd] = [self.gains(&keys::KP, &driven), self.gains(&keys::KD, &driven)];
        let missing: Vec<usize> = driven.iter().copied().filter(|velocity| !follows(velocity)).collect();
        if !missing.is_empty() {
            return not_prescribed(&mut self.reader, self.subject.layout, &missing);
        }
        let limits = self.limits(&driven)?;
        Some(limits.of(Torque::TrackingPd { driven, trajectory: trajectory.clone(), kp: kp?, kd: kd? }))
    }

    fn computed_torque(mut self) -> Option<Torque> {
        let trajectory = self.followed()?;
        let [kp, kd] = [keys::KP, keys::KD].map(|key| self.gains(&key, &trajectory.velocities));
        let (layout, actuated) = (self.subject.layout, self.subject.actuated());
        if !self.prescribed.is_empty() {
            return prescribed(&mut self.reader, "computed torque moves it too", layout, self.prescribed);
        }
        if !self.subject.loops() && actuated.len() < layout.nv() {
            // The velocities without an actuator follow from the dynamics.
            let is_prescribed = |velocity: &usize| trajectory.velocities.contains(velocity);
            let idle: Vec<usize> = actuated.iter().copied().filter(|velocity| !is_prescribed(velocity)).collect();
            if !idle.is_empty() || trajectory.velocities.len() > actuated.len() {
                return underactuated(&mut self.reader, layout, (&trajectory.velocities, &idle));
            }
        } else if let Err((fault, help)) = trajectory.check_joints(self.subject) {
            let title = format!("{}: {fault}, and computed torque moves it whole", self.reader.item());
            return self.reader.error_of_table(Message { title, label: "not with this trajectory".into(), help });
        }
        let limits = self.limits(&actuated)?;
        Some(limits.of(Torque::Computed { actuated, trajectory: trajectory.clone(), kp: kp?, kd: kd? }))
    }

    fn table(mut self) -> Option<Torque> {
        let driven = self.driven()?;
        let forces = self
            .subject
            .table(&mut self.reader, &keys::FORCE_FILE, |table| Forces::of(table, self.subject.layout, &driven))?;
        let limits = self.limits(&driven)?;
        Some(limits.of(Torque::Table { driven, forces }))
    }

    /// The motion that the law follows.
    fn followed(&mut self) -> Option<&'s Prescribed> {
        self.trajectory?.or_else(|| unfollowed(&mut self.reader))
    }

    /// The velocities that the law drives, by default those with an actuator that do not follow the trajectory.
    fn driven(&mut self) -> Option<Vec<usize>> {
        let follows = |velocity: &usize| self.prescribed.contains(velocity);
        let usual = self.subject.actuated().into_iter().filter(|velocity| !follows(velocity)).collect();
        let of_none = if self.prescribed.is_empty() { "no joint" } else { "no joint that is not prescribed" };
        self.driven_among(usual, of_none)
    }

    /// The velocities that the law drives, by default `usual`; a message about an empty default begins with `of_none`.
    fn driven_among(&mut self, usual: Vec<usize>, of_none: &str) -> Option<Vec<usize>> {
        let layout = self.subject.layout;
        let field = chosen(&mut self.reader, &keys::DRIVEN, layout);
        let Some(named) = field.spanned() else {
            return match field.is_missing() && usual.is_empty() {
                true => nothing_actuated(&mut self.reader, of_none),
                false => field.value_or(usual),
            };
        };
        let follows = |velocity: &usize| self.prescribed.contains(velocity);
        let both: Vec<usize> = named.get_ref().iter().copied().filter(follows).collect();
        if !both.is_empty() {
            return prescribed(&mut self.reader, "the torque law drives it", layout, &both);
        }
        if let Some((name, lacking)) = layout.lacking_actuators(named.get_ref()) {
            let message = Message {
                title: format!("{}: the torque law drives {name}, which {lacking}", self.reader.item()),
                label: "one of these".into(),
                help: "leave it out, or give it an actuator; keep it if the law stands for a spring or a damper".into(),
            };
            self.reader.warning_at(named.span(), message);
        }
        field.value().cloned()
    }

    fn targets(&mut self, driven: &[usize]) -> Option<Vec<f64>> {
        self.of(&keys::TARGET, Quantity::Coordinate, &self.subject.layout.coordinates_along(driven))
    }

    fn gains(&mut self, key: &Key, driven: &[usize]) -> Option<Vec<f64>> {
        self.of(key, Quantity::Gain, driven)
    }

    /// What stands under `key` for `of`, indices of coordinates or velocities.
    fn of(&mut self, key: &Key, quantity: Quantity, of: &[usize]) -> Option<Vec<f64>> {
        let layout = self.subject.layout;
        let field = self.reader.required(key, |reader, key| values(reader, key, quantity, layout, of));
        field.value().cloned()
    }
}
