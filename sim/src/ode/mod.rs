//! A general solver for y' = f(t, y) with switching surfaces.
//!
//! The pipeline: a [`System`] is evaluated under `watch`, which notices when a trial
//! leaves the regime the step began in; a `stepper` makes single steps, those of the
//! Dormand-Prince method of order 8 (`dormand_prince`) or of Adams' method of variable
//! order (`adams`, of `attempt`s that continue a `history`), or of Radau's implicit method of order 5
//! for stiff systems (`radau`, each a `collocation`); `crossing` approaches a switching
//! surface by steps that stay on one side and then steps over it, `grazing` finds what a step
//! passed over, and `resolution` keeps steps so short that they see what switching functions do; `driver` strings these
//! together into a [`Trajectory`], with the `passage` over surfaces and the `limits`, `stiffness` being asked whether there will be an end; an
//! `error` says why there is none, with `names`. A step therefore never averages over a kink or a jump
//! of the right-hand side, which is what ruins the order of a method applied blindly.
//!
//! The Runge-Kutta steps come from the crate `differential-equations`. What its interpolation
//! between steps gives is in version 0.7 of order 4 instead of 7, and `continuous_extension` mends
//! it: states inside a step have its accuracy and cost no evaluation. The tables of its Verner
//! methods carry eleven digits.
//! Its predictor-corrector method is no multistep method of variable step: it replaces
//! its memory by three Runge-Kutta steps after every step, without control of their
//! error, so Adams' method is written here.
//!
//! # Tolerance
//!
//! `tolerance` is relative and holds for every component by itself: a step's estimated
//! error in component i stays below `tolerance` times (|y_i| + the largest |y_i| so
//! far), in the root-mean-square over the components. Nothing is said about units, so
//! mesh deflections of micrometres and rotations of several radians get the same number
//! of digits. Before a component moves, [`UNMOVED_PART`] of its typical size ([`System::typical_sizes`]) counts
//! as its largest magnitude.

mod adams;
mod attempt;
mod collocation;
mod continuous_extension;
mod crossing;
mod dormand_prince;
mod driver;
mod error;
mod grazing;
mod history;
mod limits;
mod magnitudes;
mod names;
mod passage;
mod point;
mod radau;
mod request;
mod resolution;
pub mod runge_kutta;
mod settings;
mod stepper;
mod stiffness;
mod system;
mod trajectory;
mod watch;

pub use driver::{simulate, simulate_into};
pub use error::{NOT_POSITIVE, SolveError};
pub use names::{Names, Surface, Unfollowed};
pub use settings::{Method, Settings, UNMOVED_PART, difference_step};
pub use system::{Interior, ObservedStep, System, jacobian_by_differences};
pub use trajectory::{Switch, Trajectory, Work};
