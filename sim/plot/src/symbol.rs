//! Names in the notation of the paper: `theta_s_dot` is a dotted Greek letter with a subscript.

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Letter or word, with the dots of a rate or an acceleration.
    pub head: String,
    pub subscript: String,
}

const GREEK: [(&str, &str); 24] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Omega", "Ω"),
    ("dtheta", "Δθ"),
    ("betal", "βl"),
];

pub(super) const DOT_ABOVE: char = '\u{307}';
pub(super) const TWO_DOTS_ABOVE: char = '\u{308}';

impl Symbol {
    /// Splits an identifier at its first underscore. Further underscores become commas in the subscript.
    pub fn parse(name: &str) -> Self {
        if let Some(stem) = name.strip_suffix("_ddot").filter(|stem| !stem.is_empty()) {
            return Self::parse(stem).with_mark(TWO_DOTS_ABOVE);
        }
        if let Some(stem) = name.strip_suffix("_dot").filter(|stem| !stem.is_empty()) {
            return Self::parse(stem).with_mark(DOT_ABOVE);
        }
        let (head, subscript) = match name.split_once('_') {
            Some((head, rest)) if !head.is_empty() && !rest.is_empty() => (head, rest),
            _ => (name, ""),
        };
        Self {
            head: greek_letter(head).to_owned(),
            subscript: subscript.replace('_', ","),
        }
    }

    fn with_mark(mut self, mark: char) -> Self {
        self.head.push(mark);
        self
    }
}

fn greek_letter(head: &str) -> &str {
    GREEK
        .iter()
        .find(|(name, _)| *name == head)
        .map_or(head, |(_, letter)| letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(name: &str) -> (String, String) {
        let Symbol { head, subscript } = Symbol::parse(name);
        (head, subscript)
    }

    #[test]
    fn names_split_into_head_and_subscript() {
        for (name, head, subscript) in [
            ("t", "t", ""),
            ("x_sp", "x", "sp"),
            ("theta_s", "θ", "s"),
            ("b_m_1", "b", "m,1"),
            ("x_c_dot", "x\u{307}", "c"),
            ("q_1_ddot", "q\u{308}", "1"),
            ("_x", "_x", ""),
            ("x_", "x_", ""),
            ("_dot", "_dot", ""),
            ("", "", ""),
        ] {
            assert_eq!(
                parts(name),
                (head.to_owned(), subscript.to_owned()),
                "{name}"
            );
        }
    }
}
