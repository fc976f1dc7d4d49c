//! General solvers for y' = f(t, y) with switching surfaces.
//!
//! A [`System`] is evaluated under `watch`, which detects a trial state outside the regime in
//! which the step began. A `stepper` makes single steps: `dormand_prince` (Runge-Kutta, order 8),
//! `adams` (multistep, variable order; with `attempt` and `history`) or `radau` (implicit, order
//! 5; with `collocation`). `crossing` approaches a switching surface by steps on one side and then
//! steps across it. `examination` searches each step for crossings: `event_search` by bounds of the
//! switching functions over its interior, a polynomial in `bernstein` form; `grazing` and
//! `resolution` by samples, for functions without bounds. `driver` combines these into a
//! [`Trajectory`], with `passage`, `limits` and `stiffness`. No step averages over a kink or jump
//! of the right-hand side, which would reduce the order of the method.
//!
//! The Runge-Kutta steps come from the crate `differential-equations`. Its interpolation within
//! steps has order 4 instead of 7 in version 0.7; `continuous_extension` corrects this without
//! further evaluations. The coefficients of its Verner methods have only eleven digits. Its
//! predictor-corrector method restarts from three Runge-Kutta steps after every step, without
//! error control, so the Adams method is implemented here.
//!
//! # Tolerance
//!
//! `tolerance` is relative and applies to each component: the estimated error of a step in
//! component i stays below `tolerance` times (|y_i| + the largest |y_i| up to now), as a root mean
//! square over the components. It does not depend on units: deflections of micrometres and
//! rotations of several radians get the same number of digits. Until a component moves,
//! [`UNMOVED_SIZE_FRACTION`] of its typical size ([`System::typical_sizes`]) counts as its largest
//! magnitude.

mod adams;
mod approach;
mod attempt;
mod bernstein;
mod collocation;
mod dormand_prince;
mod driver;
mod error;
mod event_search;
mod examination;
mod grazing;
mod history;
mod limits;
mod location;
mod magnitudes;
mod names;
mod passage;
mod point;
mod radau;
mod request;
mod resolution;
pub mod runge_kutta;
mod settings;
mod slopes;
mod stepper;
mod stiffness;
mod system;
mod tableau;
mod trajectory;
mod watch;

pub use driver::{simulate, simulate_into};
pub use error::{NOT_POSITIVE_DEFINITE_MESSAGE, SolveError};
pub use names::{Names, Surface, UnsupportedSticking};
pub use settings::{Method, Settings, UNMOVED_SIZE_FRACTION, difference_step};
pub use system::{Interior, ObservedStep, System, jacobian_by_differences};
pub use trajectory::{SolverStatistics, Switch, Trajectory};
