//! Error against time per call: what a scalar, an instruction set or a tolerance buys.

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use redysim::generic::JointRange;
use redysim::generic::{GenericMechanism, Model};
use redysim::lanes::{F32x16, F64x8, Lanes};
use redysim::{ForwardDynamics, InverseDynamics, Real, Vector};

use super::models::{DOF, Kr5, pruned};
use crate::common::csv::Csv;
use crate::common::figure::{Figure, Panel};
use crate::common::outputs::workspace;
use crate::common::reference::Reference;
use crate::common::speed::{median, remark_processor};
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Context, Failure, Outputs, Rows, column, peak};
use redysim_codegen::accuracy::double_double::{DoubleDouble, exact};

/// One way to compute KR5's dynamics: time per state, ns, and error, of inverse and of forward dynamics.
pub struct Measured {
    /// One of [`GROUPS`].
    group: &'static str,
    name: String,
    nanoseconds: [f64; 2],
    error: [f64; 2],
}

/// Coordinates, velocities and accelerations; the joint forces are those that belong to them.
type Sample = [[f64; DOF]; 3];

const SAMPLES: usize = 1024;
const BATCHES: usize = 31;

/// The states, and what comes out at each in double-double: joint forces and accelerations.
struct Judge {
    samples: Vec<Sample>,
    expected: [Vec<[f64; DOF]>; 2],
    /// The largest of each joint's forces and accelerations.
    scale: [[f64; DOF]; 2],
}

impl Judge {
    /// States spread evenly over the ranges of the joints, judged by the generic path over double-double.
    fn new(generic: &GenericMechanism) -> Self {
        const GOLDEN: f64 = 1.618_033_988_749_895;
        let ranges: Vec<JointRange> = generic.model().moving_links().flat_map(|link| link.range.clone()).collect();
        let mut count = 0.0;
        // Numbers that `f32` has, so that its error is that of the arithmetic.
        let mut between = |low: f64, high: f64| {
            count += 1.0;
            f64::from((low + (high - low) * (count * GOLDEN).fract()) as f32)
        };
        let mut samples = Vec::new();
        let mut expected = [Vec::new(), Vec::new()];
        let mut scale = [[0.0_f64; DOF]; 2];
        for _ in 0..SAMPLES {
            let q: [f64; DOF] = std::array::from_fn(|i| between(ranges[i].position[0], ranges[i].position[1]));
            let v: [f64; DOF] = std::array::from_fn(|i| between(-ranges[i].velocity, ranges[i].velocity));
            let a: [f64; DOF] = std::array::from_fn(|i| {
                let largest = ranges[i].acceleration.expect("the model's ranges have accelerations");
                between(-largest, largest)
            });
            let [wide_q, wide_v, wide_a] = [&q, &v, &a].map(|values| exact(values));
            let torques: Vec<DoubleDouble> = generic.inverse_dynamics(&wide_q, &wide_v, &wide_a);
            let tau: [f64; DOF] = std::array::from_fn(|i| f64::from(torques[i].to_f64() as f32));
            let accelerations: Vec<DoubleDouble> = generic.forward_dynamics(&wide_q, &wide_v, &exact(&tau));
            for (function, values) in [&torques, &accelerations].into_iter().enumerate() {
                let values: [f64; DOF] = std::array::from_fn(|i| values[i].to_f64());
                for (scale, value) in scale[function].iter_mut().zip(values) {
                    *scale = scale.max(value.abs());
                }
                expected[function].push(values);
            }
            samples.push([q, v, a]);
        }
        Judge { samples, expected, scale }
    }

    /// What forward dynamics is given at a state: its joint forces, as `f32` has them.
    fn torques(&self, sample: usize) -> [f64; DOF] {
        self.expected[0][sample].map(|torque| f64::from(torque as f32))
    }

    /// The largest error of a function over all states, as a share of the joint's largest value.
    fn error(&self, function: usize, found: impl Fn(usize) -> [f64; DOF]) -> f64 {
        let worst = |sample: usize| {
            let pairs = found(sample).into_iter().zip(self.expected[function][sample]).zip(self.scale[function]);
            pairs.map(|((found, expected), scale)| (found - expected).abs() / scale).fold(0.0, f64::max)
        };
        (0..SAMPLES).map(worst).fold(0.0, f64::max)
    }

    fn scalar<S: Real, M: InverseDynamics<S> + ForwardDynamics<S>>(
        &self,
        group: &'static str,
        name: &str,
        mechanism: &M,
    ) -> Measured {
        let vector = |values: &[f64; DOF]| M::Velocities::from_fn(DOF, |i| S::from_f64(values[i]));
        let coordinates = |values: &[f64; DOF]| M::Coordinates::from_fn(DOF, |i| S::from_f64(values[i]));
        let states = |function: usize| {
            let state = move |(index, [q, v, a]): (usize, &Sample)| {
                let last = if function == 0 { *a } else { self.torques(index) };
                (coordinates(q), vector(v), vector(&last))
            };
            self.samples.iter().enumerate().map(state).collect::<Vec<_>>()
        };
        let (inverse, forward) = (states(0), states(1));
        let numbers = |values: M::Velocities| std::array::from_fn(|i| values.as_ref()[i].to_f64());
        let tau = |index: usize| mechanism.inverse_dynamics(&inverse[index].0, &inverse[index].1, &inverse[index].2);
        let a = |index: usize| mechanism.forward_dynamics(&forward[index].0, &forward[index].1, &forward[index].2);
        Measured {
            group,
            name: name.to_owned(),
            error: [self.error(0, |index| numbers(tau(index))), self.error(1, |index| numbers(a(index)))],
            nanoseconds: [
                per_state(1, |index| {
                    black_box(tau(index));
                }),
                per_state(1, |index| {
                    black_box(a(index));
                }),
            ],
        }
    }

    fn lanes<T: Real, L: Lanes<T, W>, const W: usize>(&self, name: &str) -> Measured {
        let pack = |rows: [[f64; DOF]; W]| -> [L; DOF] {
            std::array::from_fn(|joint| L::from(std::array::from_fn(|lane| T::from_f64(rows[lane][joint]))))
        };
        let states = |function: usize| {
            let state = move |group: usize| {
                let of_lane = |part: usize| std::array::from_fn(|lane| self.samples[group * W + lane][part]);
                let torques = std::array::from_fn(|lane| self.torques(group * W + lane));
                (pack(of_lane(0)), pack(of_lane(1)), pack(if function == 0 { of_lane(2) } else { torques }))
            };
            (0..SAMPLES / W).map(state).collect::<Vec<_>>()
        };
        let (inverse, forward) = (states(0), states(1));
        let tau = |group: usize| Kr5::inverse_dynamics(&inverse[group].0, &inverse[group].1, &inverse[group].2);
        let a = |group: usize| Kr5::forward_dynamics(&forward[group].0, &forward[group].1, &forward[group].2);
        let lane =
            |values: [L; DOF], sample: usize| values.map(|value| Into::<[T; W]>::into(value)[sample % W].to_f64());
        Measured {
            group: LANES,
            name: name.to_owned(),
            error: [
                self.error(0, |sample| lane(tau(sample / W), sample)),
                self.error(1, |sample| lane(a(sample / W), sample)),
            ],
            nanoseconds: [
                per_state(W, |group| {
                    black_box(tau(group));
                }),
                per_state(W, |group| {
                    black_box(a(group));
                }),
            ],
        }
    }
}

/// Time per state, ns, where a call takes `width` states at once: the median of batches.
fn per_state(width: usize, mut call: impl FnMut(usize)) -> f64 {
    let mut batch = || {
        let begun = Instant::now();
        for _ in 0..4 {
            (0..SAMPLES / width).for_each(&mut call);
        }
        begun.elapsed().as_nanos() as f64 / (4 * SAMPLES) as f64
    };
    median((0..BATCHES).map(|_| batch()).collect())
}

/// KR5 on the generic path.
fn generic() -> Result<GenericMechanism, Failure> {
    let path = workspace().join("models/test/kr5_ranges.toml");
    Ok(GenericMechanism::new(Model::load(&path).context(|| format!("cannot read {}", path.display()))?.model))
}

/// What this build has to measure: everything, or, where it is another build of the same program, what differs.
pub fn measure(build: &str) -> Result<Vec<Measured>, Failure> {
    let generic = generic()?;
    let judge = Judge::new(&generic);
    Ok(match build {
        DETERMINISTIC => vec![judge.scalar::<f64, _>(COMPILED, "f64, deterministic", &Kr5)],
        NATIVE => vec![
            judge.scalar::<f64, _>(FUSED, "f64, fused multiply-add", &Kr5),
            judge.scalar::<f32, _>(FUSED, "f32, fused multiply-add", &Kr5),
            judge.lanes::<f64, F64x8, 8>("f64 × 8, this machine"),
            judge.lanes::<f32, F32x16, 16>("f32 × 16, this machine"),
        ],
        _ => {
            vec![
                judge.scalar::<f64, _>(GENERIC, "f64, generic path", &generic),
                judge.scalar::<f64, _>(COMPILED, "f64", &Kr5),
                judge.scalar::<f32, _>(COMPILED, "f32", &Kr5),
                judge.lanes::<f64, F64x8, 8>("f64 × 8"),
                judge.lanes::<f32, F32x16, 16>("f32 × 16"),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-6", &pruned::To1e6),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-5", &pruned::To1e5),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-4", &pruned::To1e4),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-3", &pruned::To1e3),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-2", &pruned::To1e2),
                judge.scalar::<f64, _>(PRUNED, "f64, pruned at 1e-1", &pruned::To1e1),
            ]
        }
    })
}

/// The builds that are run as programs of their own.
pub const NATIVE: &str = "native";
pub const DETERMINISTIC: &str = "deterministic";

/// Prints what [`parsed`] reads.
pub fn print_lines(measured: &[Measured]) {
    for Measured { group, name, nanoseconds: [inverse, forward], error: [of_inverse, of_forward] } in measured {
        println!("{group};{name};{inverse};{forward};{of_inverse:e};{of_forward:e}");
    }
}

fn parsed(line: &str) -> Option<Measured> {
    let mut parts = line.split(';');
    let group = parts.next()?;
    let group = GROUPS.into_iter().find(|known| *known == group)?;
    let name = parts.next()?.to_owned();
    let mut number = || parts.next()?.parse().ok();
    Some(Measured { group, name, nanoseconds: [number()?, number()?], error: [number()?, number()?] })
}

/// Builds this program again in another way, and runs it for its measurements.
fn of_build(build: &str) -> Result<Vec<Measured>, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let root = workspace();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
    let mut command = Command::new(cargo);
    command.current_dir(root).args(["run", "--release", "--quiet", "--bin", "accuracy_vs_speed"]);
    command.env("CARGO_TARGET_DIR", target.join(build));
    match build {
        NATIVE => command.env("RUSTFLAGS", "-C target-cpu=native"),
        _ => command.args(["--features", build]),
    };
    let output = command.args(["--", "--evaluate", build]).output().context(|| "cannot start cargo".to_owned())?;
    if !output.status.success() {
        let reason = String::from_utf8_lossy(&output.stderr);
        return Err(Failure(format!("the {build} build of this program failed:\n{reason}")));
    }
    Ok(String::from_utf8_lossy(&output.stdout).lines().filter_map(parsed).collect())
}

/// Measures all ways, and shows them.
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    headline("KR5: error against time per state");
    let mut all = measure("")?;
    for build in [DETERMINISTIC, NATIVE] {
        eprintln!("building this program again: {build}");
        all.extend(of_build(build)?);
    }
    let mut table = Table::new(&["", "inverse\nns", "error\n", "forward\nns", "error\n"]);
    let headers = ["way", "inverse [ns]", "error of inverse", "forward [ns]", "error of forward"];
    let mut csv = Csv::new(&headers.map(String::from));
    for way in &all {
        let [inverse, forward] = way.nanoseconds;
        let [of_inverse, of_forward] = way.error;
        table.row([
            way.name.clone(),
            format!("{inverse:.1}"),
            tiny(of_inverse),
            format!("{forward:.1}"),
            tiny(of_forward),
        ]);
        csv.named_row(&way.name, [inverse, of_inverse, forward, of_forward]);
    }
    table.print();
    remark("Error: the largest of 1,024 states and six joints, as a share of the joint's largest value, judged by the");
    remark("generic path over double-double. Lanes: per state. Plain names: built for any x86-64 or AArch64 machine.");
    let generic = generic()?;
    let deviations = [
        from_reference::<f64, _>(&generic)?,
        from_reference::<f64, _>(&Kr5)?,
        from_reference::<f32, _>(&Kr5)?,
        from_reference::<f64, _>(&pruned::To1e3)?,
    ]
    .map(tiny);
    let [generic, double, single, pruned] = deviations;
    remark(&format!(
        "Inverse dynamics against an independent program in quadruple precision: generic {generic}, f64 {double},"
    ));
    remark(&format!("f32 {single}, pruned at 1e-3 {pruned} of the joint's peak."));
    remark_processor();
    let panel = |function: usize, title: &str| {
        let start = Panel::new(title, "error", "1").logarithmic().over("time per state [ns]");
        GROUPS.iter().enumerate().fold(start, |panel, (colour, group)| {
            let ways = all.iter().filter(|way| way.group == *group);
            let points: Vec<(f64, f64)> = ways.map(|way| (way.nanoseconds[function], way.error[function])).collect();
            panel.scatter(group, colour, &points)
        })
    };
    let panels = vec![panel(0, "Inverse dynamics"), panel(1, "Forward dynamics")];
    outputs.picture(
        "evaluation",
        "KR5: error against time per state",
        &Figure { columns: 2, panels, shared_legend: true },
    )?;
    outputs.numbers("evaluation", "the same in numbers", &csv)
}

/// The largest deviation of inverse dynamics from a program of its own in quadruple precision, at five instants of the
/// paper's motion, as a share of the joint's largest force.
fn from_reference<S: Real, M: InverseDynamics<S>>(mechanism: &M) -> Result<f64, Failure> {
    let text = include_str!("../../tests/reference/kane_quad_ID_kr5.csv");
    let reference = Reference::joint_forces("quad precision", text, DOF)?;
    let peaks: Vec<f64> = (0..DOF).map(|joint| peak(column(&reference.tau, joint))).collect();
    let mut worst = 0.0_f64;
    for (row, expected) in reference.tau.iter().enumerate() {
        let of_row = |rows: &Rows| M::Velocities::from_fn(DOF, |i| S::from_f64(rows[row][i]));
        let q = M::Coordinates::from_fn(DOF, |i| S::from_f64(reference.q[row][i]));
        let found = mechanism.inverse_dynamics(&q, &of_row(&reference.v), &of_row(&reference.a));
        for ((found, expected), peak) in found.as_ref().iter().zip(expected).zip(&peaks) {
            worst = worst.max((found.to_f64() - expected).abs() / peak);
        }
    }
    Ok(worst)
}

/// What the ways have in common, as the legend calls it.
const GENERIC: &str = "generic path";
const COMPILED: &str = "compiled";
const FUSED: &str = "fused";
const LANES: &str = "lanes";
const PRUNED: &str = "pruned";
const GROUPS: [&str; 5] = [GENERIC, COMPILED, FUSED, LANES, PRUNED];
