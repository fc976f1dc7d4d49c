//! Outputs on request, in addition to rates, observables, energy, power, guards and mass matrix.
//!
//! `output` lists them, `types` defines their structure, `derive` derives them. `jacobian` differentiates with respect
//! to state, inputs and parameters, `adjoint` and `adjoint_matrices` derive products with weights by reverse
//! accumulation, and
//! `hessian` second derivatives of the weighted rates. `matrix_derivatives` differentiates modal matrices, `regimes`
//! finds the surfaces that determine each branch, and `reactions` derives frictions and contacts for steps of fixed
//! length.

#[cfg(feature = "derive")]
mod adjoint;
#[cfg(feature = "derive")]
mod adjoint_matrices;
#[cfg(feature = "derive")]
mod derive;
#[cfg(feature = "derive")]
mod hessian;
#[cfg(feature = "derive")]
mod jacobian;
#[cfg(feature = "derive")]
mod matrix_derivatives;
mod output;
#[cfg(feature = "derive")]
mod reactions;
#[cfg(feature = "derive")]
mod regimes;
mod types;

#[cfg(feature = "derive")]
pub use derive::{OutputError, TANGENTS, derive_outputs};
pub use output::{Output, UnknownOutput};
#[cfg(feature = "derive")]
pub use reactions::StepObstacle;
pub use types::{
    BlockPlace, Corners, Decision, GradientDerivative, GradientRow, Jacobian, JacobianBlock,
    Outputs, Products, RateRow, ReactionCounts, Reactions, SURFACES_OF_A_REGIME, Side,
    SlidingSurface, Switch,
};
