//! A blind suite for discovery: machines with something hidden in them, records of their
//! motion, and a count of how often the program finds what was hidden.
//!
//! ```text
//! plan      which cases a seed makes: machine, what is hidden, how large
//! machines  equations of motion by hand, with everything that may be hidden; fixed steps
//! size      how large a hidden effect must be to stand this far above the floor
//! records   inputs, sensors, and the files that the program is given; labels apart
//! run       the program on a case, as a user runs it, with a time limit
//! score     results against labels
//! history   the figures of runs, kept over time
//! ```
//!
//! Nothing here is shared with the simulator, the derivation or the catalogue: the equations
//! are written down by hand from Newton's laws, friction is that of bristles or a steep
//! smooth curve, and the arm has more modes than the model is given.

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
