//! Regime of a piecewise model at a point: the side of each switching surface.

use std::fmt;

use eomgen_compiled_model::{Instance, OperatingPoint};
use serde_json::{Value, json};

use crate::error::{Result, warn};

/// Side of a switching surface at a point.
pub struct Side {
    /// Switching function.
    formula: String,
    value: f64,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} 0", self.formula, self.sign())
    }
}

impl Side {
    fn sign(&self) -> char {
        match self.value {
            value if value > 0.0 => '>',
            value if value < 0.0 => '<',
            _ => '=',
        }
    }

    pub fn json(&self) -> Value {
        json!({ "surface": self.formula, "value": self.value, "side": self.sign().to_string() })
    }
}

/// Maximum number of surfaces in a summary.
const MAX_SURFACES: usize = 12;

/// Returns one text for each surface; for the surfaces of a field, the number of positions on each side. The last text
/// is the number of omitted surfaces.
pub fn summary(sides: &[Side]) -> Vec<String> {
    let surfaces: Vec<&[Side]> = sides
        .chunk_by(|one, next| one.formula == next.formula)
        .collect();
    let mut texts: Vec<String> = surfaces
        .iter()
        .take(MAX_SURFACES)
        .map(|surface| counts(surface))
        .collect();
    if let Some(left @ 1..) = surfaces.len().checked_sub(MAX_SURFACES) {
        texts.push(format!("and {left} other surfaces (--json lists all)"));
    }
    texts
}

/// Returns the side of a surface, or for a field the number of positions on each side.
fn counts(surface: &[Side]) -> String {
    let [first, others @ ..] = surface else {
        return String::new();
    };
    let places = surface.len();
    if others.is_empty() {
        return first.to_string();
    }
    let counts: Vec<String> = ['>', '<', '=']
        .into_iter()
        .filter_map(|sign| {
            let count = surface.iter().filter(|side| side.sign() == sign).count();
            (count > 0).then(|| format!("{sign} 0 at {count}"))
        })
        .collect();
    format!("{} {} of {places} places", first.formula, counts.join(", "))
}

/// Returns the sides of all switching surfaces at a point; a surface of a sum over modes has one side for each mode.
pub fn regime(run: &Instance<'_>, at: &OperatingPoint) -> Result<Vec<Side>> {
    let mut evaluator = run.interpreter()?;
    let mut values = vec![0.0; evaluator.guard_count()];
    evaluator.guards(at.point(), &mut values);
    let program = run.model().program();
    let formulas = program.guards.iter().flat_map(|guard| {
        let count = program.value(guard.value).extent.length();
        std::iter::repeat_n(guard.formula.clone(), count)
    });
    let sides = formulas.zip(values);
    Ok(sides
        .map(|(formula, value)| Side { formula, value })
        .collect())
}

/// Prints a note if the point is on switching surfaces, because the linearisation is then one-sided.
pub fn note_surfaces(regime: &[Side]) {
    let mut on: Vec<String> = (regime.iter())
        .filter(|side| side.sign() == '=')
        .map(|side| format!("`{}`", side.formula))
        .collect();
    on.dedup();
    let listed: Vec<String> = on.iter().take(MAX_SURFACES).cloned().collect();
    warn(&format!(
        "note: at this state {} {} zero: the linearisation uses one side of the switching surface; to select a side, give a \
         state on this side with --state",
        listed.join(", "),
        if on.len() == 1 { "is" } else { "are" }
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(formula: &str, value: f64) -> Side {
        Side {
            formula: formula.to_owned(),
            value,
        }
    }

    #[test]
    fn surfaces_of_a_field_are_counted() {
        let mut sides = vec![side("x", -1.0), side("y - b", 0.0)];
        let field = (0..200).map(|place| side("w", f64::from(place - 50)));
        sides.extend(field);
        let expected = [
            "x < 0",
            "y - b = 0",
            "w > 0 at 149, < 0 at 50, = 0 at 1 of 200 places",
        ];
        assert_eq!(summary(&sides), expected);
        let rest: Vec<Side> = (0..20)
            .map(|place| side("w", f64::from(place)))
            .skip(1)
            .collect();
        assert_eq!(summary(&rest), ["w > 0 at 19 of 19 places"]);
    }

    #[test]
    fn surfaces_after_the_twelfth_are_counted() {
        let sides: Vec<Side> = (0..15)
            .map(|place| side(&format!("x_{place}"), 1.0))
            .collect();
        let found = summary(&sides);
        assert_eq!(found.len(), 13);
        assert_eq!(found[12], "and 3 other surfaces (--json lists all)");
        assert_eq!(summary(&sides[..12]).len(), 12);
        assert!(summary(&[]).is_empty());
    }
}
