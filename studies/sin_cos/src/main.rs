//! The largest errors of sine and cosine, in units in the last place of the true value, against MPFR.
//!
//! `cargo run --release -- [arguments per range]`, with and without `RUSTFLAGS="-C target-cpu=native"`. All arguments
//! are also sent through every width of lanes, which must give the same bits; so one table holds for all.

mod arguments;
mod single;
mod truth;

use arguments::Range;
use redysim_runtime::Scalar;
use redysim_runtime::lanes::{F64x2, F64x4, F64x8};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use truth::Truth;

/// The largest error of a range, and where it is.
#[derive(Clone, Copy, Default)]
struct Worst {
    ulp: f64,
    at: f64,
}

impl Worst {
    fn see(&mut self, ulp: f64, at: f64) {
        if ulp > self.ulp {
            *self = Self { ulp, at };
        }
    }
}

fn main() {
    let count = std::env::args().nth(1).map_or(10_000_000, |count| count.parse().expect("a number of arguments"));
    println!("fused multiply-add: {}", redysim_runtime::FUSED);
    println!("| f64 arguments | how many | sine, ulp | at | cosine, ulp | at |");
    println!("|---|---|---|---|---|---|");
    for range in Range::ALL {
        let count = range.count(count);
        let [sin, cos] = measured(range, count);
        println!("| {} | {count} | {:.4} | {:e} | {:.4} | {:e} |", range.name(), sin.ulp, sin.at, cos.ulp, cos.at);
    }
    single::exhaustive();
}

/// The arguments that one thread takes at a time.
const CHUNK: usize = 8192;

fn measured(range: Range, count: usize) -> [Worst; 2] {
    let (next, worst) = (AtomicUsize::new(0), Mutex::new([Worst::default(); 2]));
    let work = || {
        let (mut truth, mut mine) = (Truth::new(), [Worst::default(); 2]);
        loop {
            let start = next.fetch_add(CHUNK, Ordering::Relaxed);
            if start >= count {
                break;
            }
            let angles: Vec<f64> = (start..count.min(start + CHUNK)).map(|index| range.argument(index)).collect();
            for eight in angles.chunks_exact(8) {
                lanes_agree(eight.try_into().expect("eight"));
            }
            for angle in angles {
                let (sin, cos) = Scalar::sin_cos(angle);
                let errors = truth.errors(angle, sin, cos);
                mine[0].see(errors[0], angle);
                mine[1].see(errors[1], angle);
            }
        }
        let mut all = worst.lock().expect("no thread panics");
        for (all, mine) in all.iter_mut().zip(mine) {
            all.see(mine.ulp, mine.at);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    worst.into_inner().expect("no thread panics")
}

/// Every width of lanes, and lists of most lengths up to eight, give the bits of one angle at a time.
fn lanes_agree(angles: [f64; 8]) {
    let alone = angles.map(Scalar::sin_cos).map(|(sin, cos)| (sin.to_bits(), cos.to_bits()));
    let check = |sines: &[f64], cosines: &[f64]| {
        for (index, (sin, cos)) in sines.iter().zip(cosines).enumerate() {
            assert_eq!((sin.to_bits(), cos.to_bits()), alone[index], "{:e}", angles[index]);
        }
    };
    let [a, b, c, d, e, f, g, h] = angles;
    let (sin, cos) = F64x2::from([a, b]).sin_cos();
    check(&sin.to_array(), &cos.to_array());
    let (sin, cos) = F64x4::from([a, b, c, d]).sin_cos();
    check(&sin.to_array(), &cos.to_array());
    let (sin, cos) = F64x8::from(angles).sin_cos();
    check(&sin.to_array(), &cos.to_array());
    fn list<const N: usize>(angles: [f64; N], check: impl Fn(&[f64], &[f64])) {
        let (sin, cos) = Scalar::sin_cos_all(angles);
        check(&sin, &cos);
    }
    list([a, b, c], check);
    list([a, b, c, d, e], check);
    list([a, b, c, d, e, f], check);
    list([a, b, c, d, e, f, g], check);
    list([a, b, c, d, e, f, g, h], check);
}
