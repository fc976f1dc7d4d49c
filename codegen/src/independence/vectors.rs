//! Products and sizes of vectors.

/// The scalar product of two vectors.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The Euclidean length of a vector.
pub fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// The largest magnitude of some entries; 0 without any.
pub fn largest<'e>(entries: impl IntoIterator<Item = &'e f64>) -> f64 {
    let magnitudes = entries.into_iter().map(|entry| entry.abs());
    magnitudes.fold(0.0, f64::max)
}
