//! Common code of the benchmarks: the planetary arm emitted for orders from 0 to 128 ([`variants`]), the other
//! [`contenders`], counts of [`instructions`], and the [`history`] of times and counts. The benchmark of rigid trees
//! uses [`rigid_specifications`] and [`casadi_contender`].

pub mod casadi_contender;
pub mod cases;
pub mod contenders;
pub mod eliminated_arm;
pub mod history;
pub mod instructions;
pub mod rigid_specifications;

/// Emitted modules, one for each order, from the build script.
pub mod variants {
    include!(concat!(env!("OUT_DIR"), "/variants.rs"));
}

/// Returns a state of `N` numbers with contact in one mesh, separation in the other, and vibrating modes.
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
