//! Loops of libgcc whose number of iterations is bounded by the number format.

use std::collections::BTreeMap;

use eomgen_model_spec::source::sha256;

use crate::listing::{CodeAddress, Listing};
use crate::state::State;
use crate::value::{Flags, UNKNOWN};

/// Loop that shifts the fraction of a subnormal number to the left until its highest bit is set.
struct Normalisation {
    /// Offset of the backward jump from the start of the function, in bytes.
    jump: u64,
    /// Registers that the loop writes.
    registers: [u8; 3],
}

/// Function of libgcc for the product of doubles. The quotient uses its loops, too.
const PRODUCT: &str = "__aeabi_dmul";

/// SHA-256 of the hexadecimal digits of [`PRODUCT`] in libgcc for processors with Thumb-2 (`ieee754-df.S`).
const PRODUCT_SHA256: &str = "c857296badd9bae22602656ca7dfb3d4aa7811313f81a2303da86db86219893d";

const NORMALISATIONS: [Normalisation; 2] = [
    Normalisation {
        jump: 0x1b4,
        registers: [0, 1, 4],
    },
    Normalisation {
        jump: 0x1d4,
        registers: [2, 3, 5],
    },
];

/// Number of instructions in one iteration, from `lsls` to `beq`.
const INSTRUCTIONS_PER_ITERATION: u64 = 6;

/// Largest number of iterations: the number of bits of the fraction. The loop is entered only for numbers other than
/// 0.
const MAX_ITERATIONS: u64 = 52;

/// Loop with a known bound on its iterations.
#[derive(Clone, Copy, Debug)]
pub struct KnownLoop {
    registers: [u8; 3],
    /// Largest number of instructions after the first iteration.
    pub repeated_instructions: u64,
}

impl KnownLoop {
    /// Marks the registers and flags that the loop changes as unknown.
    pub fn forget(self, state: &mut State) {
        for register in self.registers {
            state.set(register, UNKNOWN);
        }
        state.flags = Flags::default();
    }
}

/// Returns the loops with known bounds, by the address of the backward jump.
pub fn known_loops(listing: &Listing) -> BTreeMap<CodeAddress, KnownLoop> {
    let product = listing.functions.get(PRODUCT);
    let product = product.filter(|product| sha256(listing.bytes(**product)) == PRODUCT_SHA256);
    let loops = product.into_iter().flat_map(|product| {
        NORMALISATIONS.iter().map(|known| {
            let limit = KnownLoop {
                registers: known.registers,
                repeated_instructions: (MAX_ITERATIONS - 1) * INSTRUCTIONS_PER_ITERATION,
            };
            (product.code_address + known.jump, limit)
        })
    });
    loops.collect()
}
