//! What is run: orders, backlash, times, and what is kept of one order.

use std::f64::consts::PI;

use crate::studies::case::{Amplitude, Record};

/// The orders compared, and the one that stands for all modes.
pub const HIGHEST: usize = 16;
pub const REFERENCE: usize = 32;
/// The forcing frequency, which the paper does not give for Fig. 4, and the backlash of the
/// chaotic case in micrometres.
pub const OMEGA: f64 = 10.0 * PI;
pub const BACKLASH: u32 = 25;
/// Time from one sample to the next, s; over a long time, where only amplitudes are wanted.
pub const STEP: f64 = 1.0 / 20_480.0;
pub const COARSE_STEP: f64 = 1.0 / 4_096.0;
/// The motion from the start is kept over this time, s.
pub const START: f64 = 6.0;
/// With backlash, differences are averaged over this time from the start, s.
pub const SHORT: f64 = 0.02;
/// Statistics are taken over this time, s, after this transient, s.
pub const STATISTICS: f64 = 40.0;
pub const TRANSIENT: f64 = 60.0;
/// The orders whose differences are shown over time, and whose spectra are.
pub const SHOWN: [usize; 4] = [1, 4, 5, 16];

/// One order's series at one backlash.
pub struct Run {
    pub order: usize,
    /// From the start.
    pub start: Record,
    /// x_sp, f_la and dr over a long time after the transient.
    pub statistics: [Amplitude; 3],
}
