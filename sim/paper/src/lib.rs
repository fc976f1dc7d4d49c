//! The paper's machine, a flexible arm behind a planetary gear reducer with backlash.
//!
//! [`mod@reference`] holds equations written by hand, the errata among them; [`reference_equations`] says
//! which belong to which model, by [`same_motion`]; [`studies`] repeat the paper's figures and
//! judge its claims.

pub mod reference;
pub mod reference_equations;
pub mod same_motion;
pub mod studies;
