//! Suggests the nearest known name for an unknown one.

/// Returns the nearest known name, if its edit distance is within the limit for its length.
pub fn nearest<'k>(wrong: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // Names have at most 64 letters; a longer text is no misspelling.
    if wrong.len() > 128 {
        return None;
    }
    let lowered = wrong.to_lowercase();
    known
        .into_iter()
        .filter(|name| *name != wrong)
        .map(|name| {
            count_comparison();
            let distance = strsim::damerau_levenshtein(&lowered, &name.to_lowercase());
            (distance, name)
        })
        .filter(|(distance, name)| *distance <= max_distance(wrong.len().max(name.len())))
        .min_by_key(|(distance, name)| {
            (
                *distance,
                std::cmp::Reverse(common_prefix_length(&lowered, name)),
            )
        })
        .map(|(_, name)| name)
}

/// Returns "did you mean ...?", if a known name is near enough.
pub fn did_you_mean<'k>(wrong: &str, known: impl IntoIterator<Item = &'k str>) -> Option<String> {
    nearest(wrong, known).map(|name| format!("did you mean `{name}`?"))
}

#[cfg(not(test))]
fn count_comparison() {}

#[cfg(test)]
fn count_comparison() {
    tests::COMPARED.with(|compared| compared.set(compared.get() + 1));
}

fn common_prefix_length(one: &str, other: &str) -> usize {
    one.chars()
        .zip(other.chars())
        .take_while(|(a, b)| a == b)
        .count()
}

/// Returns the largest edit distance for a name of this length.
fn max_distance(length: usize) -> usize {
    match length {
        0 | 1 => 0,
        2 => 1,
        3..=5 => 2,
        _ => 3,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::cell::Cell;

    thread_local! {
        /// Number of names that were compared on this thread.
        pub(crate) static COMPARED: Cell<usize> = const { Cell::new(0) };
    }

    #[test]
    fn only_near_names_are_suggested() {
        let known = ["theta_s", "theta_c", "k_sp", "coordinates"];
        assert_eq!(nearest("thetas", known), Some("theta_s"));
        assert_eq!(nearest("K_sp", known), Some("k_sp"));
        assert_eq!(nearest("cordinates", known), Some("coordinates"));
        assert_eq!(nearest("velocity", known), None);
        assert_eq!(nearest("cosine", ["sin", "cos"]), Some("cos"));
        assert_eq!(nearest(&"x".repeat(10_000), known), None);
    }
}
