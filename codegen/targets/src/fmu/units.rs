//! Units of measurement. Numbers are in SI; the declared unit is the display unit.

use std::collections::BTreeMap;

use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

/// Names of the base units in a description, in the order of a dimension's exponents.
const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// Unit of a variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Coherent SI unit.
    pub unit: String,
    /// Display unit, if different.
    pub shown: Option<String>,
}

/// SI unit: base units, if their exponents are whole numbers, and display units with their factors.
#[derive(Clone, Debug, Default)]
pub struct Definition {
    /// Exponents by base unit.
    pub base: Option<Vec<(&'static str, i32)>>,
    /// Factors of display units, by name.
    pub shown: BTreeMap<String, f64>,
}

/// Units of a description, by name.
#[derive(Clone, Debug, Default)]
pub struct Units {
    pub definitions: BTreeMap<String, Definition>,
}

impl Units {
    /// Registers a declared unit.
    pub fn measure(&mut self, unit: &Unit) -> Measure {
        if unit.is_coherent() {
            let name = unit.to_string();
            self.define(&name, unit.dimension);
            return Measure {
                unit: name,
                shown: None,
            };
        }
        let name = match unit.dimension.is_dimensionless() && unit.text.contains("deg") {
            true => "rad".to_owned(),
            false => unit.dimension.to_string(),
        };
        let shown = unit.to_string();
        let definition = self.define(&name, unit.dimension);
        definition.shown.insert(shown.clone(), unit.from_si(1.0));
        Measure {
            unit: name,
            shown: Some(shown),
        }
    }

    /// Registers the unit of the time derivative of order `times` of a quantity in `unit`.
    pub fn rate(&mut self, unit: &Unit, times: u8) -> Option<Measure> {
        let mut dimension = unit.dimension;
        for _ in 0..times {
            dimension = dimension.divide(Dimension::TIME)?;
        }
        let is_angle =
            unit.dimension.is_dimensionless() && matches!(unit.text.as_str(), "rad" | "deg");
        let name = match (is_angle, times) {
            (false, _) => dimension.to_string(),
            (true, 0) => "rad".to_owned(),
            (true, 1) => "rad/s".to_owned(),
            (true, times) => format!("rad/s^{times}"),
        };
        self.define(&name, dimension);
        Some(Measure {
            unit: name,
            shown: None,
        })
    }

    fn define(&mut self, name: &str, dimension: Dimension) -> &mut Definition {
        self.definitions
            .entry(name.to_owned())
            .or_insert_with(|| Definition {
                base: base(name, dimension),
                shown: BTreeMap::new(),
            })
    }
}

/// Returns exponents by base unit. The radian is dimensionless, so it is recognised by the name of the unit.
fn base(name: &str, dimension: Dimension) -> Option<Vec<(&'static str, i32)>> {
    let exponents = dimension.exponents();
    if !exponents.iter().all(|exponent| exponent.is_integer()) {
        return None;
    }
    let whole = exponents.iter().map(|exponent| exponent.to_integer());
    let mut base: Vec<(&str, i32)> = BASE.into_iter().zip(whole).collect();
    base.retain(|(_, exponent)| *exponent != 0);
    if matches!(name, "rad" | "rad/s" | "rad/s^2") {
        base.push(("rad", 1));
    }
    Some(base)
}
