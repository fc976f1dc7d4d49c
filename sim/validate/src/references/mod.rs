//! Hand-written equations for comparison with derived models.
//!
//! Their sources are the paper (with its errors corrected) and textbooks. They share no code with the derivation.
//! [`planetary_arm`] contains the equations of the paper, and [`closed_forms`] the equations of the other machines.
//! Each row has a scale of its rounding error ([`evaluation`]). [`reference_equations`] assigns them to models by an
//! [`equation_comparison`]:
//!
//! ```
//! use eomgen_validate::references::reference_equations;
//!
//! let arm = eomgen_model_spec::check(eomgen_model_spec::models::PLANETARY_ARM.source())?.model;
//! let values = arm.parameter_values()?;
//! let found = reference_equations(&arm, 0, &values);
//! // Eq. (10) and Eq. (12) apply to the rigid arm.
//! assert_eq!(found.references.len(), 2);
//!
//! let emps = eomgen_model_spec::check(eomgen_model_spec::models::EMPS.source())?.model;
//! let values = emps.parameter_values()?;
//! assert_eq!(reference_equations(&emps, 0, &values).references.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assignment;
pub mod closed_forms;
pub mod equation_comparison;
pub mod evaluation;
pub mod planetary_arm;

pub use assignment::reference_equations;
