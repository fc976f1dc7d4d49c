//! The paper's numerical studies: its cases, its claims, and what this model says of them.
//!
//! [`arm`] makes the paper's arm at any values of what the paper does not disclose, and
//! [`case`](mod@case) measures one case: `run` follows its motion, `neighbours` says how
//! fast neighbouring motions part, `kind` what kind of motion that makes it, `series` has the paper's quantities. [`reading`] is what the claims need of it, [`claims`]
//! states them with their rules, [`judge`] decides, `evidence` says on what grounds.
//! [`sets`] spreads the undisclosed values over plausible ranges, [`search`] judges all
//! claims at each, [`tally`] counts what holds together, [`charts`] draws it. `display` samples cases for
//! `figures` and `planes`, `bifurcation` goes over the backlash, `machine` draws what it is all about; [`responses`] and [`order`] are the paper's studies as `report` hands them out.

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
mod planes;
pub mod reading;
pub mod report;
pub mod responses;
mod run;
pub mod search;
pub mod search_report;
mod series;
pub mod sets;
pub mod tally;

pub use error::StudyError;
