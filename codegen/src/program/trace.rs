//! Units of the values of a program, and the terms of the specification that contribute to them.

use super::ValueId;

/// Terms and units of the values of a program. It is empty unless
/// [`Variant::add_trace`](crate::variant::Variant::add_trace) computed it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// Terms of the specification.
    pub terms: Vec<TraceTerm>,
    /// Unit and terms of each value.
    pub values: Vec<ValueTrace>,
}

/// Energy, force, constraint, first-order state, guard or observable of a specification.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TraceTerm {
    /// Section of the specification, or `guards`.
    pub section: String,
    /// Name in the section; for a guard, its formula.
    pub name: String,
}

/// Unit and terms of a value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ValueTrace {
    /// SI unit; `None` if it is not known.
    pub unit: Option<String>,
    /// Indices of the terms, ascending.
    pub terms: Vec<usize>,
}

/// Placeholder for all terms of a section with several terms.
const ALL: &str = "*";

impl Trace {
    /// Returns unit and terms of a value on one line, such as `[N m] potential.gear, dissipation.gear`; `None` without a
    /// trace.
    pub fn note(&self, id: ValueId) -> Option<String> {
        let value = self.values.get(id.index())?;
        let unit = value.unit.as_deref().map(|unit| format!("[{unit}]"));
        let words: Vec<String> = unit.into_iter().chain(self.words(&value.terms)).collect();
        let (first, terms) = words.split_first()?;
        let terms = terms.join(", ");
        Some(match value.unit {
            Some(_) if !terms.is_empty() => format!("{first} {terms}"),
            _ if terms.is_empty() => first.clone(),
            _ => format!("{first}, {terms}"),
        })
    }

    /// Returns the names of terms as `section.name`. If all terms of a section with several terms are included,
    /// returns `section.*`.
    fn words(&self, terms: &[usize]) -> Vec<String> {
        let mut words = Vec::new();
        let mut rest = terms;
        while let Some(first) = rest.first() {
            let section = &self.terms[*first].section;
            let is_own = |term: &usize| self.terms[*term].section == *section;
            let count = rest.iter().take_while(|term| is_own(term)).count();
            let whole = self
                .terms
                .iter()
                .filter(|term| term.section == *section)
                .count();
            let (own, others) = rest.split_at(count);
            if count == whole && whole > 1 {
                words.push(format!("{section}.{ALL}"));
            } else {
                words.extend(
                    own.iter()
                        .map(|term| format!("{section}.{}", self.terms[*term].name)),
                );
            }
            rest = others;
        }
        words
    }
}
