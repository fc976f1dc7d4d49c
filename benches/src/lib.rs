//! What the criterion benches of `benches/` compare: the planetary arm as emitted for
//! orders from 0 to 128 ([`variants`]) beside the other [`contenders`], and a state to
//! evaluate it at; and how [`instructions`] are counted and the [`history`] of both is kept. [`rigid_specifications`] and
//! [`casadi_contender`] are what rigid trees are compared by.

pub mod casadi_contender;
pub mod cases;
pub mod contenders;
pub mod history;
pub mod instructions;
pub mod rigid_specifications;

/// One module per order, emitted when this crate is built.
pub mod variants {
    include!(concat!(env!("OUT_DIR"), "/variants.rs"));
}

/// A state of `N` numbers in contact on one mesh and free on the other, modes in motion.
pub fn state<const N: usize>() -> [f64; N] {
    let mut state = [0.0; N];
    let degrees = N / 2;
    state[..3].copy_from_slice(&[3e-5, -1e-5, 0.01]);
    state[degrees..degrees + 3].copy_from_slice(&[0.02, -0.01, 0.1]);
    for mode in 3..degrees {
        state[mode] = 1e-4 / (mode * mode) as f64;
        state[degrees + mode] = 1e-2 / mode as f64;
    }
    state
}
