//! Products and norms of vectors.

/// Returns the scalar product of two vectors.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the Euclidean norm of a vector.
pub fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// Returns the largest magnitude of the entries, or 0 if there are none.
pub fn find_max_magnitude<'e>(entries: impl IntoIterator<Item = &'e f64>) -> f64 {
    let magnitudes = entries.into_iter().map(|entry| entry.abs());
    magnitudes.fold(0.0, f64::max)
}
