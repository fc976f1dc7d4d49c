//! 8-wide SIMD for emitted equations of motion. At run time the crate selects the widest registers of the machine:
//! one of 512 bits, two of 256 bits, or eight plain numbers. The results of each lane are bit-identical to those of a
//! scalar evaluation.
//!
//! Emit a model with `lanes`, call [`scalar!`] to make [`Lanes`] a number type of the model, and implement a [`Task`]
//! that contains the loop over many states. The task is compiled for each kind of register, and [`run`] selects one.
//!
//! ```
//! mod pendulum {
//!     eomgen::model! {
//!         with = [lanes],
//!         model { name: pendulum }
//!         parameters {
//!             m: { value: 0.15, unit: kg },
//!             l: { value: 300, unit: mm },
//!             g: { value: 9.81, unit: m/s^2 },
//!         }
//!         coordinates { theta: { unit: rad } }
//!         kinetic { bob: 1/2*m*(l*dot(theta))^2 }
//!         potential { gravity: -m*g*l*cos(theta) }
//!     }
//! }
//! eomgen_lanes::scalar!(pendulum);
//!
//! use eomgen_lanes::{Lanes, Vector};
//!
//! /// One step of Euler's method for eight pendulums in each entry of `states`.
//! struct Step<'a> {
//!     states: &'a mut [[[f64; 8]; pendulum::STATES]],
//!     coefficients: pendulum::Coefficients,
//! }
//!
//! impl eomgen_lanes::Task for Step<'_> {
//!     type Output = ();
//!     #[inline(always)]
//!     fn run<V: Vector>(self) {
//!         let (t, h) = (Lanes::<V>::splat(0.0), Lanes::splat(1e-3));
//!         for numbers in self.states {
//!             let state = Lanes::from_arrays(numbers);
//!             let inputs = pendulum::Inputs::default();
//!             let rates = pendulum::inlined_rates(t, &state, &inputs, &self.coefficients);
//!             for i in 0..pendulum::STATES {
//!                 numbers[i] = (state[i] + h * rates[i]).to_array();
//!             }
//!         }
//!     }
//! }
//!
//! let mut states = [[[0.5; 8], [0.0; 8]]; 100];
//! let coefficients = pendulum::Coefficients::prepare(&pendulum::Parameters::default());
//! eomgen_lanes::run(Step { states: &mut states, coefficients });
//! assert!(states[99][1][7] < 0.0);
//! ```
//!
//! `vector` defines the operations and the plain implementation, `x86` the registers of x86-64, `task` their selection,
//! and `scalar` the traits of emitted code.

mod scalar;
mod task;
mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use scalar::Lanes;
pub use task::{Registers, Task, run, run_with};
pub use vector::{LANES, Vector};
