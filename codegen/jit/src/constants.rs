//! Literals, each stored twice in succession, so that one lane or both can be read from memory. A load from memory is
//! part of the instruction that uses the literal; a literal in the code would need its own instruction.

use std::collections::HashMap;

/// Literals of all stages, stored in memory after the values of the program.
#[derive(Default)]
pub struct Constants {
    places: HashMap<u64, usize>,
    numbers: Vec<f64>,
}

impl Constants {
    /// Returns the index of a literal in [`Constants::numbers`]; stores the literal if it is new. The next number is
    /// its copy.
    pub fn place(&mut self, value: f64) -> usize {
        *self.places.entry(value.to_bits()).or_insert_with(|| {
            self.numbers.extend([value; 2]);
            self.numbers.len() - 2
        })
    }

    /// Returns all literals, each stored twice.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }
}
