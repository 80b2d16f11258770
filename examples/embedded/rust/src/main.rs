//! The KR5 under computed torque at 1 kHz. Every millisecond the controller takes a sample and sets torques, which stay
//! until the next one; the robot, which is simulated here, moves on.
//!
//! On the board the program does not link if a panic is left in it.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod controller;

use core::hint::black_box;
use core::mem::MaybeUninit;

use board::{TICKS_PER_MS, instructions, print, stack_of, ticks};
use controller::{Joints, Kr5, Real, control, desired_motion};

const SAMPLES: u32 = 1000;
const PERIOD: Real = 1e-3;
/// The robot starts 5° beside the motion in every joint, and not at rest.
const START: Joints = [0.087_266_462_599_716_47; Kr5::NV];
const START_VELOCITY: Joints = [0.0, 0.4, 0.8, -0.4, -0.8, -1.2];

#[cfg(target_os = "none")]
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    run()
}

#[cfg(not(target_os = "none"))]
fn main() {
    run()
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        /// Defined nowhere.
        fn a_panic_is_left_in_the_program() -> !;
    }
    // Safety: this is never called, since the program links only if the optimiser finds no way to get here.
    unsafe { a_panic_is_left_in_the_program() }
}

fn run() -> ! {
    let (mut q, mut v) = (START, START_VELOCITY);
    let (mut inverse, mut forward, mut cycle, mut lost) = (0, 0, 0, 0.0);
    board::start(TICKS_PER_MS, true);
    let mut begun = board::wait();
    for sample in 0..=SAMPLES {
        let t = PERIOD * sample as Real;
        let desired = desired_motion(t);
        let name = match sample {
            0 => "error_0",
            100 => "error_100",
            250 => "error_250",
            SAMPLES => "error_1000",
            _ => "",
        };
        if !name.is_empty() {
            print(name, micro(largest(&desired.q, &q)));
            begun = board::wait().wrapping_sub(sample);
        }
        if sample == SAMPLES {
            break;
        }
        // What is measured are the torques; the forward dynamics must give back the acceleration.
        let a: Joints =
            core::array::from_fn(|i| desired.a[i] + 40.0 * (desired.v[i] - v[i]) + 400.0 * (desired.q[i] - q[i]));
        let (empty, _) = measured(nothing, &q, &v, &a);
        let (took, tau) = measured(inverse_dynamics, &q, &v, &a);
        inverse += took - empty;
        let (took, found) = measured(forward_dynamics, &q, &v, &tau);
        forward += took - empty;
        let difference = largest(&a, &found);
        lost = if difference <= lost { lost } else { difference };
        let start = ticks();
        let tau = black_box(control)(t, &q, &v);
        cycle += ticks() - start;
        (q, v) = moved(&q, &v, &tau);
        if board::wait() != begun.wrapping_add(sample + 1) {
            print("late_at", sample);
            board::exit(1);
        }
    }
    print("inverse", instructions(inverse, SAMPLES));
    print("forward", instructions(forward, SAMPLES));
    print("cycle", instructions(cycle, SAMPLES));
    print("lost", micro(lost));
    print("bits", bits(&[q, v]));
    print("stack_inverse", stack_of(|| called(inverse_dynamics)));
    print("stack_forward", stack_of(|| called(forward_dynamics)));
    print("stack_cycle", stack_of(|| called(|q, v, _| control(0.5, q, v))));
    board::exit(0)
}

#[inline(never)]
fn inverse_dynamics(q: &Joints, v: &Joints, a: &Joints) -> Joints {
    Kr5::inverse_dynamics(q, v, a)
}

#[inline(never)]
fn forward_dynamics(q: &Joints, v: &Joints, tau: &Joints) -> Joints {
    Kr5::forward_dynamics(q, v, tau)
}

/// What a call costs in which nothing is done.
#[inline(never)]
fn nothing(_: &Joints, _: &Joints, _: &Joints) -> MaybeUninit<Joints> {
    MaybeUninit::uninit()
}

type Function<R> = fn(&Joints, &Joints, &Joints) -> R;

/// The ticks of a call and its result.
#[inline(never)]
fn measured<R>(function: Function<R>, q: &Joints, v: &Joints, u: &Joints) -> (u32, R) {
    let start = ticks();
    let result = black_box(black_box(function)(q, v, u));
    (ticks() - start, result)
}

/// Calls a function of which the compiler does not know the arguments.
fn called(function: Function<Joints>) {
    let [q, v, u] = black_box([START; 3]);
    black_box(black_box(function)(&q, &v, &u));
}

/// The robot one period later: a step of the classical Runge-Kutta method.
fn moved(q: &Joints, v: &Joints, tau: &Joints) -> (Joints, Joints) {
    let (mut dq, mut dv) = ([0.0; Kr5::NV], [0.0; Kr5::NV]);
    let (mut sum_q, mut sum_v) = (dq, dv);
    for (step, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let at = |start: &Joints, rate: &Joints| core::array::from_fn(|i| start[i] + step * PERIOD * rate[i]);
        let (at_q, at_v) = (at(q, &dq), at(v, &dv));
        (dq, dv) = (at_v, forward_dynamics(&at_q, &at_v, tau));
        sum_q = core::array::from_fn(|i| sum_q[i] + weight * dq[i]);
        sum_v = core::array::from_fn(|i| sum_v[i] + weight * dv[i]);
    }
    let end = |start: &Joints, sum: &Joints| core::array::from_fn(|i| start[i] + PERIOD / 6.0 * sum[i]);
    (end(q, &sum_q), end(v, &sum_v))
}

fn largest(x: &Joints, y: &Joints) -> Real {
    // NaN is taken as well.
    x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, |largest, x| if x <= largest { largest } else { x })
}

/// A number in millionths; the largest integer for one that is too large or not a number.
fn micro(x: Real) -> u32 {
    if x < 4000.0 { (1e6 * x + 0.5) as u32 } else { u32::MAX }
}

/// All bits of the state (FNV-1a).
fn bits(state: &[Joints; 2]) -> u32 {
    let bytes = state.iter().flatten().flat_map(|number| number.to_le_bytes());
    bytes.fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}
