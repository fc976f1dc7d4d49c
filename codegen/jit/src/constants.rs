//! Literals, each stored twice in a row so that one lane or both can be read from memory:
//! loads fold into the operations that use them, where literals in the code would not.

use std::collections::HashMap;

/// The literals of all stages, in the room behind a program's values.
#[derive(Default)]
pub struct Constants {
    places: HashMap<u64, usize>,
    numbers: Vec<f64>,
}

impl Constants {
    /// The place of a literal among [`Constants::numbers`]: there and one further.
    pub fn place(&mut self, value: f64) -> usize {
        *self.places.entry(value.to_bits()).or_insert_with(|| {
            self.numbers.extend([value; 2]);
            self.numbers.len() - 2
        })
    }

    /// All literals, each twice.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }
}
