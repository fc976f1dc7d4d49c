//! Studies of the paper's planetary arm: a flexible arm behind a planetary gear reducer with
//! backlash.
//!
//! [`studies`] reproduce the figures of the paper and judge its claims. The equations of the paper
//! are in `eomgen_validate::references::planetary_arm`.

pub mod studies;
