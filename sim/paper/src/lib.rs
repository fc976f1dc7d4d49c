//! Planetary arm of the paper: a flexible arm behind a planetary gear reducer with backlash.
//!
//! [`mod@reference`] has hand-written equations and the errata. [`reference_equations`] assigns
//! them to models with [`equation_comparison`], and [`certification`] adds them to certificates.
//! [`studies`] reproduce the figures of the paper and judge its claims.
//!
//! Reference equations of two models:
//!
//! ```
//! use eomgen_paper::reference_equations::reference_equations;
//!
//! let arm = eomgen_model_spec::check(eomgen_model_spec::models::PLANETARY_ARM.source())?.model;
//! let values = arm.parameter_values()?;
//! let found = reference_equations(&arm, 0, &values);
//! // Eq. (12) and Eq. (22) apply to the rigid arm.
//! assert!(!found.references.is_empty());
//!
//! let emps = eomgen_model_spec::check(eomgen_model_spec::models::EMPS.source())?.model;
//! let values = emps.parameter_values()?;
//! assert_eq!(reference_equations(&emps, 0, &values).references.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod certification;
pub mod equation_comparison;
pub mod reference;
pub mod reference_equations;
pub mod studies;
