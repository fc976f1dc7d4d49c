//! Start-up code of a Cortex-M without operating system, standard library or allocator, with output through the
//! semihosting of a debugger or emulator, an instruction counter, and stack painting.
//!
//! The SysTick timer counts instructions. In QEMU with `-icount shift=0` an instruction takes 1 ns, and a tick of the
//! 25 MHz clock 40 ns.

use core::arch::{asm, global_asm};
use core::hint::black_box;
use core::panic::PanicInfo;
use core::ptr::{addr_of, read_volatile, write_volatile};

/// Number of calls over which instructions are averaged.
const CALLS: u32 = 200;
/// Pattern of the painted stack.
const PAINT: u32 = 0xa5a5_5a5a;
/// Instructions per tick of the timer.
const INSTRUCTIONS_PER_TICK: u32 = 40;

const SYSTICK_CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
const SYSTICK_RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
const SYSTICK_CURRENT: *mut u32 = 0xe000_e018 as *mut u32;
/// Start value of the timer, which counts down.
const SYSTICK_LARGEST: u32 = 0x00ff_ffff;

// Vector table and reset handler, which enables the floating-point unit before any code uses it.
global_asm!(
    ".section .vectors, \"a\"",
    ".word stack_top",
    ".word reset",
    ".rept 14",
    ".word stopped",
    ".endr",
    ".section .text.reset, \"ax\"",
    ".thumb",
    ".global reset",
    ".type reset, %function",
    ".thumb_func",
    "reset:",
    "ldr r0, =0xe000ed88",
    "ldr r1, [r0]",
    "orr r1, r1, #0xf00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl run",
    ".type stopped, %function",
    ".thumb_func",
    "stopped:",
    "b stopped",
);

unsafe extern "C" {
    /// Undefined symbol. If the program contains a panic, it does not link.
    fn a_panic_is_left_in_the_program() -> !;
    static stack_bottom: u32;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: never linked, so never called.
    unsafe { a_panic_is_left_in_the_program() }
}

/// Calls a service of the debugger or emulator.
fn semihosting(operation: u32, argument: usize) {
    // SAFETY: the host reads at most the string or word at `argument`.
    unsafe {
        asm!("bkpt #0xab", inout("r0") operation => _, in("r1") argument, options(nostack));
    }
}

/// Writes a line with a name and a number of `digits` hexadecimal digits.
pub fn print(name: &[u8; 16], number: u64, digits: usize) {
    let mut line = [0_u8; 40];
    for (place, letter) in line.iter_mut().zip(name) {
        *place = *letter;
    }
    let places = line.iter_mut().skip(name.len()).take(digits);
    for (index, place) in places.enumerate() {
        let digit = (number >> (4 * (digits - 1 - index))) as u8 & 0xf;
        *place = if digit < 10 {
            b'0' + digit
        } else {
            b'a' + digit - 10
        };
    }
    if let Some(end) = line.get_mut(name.len() + digits) {
        *end = b'\n';
    }
    semihosting(0x04, line.as_ptr() as usize);
}

/// Returns the number of timer ticks that `work` takes.
#[inline(never)]
fn ticks(mut work: impl FnMut()) -> u32 {
    // SAFETY: no other code uses the registers of the timer.
    unsafe {
        write_volatile(SYSTICK_RELOAD, SYSTICK_LARGEST);
        write_volatile(SYSTICK_CURRENT, 0);
        write_volatile(SYSTICK_CONTROL, 0b101);
        // The first tick loads the counter.
        while read_volatile(SYSTICK_CURRENT) == 0 {}
        let begin = read_volatile(SYSTICK_CURRENT);
        work();
        begin.wrapping_sub(read_volatile(SYSTICK_CURRENT)) & SYSTICK_LARGEST
    }
}

/// Returns the number of instructions per call, averaged over `CALLS` calls. Instructions of the loop are subtracted.
pub fn instructions(mut call: impl FnMut()) -> u32 {
    let calls = ticks(|| {
        for _ in 0..CALLS {
            call();
        }
    });
    let loop_alone = ticks(|| {
        for _ in 0..CALLS {
            black_box(());
        }
    });
    calls.saturating_sub(loop_alone) * INSTRUCTIONS_PER_TICK / CALLS
}

/// Returns the address of the lowest word of the stack.
fn bottom() -> *mut u32 {
    addr_of!(stack_bottom).cast_mut()
}

/// Returns the stack pointer.
#[inline(always)]
fn stack_pointer() -> usize {
    let pointer: usize;
    // SAFETY: the instruction only reads a register.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack)) };
    pointer
}

/// Returns the number of bytes of stack that `work` uses below its caller.
#[inline(never)]
pub fn stack_depth(work: impl FnOnce()) -> u32 {
    let here = stack_pointer();
    let mut place = bottom();
    while (place as usize) < here {
        // SAFETY: the addresses are between the program's data and the stack pointer.
        unsafe {
            write_volatile(place, PAINT);
            place = place.add(1);
        }
    }
    work();
    let mut place = bottom();
    // SAFETY: the addresses are between the program's data and the stack pointer.
    unsafe {
        while (place as usize) < here && read_volatile(place) == PAINT {
            place = place.add(1);
        }
    }
    (here - place as usize) as u32
}

/// Ends the program.
pub fn end() -> ! {
    semihosting(0x18, 0x2_0026);
    loop {}
}
