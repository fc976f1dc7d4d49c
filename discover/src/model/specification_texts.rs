//! Text of a specification and of its linear part.

use std::path::Path;

use eomgen_model_spec::source::Source;

/// Two texts of one specification.
#[derive(Clone, Debug)]
pub struct SpecificationTexts {
    /// Whole specification.
    pub full: String,
    /// Specification without terms that are nonlinear between switches, if it has such terms.
    pub linear: String,
}

impl SpecificationTexts {
    /// Uses the text for both the whole specification and its linear part.
    pub fn from_text(text: &str) -> Self {
        Self {
            full: text.to_owned(),
            linear: text.to_owned(),
        }
    }
}

/// Returns the source of an edited specification. `path`: path of the original file; its folder
/// contains the tables of mode shapes.
pub fn edited_source(path: &str, text: &str) -> Source {
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    Source::new(path, text).in_folder(folder)
}
