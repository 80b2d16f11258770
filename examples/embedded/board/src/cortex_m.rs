//! A Cortex-M with a floating-point unit, without an operating system, under QEMU.

use core::arch::{asm, global_asm};
use core::fmt::Write;
use core::ptr::{read_volatile, write_volatile};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

// The processor begins with the stack pointer and the address that lie at address 0; entry 15 is the timer's. The code
// enables the floating-point unit (CPACR) before anything uses it, and calls the program's `main`.
global_asm!(
    ".section .vectors, \"a\"",
    ".word stack_top",
    ".word reset",
    ".skip 52",
    ".word millisecond",
    ".section .text.reset, \"ax\"",
    ".global reset",
    ".thumb_func",
    "reset:",
    "ldr r0, =0xe000ed88",
    "ldr r1, [r0]",
    "orr r1, r1, #(0xf << 20)",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl main",
);

/// Control, reload value and current value of SysTick.
const SYSTICK: [*mut u32; 3] = [0xe000_e010 as *mut u32, 0xe000_e014 as *mut u32, 0xe000_e018 as *mut u32];
/// What is painted below the stack, and how many words of it: more than any call here takes.
const PAINT: u32 = 0xfeed_beef;
const PAINTED: usize = 2048;

static MILLISECONDS: AtomicU32 = AtomicU32::new(0);

/// The timer's interrupt, the only one: nothing else writes at the same time.
#[unsafe(no_mangle)]
extern "C" fn millisecond() {
    MILLISECONDS.store(MILLISECONDS.load(Relaxed).wrapping_add(1), Relaxed);
}

/// Starts the timer, which begins anew every `period` ticks, with an interrupt or without.
pub fn start(period: u32, interrupt: bool) {
    // Safety: these are the timer's registers, and nothing else uses them.
    unsafe {
        write_volatile(SYSTICK[1], period - 1);
        write_volatile(SYSTICK[2], 0);
        write_volatile(SYSTICK[0], if interrupt { 0b111 } else { 0b101 });
    }
}

/// Sleeps until the next interrupt of the timer, and returns how many there were.
pub fn wait() -> u32 {
    let before = MILLISECONDS.load(Relaxed);
    loop {
        // Safety: the processor sleeps until an interrupt comes.
        unsafe { asm!("wfi", options(nostack)) };
        let now = MILLISECONDS.load(Relaxed);
        if now != before {
            return now;
        }
    }
}

/// Ticks of the timer since its period began.
pub fn ticks() -> u32 {
    // Safety: reading the timer changes nothing.
    unsafe { read_volatile(SYSTICK[1]) - read_volatile(SYSTICK[2]) }
}

/// The bytes of stack that a call takes: it paints what lies below the stack, and looks how much of the paint is left.
/// An interrupt would be seen, too, and is held back.
#[inline(never)]
pub fn stack_of(call: fn()) -> u32 {
    let top: *mut u32;
    // Safety: memory below the stack pointer is free as long as no interrupt comes, and there is more of it than is
    // painted.
    unsafe {
        asm!("cpsid i", "mov {}, sp", out(reg) top);
        for word in 1..=PAINTED {
            write_volatile(top.sub(word), PAINT);
        }
        call();
        let mut left = 0;
        while left < PAINTED && read_volatile(top.sub(PAINTED - left)) == PAINT {
            left += 1;
        }
        asm!("cpsie i");
        4 * (PAINTED - left) as u32
    }
}

/// What QEMU prints.
pub struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for byte in text.bytes() {
            semihosting(0x03, &raw const byte as usize);
        }
        Ok(())
    }
}

/// Ends QEMU: `ADP_Stopped_ApplicationExit` is a success, any other reason a failure.
pub fn exit(code: usize) -> ! {
    semihosting(0x18, if code == 0 { 0x2_0026 } else { 0x2_0023 });
    loop {}
}

fn semihosting(operation: usize, argument: usize) {
    // Safety: QEMU takes what the operation says; none of those used here writes to memory.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument, options(nostack)) }
}
