//! Quantities in command-line options, as `NAME=VALUE`, with the syntax of a specification.
//!
//! A plain number is in the unit of the quantity. A value can also end with a unit, for example `30 deg` or
//! `2*sqrt(2) mm`. Any other value is an expression of parameters and constants in SI whose unit must match, for
//! example `pi/3` or `2*l`.

mod quantity_reader;
mod settings;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::Source;
use crate::span::Span;

pub use quantity_reader::QuantityReader;
pub(crate) use quantity_reader::find_unit_start;

/// Parts of `NAME=VALUE`, with their positions.
#[derive(Clone, Debug)]
pub struct Assignment {
    source: Source,
    name: Span,
    value: Span,
}

impl Assignment {
    /// Splits the text of an option. `option`, for example `--set`, replaces the file name in
    /// messages.
    ///
    /// # Errors
    /// The text has no `=`, or the name or the value is empty.
    pub fn split(option: &str, text: &str) -> Result<Self, Diagnostics> {
        let source = Source::new(option, text);
        let trimmed = |start: usize, end: usize| {
            let part = &text[start..end];
            let start = start + part.len() - part.trim_start().len();
            Span::new(start, start + part.trim().len())
        };
        let parts = text
            .find('=')
            .map(|at| [trimmed(0, at), trimmed(at + 1, text.len())]);
        match parts {
            Some([name, value]) if name.start < name.end && value.start < value.end => Ok(Self {
                source,
                name,
                value,
            }),
            _ => {
                let message = format!("{option} {text}: expected NAME=VALUE");
                let wrong = Diagnostic::error(message).with_span(Span::new(0, text.len()), "");
                let help = "give a number, an expression of parameters, or an expression with a unit: k=2*k_0, \
                            theta=pi/3, theta=\"30 deg\"";
                Err(Diagnostics::from_one(source, wrong.with_help(help)))
            }
        }
    }

    /// Returns the option that contains the assignment.
    pub fn option(&self) -> &str {
        &self.source.path
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.source.text[self.name.start..self.name.end]
    }

    /// Returns the whole text.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// Returns the error that the name is wrong.
    pub fn name_error(&self, message: String, help: Option<String>) -> Diagnostics {
        let wrong = Diagnostic::error(message)
            .with_span(self.name, "")
            .with_optional_help(help);
        Diagnostics::from_one(self.source.clone(), wrong)
    }

    /// Converts errors in a text that contains the value to errors at their positions in this option. Returns `None`
    /// if an error has no position in the value.
    pub fn relocated(&self, found: &Diagnostics) -> Option<Diagnostics> {
        let (text, value) = (&found.source().text, self.value());
        let shifted = |span: Span| {
            let mut starts = text.match_indices(value).map(|(start, _)| start);
            let start =
                starts.find(|start| *start <= span.start && span.end <= start + value.len() + 1)?;
            Some(self.place(span.start - start, span.end - start))
        };
        let mut here = Diagnostics::new(self.source.clone());
        for finding in found.list() {
            let primary = finding.primary.as_ref()?;
            let mut moved = finding
                .clone()
                .with_span(shifted(primary.span)?, &*primary.text);
            moved
                .secondary
                .retain_mut(|label| match shifted(label.span) {
                    Some(span) => {
                        label.span = span;
                        true
                    }
                    None => false,
                });
            here.push(moved);
        }
        Some(here)
    }

    /// The value.
    pub fn value(&self) -> &str {
        &self.source.text[self.value.start..self.value.end]
    }

    fn place(&self, start: usize, end: usize) -> Span {
        Span::new(self.value.start + start, self.value.start + end)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::model::Model;
    use crate::unit::Unit;

    const TEXT: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 500, unit = "mm" }
a = { value = 30, unit = "deg" }
r = { value = 3 }
d = { value = "l/r", unit = "mm" }
[coordinates]
theta = { unit = "rad" }
x = { unit = "m" }
[kinetic]
mass = "1/2*m*l^2*dot(theta)^2*r + 1/2*m*dot(x)^2"
[observables]
kept = "a + d/l"
"#;

    fn model() -> Model {
        crate::check(Source::new("pendulum.toml", TEXT))
            .expect("a model")
            .model
    }

    fn read(text: &str, unit: &str) -> Result<f64, String> {
        let model = model();
        let given = Assignment::split("--state", text).map_err(|error| error.to_string())?;
        let unit = Unit::parse(unit).expect("a unit");
        let reader = QuantityReader::new(&model).expect("a reader");
        reader
            .read(&given, &unit)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn numbers_expressions_and_units_are_read() {
        for (text, unit, right) in [
            ("theta=0.5", "rad", 0.5),
            ("theta = -1e-3", "rad", -1e-3),
            ("theta=pi", "rad", PI),
            ("theta=30 deg", "rad", PI / 6.0),
            ("theta=-(10 + 20) deg", "rad", -PI / 6.0),
            ("theta=a", "rad", PI / 6.0),
            ("theta=2*pi/3", "rad", 2.0 * PI / 3.0),
            ("theta=pi rad", "rad", PI),
            ("x=2*l", "m", 1.0),
            ("x=250 mm", "m", 0.25),
            ("x=1/4", "m", 0.25),
            ("u=3 N m", "N m", 3.0),
            ("u=2 kN mm", "N m", 2.0),
            ("l=1/3 m", "mm", 1000.0 / 3.0),
            ("l=250 mm", "mm", 250.0),
            ("l=250", "mm", 250.0),
            ("l=l/2", "mm", 250.0),
            ("a=pi/2", "deg", 90.0),
            ("a=2", "deg", 2.0),
        ] {
            let found = read(text, unit).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert!(
                (found - right).abs() <= 1e-15 * right.abs().max(1.0),
                "{text}: {found}"
            );
        }
    }

    #[test]
    fn wrong_values_are_rejected_with_their_position() {
        for (text, unit, parts) in [
            ("theta", "rad", &["expected NAME=VALUE"][..]),
            ("theta=", "rad", &["expected NAME=VALUE"]),
            (
                "theta=2*pii",
                "rad",
                &["--state:1:9", "unknown name `pii`", "`pi`"],
            ),
            ("theta=2*", "rad", &["--state:1:9"]),
            ("theta=30 mm", "rad", &["--state:1:10", "in rad, not in mm"]),
            (
                "theta=30 degs",
                "rad",
                &["--state:1:10", "unknown unit `degs`"],
            ),
            ("x=a", "m", &["--state:1:3", "a pure number"]),
            ("x=m", "m", &["--state:1:3", "in kg"]),
            (
                "x=2*l mm",
                "m",
                &["--state:1:3", "a second unit", "remove the unit"],
            ),
            ("l=1/3", "mm", &["--state:1:3", "1/3 mm"]),
            ("x=nan", "m", &["finite"]),
            ("x=1/0", "m", &["finite"]),
            ("x=1e-400", "m", &["--state:1:3", "too small"]),
            ("x=-1e-400 mm", "m", &["--state:1:4", "too small"]),
            ("x=1e-320 um", "m", &["--state:1:3", "too small"]),
            ("l=1e-322", "mm", &["--state:1:3", "too small"]),
            ("x=1e400", "m", &["--state:1:3", "too large"]),
            ("x=theta", "m", &["--state:1:3", "a coordinate"]),
            ("x=1=2", "m", &["--state:1:4"]),
            ("x=3 (2)", "m", &["--state:1:5"]),
        ] {
            let error = read(text, unit).expect_err(text);
            for part in parts {
                assert!(
                    error.contains(part),
                    "{text}: {part} is missing in\n{error}"
                );
            }
        }
    }

    fn settings(texts: &[&str]) -> Result<Vec<(String, f64)>, Diagnostics> {
        let given = texts.iter().map(|text| Assignment::split("--set", text));
        let given: Vec<Assignment> = given.map(|given| given.expect("an assignment")).collect();
        model().read_settings(&given)
    }

    #[test]
    fn settings_do_not_depend_on_their_order() {
        // d = l/r is declared. Therefore r = 5*d/l refers to l, and also to its own declared value 3.
        for texts in [
            ["l=1 m", "m=2*m", "a=d/l", "r=6*d/l"],
            ["r=6*d/l", "a=d/l", "m=2*m", "l=1 m"],
            ["a=d/l", "l=1 m", "r=6*d/l", "m=2*m"],
        ] {
            let found = settings(&texts).expect("settings");
            for (name, right) in [("l", 1000.0), ("m", 4.0), ("r", 2.0), ("a", 90.0 / PI)] {
                let value = found.iter().find(|(known, _)| known == name);
                let (_, value) = value.expect("a value");
                assert!(
                    (value / right - 1.0).abs() < 1e-14,
                    "{texts:?}: {name} = {value}"
                );
            }
            assert!(
                found
                    .iter()
                    .zip(texts)
                    .all(|((name, _), text)| text.starts_with(name))
            );
        }
        for texts in [["l=2*d", "d=l/4"], ["d=l/4", "l=2*d"]] {
            let error = settings(&texts).expect_err("a cycle").to_string();
            assert!(
                error.contains("refer to each other") && error.contains("`d`"),
                "{error}"
            );
        }
    }

    #[test]
    fn unknown_settings_are_rejected_with_a_suggestion() {
        let model = model();
        let wrong = Assignment::split("--set", "ll=1").expect("an assignment");
        let error = model
            .read_settings(&[wrong])
            .expect_err("no such parameter")
            .to_string();
        assert!(
            error.contains("--set:1:1") && error.contains("did you mean `l`"),
            "{error}"
        );
    }

    #[test]
    fn errors_of_an_edited_text_are_relocated() {
        let given = Assignment::split("--input", "u = 2*zz + 1").expect("an assignment");
        let text = "# 1\n[definitions]\nu = \"2*zz + 1\"\n";
        let start = text.find("zz").expect("the name");
        let source = Source::new("model.toml", text);
        let found = |span| {
            Diagnostics::from_one(
                source.clone(),
                Diagnostic::error("unknown").with_span(span, ""),
            )
        };
        let moved = given.relocated(&found(Span::new(start, start + 2)));
        let moved = moved.expect("a place").render(false);
        assert!(
            moved.contains("--input:1:7") && moved.contains("u = 2*zz + 1"),
            "{moved}"
        );
        assert!(given.relocated(&found(Span::new(0, 1))).is_none());
        let missing = Diagnostics::from_one(source.clone(), Diagnostic::error("unknown"));
        assert!(given.relocated(&missing).is_none());
    }
}
