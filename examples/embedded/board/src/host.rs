//! This machine instead of the board.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

static MILLISECONDS: AtomicU32 = AtomicU32::new(0);

/// The standard output.
pub struct Console;

impl core::fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        print!("{text}");
        Ok(())
    }
}

/// The host has no timer: `wait` counts its calls.
pub fn start(_: u32, _: bool) {}

/// The number of calls.
pub fn wait() -> u32 {
    MILLISECONDS.fetch_add(1, Relaxed) + 1
}

/// No time passes.
pub fn ticks() -> u32 {
    0
}

/// Calls the function; how much stack it takes is not known.
pub fn stack_of(call: fn()) -> u32 {
    call();
    0
}

/// Ends the program.
pub fn exit(code: usize) -> ! {
    std::process::exit(code as i32)
}
