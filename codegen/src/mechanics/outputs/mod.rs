//! What is derived on request beside rates, observables, energy, power, guards and mass matrix.
//!
//! `output` (what can be asked for), `types` (the structure of what was derived), `derive` (its
//! derivation), `jacobian` (columns by state, inputs and parameters), `adjoint` and `adjoint_matrices`
//! (products with weights, backward), `hessian` (second derivatives of the weighted rates),
//! `matrix_derivatives` (derivatives of modal matrices), `regimes` (which surfaces decide each branch).

mod adjoint;
mod adjoint_matrices;
mod derive;
mod hessian;
mod jacobian;
mod matrix_derivatives;
mod output;
mod regimes;
mod types;

pub use derive::derive_outputs;
pub(crate) use derive::guard_rate;
pub use output::{Output, UnknownOutput};
pub use regimes::{Decided, SURFACES_OF_A_REGIME, Switch};
pub use types::{
    BlockPlace, GradientDerivative, GradientRow, Jacobian, JacobianBlock, Outputs, Products,
    SlidingSurface,
};
