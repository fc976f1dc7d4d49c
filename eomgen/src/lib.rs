//! Equations of motion from energies, at compile time: [`model!`] derives them from a
//! specification. It expands to fast Rust that needs neither the standard library nor this
//! crate.
//!
//! ```
//! mod pendulum {
//!     eomgen::model! {
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
//!
//! use pendulum::{Coefficients, Inputs, Parameters, rates};
//!
//! let coefficients = Coefficients::prepare(&Parameters::default());
//! let [rate, acceleration] = rates(0.0, &[0.5, 0.0], &Inputs::default(), &coefficients);
//! assert_eq!(rate, 0.0);
//! assert!((acceleration + 9.81 / 0.3 * 0.5_f64.sin()).abs() < 1e-12);
//! ```
#![no_std]

/// Expands to the equations of motion of a specification, as items of the surrounding module.
///
/// From a file: `spec` is a path relative to the root of the crate. `order` is the number of
/// modes of every field; the default is the order in the file.
///
/// ```
/// mod arm {
///     eomgen::model! { spec = "../model-spec/models/planetary_arm.toml", order = 6 }
/// }
/// use arm::{Coefficients, Parameters};
///
/// assert_eq!(arm::ORDERS, [6]);
/// assert!(Coefficients::prepare(&Parameters::default()).positive_definite);
/// ```
///
/// Inline: the sections of a file, with braces around them, commas between entries and no
/// quotes.
///
/// ```
/// mod slider {
///     eomgen::model! {
///         model { name: slider }
///         parameters { m: { value: 2, unit: kg, doc: "moved mass", min: 0 } }
///         coordinates { x: { unit: m } }
///         inputs { u: { unit: N } }
///         kinetic { slider: 1/2*m*dot(x)^2 }
///         forces { drive: { on: x, value: u } }
///     }
/// }
/// use slider::{Coefficients, Inputs, Parameters, rates};
///
/// let coefficients = Coefficients::prepare(&Parameters { m: 4.0 });
/// let rates = rates(0.0, &[0.0, 1.0], &Inputs { u: 8.0 }, &coefficients);
/// assert_eq!(rates, [1.0, 2.0]);
/// ```
///
/// `with = [...]`, next to `spec` or before the sections, adds functions: `bias_forces`,
/// `inverse_dynamics`, `guard_rates`, `jacobians`, `products`, `linearisation`, `regimes`,
/// `lanes`.
///
/// ```
/// mod slider {
///     eomgen::model! {
///         with = [jacobians],
///         model { name: slider }
///         parameters { m: { value: 2, unit: kg, doc: "moved mass", min: 0 } }
///         coordinates { x: { unit: m } }
///         inputs { u: { unit: N } }
///         kinetic { slider: 1/2*m*dot(x)^2 }
///         forces { drive: { on: x, value: u } }
///     }
/// }
/// use slider::{Coefficients, Inputs, Parameters, rates_by_inputs};
///
/// let coefficients = Coefficients::prepare(&Parameters { m: 4.0 });
/// assert_eq!(rates_by_inputs(0.0, &[0.0; 2], &Inputs { u: 8.0 }, &coefficients), [0.25]);
/// ```
///
/// The items are those that `eomgen generate` writes, among them:
///
/// | item | meaning |
/// | --- | --- |
/// | `Parameters` | values in SI units; `Default` gives those of the specification |
/// | `Coefficients` | quantities that depend only on the parameters: call `prepare` once, use in every call |
/// | `Inputs` | signals at run time; `Default` gives zeros |
/// | `rates(t, &state, &inputs, &coefficients)` | rates of the state, `[f64; STATES]`; generic over the trait `Scalar` |
/// | `observables`, `energy`, `power`, `guards`, `mass_matrix` | functions of the same arguments |
/// | `STATES`, `STATE_NAMES`, `ORDERS`, `OBSERVABLE_NAMES` | constants |
/// | `SPECIFICATION` | inline sections only: the specification as TOML text |
///
/// Helper functions, for example the emitted sine, are in an inner module. Each model needs its
/// own module.
///
/// An error in inline sections is reported at its token. An error in a file is reported at the
/// path, with file, line and column in the message:
///
/// ```compile_fail
/// eomgen::model! {
///     model { name: slider }
///     parameters { m: { value: 2, unit: kg } }
///     coordinates { x: { unit: m } }
///     kinetic { slider: 1/2*m*dot(x) } // in kg m/s, expected J
/// }
/// ```
pub use eomgen_macros::model;

/// Simulation and discovery at run time, with the feature `library`.
///
/// ```
/// use eomgen::library::{CompiledModel, Orders, Solver};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = CompiledModel::load("../model-spec/models/planetary_arm.toml", Orders::Uniform(2))?;
/// let run = model.with_parameters(&[("b_sp", 50e-6)])?;
/// let times = [0.0, 0.01, 0.02];
/// let motion = run.simulate(run.initial_state(), &times, &run.default_inputs(), Solver::Auto)?;
/// assert_eq!(motion.solver, Solver::Exact);
/// let shown = run.observables(&motion)?;
/// assert_eq!(shown.len(), times.len());
/// # Ok(())
/// # }
/// ```
#[cfg(feature = "library")]
pub mod library {
    pub use eomgen_compiled_model::*;
    pub use eomgen_discover as discover;
    pub use eomgen_records as records;
    pub use eomgen_sim as sim;
}
