//! The paper's machine, a flexible arm behind a planetary gear reducer with backlash.
//!
//! [`mod@reference`] holds equations written by hand, the errata among them; [`reference_equations`] says
//! which belong to which model, by [`same_motion`], and [`certification`] brings them into certificates; [`studies`] repeat the paper's figures and
//! judge its claims.
//!
//! The equations that were written by hand for a model, beside those that are derived:
//!
//! ```
//! use eomgen_paper::reference_equations::reference_equations;
//!
//! let arm = eomgen_model_spec::check(eomgen_model_spec::models::PLANETARY_ARM.source())?.model;
//! let values = arm.parameter_values()?;
//! let found = reference_equations(&arm, 0, &values);
//! // Eq. (12) and Eq. (22) hold of the rigid arm.
//! assert!(!found.references.is_empty());
//!
//! let emps = eomgen_model_spec::check(eomgen_model_spec::models::EMPS.source())?.model;
//! let values = emps.parameter_values()?;
//! assert_eq!(reference_equations(&emps, 0, &values).references.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod certification;
pub mod reference;
pub mod reference_equations;
pub mod same_motion;
pub mod studies;
