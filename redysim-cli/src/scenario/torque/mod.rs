//! What the actuators do.

mod impedance;
mod payload;
mod tangent;

use redysim_model::GenericMechanism;
use redysim_runtime::{
    ClosedLoop, ClosedLoopComputedTorque, ComputedTorque, HybridComputedTorque, Limited, Motion, Pd, PdGravity, Pid,
    Proportional, SetPoint, TrackingPd, Trajectory, ZeroTorque, tracking_rates,
};
use redysim_toml::{Key, Kind, Message, Reader};

use super::Ground;
use super::forces::Forces;
use super::initial::Initial;
use super::joints::{Quantity, limits, some, values};
use super::keys;
use super::law::Law;
use super::subject::{Subject, given, spread};
use super::trajectory::Prescribed;
use crate::layout::{Joint, Layout};
pub use impedance::HeldFrame;
use tangent::OnTangent;

/// A torque law, as the scenario has it: its values are those of the joints that it drives.
#[derive(Clone, Debug)]
pub enum Torque {
    Zero,
    P {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
    },
    Pd {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    Pid {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        ki: Vec<f64>,
        kd: Vec<f64>,
        tracking_rate: Vec<f64>,
    },
    PdGravity {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
        /// The model with the payload that the law assumes, if it assumes one.
        laden: Option<Box<GenericMechanism>>,
    },
    /// Springs and dampers on a frame.
    Impedance(HeldFrame),
    /// A law within the limits of the actuators, one for each of the velocities that it drives.
    Limited {
        law: Box<Torque>,
        joints: Vec<usize>,
        limits: Vec<f64>,
    },
    /// A spring and a damper to a motion.
    TrackingPd {
        joints: Vec<usize>,
        trajectory: Prescribed,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// The same, with the model; its gains are those of the joints that are prescribed, of closed loops the independent
    /// ones.
    Computed {
        /// The velocities that have an actuator.
        actuated: Vec<usize>,
        trajectory: Prescribed,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// Forces over time.
    Table {
        joints: Vec<usize>,
        forces: Forces,
    },
}

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
struct Source<'s, 'a, 'f> {
    reader: Reader<'a, 'f>,
    subject: &'s Subject<'s>,
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

    /// The joints that the law drives, given or by default.
    pub fn joints(&self) -> Option<&[usize]> {
        match self.unlimited() {
            Torque::Zero | Torque::Computed { .. } | Torque::Limited { .. } => None,
            Torque::P { joints, .. }
            | Torque::Pd { joints, .. }
            | Torque::Pid { joints, .. }
            | Torque::PdGravity { joints, .. }
            | Torque::Impedance(HeldFrame { joints, .. })
            | Torque::TrackingPd { joints, .. }
            | Torque::Table { joints, .. } => Some(joints),
        }
    }

    /// The law without the limits of its forces.
    pub fn unlimited(&self) -> &Torque {
        match self {
            Torque::Limited { law, .. } => law,
            law => law,
        }
    }

    /// What the law follows, if it follows a motion.
    pub fn followed(&self) -> Option<&Prescribed> {
        match self.unlimited() {
            Torque::TrackingPd { trajectory, .. } | Torque::Computed { trajectory, .. } => Some(trajectory),
            _ => None,
        }
    }

    /// The law as it acts on the mechanism on `ground`, which starts at `initial`.
    pub fn law<'a>(&'a self, ground: &'a Ground<'a>, layout: &'a Layout, initial: &Initial) -> Law<'a> {
        let mechanism = ground.mechanism();
        let positions =
            |joints: &[usize], values: &[f64]| spread(&layout.coordinates_of(joints), values, &layout.coordinates);
        let whole =
            |joints: &[usize], values: &[f64]| spread(&layout.velocities_of(joints), values, &layout.velocities);
        let rest = || vec![0.0; layout.nv()];
        // Where coordinates are not as many as velocities, their differences are.
        let on_tangent = layout.nq() != layout.nv();
        match self {
            Torque::Zero => Law::total(ZeroTorque),
            Torque::P { joints, target, kp } => {
                let (target, kp) = (positions(joints, target), whole(joints, kp));
                if on_tangent {
                    let law = Proportional { target: rest(), kp };
                    return Law::total(OnTangent { mechanism, target: SetPoint::new(mechanism, target), law });
                }
                Law::total(Proportional { target, kp })
            }
            Torque::Pd { joints, target, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                let target = positions(joints, target);
                if on_tangent {
                    let law = Pd { target: rest(), kp, kd };
                    return Law::total(OnTangent { mechanism, target: SetPoint::new(mechanism, target), law });
                }
                Law::total(Pd { target, kp, kd })
            }
            Torque::Pid { joints, target, kp, ki, kd, tracking_rate } => {
                let [kp, ki, kd, tracking] = [kp, ki, kd, tracking_rate].map(|gains| whole(joints, gains));
                let trajectory = SetPoint::new(mechanism, positions(joints, target));
                if on_tangent {
                    let origin = SetPoint::new(mechanism, rest());
                    let law = Pid { trajectory: origin, kp, ki, kd, tracking, integral: rest() };
                    return Law::total(OnTangent { mechanism, target: trajectory, law });
                }
                Law::total(Pid { trajectory, kp, ki, kd, tracking, integral: rest() })
            }
            Torque::PdGravity { joints, target, kp, kd, laden } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                let trajectory = SetPoint::new(mechanism, positions(joints, target));
                let law = PdGravity { mechanism: laden.as_deref().unwrap_or(mechanism), trajectory, kp, kd };
                Law::total(Limited { law, limits: only(joints, layout) })
            }
            Torque::Impedance(held) => {
                Law::total(Limited { law: held.law(mechanism, initial), limits: only(&held.joints, layout) })
            }
            Torque::Limited { law, joints, limits } => {
                let mut all = vec![f64::INFINITY; layout.nv()];
                for (velocity, &limit) in layout.velocities_of(joints).into_iter().zip(limits) {
                    all[velocity] = limit;
                }
                Law::limited(law.law(ground, layout, initial), all)
            }
            Torque::TrackingPd { joints, trajectory, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                let target = trajectory.spread(layout);
                if on_tangent {
                    let rates = move |t: f64| Motion { q: vec![0.0; layout.nv()], ..target.at(t) };
                    return Law::total(OnTangent { mechanism, target, law: TrackingPd { trajectory: rates, kp, kd } });
                }
                Law::total(TrackingPd { trajectory: target, kp, kd })
            }
            Torque::Computed { actuated, trajectory, kp, kd } if mechanism.model().loops.is_empty() => {
                let [kp, kd] = [kp, kd].map(|gains| whole(&trajectory.joints, gains));
                let trajectory = trajectory.spread(layout);
                if actuated.len() == layout.nv() {
                    return Law::total(ComputedTorque { mechanism, trajectory, kp, kd });
                }
                let actuated: Vec<_> = (0..layout.nv()).map(|velocity| actuated.contains(&velocity)).collect();
                let external = |q: &Vec<f64>, v: &Vec<f64>| ground.ground_forces(q, v);
                Law::total(HybridComputedTorque { mechanism, trajectory, kp, kd, actuated, external })
            }
            Torque::Computed { actuated, trajectory, kp, kd } => {
                let (loops, gains) = (ClosedLoop::new(mechanism), [kp.clone(), kd.clone()]);
                let law = ClosedLoopComputedTorque::new(loops, &trajectory.velocities, trajectory, gains);
                Law::OfLoops(law.actuated(actuated))
            }
            Torque::Table { forces, .. } => Law::total(forces),
        }
    }
}

/// Limits that leave the joints `driven` alone and let nothing act on the others.
fn only(driven: &[usize], layout: &Layout) -> Vec<f64> {
    let mut limits = vec![0.0; layout.nv()];
    for velocity in layout.velocities_of(driven) {
        limits[velocity] = f64::INFINITY;
    }
    limits
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
        let force = |joint: usize| self.subject.model.moving_links().nth(joint)?.range?.force;
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
                return underactuated(&mut self.reader, joint);
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
            let name = &self.subject.joints()[joint].name;
            let item = self.reader.item();
            let message = Message {
                title: format!("{item}: the torque law drives the joint `{name}`, which has no actuator"),
                label: "one of these".into(),
                help: "well if a spring or a damper is there; else leave it out, or give it an actuator".into(),
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

fn unfollowed<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: the torque law follows a trajectory, but the scenario does not define one", reader.item()),
        label: "needs a trajectory".into(),
        help: "add a table `[trajectory]`".into(),
    })
}

fn nothing_actuated<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: no joint that the trajectory prescribes has an actuator", reader.item()),
        label: "drives nothing".into(),
        help: "prescribe actuated joints, or name those that the law drives under `joints`".into(),
    })
}

fn not_prescribed<T>(reader: &mut Reader<'_, '_>, joint: &Joint) -> Option<T> {
    reader.error_of_table(Message {
        title: format!(
            "{}: the trajectory does not prescribe the joint `{}` that the torque law drives",
            reader.item(),
            joint.name
        ),
        label: "drives a joint without a prescribed motion".into(),
        help: "name it among the `joints` of `[trajectory]`, or drive fewer".into(),
    })
}

/// Reports a joint that follows the trajectory and is driven as well, as `also` states. Always `None`.
fn prescribed<T>(reader: &mut Reader<'_, '_>, also: &str, joint: &Joint) -> Option<T> {
    reader.error_of_table(Message {
        title: format!(
            "{}: the joint `{}` is prescribed, and {also}: its force follows from its motion",
            reader.item(),
            joint.name
        ),
        label: "drives a joint that is prescribed".into(),
        help: "leave the joint out here, or out of `forward.prescribed`".into(),
    })
}

/// Of a tree with joints that have no actuator, computed torque moves the others, all of them.
fn underactuated<T>(reader: &mut Reader<'_, '_>, joint: &Joint) -> Option<T> {
    let (item, Joint { name, actuated, .. }) = (reader.item(), joint);
    let (title, help) = if *actuated {
        let title = format!(
            "{item}: the trajectory does not prescribe the joint `{name}`, and computed torque moves every joint with \
             an actuator"
        );
        (title, "name all joints with an actuator among the `joints` of `[trajectory]`")
    } else {
        let title = format!(
            "{item}: computed torque moves what the trajectory prescribes, but the joint `{name}` has no actuator"
        );
        let help = "name those with an actuator as the `joints` of `[trajectory]`, and the others follow from the \
                    dynamics; or take the law `tracking-pd`";
        (title, help)
    };
    reader.error_of_table(Message { title, label: "not with this trajectory".into(), help: help.into() })
}
