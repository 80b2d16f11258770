//! Every one of the 2³² bit patterns of `f32`, against the sine and cosine of `f64`, which are exact beside it.

use super::Worst;
use redysim_runtime::Scalar;
use redysim_runtime::lanes::{F32x4, F32x8, F32x16, Lanes};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

/// Up to this many radians a smaller error is promised.
const NEAR: f32 = 1e5;
/// What is promised of these and of all, in units in the last place.
const PROMISED: [f64; 2] = [1.0, 2.0];
/// One thread takes 2¹⁶ angles at a time.
const CHUNKS: u32 = 1 << 16;

/// The largest errors, of sine and cosine, of those up to 10⁵ and of all.
type Errors = [[Worst; 2]; 2];

/// Tries all of them, and prints the largest errors.
pub fn exhaustive() {
    let (next, worst) = (AtomicU32::new(0), Mutex::new(Errors::default()));
    let work = || {
        let mut mine = Errors::default();
        loop {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= CHUNKS {
                break;
            }
            for sixteenth in 0..1 << 12 {
                let bits = (chunk << 16) | (sixteenth << 4);
                sixteen(core::array::from_fn(|lane| f32::from_bits(bits + lane as u32)), sixteenth, &mut mine);
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
    let worst = worst.into_inner().expect("no thread panics");
    for (name, [sin, cos]) in ["up to 10⁵, every one", "every finite number"].iter().zip(worst) {
        println!("| {name} | {:.4} | {:e} | {:.4} | {:e} |", sin.ulp, sin.at, cos.ulp, cos.at);
    }
    for (worst, promised) in worst.iter().zip(PROMISED) {
        assert!(worst.iter().all(|worst| worst.ulp <= promised), "more than {promised} units in the last place");
    }
}

/// Sines and cosines as bits, those of NaN all alike.
fn bits<const N: usize>((sines, cosines): ([f32; N], [f32; N])) -> [[u32; 2]; N] {
    let bits = |number: f32| if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() };
    core::array::from_fn(|index| [bits(sines[index]), bits(cosines[index])])
}

fn sixteen(angles: [f32; 16], turn: u32, worst: &mut Errors) {
    let alone = angles.map(Scalar::sin_cos);
    for (angle, found) in angles.into_iter().zip(alone) {
        if angle.is_finite() {
            let truth = Scalar::sin_cos(f64::from(angle));
            for (index, (found, truth)) in [(found.0, truth.0), (found.1, truth.1)].into_iter().enumerate() {
                let error = (f64::from(found) - truth).abs() / place(truth);
                let error = if error.is_nan() { f64::INFINITY } else { error };
                worst[1][index].see(error, f64::from(angle));
                if angle.abs() <= NEAR {
                    worst[0][index].see(error, f64::from(angle));
                }
            }
        } else {
            assert!(found.0.is_nan() && found.1.is_nan(), "{angle}");
        }
    }
    let alone = bits((alone.map(|(sin, _)| sin), alone.map(|(_, cos)| cos)));
    lanes::<F32x16, 16>(&angles, &alone);
    lanes::<F32x8, 8>(&angles, &alone);
    lanes::<F32x4, 4>(&angles, &alone);
    match turn % 3 {
        0 => {
            list::<3>(&angles, &alone, 0);
            list::<5>(&angles, &alone, 3);
            list::<8>(&angles, &alone, 8);
        }
        1 => {
            list::<1>(&angles, &alone, 0);
            list::<2>(&angles, &alone, 1);
            list::<6>(&angles, &alone, 3);
            list::<7>(&angles, &alone, 9);
        }
        _ => {
            list::<4>(&angles, &alone, 0);
            list::<12>(&angles, &alone, 4);
        }
    }
}

/// In lanes all have the bits that they have alone.
fn lanes<L: Lanes<f32, W>, const W: usize>(angles: &[f32; 16], alone: &[[u32; 2]; 16]) {
    for (angles, alone) in angles.as_chunks::<W>().0.iter().zip(alone.as_chunks::<W>().0) {
        let (sin, cos) = L::from(*angles).sin_cos();
        assert_eq!(bits((sin.into(), cos.into())), *alone, "{angles:?}");
    }
}

/// In a list of `N` from `start` on all have the bits that they have alone.
fn list<const N: usize>(angles: &[f32; 16], alone: &[[u32; 2]; 16], start: usize) {
    let (angles, alone) = (&angles[start..start + N], &alone[start..start + N]);
    let found = bits(Scalar::sin_cos_all::<N>(angles.try_into().expect("as many")));
    assert_eq!(found, *alone, "{angles:?}");
}

/// The distance between neighbouring `f32` about `value`.
fn place(value: f64) -> f64 {
    let exponent = ((value.abs().to_bits() >> 52) as i32) - 1023;
    f64::from_bits(((1023 + (exponent - 23).max(-149)) as u64) << 52)
}
