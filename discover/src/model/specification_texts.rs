//! Text of a specification and of its linear part.

/// Two texts of one specification.
#[derive(Clone, Debug)]
pub struct SpecificationTexts {
    /// The whole specification.
    pub whole: String,
    /// The specification without terms that are nonlinear between switches, if it has such terms.
    pub linear: String,
}

impl SpecificationTexts {
    /// Takes the whole specification as linear until it is derived.
    pub fn of(text: &str) -> Self {
        Self {
            whole: text.to_owned(),
            linear: text.to_owned(),
        }
    }
}
