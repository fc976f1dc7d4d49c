//! Formulas in the plain notation of the report as HTML: subscripts, exponents, dots, Greek.
//!
//! The text is gone through once from left to right; what is not known is escaped and kept,
//! so that every text gives a page.

use eomgen_plot::symbol::Symbol;

use super::markup::push_escaped;

/// Names of functions and operations, which are set upright.
const UPRIGHT: [&str; 26] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "ln",
    "sqrt", "abs", "sign", "min", "max", "deadzone", "contact", "above", "if", "diag", "gram",
    "gram_ii", "cholesky", "solve",
];

/// What the next closing parenthesis ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Open {
    Parenthesis,
    Exponent,
}

struct Writer<'a> {
    rest: &'a str,
    html: String,
    open: Vec<Open>,
}

/// A formula as HTML.
pub(super) fn html(formula: &str) -> String {
    let mut writer = Writer {
        rest: formula,
        html: String::with_capacity(2 * formula.len()),
        open: Vec::new(),
    };
    while let Some(next) = writer.rest.chars().next() {
        writer.step(next);
    }
    let unclosed = writer
        .open
        .iter()
        .filter(|open| **open == Open::Exponent)
        .count();
    writer.html.push_str(&"</sup>".repeat(unclosed));
    writer.html
}

impl<'a> Writer<'a> {
    fn step(&mut self, next: char) {
        match next {
            c if c.is_alphabetic() || c == '_' => self.word(),
            c if c.is_ascii_digit() => self.number(),
            '^' => self.exponent(),
            '(' => {
                self.take(1);
                self.open.push(Open::Parenthesis);
                self.html.push('(');
            }
            ')' => {
                self.take(1);
                self.html.push_str(match self.open.pop() {
                    Some(Open::Exponent) => "</sup>",
                    _ => ")",
                });
            }
            '*' => self.times(),
            '-' => self.replace("−"),
            '\'' => self.replace("′"),
            c => {
                self.take(c.len_utf8());
                push_escaped(&mut self.html, c);
            }
        }
    }

    /// Takes so many bytes, which must end between two characters.
    fn take(&mut self, bytes: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at_checked(bytes).unwrap_or((self.rest, ""));
        self.rest = rest;
        taken
    }

    fn replace(&mut self, by: &str) {
        self.take(1);
        self.html.push_str(by);
    }

    fn word(&mut self) {
        let word = self.take(word_length(self.rest));
        match word {
            "dot" | "ddot" => self.derivative(word),
            "sum_i" | "sum_j" => {
                let index = word.trim_start_matches("sum_");
                self.html.push_str(&format!("∑<sub><i>{index}</i></sub>"));
            }
            "int" if self.rest.starts_with('[') => self.html.push_str("∫<sub>0</sub><sup>1</sup>"),
            _ if UPRIGHT.contains(&word) => self.html.push_str(word),
            _ => match word.strip_prefix('_') {
                Some(index) if self.html.ends_with([']', ')']) => self.subscript(index),
                _ => self.symbol(&Symbol::parse(word)),
            },
        }
    }

    /// `dot(name)` with the dot on the name; of anything else it stays a function.
    fn derivative(&mut self, word: &str) {
        let argument = self.rest.strip_prefix('(').unwrap_or("");
        let name = &argument[..word_length(argument)];
        if name.is_empty() || !argument[name.len()..].starts_with(')') {
            self.html
                .push_str(if word == "dot" { "d/dt " } else { "d²/dt² " });
            return;
        }
        self.take(name.len() + 2);
        let symbol = Symbol::parse(name);
        self.symbol(&if word == "dot" {
            symbol.rate()
        } else {
            symbol.acceleration()
        });
    }

    fn symbol(&mut self, symbol: &Symbol) {
        self.html.push_str("<i>");
        symbol
            .head
            .chars()
            .for_each(|c| push_escaped(&mut self.html, c));
        self.html.push_str("</i>");
        if !symbol.subscript.is_empty() {
            self.subscript(&symbol.subscript);
        }
    }

    fn subscript(&mut self, text: &str) {
        self.html.push_str("<sub>");
        text.chars().for_each(|c| push_escaped(&mut self.html, c));
        self.html.push_str("</sub>");
    }

    /// A number; with a power of ten if it has an exponent.
    fn number(&mut self) {
        let digits = digits_length(self.rest);
        let mantissa = self.take(digits);
        let (sign, after) = match self.rest.strip_prefix(['e', 'E']) {
            Some(after) => match after.strip_prefix('-') {
                Some(after) => ("−", after),
                None => ("", after.strip_prefix('+').unwrap_or(after)),
            },
            None => ("", ""),
        };
        let power = &after[..after.bytes().take_while(u8::is_ascii_digit).count()];
        if power.is_empty() {
            self.html.push_str(mantissa);
            return;
        }
        self.take(self.rest.len() - after.len() + power.len());
        if mantissa != "1" {
            self.html.push_str(&format!("{mantissa}·"));
        }
        self.html.push_str(&format!("10<sup>{sign}{power}</sup>"));
    }

    fn exponent(&mut self) {
        self.take(1);
        if self.rest.starts_with('(') {
            self.take(1);
            self.open.push(Open::Exponent);
            self.html.push_str("<sup>");
            return;
        }
        let length = match digits_length(self.rest) {
            0 => word_length(self.rest),
            digits => digits,
        };
        let exponent = self.take(length);
        self.html.push_str("<sup>");
        exponent
            .chars()
            .for_each(|c| push_escaped(&mut self.html, c));
        self.html.push_str("</sup>");
    }

    /// Factors stand side by side, so that lines break between terms only; a point where that could be read as something else.
    fn times(&mut self) {
        self.take(1);
        let ambiguous = self
            .rest
            .starts_with(|c: char| c.is_ascii_digit() || c == '(');
        self.html.push(if ambiguous { '·' } else { '\u{202f}' });
    }
}

fn word_length(text: &str) -> usize {
    text.find(|c: char| !(c.is_alphanumeric() || c == '_'))
        .unwrap_or(text.len())
}

fn digits_length(text: &str) -> usize {
    text.find(|c: char| !(c.is_ascii_digit() || c == '.'))
        .unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_set_as_in_print() {
        for (formula, expected) in [
            ("x_sp", "<i>x</i><sub>sp</sub>"),
            (
                "1/2*I_s*dot(theta_s)^2",
                "1/2\u{202f}<i>I</i><sub>s</sub>\u{202f}<i>θ\u{307}</i><sub>s</sub><sup>2</sup>",
            ),
            ("ddot(q_i)", "<i>q\u{308}</i><sub>i</sub>"),
            ("dot(a + b)", "d/dt (<i>a</i> + <i>b</i>)"),
            (
                "sum_i(phi_i')",
                "∑<sub><i>i</i></sub>(<i>φ</i><sub>i</sub>′)",
            ),
            (
                "int[s phi_i]",
                "∫<sub>0</sub><sup>1</sup>[<i>s</i> <i>φ</i><sub>i</sub>]",
            ),
            (
                "a^(b + (c))*2",
                "<i>a</i><sup><i>b</i> + (<i>c</i>)</sup>·2",
            ),
            ("2.5e-7*(a)", "2.5·10<sup>−7</sup>·(<i>a</i>)"),
            (
                "[a]_i (b . c)_i",
                "[<i>a</i>]<sub>i</sub> (<i>b</i> . <i>c</i>)<sub>i</sub>",
            ),
            ("1e8", "10<sup>8</sup>"),
            ("sin(x)/2", "sin(<i>x</i>)/2"),
        ] {
            assert_eq!(html(formula), expected, "{formula}");
        }
    }

    #[test]
    fn what_is_no_formula_is_kept_and_escaped() {
        for (formula, expected) in [
            ("<b>&", "&lt;<i>b</i>&gt;&amp;"),
            ("a^", "<i>a</i><sup></sup>"),
            ("a^(b", "<i>a</i><sup><i>b</i></sup>"),
            ("dot(", "d/dt ("),
            (")", ")"),
            ("1e", "1<i>e</i>"),
            ("√2é", "√2<i>é</i>"),
        ] {
            assert_eq!(html(formula), expected, "{formula}");
        }
    }
}
