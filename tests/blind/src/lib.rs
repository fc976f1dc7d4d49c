//! Blind suite for discovery: machines with hidden effects, records of their motion, and a count of
//! found effects.
//!
//! ```text
//! plan      cases of a seed: machine, hidden effects, sizes
//! machines  hand-written equations of motion with all effects; fixed steps
//! size      size of a hidden effect for a given ratio to the noise floor
//! records   inputs, sensors, and the input files of the program; labels in another folder
//! run       the program on a case, with a time limit
//! score     comparison of results with labels
//! history   success rates of earlier runs
//! ```
//!
//! The suite shares no code with the simulator, the derivation or the catalogue. The equations are
//! written by hand from Newton's laws, friction uses bristles or a steep smooth curve, and the arm
//! has more modes than its model.

pub mod friction;
pub mod hidden;
pub mod history;
pub mod inputs;
pub mod integrate;
pub mod machines;
pub mod plan;
pub mod random;
pub mod records;
pub mod run;
pub mod score;
pub mod size;
