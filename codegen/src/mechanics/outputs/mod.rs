//! Outputs on request, in addition to rates, observables, energy, power, guards and mass matrix.
//!
//! `output` lists them, `types` defines their structure, `derive` derives them. `jacobian` differentiates by
//! state, inputs and parameters, `adjoint` and `adjoint_matrices` derive products with weights by reverse
//! accumulation, `hessian` second derivatives of the weighted rates, `matrix_derivatives` derivatives of
//! modal matrices, and `regimes` the surfaces that decide each branch.

mod adjoint;
mod adjoint_matrices;
mod derive;
mod hessian;
mod jacobian;
mod matrix_derivatives;
mod output;
mod regimes;
mod types;

pub(crate) use derive::guard_rate;
pub use derive::{TANGENTS, derive_outputs};
pub use output::{Output, UnknownOutput};
pub use regimes::{Decision, SURFACES_OF_A_REGIME, Switch};
pub use types::{
    BlockPlace, Corners, GradientDerivative, GradientRow, Jacobian, JacobianBlock, Outputs,
    Products, RateRow, Side, SlidingSurface,
};
