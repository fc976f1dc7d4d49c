//! Selection of registers, and tasks that are compiled for each kind.

use crate::vector::{Plain, Vector};

/// Computation with lanes, compiled for each kind of register. `run` and all functions of lanes that it calls must be
/// inlined, because a separate function is compiled for the baseline instruction set.
pub trait Task {
    /// Result of the task.
    type Output;
    /// Runs the task. Mark the implementation `#[inline(always)]`.
    fn run<V: Vector>(self) -> Self::Output;
}

/// Kinds of registers, widest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Registers {
    /// One register of 512 bits (AVX-512 F and DQ).
    Wide,
    /// Two registers of 256 bits (AVX2).
    Pair,
    /// Eight plain numbers.
    Plain,
}

impl Registers {
    /// Every kind, widest first.
    pub const ALL: [Self; 3] = [Self::Wide, Self::Pair, Self::Plain];

    /// Returns true if this machine has the registers.
    pub fn are_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Wide => {
                is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Pair => is_x86_feature_detected!("avx2"),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Wide | Self::Pair => false,
            Self::Plain => true,
        }
    }
}

/// Runs a task with the widest registers of this machine.
#[inline]
pub fn run<T: Task>(task: T) -> T::Output {
    for registers in Registers::ALL {
        if registers.are_available() {
            return run_with(registers, task);
        }
    }
    task.run::<Plain>()
}

/// Runs a task with given registers, or with plain numbers if the machine lacks them.
#[inline]
#[allow(unsafe_code)]
pub fn run_with<T: Task>(registers: Registers, task: T) -> T::Output {
    match registers {
        #[cfg(target_arch = "x86_64")]
        Registers::Wide if registers.are_available() => {
            // SAFETY: the condition above checks that the machine has the instructions.
            unsafe { crate::x86::with_wide(task) }
        }
        #[cfg(target_arch = "x86_64")]
        Registers::Pair if registers.are_available() => {
            // SAFETY: the condition above checks that the machine has the instructions.
            unsafe { crate::x86::with_pairs(task) }
        }
        _ => task.run::<Plain>(),
    }
}
