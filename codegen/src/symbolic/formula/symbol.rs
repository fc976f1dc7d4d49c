//! Names of quantities in the parts a reader expects: a letter or word, what stands below the
//! line, dots of a rate or an acceleration, an index over modes. How each is set is the
//! printers' business.

use std::fmt;

/// An index over the modes of a field, or over its quadrature nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    /// Of elements and rows.
    I,
    /// Of columns.
    J,
}

impl Index {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::I => "i",
            Self::J => "j",
        }
    }
}

/// A named quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name in the specification.
    pub name: String,
    /// How often it is differentiated by time.
    pub dots: u8,
    /// Its indices: none of a scalar, one of a vector, two of a matrix.
    pub indices: Vec<Index>,
}

impl Symbol {
    /// A scalar of this name.
    pub fn plain(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            dots: 0,
            indices: Vec::new(),
        }
    }

    /// Differentiated so often by time.
    pub fn with_dots(mut self, dots: u8) -> Self {
        self.dots = dots;
        self
    }

    /// With these indices.
    pub fn with_indices(mut self, indices: &[Index]) -> Self {
        self.indices = indices.to_vec();
        self
    }

    /// The entry of a state of this name: what ends in `_dot` is a rate.
    pub fn of_state(name: &str) -> Self {
        match name.strip_suffix("_dot").filter(|stem| !stem.is_empty()) {
            Some(stem) => Self::plain(stem).with_dots(1),
            None => Self::plain(name),
        }
    }

    /// Head and subscripts of the name: `theta_s` is theta with s. A name that is no such
    /// sequence is a head as it is.
    pub fn parts(&self) -> (&str, Vec<&str>) {
        let mut parts = self.name.split('_');
        let head = parts.next().unwrap_or_default();
        let rest: Vec<&str> = parts.collect();
        if head.is_empty() || rest.iter().any(|part| part.is_empty()) {
            return (&self.name, Vec::new());
        }
        (head, rest)
    }
}

/// In plain text a rate is `dot(x)`; the index of a rate's element stands with the name.
impl fmt::Display for Symbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (before, after) = match self.dots {
            0 => ("", ""),
            1 => ("dot(", ")"),
            _ => ("ddot(", ")"),
        };
        write!(f, "{before}{}", self.name)?;
        if !self.indices.is_empty() {
            let indices: String = self.indices.iter().map(|index| index.name()).collect();
            write!(f, "_{indices}")?;
        }
        f.write_str(after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fall_into_head_and_subscripts() {
        for (name, head, rest) in [
            ("t", "t", vec![]),
            ("theta_s", "theta", vec!["s"]),
            ("b_m_1", "b", vec!["m", "1"]),
            ("x_", "x_", vec![]),
            ("a__b", "a__b", vec![]),
        ] {
            assert_eq!(Symbol::plain(name).parts(), (head, rest), "{name}");
        }
    }

    #[test]
    fn symbols_are_written_with_dots_and_indices() {
        let symbol = Symbol::plain("q").with_indices(&[Index::I]);
        assert_eq!(symbol.to_string(), "q_i");
        assert_eq!(symbol.with_dots(2).to_string(), "ddot(q_i)");
        let matrix = Symbol::plain("a_qq").with_indices(&[Index::I, Index::J]);
        assert_eq!(matrix.to_string(), "a_qq_ij");
        assert_eq!(Symbol::of_state("x_sp_dot").to_string(), "dot(x_sp)");
    }
}
