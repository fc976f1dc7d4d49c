//! Units of measurement: numbers are in SI, and shown in the unit that the specification declares.

use std::collections::BTreeMap;

use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

/// The base units by their names in a description, in the order of a dimension's exponents.
const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// How a variable's numbers are measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measure {
    /// The coherent SI unit.
    pub unit: String,
    /// The unit that it is shown in, if another.
    pub shown: Option<String>,
}

/// An SI unit: its base units, if their exponents are whole numbers, and the units it is shown in
/// with the number of each in one of it.
#[derive(Clone, Debug, Default)]
pub struct Definition {
    /// Exponents by base unit.
    pub base: Option<Vec<(&'static str, i32)>>,
    /// Factors by name.
    pub shown: BTreeMap<String, f64>,
}

/// All units of a description, by name.
#[derive(Clone, Debug, Default)]
pub struct Units {
    /// Definitions.
    pub definitions: BTreeMap<String, Definition>,
}

impl Units {
    /// How numbers declared in `unit` are measured.
    pub fn measure(&mut self, unit: &Unit) -> Measure {
        if unit.is_coherent() {
            let name = unit.to_string();
            self.define(&name, unit.dimension);
            return Measure {
                unit: name,
                shown: None,
            };
        }
        let name = match unit.dimension.is_none() && unit.text.contains("deg") {
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

    /// How the rate of what is measured in `unit` is measured, `times` times differentiated.
    pub fn rate(&mut self, unit: &Unit, times: u8) -> Option<Measure> {
        let mut dimension = unit.dimension;
        for _ in 0..times {
            dimension = dimension.over(Dimension::TIME)?;
        }
        let is_angle = unit.dimension.is_none() && matches!(unit.text.as_str(), "rad" | "deg");
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

/// Exponents by base unit. Radians, which have no dimension, are told by the unit's name.
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
