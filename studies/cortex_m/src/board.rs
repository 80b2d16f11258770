//! A Cortex-M4F without an operating system, under QEMU: its start, its timer, and a way to print.

use crate::robots::{self, CALLS, Numbers, Visitor};
use core::arch::{asm, global_asm};
use core::fmt::Write;
use core::hint::black_box;
use core::mem::MaybeUninit;
use core::ptr::{read_volatile, write_volatile};

// The processor begins with the stack pointer and the address that lie at address 0. The code enables the
// floating-point unit (CPACR) before anything uses it.
global_asm!(
    ".section .vectors, \"a\"",
    ".word stack_top",
    ".word reset",
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
/// SysTick counts 24 bits down.
const MOST_TICKS: u32 = 0xff_ffff;

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    // Safety: these are the timer's registers, and nothing else uses it.
    unsafe {
        write_volatile(SYSTICK[1], MOST_TICKS);
        write_volatile(SYSTICK[2], 0);
        write_volatile(SYSTICK[0], 0b101);
    }
    robots::visit_all(&mut Counts);
    exit(0)
}

struct Counts;

impl Visitor for Counts {
    fn visit<I, R: Numbers>(&mut self, name: &str, inputs: &[I; CALLS], function: fn(&I) -> R) {
        let (all, without) = (ticks(inputs, function), ticks(inputs, nothing::<I, R>));
        // At 25 MHz a tick is 40 ns; `-icount shift=6` makes an instruction 64 ns.
        let calls = 64 * CALLS as u32;
        let instructions = (40 * (all - without) + calls / 2) / calls;
        // Nothing can be done where printing fails.
        let _ = writeln!(Console, "{name} {instructions}\n{name}: {:016x}", robots::hash(inputs, function));
    }
}

/// Ticks of a call for each of `inputs`.
#[inline(never)]
fn ticks<I, R>(inputs: &[I; CALLS], function: fn(&I) -> R) -> u32 {
    let start = now();
    for input in inputs {
        black_box(black_box(function)(input));
    }
    start.wrapping_sub(now()) & MOST_TICKS
}

/// What a call costs in which nothing is done.
#[inline(never)]
fn nothing<I, R>(_: &I) -> MaybeUninit<R> {
    MaybeUninit::uninit()
}

fn now() -> u32 {
    // Safety: reading the timer changes nothing.
    unsafe { read_volatile(SYSTICK[2]) }
}

/// What QEMU prints.
struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for byte in text.bytes() {
            semihosting(0x03, &raw const byte as usize);
        }
        Ok(())
    }
}

/// Ends QEMU: `ADP_Stopped_ApplicationExit` is a success, any other reason a failure.
fn exit(code: usize) -> ! {
    semihosting(0x18, if code == 0 { 0x2_0026 } else { 0x2_0023 });
    loop {}
}

fn semihosting(operation: usize, argument: usize) {
    // Safety: QEMU takes what the operation says; none of those used here writes to memory.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument, options(nostack)) }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    exit(1)
}
