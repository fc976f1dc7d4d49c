//! Comparison of a model with measured records, and search for the missing effects.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use eomgen_discover::report::result::Verdict;
//! use eomgen_discover::{Specification, catalogue};
//! use eomgen_records::read_dataset;
//! use eomgen_model_spec::source::Source;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = std::fs::read_to_string("arm.toml")?;
//! let model = eomgen_model_spec::check(Source::new("arm.toml", text.as_str()))?.model;
//! let dataset = read_dataset(Path::new("records/dataset.toml"), &model)?;
//! let specification = Specification {
//!     path: "arm.toml",
//!     text: &text,
//!     order: None,
//! };
//! let effects = catalogue::load_effects(None)?;
//! let progress = |line: &str| eprintln!("{line}");
//! let found = eomgen_discover::discover(specification, dataset, &effects, 1, &progress)?;
//! if found.verdict == Verdict::EffectsFound {
//!     for effect in &found.effects {
//!         println!("{} on {}: {}", effect.at.effect, effect.at.site, effect.term);
//!     }
//!     std::fs::write("extended.toml", &found.extended)?;
//! }
//! std::fs::write("discovery.json", found.to_json().to_string())?;
//! std::fs::write("report.html", found.to_html())?;
//! # Ok(())
//! # }
//! ```
//!
//! Data flows one way: [`model`] (compiled model and unknowns), [`fit`] (estimates, uncertainties and
//! residuals), [`catalogue`] (effects and their sites), [`mod@residual_force`] (equation and form of a
//! missing force), [`free_function`] (laws and curves along the measured motion), [`mod@search`] (accepted effects), [`empirical`] (unnamed expressions),
//! [`experiment`] (next experiments), [`report`] (results as documents and pages). [`thresholds`]
//! contains the limits of decisions, [`error`] the errors, [`ids`] the typed indices.

pub mod catalogue;
pub mod empirical;
pub mod error;
pub mod experiment;
pub mod fit;
pub mod free_function;
pub mod ids;
pub mod interval;
pub mod model;
pub mod report;
pub mod residual_force;
pub mod search;
mod threads;
pub mod thresholds;

pub use model::stop::StopRequest;
pub use report::origin::Specification;
pub use report::result::{Comparison, Discovery};
pub use report::run::{compare, discover, discover_until};
pub use threads::prepare_threads;
