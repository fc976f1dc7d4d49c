//! Solvers for derived models.
//!
//! | module | purpose |
//! | --- | --- |
//! | [`ode`] | integrates any model and locates events |
//! | [`piecewise_linear`] | propagates piecewise-linear models exactly from event to event |
//! | [`exponential`] | integrates nearly piecewise-linear models with tangent vectors |
//! | [`sliding_modes`] | finds the surfaces that hold a motion |
//! | [`friction_discs`] | dry friction with two or three components of sliding velocity: sticking or sliding direction |
//! | [`contact_friction`] | modes of contacts with friction, and impacts |
//! | [`variational`] | measures the growth of a tangent vector |
//! | [`inputs`] | inputs as functions of time |
//! | [`cubic_spline`] | prescribed motion through samples |
//!
//! The crate `codegen` derives the models; the crate `compiled_model` chooses the solver.
//!
//! A mass on a spring with play, solved by the general and by the exact solver:
//!
//! ```
//! use std::cell::RefCell;
//!
//! use eomgen_sim::inputs::HeldInputs;
//! use eomgen_sim::ode::{self, Settings, System};
//! use eomgen_sim::piecewise_linear::PiecewiseLinear;
//! use eomgen_model_spec::source::Source;
//!
//! #[derive(Default)]
//! struct Mass {
//!     sides: RefCell<Option<Vec<f64>>>,
//! }
//!
//! impl System for Mass {
//!     fn state_count(&self) -> usize {
//!         2
//!     }
//!
//!     fn rates(&self, _t: f64, y: &[f64], out: &mut [f64]) {
//!         let mut sides = vec![0.0; 2];
//!         self.guards(0.0, y, &mut sides);
//!         // With fixed sides the rates continue smoothly over a surface.
//!         let fixed = self.sides.borrow();
//!         let sides = fixed.as_ref().unwrap_or(&sides);
//!         let stretched = match (sides[0] < 0.0, sides[1] > 0.0) {
//!             (true, _) => y[0] + 0.1,
//!             (_, true) => y[0] - 0.1,
//!             _ => 0.0,
//!         };
//!         (out[0], out[1]) = (y[1], -25.0 * stretched);
//!     }
//!
//!     fn guard_count(&self) -> usize {
//!         2
//!     }
//!
//!     fn guards(&self, _t: f64, y: &[f64], out: &mut [f64]) {
//!         (out[0], out[1]) = (y[0] + 0.1, y[0] - 0.1);
//!     }
//!
//!     fn fix_sides(&self, sides: Option<&[f64]>) {
//!         *self.sides.borrow_mut() = sides.map(<[f64]>::to_vec);
//!     }
//! }
//!
//! let (initial, span, samples) = ([0.3, 0.0], (0.0, 2.0), [1.0, 2.0]);
//! let settings = Settings::default();
//! let located = ode::simulate(&Mass::default(), &initial, span, &samples, &settings, &mut |_| {})?;
//!
//! let text = r#"
//! [model]
//! name = "mass_with_play"
//!
//! [parameters]
//! m = { value = 2, unit = "kg" }
//! k = { value = 50, unit = "N/m" }
//! b = { value = 0.1, unit = "m" }
//!
//! [coordinates]
//! x = { unit = "m" }
//!
//! [kinetic]
//! mass = "1/2*m*dot(x)^2"
//!
//! [potential]
//! spring = "1/2*k*deadzone(x, b)^2"
//! "#;
//! let model = eomgen_model_spec::check(Source::new("mass_with_play.toml", text))?.model;
//! let mut propagator = PiecewiseLinear::derive(&model, &[])?.propagator_for_model(&model)?;
//! let none = HeldInputs::zero(0);
//! let exact = propagator.simulate(&initial, span, &samples, &none, &mut |_| {})?;
//!
//! assert_eq!(exact.events.len(), located.events.len());
//! for (exact, located) in exact.states.iter().zip(&located.states) {
//!     assert!((exact[0] - located[0]).abs() < 1e-8);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "derive")]
mod balancing;
pub mod contact_friction;
pub mod cubic_spline;
#[cfg(feature = "derive")]
pub mod exponential;
pub mod friction_discs;
pub mod inputs;
pub mod ode;
#[cfg(feature = "derive")]
pub mod piecewise_linear;
pub mod random_numbers;
#[cfg(feature = "derive")]
mod registers;
pub mod sliding_modes;
#[cfg(feature = "derive")]
pub mod variational;
