//! Symbols of quantities: a letter or word, subscripts, dots for time derivatives, and indices over modes.

use std::fmt;

/// Index over the modes of a field, or over its quadrature nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    /// Index of elements and rows.
    I,
    /// Index of columns.
    J,
}

impl Index {
    /// Returns the letter of the index.
    pub fn name(self) -> &'static str {
        match self {
            Self::I => "i",
            Self::J => "j",
        }
    }
}

/// Named quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Name in the specification.
    pub name: String,
    /// Number of time derivatives.
    pub dots: u8,
    /// Indices: none for a scalar, one for a vector, two for a matrix.
    pub indices: Vec<Index>,
    /// Symbols used as subscripts, such as row and column of a matrix entry. They replace the subscripts from the
    /// name.
    pub owners: Vec<Self>,
}

impl Symbol {
    /// Returns the symbol of a scalar.
    pub fn plain(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            dots: 0,
            indices: Vec::new(),
            owners: Vec::new(),
        }
    }

    /// Returns a symbol with other symbols as subscripts, such as an entry of the mass matrix with two coordinates.
    pub fn part_of(head: &str, owners: Vec<Self>) -> Self {
        let names = owners.iter().map(|owner| owner.name.as_str());
        let names: Vec<&str> = std::iter::once(head).chain(names).collect();
        let name = names.join("_");
        Self {
            owners,
            ..Self::plain(&name)
        }
    }

    /// Sets the number of time derivatives.
    pub fn with_dots(mut self, dots: u8) -> Self {
        self.dots = dots;
        self
    }

    /// Sets the indices.
    pub fn with_indices(mut self, indices: &[Index]) -> Self {
        self.indices = indices.to_vec();
        self
    }

    /// Returns the symbol of a state or an input; the suffixes `_dot` and `_ddot` denote rates.
    pub fn from_state(name: &str) -> Self {
        let stem = |suffix| name.strip_suffix(suffix).filter(|stem| !stem.is_empty());
        match (stem("_ddot"), stem("_dot")) {
            (Some(stem), _) => Self::plain(stem).with_dots(2),
            (None, Some(stem)) => Self::plain(stem).with_dots(1),
            (None, None) => Self::plain(name),
        }
    }

    /// Splits the name at underscores into head and subscripts: `theta_s` is theta with the subscript s. A name with
    /// empty parts is not split. If the symbol has owners, no subscripts are returned.
    pub fn parts(&self) -> (&str, Vec<&str>) {
        let mut parts = self.name.split('_');
        let head = parts.next().unwrap_or_default();
        if !self.owners.is_empty() {
            return (head, Vec::new());
        }
        let rest: Vec<&str> = parts.collect();
        if head.is_empty() || rest.iter().any(|part| part.is_empty()) {
            return (&self.name, Vec::new());
        }
        (head, rest)
    }
}

/// Prints a symbol as plain text. A rate is printed as `dot(x)`, with indices inside the parentheses.
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
    fn name_splits_into_head_and_subscripts() {
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
    fn entry_has_its_row_and_column_as_subscripts() {
        let owners = ["x_sp", "q"].map(Symbol::plain);
        let entry = Symbol::part_of("M", owners.to_vec());
        assert_eq!(entry.to_string(), "M_x_sp_q");
        assert_eq!(entry.parts(), ("M", vec![]));
        assert_eq!(entry.owners, owners);
    }

    #[test]
    fn symbol_prints_dots_and_indices() {
        let symbol = Symbol::plain("q").with_indices(&[Index::I]);
        assert_eq!(symbol.to_string(), "q_i");
        assert_eq!(symbol.with_dots(2).to_string(), "ddot(q_i)");
        let matrix = Symbol::plain("a_qq").with_indices(&[Index::I, Index::J]);
        assert_eq!(matrix.to_string(), "a_qq_ij");
        assert_eq!(Symbol::from_state("x_sp_dot").to_string(), "dot(x_sp)");
        assert_eq!(Symbol::from_state("a_ddot").to_string(), "ddot(a)");
    }
}
