//! Text for pages: names of quantities become symbols, other names become code, and a number stays with its
//! unit.

use eomgen_codegen::symbolic::formula::letter;
use maud::{Markup, html};

use crate::formula::quantity_symbol;
use crate::number::to_superscript;

const NO_BREAK_SPACE: &str = "\u{a0}";

/// Units that can have a prefix.
const UNITS: [&str; 17] = [
    "m", "g", "s", "N", "J", "W", "Hz", "Pa", "V", "A", "K", "F", "H", "C", "T", "rad", "deg",
];

const PREFIXES: [char; 9] = ['p', 'n', 'µ', 'u', 'm', 'c', 'k', 'M', 'G'];

/// Returns text as markup. The parts between backticks are code. Names of quantities, such as `T_c` and
/// `theta`, become symbols. Lines do not break between a number and its unit.
pub fn prose(text: &str) -> Markup {
    html! {
        @for (index, part) in text.split('`').enumerate() {
            @if index % 2 == 1 { code { (part) } } @else { (words(part)) }
        }
    }
}

/// Returns text with symbols for its names.
fn words(text: &str) -> Markup {
    let pieces = split_words(text);
    let before = |index: usize, distance: usize| {
        let index = index.checked_sub(distance);
        index.map_or("", |index| pieces[index])
    };
    let is_power =
        |index: usize| before(index, 1) == "^" && pieces[index].chars().all(|c| c.is_ascii_digit());
    let is_named = |index: usize| {
        is_symbol(pieces[index]) || is_site(pieces[index], before(index, 1), before(index, 2))
    };
    html! {
        @for (index, piece) in pieces.iter().enumerate() {
            @match *piece {
                " " if is_unit_after(before(index, 1), pieces.get(index + 1)) => (NO_BREAK_SPACE),
                "^" if index + 1 < pieces.len() && is_power(index + 1) => {},
                digits if is_power(index) => (digits.chars().map(to_superscript).collect::<String>()),
                "pi" => i { "π" },
                name if is_named(index) => {
                    // No line break before a punctuation mark.
                    @match pieces.get(index + 1).and_then(|next| leading_mark(next)) {
                        Some(mark) => span.word { (quantity_symbol(name)) (mark) },
                        None => (quantity_symbol(name)),
                    }
                },
                name if name.contains('_') => code { (name) },
                plain => {
                    @let mark = match index > 0 && is_named(index - 1) {
                        true => leading_mark(plain).map_or(0, str::len),
                        false => 0,
                    };
                    (plain[mark..].replace(" %", &format!("{NO_BREAK_SPACE}%")))
                },
            }
        }
    }
}

/// Splits text into words and the text between them.
fn split_words(text: &str) -> Vec<&str> {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    let mut pieces: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = is_letter(first);
        let end = rest.find(|c| is_letter(c) != is_word);
        let (piece, after) = rest.split_at(end.unwrap_or(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces
}

/// Returns the punctuation mark at the start of a text.
fn leading_mark(text: &str) -> Option<&str> {
    text.starts_with([',', '.', ';', ':', ')'])
        .then(|| &text[..1])
}

/// Returns true for the name of a Greek letter, and for a letter with a subscript.
fn is_symbol(name: &str) -> bool {
    match name.split_once('_') {
        Some((head, rest)) => {
            !rest.is_empty() && (head.chars().count() == 1 || letter(head).is_some())
        }
        None => letter(name).is_some(),
    }
}

/// Letters after "in" and "of" that can be words or units.
const WORDS_AND_UNITS: [&str; 5] = ["a", "g", "h", "m", "s"];

/// Returns true for a single letter after a preposition, which then names a coordinate.
fn is_site(name: &str, space: &str, preposition: &str) -> bool {
    let is_letter = name.len() == 1 && name.chars().all(|c| c.is_ascii_lowercase());
    let is_quantity = match preposition {
        "on" => name != "a",
        "in" | "of" => !WORDS_AND_UNITS.contains(&name),
        _ => false,
    };
    is_letter && space == " " && is_quantity
}

/// Returns true if a number before a space has a unit after it.
fn is_unit_after(number: &str, unit: Option<&&str>) -> bool {
    let is_unit = |unit: &str| {
        let rest = unit.strip_prefix(PREFIXES).unwrap_or_default();
        UNITS.contains(&unit) || UNITS.contains(&rest)
    };
    number.ends_with(|c: char| c.is_ascii_digit()) && unit.is_some_and(|unit| is_unit(unit))
}

#[cfg(test)]
mod tests {
    use super::prose;

    fn set(text: &str) -> String {
        prose(text).into_string()
    }

    #[test]
    fn backticks_become_code() {
        assert_eq!(set("run `a < b` now"), "run <code>a &lt; b</code> now");
        assert_eq!(set("plain"), "plain");
        assert_eq!(
            set("the key noise_floor"),
            "the key <code>noise_floor</code>"
        );
    }

    #[test]
    fn names_of_quantities_become_symbols() {
        let friction = "<math><msub><mi>T</mi><mi>c</mi></msub></math>";
        assert_eq!(set("T_c = 1, b."), format!("{friction} = 1, b."));
        assert_eq!(set("floors in theta"), "floors in <math><mi>θ</mi></math>");
        assert_eq!(
            set("friction on q, on a"),
            "friction on <span class=\"word\"><math><mi>q</mi></math>,</span> on a"
        );
        assert_eq!(set("in q of s"), "in <math><mi>q</mi></math> of s");
        assert_eq!(set("10 pi m^2"), "10 <i>π</i> m²");
    }

    #[test]
    fn number_keeps_its_unit() {
        assert_eq!(set("4.11 mrad or 3 N·m"), "4.11\u{a0}mrad or 3\u{a0}N·m");
        assert_eq!(
            set("by 8.2 %, `a % b`, 2 models"),
            "by 8.2\u{a0}%, <code>a % b</code>, 2 models"
        );
    }
}
