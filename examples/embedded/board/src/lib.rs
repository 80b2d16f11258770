//! What a program needs of a board: a millisecond, a clock, a measure of the stack, and a way to print. The board is a
//! Cortex-M with a floating-point unit under QEMU; elsewhere it is this machine, where no time passes.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(target_os = "none")]
mod cortex_m;
#[cfg(not(target_os = "none"))]
mod host;

#[cfg(target_os = "none")]
pub use cortex_m::{Console, exit, stack_of, start, ticks, wait};
#[cfg(not(target_os = "none"))]
pub use host::{Console, exit, stack_of, start, ticks, wait};

use core::fmt::Write;

/// Ticks of the timer in a millisecond: it runs at 25 MHz.
pub const TICKS_PER_MS: u32 = 25_000;
/// As many ticks as the timer counts.
pub const MOST_TICKS: u32 = 1 << 24;

/// Instructions of each of the calls that have taken the given ticks: a tick is 40 ns, and with `-icount shift=6` QEMU
/// takes 64 ns for an instruction.
#[must_use]
pub const fn instructions(ticks: u32, calls: u32) -> u32 {
    (40 * ticks + 32 * calls) / (64 * calls)
}

/// Prints a line: a name and a number. No formatting of `core` is involved, and so none of its panics.
pub fn print(name: &str, mut number: u32) {
    let mut digits = [b'0'; 10];
    let mut len = 0;
    for digit in digits.iter_mut().rev() {
        *digit += (number % 10) as u8;
        number /= 10;
        len += 1;
        if number == 0 {
            break;
        }
    }
    let written = digits.get(digits.len() - len..).and_then(|digits| core::str::from_utf8(digits).ok());
    for part in [name, " ", written.unwrap_or_default(), "\n"] {
        // Nothing can be done where printing fails.
        let _ = Console.write_str(part);
    }
}
