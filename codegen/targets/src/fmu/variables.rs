//! Variables of a unit, in the order of their value references: time, state, rates, inputs, parameters, observables,
//! event indicators, states of controllers.

use std::collections::HashSet;

use eomgen_codegen::program::Op;
use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::model::{Model, ParameterValue};
use eomgen_model_spec::unit::Unit as Measurement;
use eomgen_unit::{find_surfaces, token};

use super::units::{Measure, Units};
use crate::error::{EmissionError, Result};

/// Kind of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Independent variable.
    Time,
    /// State.
    State,
    /// Derivative of the state with this value reference.
    Rate(usize),
    /// Input.
    Input,
    /// Input that a controller of the unit drives.
    DrivenInput,
    /// Tunable parameter.
    Parameter,
    /// Observable.
    Observable,
    /// Switching function.
    Indicator,
    /// State of a controller.
    ControllerState,
}

/// Variable; its index is its value reference.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Unique name.
    pub name: String,
    pub kind: Kind,
    /// Description.
    pub doc: String,
    /// Unit, if known.
    pub measure: Option<Measure>,
    /// Initial value, in SI.
    pub start: Option<f64>,
    /// Typical size, in SI.
    pub nominal: Option<f64>,
    /// Minimum, in SI.
    pub min: Option<f64>,
    /// Maximum, in SI.
    pub max: Option<f64>,
}

/// Content of the description of a unit.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Name of the model.
    pub name: String,
    /// Title of the model.
    pub title: String,
    /// Token that links a description to its binary.
    pub token: String,
    /// Variables, in the order of their value references.
    pub variables: Vec<Variable>,
    /// Units of measurement.
    pub units: Units,
    /// True if the equations depend on time.
    depends_on_time: bool,
}

impl Unit {
    /// Creates the description of a model.
    pub fn new(compiled: &CompiledModel) -> Result<Self> {
        let (model, program) = (compiled.model(), compiled.program());
        let orders = compiled.orders();
        let instance = compiled
            .with_declared_parameters()
            .map_err(EmissionError::request)?;
        let state = instance.initial_state();
        let mut list = List::default();
        let seconds = Measurement::parse("s").ok();
        list.add("time", Kind::Time, "Time", seconds.as_ref());
        list.state(
            model,
            &program.state_names(),
            (state, compiled.typical_sizes()),
            orders,
        );
        let inputs = model.inputs.iter().zip(compiled.default_inputs());
        for (place, (input, value)) in inputs.enumerate() {
            let (kind, start) = match model.is_controlled(place) {
                true => (Kind::DrivenInput, None),
                false => (Kind::Input, Some(value)),
            };
            let variable = list.add(&input.name, kind, &input.doc, Some(&input.unit));
            variable.start = start;
        }
        for (parameter, own) in model
            .parameters
            .iter()
            .filter(|parameter| matches!(parameter.value, ParameterValue::Number(_)))
            .zip(&program.parameters)
        {
            let (name, unit) = (&parameter.name, &parameter.unit);
            let variable = list.add(name, Kind::Parameter, &parameter.doc, Some(unit));
            variable.start = Some(own.value);
            variable.min = parameter.min.filter(|value| value.is_finite());
            variable.max = parameter.max.filter(|value| value.is_finite());
        }
        for observable in &program.observables {
            let unit = Measurement::parse(&observable.unit).ok();
            let (name, doc) = (&observable.name, &observable.doc);
            list.add(name, Kind::Observable, doc, unit.as_ref());
        }
        for (place, surface) in find_surfaces(&instance)
            .map_err(EmissionError::request)?
            .iter()
            .enumerate()
        {
            let name = format!("indicator[{}]", place + 1);
            let doc = format!("Changes sign at events of {}", surface.formula);
            list.add(&name, Kind::Indicator, &doc, None);
        }
        for controller in &model.controllers {
            for state in &controller.states {
                let kind = Kind::ControllerState;
                list.add(&state.name, kind, &state.doc, Some(&state.unit));
            }
        }
        Ok(Self {
            name: program.name.clone(),
            title: program.title.clone(),
            token: token(program),
            variables: list.variables,
            units: list.units,
            depends_on_time: program.ids().any(|id| program.value(id).op == Op::Time),
        })
    }

    /// Returns the value references that a variable depends on, with or without parameters. The list contains the
    /// whole state, because a rate may switch with a state although its derivative with respect to this state is
    /// zero.
    pub fn dependencies(&self, reference: usize, with_parameters: bool) -> Vec<usize> {
        let from_one = match self.variables[reference].kind {
            Kind::State => Some(reference),
            Kind::Rate(state) => self.velocity(state),
            _ => None,
        };
        if let Some(only) = from_one {
            return vec![only];
        }
        let known = self.of_kind(|kind| match kind {
            Kind::State | Kind::Input => true,
            Kind::Parameter => with_parameters,
            Kind::Time => self.depends_on_time,
            _ => false,
        });
        known.map(|(reference, _)| reference).collect()
    }

    /// Returns the state that is the rate of a coordinate.
    fn velocity(&self, state: usize) -> Option<usize> {
        let states = self.of_kind(|kind| kind == Kind::State).count();
        (state <= states / 2).then_some(state + states / 2)
    }

    /// Returns the variables of a kind, with their value references.
    pub fn of_kind(&self, is: impl Fn(Kind) -> bool) -> impl Iterator<Item = (usize, &Variable)> {
        let all = self.variables.iter().enumerate();
        all.filter(move |(_, variable)| is(variable.kind))
    }
}

/// List of variables under construction.
#[derive(Default)]
struct List {
    variables: Vec<Variable>,
    names: HashSet<String>,
    units: Units,
}

impl List {
    fn add(
        &mut self,
        name: &str,
        kind: Kind,
        doc: &str,
        unit: Option<&Measurement>,
    ) -> &mut Variable {
        let measure = unit.map(|unit| self.units.measure(unit));
        self.push(name, kind, doc, measure)
    }

    fn push(
        &mut self,
        name: &str,
        kind: Kind,
        doc: &str,
        measure: Option<Measure>,
    ) -> &mut Variable {
        let name = self.free(name, kind);
        self.names.insert(name.clone());
        self.variables.push(Variable {
            name,
            kind,
            doc: doc.to_owned(),
            measure,
            start: None,
            nominal: None,
            min: None,
            max: None,
        });
        let last = self.variables.len() - 1;
        &mut self.variables[last]
    }

    /// Returns a unique name. If a name is already used, its kind and a point are prepended; names in a specification
    /// contain no point.
    fn free(&self, name: &str, kind: Kind) -> String {
        let group = match kind {
            Kind::Time | Kind::State | Kind::Rate(_) => "state",
            Kind::Input | Kind::DrivenInput => "input",
            Kind::ControllerState => "controller",
            Kind::Parameter => "parameter",
            Kind::Observable => "observable",
            Kind::Indicator => "event",
        };
        if self.names.contains(name) {
            format!("{group}.{name}")
        } else {
            name.to_owned()
        }
    }

    fn state(
        &mut self,
        model: &Model,
        names: &[String],
        (initial, sizes): (&[f64], &[f64]),
        orders: &[usize],
    ) {
        // Description, unit, and true for a rate in this unit per second.
        let mut rows: Vec<(String, &Measurement, bool)> = Vec::new();
        for coordinate in &model.coordinates {
            rows.push((coordinate.doc.clone(), &coordinate.unit, false));
        }
        for (field, order) in model.fields.iter().zip(orders) {
            for mode in 1..=*order {
                rows.push((format!("{}, mode {mode}", field.doc), &field.unit, false));
            }
        }
        for place in 0..rows.len() {
            rows.push((format!("Rate of {}", names[place]), rows[place].1, true));
        }
        for state in &model.states {
            rows.push((state.doc.clone(), &state.unit, false));
        }
        let first = self.variables.len();
        for ((name, (doc, unit, is_rate)), (initial, size)) in
            names.iter().zip(&rows).zip(initial.iter().zip(sizes))
        {
            let measure = self.units.rate(unit, u8::from(*is_rate));
            let variable = self.push(name, Kind::State, doc, measure);
            (variable.start, variable.nominal) = (Some(*initial), Some(*size));
        }
        for (place, (_, unit, is_rate)) in rows.iter().enumerate() {
            let state = self.variables[first + place].name.clone();
            let measure = self.units.rate(unit, 1 + u8::from(*is_rate));
            let doc = format!("Derivative of {state}");
            self.push(
                &format!("der({state})"),
                Kind::Rate(first + place),
                &doc,
                measure,
            );
        }
    }
}
