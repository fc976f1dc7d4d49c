//! General solvers for y' = f(t, y) with switching surfaces.
//!
//! `watch` fixes the sides of the surfaces of a [`System`] during a step, so that its rates are smooth and a
//! step may pass a surface. A `stepper` makes single steps: `dormand_prince` (Runge-Kutta, order 8; with
//! `slopes` and `tableau`), `adams` (multistep, variable order; with `attempt` and `history`) or `radau`
//! (implicit, order 5; with `collocation`). `examination` searches each step for crossings. `event_search`
//! bounds the switching functions over the dense output, a polynomial in `bernstein` form; `grazing` and
//! `resolution` sample functions without bounds. `location` finds the root on the dense output and makes steps
//! that end at the surface. `passage` applies the event there. `driver` combines these into a [`Trajectory`],
//! with `limits` and `stiffness`. `simulation` makes a whole simulation, or one that is continued from call to
//! call. `external_motion` keeps sides and modes for an external solver; `step_adjoint` differentiates a step.
//! No step extends over a kink or jump of the right-hand side, which would reduce the order of the method.
//!
//! # Tolerance
//!
//! `tolerance` is relative and applies to each component: the estimated error of a step in component i stays
//! below `tolerance` times (|y_i| + the largest |y_i| up to now), for `adams` and `radau` as a root mean square
//! over the components. Therefore the accuracy does not depend on units: deflections of micrometres and
//! rotations of several radians have the same number of correct digits. Until a component moves,
//! [`UNMOVED_SIZE_FRACTION`] of its typical size ([`System::typical_sizes`]) counts as its largest magnitude.

mod adams;
mod approach;
mod attempt;
mod bernstein;
mod collocation;
mod dormand_prince;
mod driver;
mod error;
mod event_search;
mod events;
mod examination;
mod external_motion;
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
mod root_band;
mod roots;
pub mod runge_kutta;
mod settings;
mod simulation;
mod slopes;
mod step_adjoint;
mod stepper;
mod stiffness;
mod system;
mod tableau;
mod trajectory;
mod watch;

pub use bernstein::{BernsteinBasis, Piece};
pub use error::{NOT_POSITIVE_DEFINITE_MESSAGE, SolveError};
pub use events::{Event, Jump, SurfaceMode};
pub use external_motion::ExternalMotion;
pub use magnitudes::ROUNDING_FACTOR;
pub use names::{Names, Surface, SurfaceKind, UnsupportedSticking};
pub use settings::{Method, Settings, UNMOVED_SIZE_FRACTION, difference_step};
pub use simulation::{Simulation, simulate, simulate_into};
pub use step_adjoint::RepeatedStep;
pub use system::{Interior, ObservedStep, System, jacobian_by_differences};
pub use trajectory::{SolverStatistics, Trajectory};
