//! Time per call of the compiled functions against the generic path.

use std::hint::black_box;
use std::time::Instant;

use redysim::{OperationCount, Operations, TreeDynamics, Vector};

use super::processor;
use super::progress::Progress;
use super::table::{Table, headline, remark};

/// States that calls go through, so that no result can be kept; few enough to stay in the innermost cache.
pub const STATES: usize = 128;
/// A batch goes so many times through the states.
const PASSES: usize = 16;
const BATCHES: usize = 31;

/// One function that is timed: what it costs, and a batch of calls of both.
struct Race<'a> {
    function: &'static str,
    operations: OperationCount,
    compiled: Box<dyn Fn() + 'a>,
    generic: Box<dyn Fn() + 'a>,
}

/// Prints the time per call of both mechanisms, which are the same one, compiled with `operations` and generic.
///
/// Batches of both take turns, so that a change of the processor's clock meets both; the median of the batches counts.
pub fn report<M, G>(compiled: &M, operations: &Operations, generic: &G)
where
    M: TreeDynamics<f64>,
    G: TreeDynamics<f64>,
{
    headline("Time per call: compiled against the generic path");
    let (of_compiled, of_generic) = (states(compiled), states(generic));
    let mut table = Table::new(&["function", "flops\n", "sin/cos\npairs", "compiled\nns", "generic\nns", "ratio\n"]);
    let races = races((compiled, &of_compiled), (generic, &of_generic), operations);
    let mut progress = Progress::new("timing", races.len() * BATCHES);
    for race in races {
        let (mut fast, mut slow) = (Vec::new(), Vec::new());
        for _ in 0..BATCHES {
            fast.push(nanoseconds_per_call(&race.compiled));
            slow.push(nanoseconds_per_call(&race.generic));
            progress.advance();
        }
        let (fast, slow) = (median(fast), median(slow));
        table.row([
            race.function.to_owned(),
            race.operations.flops().to_string(),
            race.operations.trig.to_string(),
            format!("{fast:.1}"),
            format!("{slow:.0}"),
            format!("{:.1}", slow / fast),
        ]);
    }
    drop(progress);
    table.print();
    remark(&format!("Medians of {BATCHES} batches of {} calls, in turns, at changing states.", STATES * PASSES));
    remark_processor();
}

/// Prints which processor the times belong to and what the program is compiled for, and warns of a debug build.
pub fn remark_processor() {
    remark(&format!("{}.", processor::described()));
    if cfg!(debug_assertions) {
        remark("This is a debug build, whose times mean nothing: run with --release.");
    }
}

/// A mechanism and the states to call it at.
type Runner<'a, M> = (&'a M, &'a [State<M>]);

fn races<'a, M, G>(compiled: Runner<'a, M>, generic: Runner<'a, G>, operations: &Operations) -> [Race<'a>; 3]
where
    M: TreeDynamics<f64>,
    G: TreeDynamics<f64>,
{
    [
        Race {
            function: "inverse dynamics",
            operations: operations.inverse_dynamics,
            compiled: batch(compiled, |m, s| m.inverse_dynamics(&s.q, &s.v, &s.input)),
            generic: batch(generic, |m, s| m.inverse_dynamics(&s.q, &s.v, &s.input)),
        },
        Race {
            function: "forward dynamics",
            operations: operations.forward_dynamics,
            compiled: batch(compiled, |m, s| m.forward_dynamics(&s.q, &s.v, &s.input)),
            generic: batch(generic, |m, s| m.forward_dynamics(&s.q, &s.v, &s.input)),
        },
        Race {
            function: "mass matrix",
            operations: operations.mass_matrix,
            compiled: batch(compiled, |m, s| m.mass_matrix(&s.q)),
            generic: batch(generic, |m, s| m.mass_matrix(&s.q)),
        },
    ]
}

/// A batch of calls whose inputs and results the optimiser must take as unknown and used.
fn batch<'a, M, R>(runner: Runner<'a, M>, call: impl Fn(&M, &State<M>) -> R + 'a) -> Box<dyn Fn() + 'a>
where
    M: TreeDynamics<f64>,
{
    Box::new(move || {
        for _ in 0..PASSES {
            for state in runner.1 {
                black_box(call(runner.0, black_box(state)));
            }
        }
    })
}

fn nanoseconds_per_call(batch: &dyn Fn()) -> f64 {
    let begun = Instant::now();
    batch();
    begun.elapsed().as_nanos() as f64 / (STATES * PASSES) as f64
}

/// Time per call of two calls, ns: the medians of batches in turns. A call is given the number of the state, below
/// [`STATES`], that it takes.
pub fn side_by_side(mut one: impl FnMut(usize), mut other: impl FnMut(usize)) -> (f64, f64) {
    let (mut times_of_one, mut times_of_other) = (Vec::new(), Vec::new());
    for _ in 0..BATCHES {
        times_of_one.push(nanoseconds_per_state(&mut one));
        times_of_other.push(nanoseconds_per_state(&mut other));
    }
    (median(times_of_one), median(times_of_other))
}

fn nanoseconds_per_state(call: &mut impl FnMut(usize)) -> f64 {
    let begun = Instant::now();
    for _ in 0..PASSES {
        (0..STATES).for_each(&mut *call);
    }
    begun.elapsed().as_nanos() as f64 / (STATES * PASSES) as f64
}

/// The middle one of the values.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Coordinates, velocities, and accelerations or forces.
struct State<M: TreeDynamics<f64>> {
    q: M::Coordinates,
    v: M::Velocities,
    input: M::Velocities,
}

/// States spread evenly over ±π rad, ±3 rad/s and ±10 rad/s² or N m: multiples of the golden ratio, without whole
/// parts.
fn states<M: TreeDynamics<f64>>(mechanism: &M) -> Vec<State<M>> {
    const GOLDEN: f64 = 1.618_033_988_749_895;
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    let mut count = 0.0;
    let mut next = |bound: f64| {
        count += 1.0;
        bound * (2.0 * (count * GOLDEN).fract() - 1.0)
    };
    let mut state = || State {
        q: M::Coordinates::from_fn(nq, |_| next(std::f64::consts::PI)),
        v: M::Velocities::from_fn(nv, |_| next(3.0)),
        input: M::Velocities::from_fn(nv, |_| next(10.0)),
    };
    (0..STATES).map(|_| state()).collect()
}
