//! Formats counted items in messages.

/// Returns a number with its noun in the singular or plural; `noun` is the singular.
pub fn count(number: impl TryInto<u64>, noun: &str) -> String {
    let number = number.try_into().unwrap_or(u64::MAX);
    match number {
        1 => format!("1 {noun}"),
        _ if noun.ends_with("ch") => format!("{number} {noun}es"),
        _ => format!("{number} {noun}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_item_is_singular() {
        assert_eq!(count(1_u64, "switch"), "1 switch");
        assert_eq!(count(0_usize, "switch"), "0 switches");
        assert_eq!(count(2_usize, "input"), "2 inputs");
    }
}
