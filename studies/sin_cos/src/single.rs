//! Every finite `f32`, against the sine and cosine of `f64`, which are exact beside it.

use super::Worst;
use redysim_runtime::Scalar;
use redysim_runtime::lanes::{F32x8, F32x16};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

/// Up to this many radians a smaller error is promised.
const NEAR: f32 = 1e5;
/// The angles that one thread takes at a time.
const CHUNK: u32 = 1 << 16;

/// Measures all of them, and prints the largest errors of those up to 10⁵ and of all.
pub fn exhaustive() {
    let (next, worst) = (AtomicU32::new(0), Mutex::new([[Worst::default(); 2]; 2]));
    let work = || {
        let mut mine = [[Worst::default(); 2]; 2];
        loop {
            let start = next.fetch_add(CHUNK, Ordering::Relaxed);
            if start >= f32::INFINITY.to_bits() {
                break;
            }
            for bits in (start..start + CHUNK).step_by(16) {
                sixteen(core::array::from_fn(|lane| f32::from_bits(bits + lane as u32)), &mut mine);
            }
        }
        let mut all = worst.lock().expect("no thread panics");
        for (all, mine) in all.as_flattened_mut().iter_mut().zip(mine.as_flattened()) {
            all.see(mine.ulp, mine.at);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    println!("| f32 arguments | sine, ulp | at | cosine, ulp | at |");
    println!("|---|---|---|---|---|");
    for (name, [sin, cos]) in ["up to 10⁵, every one", "every finite number"].iter().zip(*worst.lock().expect("done"))
    {
        println!("| {name} | {:.4} | {:e} | {:.4} | {:e} |", sin.ulp, sin.at, cos.ulp, cos.at);
    }
}

fn sixteen(angles: [f32; 16], worst: &mut [[Worst; 2]; 2]) {
    let (sines, cosines) = F32x16::from(angles).sin_cos();
    let (sines, cosines) = (sines.to_array(), cosines.to_array());
    let eight = F32x8::from(core::array::from_fn(|lane| -angles[lane])).sin_cos();
    let (minus_sines, same_cosines) = (eight.0.to_array(), eight.1.to_array());
    for (lane, angle) in angles.into_iter().enumerate() {
        let found = (sines[lane], cosines[lane]);
        assert_eq!(Scalar::sin_cos(angle), found, "{angle:e}");
        if lane < 8 {
            assert_eq!((-minus_sines[lane], same_cosines[lane]), found, "{angle:e}");
        }
        let truth = Scalar::sin_cos(f64::from(angle));
        for (index, (found, truth)) in [(found.0, truth.0), (found.1, truth.1)].into_iter().enumerate() {
            let error = (f64::from(found) - truth).abs() / place(truth);
            worst[1][index].see(error, f64::from(angle));
            if angle <= NEAR {
                worst[0][index].see(error, f64::from(angle));
            }
        }
    }
}

/// The distance between neighbouring `f32` about `value`.
fn place(value: f64) -> f64 {
    let exponent = ((value.abs().to_bits() >> 52) as i32) - 1023;
    f64::from_bits(((1023 + (exponent - 23).max(-149)) as u64) << 52)
}
