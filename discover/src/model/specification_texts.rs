//! A specification's text and its linear part's.

/// Two texts of one specification.
#[derive(Clone, Debug)]
pub struct SpecificationTexts {
    /// The whole specification.
    pub whole: String,
    /// The same without terms that are not linear between switches, where there are such.
    pub linear: String,
}

impl SpecificationTexts {
    /// The texts of a specification all of which counts as linear until it is derived.
    pub fn of(text: &str) -> Self {
        Self {
            whole: text.to_owned(),
            linear: text.to_owned(),
        }
    }
}
