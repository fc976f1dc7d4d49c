//! Suggests the nearest known name for an unknown one.

/// Largest edit distance of a misspelling. Beyond this distance, a known name that is the beginning of the wrong name
/// is a better suggestion.
const MAX_MISSPELLING: usize = 2;

/// Smallest length of a known name that is suggested as the beginning of a wrong name.
const MIN_BEGINNING: usize = 3;

/// Returns the nearest known name: a name within the edit distance that its length permits, or a name that is the
/// beginning of the wrong name, such as `initial` for `initial_value`.
pub fn nearest<'k>(wrong: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // Names have at most 64 letters, so a much longer text is not a misspelling.
    if wrong.len() > 128 {
        return None;
    }
    let lowered = wrong.to_lowercase();
    let known: Vec<&str> = known.into_iter().filter(|name| *name != wrong).collect();
    let similar = nearest_by_letters(&lowered, &known);
    match similar {
        Some((distance, name)) if distance <= MAX_MISSPELLING => Some(name),
        _ => find_beginning(&lowered, &known).or(similar.map(|(_, name)| name)),
    }
}

/// Returns the longest known name that is the beginning of the wrong name, up to a `_`.
fn find_beginning<'k>(lowered: &str, known: &[&'k str]) -> Option<&'k str> {
    let begins = |name: &&&str| {
        let rest = lowered.strip_prefix(&*name.to_lowercase());
        name.len() >= MIN_BEGINNING && rest.is_some_and(|rest| rest.starts_with('_'))
    };
    known
        .iter()
        .filter(begins)
        .max_by_key(|name| name.len())
        .copied()
}

/// Returns the known name with the smallest edit distance, and this distance.
fn nearest_by_letters<'k>(lowered: &str, known: &[&'k str]) -> Option<(usize, &'k str)> {
    known
        .iter()
        .copied()
        .map(|name| {
            count_comparison();
            let distance = strsim::damerau_levenshtein(lowered, &name.to_lowercase());
            (distance, name)
        })
        .filter(|(distance, name)| *distance <= max_distance(lowered.len().max(name.len())))
        .min_by_key(|(distance, name)| {
            (
                *distance,
                std::cmp::Reverse(common_prefix_length(lowered, name)),
            )
        })
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
        let keys = ["unit", "initial", "initial_rate", "kinetic"];
        assert_eq!(nearest("initial_value", keys), Some("initial"));
        assert_eq!(nearest("initial_rat", keys), Some("initial_rate"));
        assert_eq!(nearest("kinetic_energy", keys), Some("kinetic"));
        assert_eq!(nearest("cosine", ["sin", "cos"]), Some("cos"));
        assert_eq!(nearest(&"x".repeat(10_000), known), None);
    }
}
