//! Text of a specification and of its linear part.

/// Two texts of one specification.
#[derive(Clone, Debug)]
pub struct SpecificationTexts {
    /// The whole specification.
    pub full: String,
    /// The specification without terms that are nonlinear between switches, if it has such terms.
    pub linear: String,
}

impl SpecificationTexts {
    /// Takes the whole specification as linear until it is derived.
    pub fn from_text(text: &str) -> Self {
        Self {
            full: text.to_owned(),
            linear: text.to_owned(),
        }
    }
}
