//! Literals, each stored twice in a row, so that one lane or both can be read from memory. Loads are part of
//! the instructions that use them; literals in the code would not be.

use std::collections::HashMap;

/// Literals of all stages, in memory after a program's values.
#[derive(Default)]
pub struct Constants {
    places: HashMap<u64, usize>,
    numbers: Vec<f64>,
}

impl Constants {
    /// Returns the index of a literal in [`Constants::numbers`]; the next number is its copy.
    pub fn place(&mut self, value: f64) -> usize {
        *self.places.entry(value.to_bits()).or_insert_with(|| {
            self.numbers.extend([value; 2]);
            self.numbers.len() - 2
        })
    }

    /// Returns all literals, each twice.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }
}
