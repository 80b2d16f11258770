//! Counts the instructions of calls on a Cortex-M4F under QEMU.

use crate::robots::{self, CALLS, Numbers, Visitor};
use board::{Console, MOST_TICKS, exit, instructions};
use core::fmt::Write;
use core::hint::black_box;
use core::mem::MaybeUninit;

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    board::start(MOST_TICKS, false);
    robots::visit_all(&mut Counts);
    exit(0)
}

struct Counts;

impl Visitor for Counts {
    fn visit<I, R: Numbers>(&mut self, name: &str, inputs: &[I; CALLS], function: fn(&I) -> R) {
        let (all, without) = (ticks(inputs, function), ticks(inputs, nothing::<I, R>));
        let count = instructions(all - without, CALLS as u32);
        // Nothing can be done where printing fails.
        let _ = writeln!(Console, "{name} {count}\n{name}: {:016x}", robots::hash(inputs, function));
    }
}

/// Ticks of a call for each of `inputs`.
#[inline(never)]
fn ticks<I, R>(inputs: &[I; CALLS], function: fn(&I) -> R) -> u32 {
    let start = board::ticks();
    for input in inputs {
        black_box(black_box(function)(input));
    }
    board::ticks().wrapping_sub(start) % MOST_TICKS
}

/// What a call costs in which nothing is done.
#[inline(never)]
fn nothing<I, R>(_: &I) -> MaybeUninit<R> {
    MaybeUninit::uninit()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    exit(1)
}
