//! What a Cortex-M needs to start without operating system, standard library or allocator, and to say what it did:
//! start-up, printing through the semihosting of a debugger or an emulator, the timer that counts instructions,
//! the painted stack. Knows no controller.
//!
//! Instructions are counted by the SysTick timer. Under QEMU with `-icount shift=0` an
//! instruction takes a nanosecond and a tick of the 25 MHz clock 40 of them.

use core::arch::{asm, global_asm};
use core::hint::black_box;
use core::panic::PanicInfo;
use core::ptr::{addr_of, read_volatile, write_volatile};

/// Calls over which instructions are averaged.
const CALLS: u32 = 200;
/// What the stack is painted with.
const PAINT: u32 = 0xa5a5_5a5a;
/// Instructions per tick of the timer.
const INSTRUCTIONS_PER_TICK: u32 = 40;

const SYSTICK_CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
const SYSTICK_RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
const SYSTICK_CURRENT: *mut u32 = 0xe000_e018 as *mut u32;
/// The timer counts down from here.
const SYSTICK_LARGEST: u32 = 0x00ff_ffff;

// The vector table, and what runs first: the floating-point unit is switched on before any
// code that may use it.
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
    /// Is nowhere defined: a program with a panic left in it does not link.
    fn a_panic_is_left_in_the_program() -> !;
    static stack_bottom: u32;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: never linked, so never called.
    unsafe { a_panic_is_left_in_the_program() }
}

/// Asks the debugger or emulator for a service.
fn semihosting(operation: u32, argument: usize) {
    // SAFETY: the host reads at most the string or the word that `argument` is about.
    unsafe {
        asm!("bkpt #0xab", inout("r0") operation => _, in("r1") argument, options(nostack));
    }
}

/// Writes a line of a name and a number of so many hexadecimal digits.
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

/// Ticks that `work` takes.
#[inline(never)]
fn ticks(mut work: impl FnMut()) -> u32 {
    // SAFETY: the registers of the timer, which nothing else uses.
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

/// Instructions of one of `CALLS` calls, the loop around them not counted.
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

/// The address of the lowest word of the stack.
fn bottom() -> *mut u32 {
    addr_of!(stack_bottom).cast_mut()
}

/// Where the stack ends now.
#[inline(always)]
fn stack_pointer() -> usize {
    let pointer: usize;
    // SAFETY: reads a register.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack)) };
    pointer
}

/// Bytes of stack that `work` takes below its caller.
#[inline(never)]
pub fn stack_depth(work: impl FnOnce()) -> u32 {
    let here = stack_pointer();
    let mut place = bottom();
    while (place as usize) < here {
        // SAFETY: below the stack pointer and above the program's data.
        unsafe {
            write_volatile(place, PAINT);
            place = place.add(1);
        }
    }
    work();
    let mut place = bottom();
    // SAFETY: as above.
    unsafe {
        while (place as usize) < here && read_volatile(place) == PAINT {
            place = place.add(1);
        }
    }
    (here - place as usize) as u32
}

/// The program ends.
pub fn end() -> ! {
    semihosting(0x18, 0x2_0026);
    loop {}
}
