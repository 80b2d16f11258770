//! How long sines and cosines take, and the dynamics of the KR5 in lanes and in batches: ns, the shortest of many runs.
//!
//! `cargo run --release --bin speed`, with `RUSTFLAGS="-C target-cpu=x86-64-v3"` for AVX2, `=native` for what there is.

use redysim::batch;
use redysim::lanes::{F32x8, F32x16, F64x2, F64x4, F64x8, pack, unpack};
use redysim::{Scalar, redysim};
use std::hint::black_box;
use std::time::Instant;

redysim! {
    /// The KUKA KR5 of the ReDySim paper.
    struct Kr5("../../../../models/kr5.toml");
}

/// Keeps the compiler from leaving out an unused result.
fn done<T>(value: T) {
    black_box(value);
}

/// Nanoseconds of one call.
fn time(mut call: impl FnMut()) -> f64 {
    let (mut shortest, mut calls) = (f64::MAX, 1_u32);
    for _ in 0..40 {
        let start = Instant::now();
        for _ in 0..calls {
            call();
        }
        let seconds = start.elapsed().as_secs_f64();
        shortest = shortest.min(seconds * 1e9 / f64::from(calls));
        if seconds < 2e-3 {
            calls *= 2;
        }
    }
    shortest
}

#[inline(never)]
fn list<S: Scalar, const N: usize>(angles: &[S; N]) -> ([S; N], [S; N]) {
    S::sin_cos_all(*angles)
}

fn lists<const N: usize>() {
    let angles: [f64; N] = core::array::from_fn(|index| 0.3 + 0.7 * index as f64);
    let single = angles.map(|angle| angle as f32);
    let double = time(|| done(list(black_box(&angles))));
    let single = time(|| done(list(black_box(&single))));
    println!("sin_cos_all of {N}: f64 {double:5.1}, f32 {single:5.1}");
}

#[inline(never)]
fn inverse<S: Scalar>(q: &[S; 6], v: &[S; 6], a: &[S; 6]) -> [S; 6] {
    Kr5::inverse_dynamics(q, v, a)
}

#[inline(never)]
fn forward<S: Scalar>(q: &[S; 6], v: &[S; 6], tau: &[S; 6]) -> [S; 6] {
    Kr5::forward_dynamics(q, v, tau)
}

fn lanes<S: Scalar>(name: &str, width: usize) {
    let [q, v, u] = [0.1, -0.3, 0.7].map(|start| core::array::from_fn(|i| S::from_f64(start + 0.3 * i as f64)));
    let inverse = time(|| done(inverse(black_box(&q), black_box(&v), black_box(&u)))) / width as f64;
    let forward = time(|| done(forward(black_box(&q), black_box(&v), black_box(&u)))) / width as f64;
    println!("KR5 in {name:6}: inverse {inverse:5.1}, forward {forward:5.1} for one state");
}

#[inline(never)]
fn packed(states: &[[f64; 6]; 8]) -> [F64x8; 6] {
    pack(states)
}

#[inline(never)]
fn unpacked(lanes: &[F64x8; 6]) -> [[f64; 6]; 8] {
    unpack(*lanes)
}

/// A macro, since code that is generic over numbers cannot name the lanes that a batch may choose.
macro_rules! batches {
    ($number:ident) => {
        for count in [8, 512, 1024, 4096, 65536] {
            let number = |index: usize| $number::from_f64(3.0 * (0.37 * index as f64).sin());
            let states: Vec<[$number; 6]> =
                (0..count).map(|i| core::array::from_fn(|j| number(6 * i + j))).collect();
            let mut found = states.clone();
            let inverse =
                time(|| batch::inverse_dynamics(&Kr5, &states, &states, &states, &mut found).expect("lengths"));
            let forward =
                time(|| batch::forward_dynamics(&Kr5, &states, &states, &states, &mut found).expect("lengths"));
            let [inverse, forward] = [inverse, forward].map(|time| time / count as f64);
            let name = stringify!($number);
            println!("batch of {count:5} {name}: inverse {inverse:5.1}, forward {forward:5.1} for one state");
        }
    };
}

fn main() {
    lists::<1>();
    lists::<2>();
    lists::<3>();
    lists::<4>();
    lists::<5>();
    lists::<6>();
    lists::<7>();
    lists::<8>();
    lanes::<f64>("f64", 1);
    lanes::<f32>("f32", 1);
    lanes::<F64x2>("F64x2", 2);
    lanes::<F64x4>("F64x4", 4);
    lanes::<F64x8>("F64x8", 8);
    lanes::<F32x8>("F32x8", 8);
    lanes::<F32x16>("F32x16", 16);
    let states = [[0.1; 6]; 8];
    let lanes = packed(&states);
    println!("eight states of six into F64x8: {:.1}", time(|| done(packed(black_box(&states)))));
    println!("and out of them: {:.1}", time(|| done(unpacked(black_box(&lanes)))));
    println!("{} threads", std::thread::available_parallelism().map_or(1, usize::from));
    batches!(f64);
    batches!(f32);
}
