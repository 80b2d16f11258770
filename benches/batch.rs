//! States per second in batches: in lanes, and from 513 states on, on all cores.
//!
//! `cargo bench --bench batch -- kr5/inverse`; a name is `robot/function/scalar/states`. Times are for a batch,
//! elements per second are states. The first line of output names the processor that they belong to.

#[path = "../examples/common/processor.rs"]
mod processor;
#[allow(dead_code)]
#[path = "../tests/common/random.rs"]
mod random;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use random::Random;
use redysim::batch::{self, Batched};
use redysim::redysim;
use std::f64::consts::PI;
use std::hint::black_box;

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    struct Kr5("../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    struct Gripper("../models/peers/gripper.toml");
}

/// The most on one thread, and enough for every core.
const SIZES: [usize; 2] = [batch::SERIAL, 65_536];

/// The same numbers within ±`bound` in every run.
fn drawn<T: Batched, const N: usize>(count: usize, bound: f64) -> Vec<[T; N]> {
    let mut random = Random::new(bound.to_bits());
    (0..count).map(|_| core::array::from_fn(|_| T::from_f64(random.within(bound)))).collect()
}

/// A macro, since code that is generic over mechanisms cannot name the lanes that a batch may choose.
macro_rules! batches {
    ($criterion:ident, $robot:literal, $mechanism:ident, $scalar:ident) => {
        for size in SIZES {
            type States = Vec<[$scalar; $mechanism::NV]>;
            let (q, v, input): (States, States, States) = (drawn(size, PI), drawn(size, 3.0), drawn(size, 10.0));
            let mut found = input.clone();
            let mut group = $criterion.benchmark_group(concat!($robot, "/inverse_dynamics"));
            group.throughput(Throughput::Elements(size as u64));
            group.bench_function(BenchmarkId::new(stringify!($scalar), size), |bencher| {
                bencher.iter(|| batch::inverse_dynamics(&$mechanism, black_box(&q), &v, &input, black_box(&mut found)));
            });
            group.finish();
            let mut group = $criterion.benchmark_group(concat!($robot, "/forward_dynamics"));
            group.throughput(Throughput::Elements(size as u64));
            group.bench_function(BenchmarkId::new(stringify!($scalar), size), |bencher| {
                bencher.iter(|| batch::forward_dynamics(&$mechanism, black_box(&q), &v, &input, black_box(&mut found)));
            });
            group.finish();
        }
    };
}

fn all(criterion: &mut Criterion) {
    batches!(criterion, "kr5", Kr5, f64);
    batches!(criterion, "kr5", Kr5, f32);
    batches!(criterion, "gripper", Gripper, f64);
    batches!(criterion, "gripper", Gripper, f32);
}

criterion_group!(batch_throughput, all);

fn main() {
    println!("processor: {}", processor::described());
    batch_throughput();
    Criterion::default().configure_from_args().final_summary();
}
