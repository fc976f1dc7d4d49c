//! Model description that a unit must have, from the specification and the program.

use std::collections::{BTreeMap, BTreeSet};

use eomgen_codegen::program::Program;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::unit::Unit;

use super::description::{Description, Measure};

/// Names of the base units, in the order of the exponents of a dimension.
const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// Variable of a model description.
pub struct Variable {
    pub name: String,
    causality: &'static str,
    variability: &'static str,
    /// Initial value, minimum and maximum by attribute name, in SI.
    numbers: BTreeMap<&'static str, f64>,
    dimension: Option<Dimension>,
    /// Declared unit, if it is not a coherent SI unit.
    shown: Option<Unit>,
    /// Name of the variable whose time derivative this variable is.
    derivative_of: Option<String>,
}

/// Expected variables of a unit, by causality and kind.
pub struct Variables {
    pub states: Vec<Variable>,
    pub rates: Vec<Variable>,
    /// Inputs that no controller drives.
    pub inputs: Vec<Variable>,
    pub parameters: Vec<Variable>,
    pub observables: Vec<Variable>,
    others: Vec<Variable>,
}

/// Names in use. If a name is already in use, the prefix `GROUP.` is added to the new one.
struct Names(BTreeSet<String>);

impl Names {
    fn variable(
        &mut self,
        (group, name): (&str, &str),
        causality: &'static str,
        variability: &'static str,
    ) -> Variable {
        let name = match self.0.contains(name) {
            true => format!("{group}.{name}"),
            false => name.to_owned(),
        };
        self.0.insert(name.clone());
        Variable {
            name,
            causality,
            variability,
            numbers: BTreeMap::new(),
            dimension: None,
            shown: None,
            derivative_of: None,
        }
    }
}

impl Variable {
    fn in_unit(mut self, unit: &Unit) -> Self {
        self.dimension = Some(unit.dimension);
        self.shown = (!unit.is_coherent()).then(|| unit.clone());
        self
    }

    fn with_number(mut self, attribute: &'static str, number: Option<f64>) -> Self {
        let finite = number.filter(|number| number.is_finite());
        self.numbers
            .extend(finite.map(|number| (attribute, number)));
        self
    }
}

impl Variables {
    /// Returns the variables of a model with these default inputs.
    pub fn new(model: &Model, program: &Program, default_inputs: &[f64]) -> Self {
        let mut names = Names(BTreeSet::new());
        let mut time = names.variable(("state", "time"), "independent", "continuous");
        time.dimension = Some(Dimension::TIME);
        let domain = &program.domain;
        let dimension = |text: &String| Unit::parse(text).ok().map(|unit| unit.dimension);
        let dimensions: Vec<Option<Dimension>> = domain.state_units.iter().map(dimension).collect();
        let state_names = program.state_names();
        let mut states: Vec<Variable> = (state_names.iter().zip(&domain.initial_state))
            .map(|(name, initial)| {
                let state = names.variable(("state", name), "output", "continuous");
                state.with_number("start", Some(*initial))
            })
            .collect();
        for (state, dimension) in states.iter_mut().zip(&dimensions) {
            state.dimension = *dimension;
        }
        let mut rates = Vec::new();
        for state in &states {
            let name = format!("der({})", state.name);
            let mut rate = names.variable(("state", &name), "local", "continuous");
            rate.dimension = state.dimension.and_then(|of| of.divide(Dimension::TIME));
            rate.derivative_of = Some(state.name.clone());
            rates.push(rate);
        }
        let inputs = model.inputs.iter().zip(default_inputs).enumerate();
        let (driven, inputs): (Vec<Variable>, Vec<Variable>) = inputs
            .map(|(place, (input, start))| {
                let is_driven = model.is_controlled(place);
                let (causality, variability, start) = match is_driven {
                    true => ("local", "discrete", None),
                    false => ("input", "continuous", Some(*start)),
                };
                let variable = names.variable(("input", &input.name), causality, variability);
                variable.in_unit(&input.unit).with_number("start", start)
            })
            .partition(|variable| variable.causality == "local");
        let parameters: Vec<Variable> = (program.parameters.iter())
            .map(|own| {
                let name = &own.quantity.name;
                let variable = names.variable(("parameter", name), "parameter", "tunable");
                let variable = variable.with_number("start", Some(own.value));
                match model.parameters.iter().find(|known| known.name == *name) {
                    Some(known) => (variable.in_unit(&known.unit))
                        .with_number("min", known.min)
                        .with_number("max", known.max),
                    None => variable,
                }
            })
            .collect();
        let observables: Vec<Variable> = (program.observables.iter())
            .map(|observable| {
                let group = ("observable", &*observable.name);
                let mut variable = names.variable(group, "output", "continuous");
                variable.dimension = dimension(&observable.unit);
                variable
            })
            .collect();
        let controllers = model.controller_states().into_iter().map(|(name, unit)| {
            let variable = names.variable(("controller", name), "output", "discrete");
            variable.in_unit(unit)
        });
        let others = controllers.chain(driven).chain([time]).collect();
        Self {
            states,
            rates,
            inputs,
            parameters,
            observables,
            others,
        }
    }

    fn iter(&self) -> impl Iterator<Item = &Variable> {
        let groups = [
            &self.states,
            &self.rates,
            &self.inputs,
            &self.parameters,
            &self.observables,
            &self.others,
        ];
        groups.into_iter().flatten()
    }

    /// Compares with `description` and returns the number of compared items and the differences.
    pub fn compare(&self, description: &Description) -> (usize, Vec<String>) {
        let mut compared = 0;
        let mut differences = Vec::new();
        let mut names: BTreeSet<&str> = BTreeSet::new();
        for variable in self.iter() {
            names.insert(&variable.name);
            let named = |found: &&BTreeMap<String, String>| {
                found.get("name").is_some_and(|name| *name == variable.name)
            };
            let mut of_name = description.variables.iter().filter(named);
            compared += 1;
            match (of_name.next(), of_name.next()) {
                (Some(found), None) => {
                    let wrong = variable.differences(found, description);
                    differences.extend(
                        (wrong.into_iter()).map(|what| format!("{what} of {}", variable.name)),
                    );
                }
                (None, _) => differences.push(format!("{}, which is missing", variable.name)),
                _ => differences.push(format!("{}, which appears twice", variable.name)),
            }
        }
        let is_indicator = |name: &str| name.starts_with("indicator[");
        for found in &description.variables {
            let name = found.get("name").map_or("", String::as_str);
            if !names.contains(name) && !is_indicator(name) {
                differences.push(format!("{name}, which the specification lacks"));
            }
        }
        let indicators = description.variables.iter();
        let indicators =
            indicators.filter(|v| v.get("name").is_some_and(|name| is_indicator(name)));
        let indicators = indicators.count().to_string();
        if let Some(stated) = description.root.get("numberOfEventIndicators") {
            compared += 1;
            if *stated != indicators {
                differences.push("numberOfEventIndicators".to_owned());
            }
        }
        (compared, differences)
    }
}

impl Variable {
    /// Returns the attributes that differ.
    fn differences(
        &self,
        found: &BTreeMap<String, String>,
        description: &Description,
    ) -> Vec<&'static str> {
        let mut wrong = Vec::new();
        for (attribute, expected) in [
            ("causality", self.causality),
            ("variability", self.variability),
        ] {
            if found.get(attribute).is_none_or(|value| value != expected) {
                wrong.push(attribute);
            }
        }
        for attribute in ["start", "min", "max"] {
            let stated = found.get(attribute);
            let is_same = match (self.numbers.get(attribute), stated) {
                (None, None) => true,
                (Some(expected), Some(stated)) => stated.parse::<f64>() == Ok(*expected),
                _ => false,
            };
            if !is_same {
                wrong.push(attribute);
            }
        }
        if !self.has_unit(found, &description.units) {
            wrong.push("unit");
        }
        if !self.has_state(found.get("derivative"), description) {
            wrong.push("derivative");
        }
        wrong
    }

    fn has_unit(
        &self,
        found: &BTreeMap<String, String>,
        units: &BTreeMap<String, Measure>,
    ) -> bool {
        let Some(dimension) = self.dimension else {
            return true;
        };
        let Some(unit) = found.get("unit") else {
            return false;
        };
        let Some(measure) = units.get(unit) else {
            return false;
        };
        let has_base = match &measure.base {
            // FMI supports integer exponents only.
            None => !dimension.exponents().iter().all(|known| known.is_integer()),
            Some(base) => {
                let same = BASE.iter().zip(dimension.exponents()).all(|(name, known)| {
                    let stated = base
                        .get(*name)
                        .map_or(Ok(0), |stated| stated.parse::<i32>());
                    known.is_integer() && stated == Ok(known.to_integer())
                });
                same && !base.contains_key("factor") && !base.contains_key("offset")
            }
        };
        let shown = found.get("displayUnit");
        let is_shown = match (&self.shown, shown) {
            (None, None) => true,
            (Some(unit), Some(shown)) => {
                let factor = measure
                    .shown
                    .get(shown)
                    .and_then(|factor| factor.parse().ok());
                *shown == unit.to_string() && factor == Some(unit.from_si(1.0))
            }
            _ => false,
        };
        has_base && is_shown
    }

    /// Returns true if the attribute `derivative` refers to the state: by value reference in FMI 3, by index from 1 in
    /// FMI 2.
    fn has_state(&self, stated: Option<&String>, description: &Description) -> bool {
        let stated = stated.map(|text| text.parse::<usize>().ok());
        let Some(state) = &self.derivative_of else {
            return stated.is_none();
        };
        let variables = &description.variables;
        let is_state =
            |found: &BTreeMap<String, String>| found.get("name").is_some_and(|name| name == state);
        let expected = match description.version() {
            Some(2) => variables.iter().position(is_state).map(|place| place + 1),
            _ => description
                .reference(state)
                .and_then(|reference| usize::try_from(reference).ok()),
        };
        stated == Some(expected) && expected.is_some()
    }
}
