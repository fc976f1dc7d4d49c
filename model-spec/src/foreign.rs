//! Operators, words and functions of other languages, with their equivalents in a specification.

use crate::suggest::did_you_mean;

/// Spellings in other languages, and the equivalent in a specification.
type Foreign = (&'static [&'static str], &'static str);

const OPERATORS: [Foreign; 12] = [
    (
        &[">"],
        "write `above(x - a)` for 1 if x > a, else 0; `contact(x, a)` is 1 if abs(x) > a",
    ),
    (
        &["<"],
        "write `above(a - x)` for 1 if x < a, else 0; `1 - contact(x, a)` is 1 if abs(x) <= a",
    ),
    (
        &[">=", "=>", "≥"],
        "write `1 - above(a - x)` for 1 if x >= a, else 0",
    ),
    (
        &["<=", "≤"],
        "write `1 - above(x - a)` for 1 if x <= a, else 0",
    ),
    (
        &["=", "==", "==="],
        "quantities that move are equal only at single times: write `1 - contact(x - a, b)` for 1 if x \
         is within b of a",
    ),
    (
        &["!=", "/=", "<>", "~=", "≠"],
        "write `contact(x - a, b)` for 1 if x is more than b away from a",
    ),
    (&["&", "&&"], AND_HELP),
    (&["||"], OR_HELP),
    (
        &["|"],
        "write `abs(x)` for a magnitude, and `max(above(x - a), above(b - x))` for x > a or x < b",
    ),
    (&["!"], NOT_HELP),
    (&["?", ":"], IF_HELP),
    (&["**", "^^"], POWER),
];

/// Words that are operators in other languages.
const WORDS: [Foreign; 4] = [
    (&["and"], AND_HELP),
    (&["or"], OR_HELP),
    (&["not"], NOT_HELP),
    (
        &[
            "if", "then", "else", "elif", "elseif", "where", "when", "case",
        ],
        IF_HELP,
    ),
];

const FUNCTIONS: [Foreign; 10] = [
    (&["ifelse", "select", "piecewise", "Piecewise"], IF_HELP),
    (
        &["heaviside", "Heaviside", "step"],
        "write `above(x)` for 1 if x > 0, else 0",
    ),
    (&["pow", "power"], POWER),
    (&["%", "mod", "fmod", "rem"], REMAINDER),
    (&["log"], "the natural logarithm is ln"),
    (&["log10"], "the logarithm to base 10 is ln(x)/ln(10)"),
    (&["sgn", "signum"], "write `sign(x)` for -1, 0 or 1"),
    (&["fabs"], "write `abs(x)`"),
    (
        &["ddt", "der", "derivative", "Derivative", "D"],
        "write dot(x) for the rate",
    ),
    (&["ddot", "dotdot", "d2dt2"], NO_ACCELERATION),
];

/// Names of quantities.
const NAMES: [Foreign; 1] = [(&["time", "Time"], "write `t` for the time")];

/// Prefix and suffix of the name of a quantity that denote its first rate.
const RATES: [(&str, &str); 13] = [
    ("", "_dot"),
    ("", "dot"),
    ("dot_", ""),
    ("d", ""),
    ("d_", ""),
    ("D", ""),
    ("d", "_dt"),
    ("d", "dt"),
    ("", "_d"),
    ("", "d"),
    ("", "'"),
    ("dot(", ")"),
    ("der(", ")"),
];

/// Prefix and suffix of the name of a quantity that denote its second derivative.
const SECOND_RATES: [(&str, &str); 9] = [
    ("", "_ddot"),
    ("", "ddot"),
    ("ddot_", ""),
    ("dd", ""),
    ("d2", ""),
    ("", "_dd"),
    ("", "''"),
    ("dot(dot(", "))"),
    ("ddot(", ")"),
];

/// Help for an acceleration in an expression.
pub const NO_ACCELERATION: &str =
    "a specification contains no accelerations: they follow from the energies";

/// Rate of a known quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForeignRate<'n> {
    /// Name of the quantity.
    pub of: &'n str,
    /// True for the second derivative.
    pub is_second: bool,
}

/// Reads a name as the rate of a known quantity, in any usual notation, such as `thetadot` or `dtheta`.
pub fn read_rate(name: &str, is_known: impl Fn(&str) -> bool) -> Option<ForeignRate<'_>> {
    let find = |notations: &[(&str, &str)]| {
        notations.iter().find_map(|(before, after)| {
            let of = name.strip_prefix(before)?.strip_suffix(after)?;
            is_known(of).then_some(of)
        })
    };
    let second = || find(&SECOND_RATES).map(|of| (of, true));
    let (of, is_second) = find(&RATES).map(|of| (of, false)).or_else(second)?;
    Some(ForeignRate { of, is_second })
}

/// Suggests the name `NAME_dot` of a rate among the names of states.
pub fn suggest_state<'k>(name: &str, known: impl Iterator<Item = &'k str>) -> Option<String> {
    let known: Vec<&str> = known.collect();
    let rate = read_rate(name, |of| known.contains(&of));
    let rate = rate.filter(|rate| !rate.is_second);
    let written = rate.map(|rate| format!("{}_dot", rate.of));
    match written.filter(|written| known.contains(&written.as_str())) {
        Some(written) => Some(format!("write `{written}` for the rate")),
        None => did_you_mean(name, known),
    }
}

const AND_HELP: &str =
    "if both conditions are required, write the product: `above(x - a)*above(b - x)`";
const OR_HELP: &str =
    "if one of two conditions is sufficient, write `max(above(x - a), above(b - x))`";
const NOT_HELP: &str = "write `1 - above(x - a)` for 1 if x <= a, else 0";
const IF_HELP: &str = "write `above(x - a)*A + (1 - above(x - a))*B` for A if x > a, else B; `min` and `max` \
                  choose the smaller and the larger of two";
const POWER: &str = "write x^2 for a power";
const REMAINDER: &str =
    "there is no remainder function: `atan2(sin(x), cos(x))` is the angle x between -pi and pi";

/// Returns the equivalent of an operator, a word or a function of another language.
pub fn find_equivalent(foreign: &str) -> Option<&'static str> {
    help(OPERATORS.iter().chain(&WORDS).chain(&FUNCTIONS), foreign)
}

/// Returns the equivalent of the name of a quantity.
pub fn find_name_equivalent(name: &str) -> Option<&'static str> {
    help(NAMES.iter(), name)
}

/// Returns the equivalent of a word that is an operator in another language.
pub fn find_word_equivalent(word: &str) -> Option<&'static str> {
    help(WORDS.iter(), word)
}

fn help<'t>(mut table: impl Iterator<Item = &'t Foreign>, foreign: &str) -> Option<&'static str> {
    let entry = table.find(|(known, _)| known.contains(&foreign));
    entry.map(|(_, help)| *help)
}

/// Returns the operator of another language at the start of a text.
pub fn find_operator(text: &str) -> Option<&str> {
    let run = text.chars().take(3).take_while(|letter| is_symbol(*letter));
    let length = run.map(char::len_utf8).sum();
    let starts = (1..=length).rev().filter_map(|end| text.get(..end));
    let mut foreign = starts.filter(|start| !["*", "/", "^"].contains(start));
    foreign.find(|start| find_equivalent(start).is_some())
}

/// Returns true if a character can be part of a foreign operator.
fn is_symbol(letter: char) -> bool {
    !letter.is_alphanumeric() && !letter.is_whitespace() && !"_.,()[]+-".contains(letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_notations_of_rates_are_read() {
        let is_known = |name: &str| ["theta", "x"].contains(&name);
        let of = |name| read_rate(name, is_known).map(|rate| (rate.of, rate.is_second));
        for name in [
            "theta_dot",
            "thetadot",
            "dtheta",
            "d_theta",
            "dtheta_dt",
            "thetad",
            "theta'",
            "dot(theta)",
        ] {
            assert_eq!(of(name), Some(("theta", false)), "{name}");
        }
        for name in ["thetaddot", "ddtheta", "theta''", "dot(dot(theta))"] {
            assert_eq!(of(name), Some(("theta", true)), "{name}");
        }
        for name in ["theta", "dot", "dphi", "xdott"] {
            assert_eq!(of(name), None, "{name}");
        }
        let states = ["theta", "x", "theta_dot", "x_dot"];
        let suggested = |name| suggest_state(name, states.into_iter()).unwrap_or_default();
        assert!(suggested("dot(theta)").contains("`theta_dot`"));
        assert!(suggested("tetha_dot").contains("`theta_dot`"));
    }

    #[test]
    fn longest_operator_is_found() {
        for (text, operator) in [
            (">= a", ">="),
            ("> a", ">"),
            ("&& b", "&&"),
            ("≥ 0", "≥"),
            ("** 2", "**"),
        ] {
            assert_eq!(find_operator(text), Some(operator), "{text}");
        }
        for text in ["if", "a", "+ a", "*a", "/ a"] {
            assert_eq!(find_operator(text), None, "{text}");
        }
    }
}
