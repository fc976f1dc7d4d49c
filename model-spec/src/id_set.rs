//! Set of small numbers, stored as bits. A union needs one operation per 64 numbers.

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IdSet {
    words: Vec<u64>,
}

impl IdSet {
    pub fn insert(&mut self, number: usize) {
        let word = number / 64;
        if self.words.len() <= word {
            self.words.resize(word + 1, 0);
        }
        self.words[word] |= 1 << (number % 64);
    }

    pub fn extend(&mut self, other: &Self) {
        if self.words.len() < other.words.len() {
            self.words.resize(other.words.len(), 0);
        }
        for (own, word) in self.words.iter_mut().zip(&other.words) {
            *own |= word;
        }
    }

    pub fn contains(&self, number: usize) -> bool {
        let word = self.words.get(number / 64);
        word.is_some_and(|word| word & (1 << (number % 64)) != 0)
    }

    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Returns the numbers in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        (0..64 * self.words.len()).filter(|number| self.contains(*number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn union_contains_the_numbers_of_both() {
        let (mut one, mut other) = (IdSet::default(), IdSet::default());
        assert!(one.is_empty());
        one.insert(3);
        one.insert(200);
        other.insert(0);
        other.insert(64);
        other.extend(&one);
        assert_eq!(other.iter().collect::<Vec<_>>(), [0, 3, 64, 200]);
        assert!(!one.contains(64) && other.contains(64) && !one.is_empty());
    }
}
