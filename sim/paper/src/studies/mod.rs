//! Numerical studies of the paper: cases, claims, and their verdicts with this model.
//!
//! - [`arm`] derives the arm with any undisclosed values.
//! - [`case`](mod@case) measures one case: `run` simulates it, `neighbours` computes the Lyapunov exponent, `kind`
//!   classifies the motion, and `series` has the quantities of the paper.
//! - [`reading`] extracts the numbers for the claims. [`claims`] has the claims with their rules, [`judge`] the
//!   verdicts, `evidence` the reasons.
//! - [`sets`] distributes the undisclosed values over plausible ranges, [`search`] judges all claims for each set,
//!   [`tally`] counts verdicts, [`charts`] draws them.
//! - [`responses`] and [`order`] are the studies; `report` creates their files.
//! - `display` samples cases for `figures` and `planes`, `bifurcation` varies the backlash, `machine` draws the signs of
//!   the paper and `overview` the arm, with parts of `sketch`.

pub mod arm;
mod bifurcation;
pub mod case;
pub mod charts;
pub mod claims;
pub mod claims_table;
mod display;
pub mod error;
mod evidence;
mod figures;
pub mod judge;
mod kind;
mod machine;
mod neighbours;
pub mod order;
mod overview;
mod planes;
pub mod reading;
pub mod report;
pub mod responses;
mod run;
pub mod search;
pub mod search_report;
mod series;
pub mod sets;
mod sketch;
pub mod tally;

pub use error::StudyError;
