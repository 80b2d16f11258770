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
use redysim::{ForwardDynamics, InverseDynamics, redysim};
use std::f64::consts::PI;
use std::hint::black_box;

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    struct Kr5("models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    struct Gripper("models/peers/gripper.toml");
}

/// The most on one thread, and enough for every core.
const SIZES: [usize; 2] = [batch::SERIAL, 65_536];

/// The same numbers within ±`bound` in every run.
fn drawn<T: Batched, const N: usize>(count: usize, bound: f64) -> Vec<[T; N]> {
    let mut random = Random::new(bound.to_bits());
    (0..count).map(|_| core::array::from_fn(|_| T::from_f64(random.within(bound)))).collect()
}

fn batches<T: Batched, M, const N: usize>(criterion: &mut Criterion, robot: &str, scalar: &str, mechanism: &M)
where
    M: InverseDynamics<T::Lanes, Coordinates = [T::Lanes; N], Velocities = [T::Lanes; N]>
        + ForwardDynamics<T::Lanes>
        + Sync,
{
    for size in SIZES {
        let (q, v, input) = (drawn::<T, N>(size, PI), drawn(size, 3.0), drawn(size, 10.0));
        let mut found = input.clone();
        let mut group = criterion.benchmark_group(format!("{robot}/inverse_dynamics"));
        group.throughput(Throughput::Elements(size as u64));
        group.bench_function(BenchmarkId::new(scalar, size), |bencher| {
            bencher.iter(|| batch::inverse_dynamics(mechanism, black_box(&q), &v, &input, black_box(&mut found)));
        });
        group.finish();
        let mut group = criterion.benchmark_group(format!("{robot}/forward_dynamics"));
        group.throughput(Throughput::Elements(size as u64));
        group.bench_function(BenchmarkId::new(scalar, size), |bencher| {
            bencher.iter(|| batch::forward_dynamics(mechanism, black_box(&q), &v, &input, black_box(&mut found)));
        });
        group.finish();
    }
}

fn all(criterion: &mut Criterion) {
    batches::<f64, _, _>(criterion, "kr5", "f64", &Kr5);
    batches::<f32, _, _>(criterion, "kr5", "f32", &Kr5);
    batches::<f64, _, _>(criterion, "gripper", "f64", &Gripper);
    batches::<f32, _, _>(criterion, "gripper", "f32", &Gripper);
}

criterion_group!(batch_throughput, all);

fn main() {
    println!("processor: {}", processor::described());
    batch_throughput();
    Criterion::default().configure_from_args().final_summary();
}
