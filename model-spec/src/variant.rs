//! Numbers of a model and their changes: values of parameters, orders of fields, names of states.

use std::path::{Path, PathBuf};

use crate::diagnostic::Diagnostic;
use crate::evaluate::evaluate;
use crate::model::{Expr, ExprKind, MAX_ORDER, Model, Parameter, ParameterValue, Range};
use crate::source::sha256;
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::{constants, positions};

/// Largest number of names in a suggestion.
const MAX_SUGGESTIONS: usize = 12;

/// Error of a model that is invalid with its numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelError {
    /// Cause.
    pub message: String,
    /// Proposed correction, if known.
    pub help: Option<String>,
    /// Position in the specification, if there is one.
    pub span: Option<Span>,
}

impl ModelError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: None,
            span: None,
        }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub(crate) fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// Converts the error to a diagnostic of the source of the model.
    pub fn diagnostic(self) -> Diagnostic {
        let diagnostic = Diagnostic::error(self.message).with_optional_help(self.help);
        match self.span {
            Some(span) => diagnostic.with_span(span, ""),
            None => diagnostic,
        }
    }
}

impl std::fmt::Display for ModelError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for ModelError {}

impl Model {
    /// Returns the SHA-256 of all text from which the model was read. If there are no tables, it is the hash of the
    /// text of the specification. If there are tables, the hexadecimal hashes of the specification and of the tables,
    /// in the order of the fields, are concatenated and hashed.
    pub fn hash(&self) -> String {
        let tables = self.fields.iter().filter_map(|field| field.basis.table());
        let tables: String = tables.map(|table| table.sha256.as_str()).collect();
        match tables.is_empty() {
            true => self.source.hash(),
            false => sha256(self.source.hash() + &tables),
        }
    }

    /// Returns the paths of all files that the model was read from, as shown in messages: the specification, the
    /// files that it extends, and its tables.
    pub fn files(&self) -> Vec<PathBuf> {
        let folder = Path::new(&self.source.path).parent();
        let folder = folder.unwrap_or(Path::new(""));
        let tables = self.fields.iter().filter_map(|field| field.basis.table());
        let texts = self.source.files().into_iter().map(PathBuf::from);
        texts
            .chain(tables.map(|table| folder.join(&table.file)))
            .collect()
    }

    /// Returns the highest order that all fields support. A table supports as many modes as it has shapes.
    pub fn highest_order(&self) -> usize {
        let tables = self.fields.iter().filter_map(|field| field.basis.table());
        tables.fold(MAX_ORDER, |order, table| order.min(table.shapes.len()))
    }

    /// Returns the expressions that determine the motion, and the observables.
    pub fn motion_expressions(&self) -> impl Iterator<Item = &Expr> {
        let terms = [&self.kinetic, &self.potential, &self.dissipation];
        (self.definitions.iter().map(|definition| &definition.value))
            .chain(terms.into_iter().flatten().map(|term| &term.value))
            .chain((self.forces.iter()).flat_map(|force| [&force.on, &force.value]))
            .chain(self.states.iter().map(|state| &state.rate))
            .chain(self.constraints.iter().map(|constraint| &constraint.zero))
            .chain(self.impacts.iter().map(|impact| &impact.when))
            .chain(self.observables.iter().map(|observable| &observable.value))
    }

    /// Returns the lowest order that contains all single modes that the expressions of the motion name.
    pub fn lowest_order(&self) -> usize {
        let mut lowest = 0;
        for expression in self.motion_expressions() {
            expression.visit(&mut |part| {
                if let ExprKind::SingleMode { mode, .. } = part.kind {
                    lowest = lowest.max(mode);
                }
            });
        }
        lowest
    }

    /// Returns the values of all parameters in SI, in the order of [`Model::parameters`].
    ///
    /// # Errors
    /// A value is not finite or outside its bounds; the error contains the name of the parameter.
    pub fn parameter_values(&self) -> Result<Vec<f64>, ModelError> {
        let values = self.evaluated_parameters();
        for &index in &self.parameter_order {
            check_value(&self.parameters[index], values[index])?;
        }
        Ok(values)
    }

    /// Returns the values of all parameters in SI, without checks.
    pub(crate) fn evaluated_parameters(&self) -> Vec<f64> {
        let mut values = vec![f64::NAN; self.parameters.len()];
        for &index in &self.parameter_order {
            values[index] = match &self.parameters[index].value {
                ParameterValue::Number(value) => *value,
                ParameterValue::Expression(expr) => evaluate(expr, &values),
            };
        }
        values
    }

    /// Returns the initial state in SI at these orders: values of coordinates and modes (0), their
    /// rates, and the first-order states.
    ///
    /// # Errors
    /// As for [`Model::parameter_values`], or an initial value is not finite.
    pub fn initial_state(&self, orders: &[usize]) -> Result<Vec<f64>, ModelError> {
        let parameters = self.parameter_values()?;
        let modes: usize = orders.iter().sum();
        let half = self.coordinates.len() + modes;
        let mut state = vec![0.0; 2 * half + self.states.len()];
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let name = &coordinate.name;
            let given = [
                (index, name.clone(), &coordinate.initial),
                (
                    half + index,
                    format!("{name}_dot"),
                    &coordinate.initial_rate,
                ),
            ];
            for (place, name, expr) in given {
                state[place] = initial_value(&name, expr.as_ref(), &parameters)?;
            }
        }
        for (first_order, place) in self.states.iter().zip(2 * half..) {
            let expr = first_order.initial.as_ref();
            state[place] = initial_value(&first_order.name, expr, &parameters)?;
        }
        Ok(state)
    }

    /// Returns the ranges of the coordinates, in SI; `None` without a `range`.
    ///
    /// # Errors
    /// As for [`Model::parameter_values`].
    pub fn coordinate_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.coordinates.iter().map(|c| c.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// Returns the ranges of the first-order states, in SI; `None` without a `range`.
    ///
    /// # Errors
    /// As for [`Model::parameter_values`].
    pub fn state_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.states.iter().map(|state| state.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// Returns default values of the inputs, in SI. A prescribed motion, which can occur in the
    /// energies, gets the middle of its range, or `without_range`; any other input gets 0.
    ///
    /// # Errors
    /// As for [`Model::parameter_values`].
    pub fn typical_inputs(&self, without_range: f64) -> Result<Vec<f64>, ModelError> {
        let ranges = self.input_ranges()?;
        let typical = self.inputs.iter().zip(ranges).map(|(input, range)| {
            match (input.is_prescribed(), range) {
                (true, Some((low, high))) => 0.5 * (low + high),
                (true, None) => without_range,
                (false, _) => 0.0,
            }
        });
        Ok(typical.collect())
    }

    /// Returns the ranges of the inputs, in SI; `None` without a `range`.
    ///
    /// # Errors
    /// As for [`Model::parameter_values`].
    pub fn input_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.inputs.iter().map(|input| input.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// Returns the model with one parameter set to a number in its declared unit. Dependent
    /// parameters are recomputed.
    ///
    /// # Errors
    /// The name is unknown, the number is not finite or outside its bounds, or a dependent value is not finite.
    pub fn with_parameter(&self, name: &str, value: f64) -> Result<Self, ModelError> {
        self.with_parameters(&[(name, value)])
    }

    /// Returns the model with several parameters set. Only the final values are checked.
    ///
    /// # Errors
    /// As for [`Model::with_parameter`].
    pub fn with_parameters(&self, settings: &[(&str, f64)]) -> Result<Self, ModelError> {
        let mut model = self.clone();
        for (name, value) in settings {
            model.set(name, *value)?;
        }
        model.check_numbers()?;
        Ok(model)
    }

    fn set(&mut self, name: &str, value: f64) -> Result<(), ModelError> {
        let Some(index) = self.parameters.iter().position(|known| known.name == name) else {
            let error = ModelError::new(format!("the model has no parameter `{name}`"));
            return Err(error.help(self.suggest_parameters(name)));
        };
        if !value.is_finite() {
            let message = format!("`{name}` cannot be {value}");
            return Err(ModelError::new(message).help("give a finite number"));
        }
        let parameter = &mut self.parameters[index];
        parameter.value = ParameterValue::Number(parameter.unit.to_si(value));
        self.settings.retain(|(known, _)| known != name);
        self.settings.push((name.to_owned(), value));
        Ok(())
    }

    /// Suggests parameters for an unknown name: the nearest name, names with a common part, or the first parameters
    /// of the model.
    pub(crate) fn suggest_parameters(&self, name: &str) -> String {
        let known = || self.parameters.iter().map(|known| known.name.as_str());
        if let Some(help) = did_you_mean(name, known()) {
            return help;
        }
        if self.coordinates.iter().any(|known| known.name == name) {
            return format!(
                "`{name}` is a coordinate: set its `initial` for another initial value"
            );
        }
        if self.states.iter().any(|known| known.name == name) {
            return format!("`{name}` is a state: set its `initial` for another initial value");
        }
        let alike: Vec<&str> = known()
            .filter(|known| have_common_part(name, known))
            .collect();
        let (intro, names) = match alike.len() {
            0 => ("the parameters are", known().collect()),
            _ => ("did you mean one of", alike),
        };
        let more = match names.len().saturating_sub(MAX_SUGGESTIONS) {
            0 => "",
            _ => ", ...",
        };
        let names: Vec<String> = names
            .iter()
            .take(MAX_SUGGESTIONS)
            .map(|name| format!("`{name}`"))
            .collect();
        match names.as_slice() {
            [] => "the model has none".to_owned(),
            names => format!("{intro} {}{more}", names.join(", ")),
        }
    }

    /// Returns the order of each field: its default, or `order` for all of them.
    ///
    /// # Errors
    /// The order is above [`MAX_ORDER`] or above the number of shapes in a table, or the order is not 0 and the model
    /// has no field.
    pub fn orders(&self, order: Option<usize>) -> Result<Vec<usize>, ModelError> {
        match order {
            Some(order) if order > MAX_ORDER => {
                let message = format!("the order {order} is above the limit");
                Err(ModelError::new(message).help(format!("the highest order is {MAX_ORDER}")))
            }
            Some(order) if order > self.highest_order() => {
                let shapes = self.highest_order();
                let message =
                    format!("the order {order} needs more mode shapes than the table has");
                Err(ModelError::new(message).help(format!("the table has {shapes}")))
            }
            Some(order) if self.fields.is_empty() && order > 0 => {
                let message = format!(
                    "the model `{}` has no field, so no order {order}",
                    self.name
                );
                Err(ModelError::new(message).help("remove the order, or give 0"))
            }
            _ => {
                let own = self.fields.iter().map(|field| order.unwrap_or(field.order));
                Ok(own.collect())
            }
        }
    }

    /// Returns the names of the states at these orders: coordinates, modes `q_1 ..`, their rates
    /// `NAME_dot` in the same order, and the first-order states.
    pub fn state_names(&self, orders: &[usize]) -> Vec<String> {
        let mut names: Vec<String> = self.coordinates.iter().map(|c| c.name.clone()).collect();
        for (field, order) in self.fields.iter().zip(orders) {
            names.extend((1..=*order).map(|mode| format!("{}_{mode}", field.coordinates)));
        }
        let rates: Vec<String> = names.iter().map(|name| format!("{name}_dot")).collect();
        names.extend(rates);
        names.extend(self.states.iter().map(|state| state.name.clone()));
        names
    }

    /// Checks that all numbers of the model are finite and admissible.
    pub(crate) fn check_numbers(&self) -> Result<(), ModelError> {
        let values = self.parameter_values()?;
        let state = self.initial_state(&vec![0; self.fields.len()])?;
        self.check_controllers(&values)?;
        for (coordinate, initial) in self.coordinates.iter().zip(&state) {
            let name = &coordinate.name;
            if let Some(range) = &coordinate.range {
                check_range(name, range, &values)?;
                check_inside(name, range, &values, *initial)?;
            }
        }
        let first_order = state.iter().skip(2 * self.coordinates.len());
        for (state, initial) in self.states.iter().zip(first_order) {
            if let Some(range) = &state.range {
                check_range(&state.name, range, &values)?;
                check_inside(&state.name, range, &values, *initial)?;
            }
        }
        for input in &self.inputs {
            if let Some(range) = &input.range {
                check_range(&input.name, range, &values)?;
            }
        }
        self.check_contact_laws(&values)?;
        for field in &self.fields {
            let (from, to) = (evaluate(&field.from, &values), evaluate(&field.to, &values));
            let length = to - from;
            if !(length.is_finite() && length > 0.0) {
                let message = format!("the field `{}` has the length {length} m", field.name);
                return Err(ModelError::new(message)
                    .at(field.to.span)
                    .help("give a `to` greater than `from`"));
            }
        }
        positions::check(self, &values).map_err(|fault| {
            ModelError::new(fault.message)
                .at(fault.span)
                .help("give a position inside the field")
        })?;
        constants::check(self, &values).map_err(|fault| {
            ModelError::new(fault.message)
                .at(fault.span)
                .help(fault.help)
        })
    }
}

impl Model {
    fn check_contact_laws(&self, parameters: &[f64]) -> Result<(), ModelError> {
        for impact in &self.impacts {
            let value = evaluate(&impact.restitution, parameters);
            if !(0.0..=1.0).contains(&value) {
                let message = format!("the restitution of `{}` is {value}", impact.name);
                return Err(ModelError::new(message)
                    .at(impact.restitution.span)
                    .help("give a restitution from 0 (plastic) to 1 (elastic)"));
            }
            let Some(friction) = &impact.friction else {
                continue;
            };
            let value = evaluate(&friction.coefficient, parameters);
            if !(value.is_finite() && value >= 0.0) {
                let message = format!("the friction of `{}` is {value}", impact.name);
                return Err(ModelError::new(message)
                    .at(friction.coefficient.span)
                    .help("give a coefficient of friction of at least 0"));
            }
        }
        Ok(())
    }
}

impl Range {
    /// Returns both ends in SI, from the values of all parameters in SI.
    pub fn ends(&self, parameters: &[f64]) -> (f64, f64) {
        let end = |expr| evaluate(expr, parameters);
        (end(&self.low), end(&self.high))
    }
}

fn initial_value(name: &str, expr: Option<&Expr>, parameters: &[f64]) -> Result<f64, ModelError> {
    let Some(expr) = expr else {
        return Ok(0.0);
    };
    let value = evaluate(expr, parameters);
    if value.is_finite() {
        return Ok(value);
    }
    let message = format!("the initial value of `{name}` evaluates to {value}");
    Err(ModelError::new(message).at(expr.span))
}

/// Checks that the ends of a range are finite and in ascending order.
fn check_range(name: &str, range: &Range, values: &[f64]) -> Result<(), ModelError> {
    let (low, high) = range.ends(values);
    if low.is_finite() && high.is_finite() && low < high {
        return Ok(());
    }
    let message = format!("the range of `{name}` evaluates to {low} to {high}");
    Err(ModelError::new(message)
        .at(range.span)
        .help("give two finite ends, the lower one first"))
}

fn check_inside(name: &str, range: &Range, values: &[f64], initial: f64) -> Result<(), ModelError> {
    let (low, high) = range.ends(values);
    if (low..=high).contains(&initial) {
        return Ok(());
    }
    let message =
        format!("the initial value {initial} of `{name}` is outside its range {low} to {high}");
    Err(ModelError::new(message)
        .at(range.span)
        .help("give an initial value inside, or a wider range"))
}

/// Returns true if two names share a part of at least two letters, as `backlash_sp` and `b_sp`,
/// or a whole name.
fn have_common_part(one: &str, other: &str) -> bool {
    let (one, other) = (one.to_lowercase(), other.to_lowercase());
    let mut parts = one.split('_');
    parts.any(|part| part.len() > 1 && other.split('_').any(|known| known == part))
}

fn check_value(parameter: &Parameter, value: f64) -> Result<(), ModelError> {
    let name = &parameter.name;
    let place = match &parameter.value {
        ParameterValue::Expression(expr) => expr.span,
        ParameterValue::Number(_) => parameter.span,
    };
    if !value.is_finite() {
        let message = format!("the value of `{name}` evaluates to {value}");
        let error = ModelError::new(message).at(place);
        return Err(error.help(match value.is_nan() {
            true => "check for a division by 0 or a square root of a negative number",
            false => "the value in SI units exceeds 1.8e308: check for a division by 0, or for a number that is too large",
        }));
    }
    let shown = |value: f64| format!("{} {}", parameter.unit.from_si(value), parameter.unit);
    let bound = match (parameter.min, parameter.max) {
        (Some(min), _) if value < min => format!("at least {}", shown(min)),
        (_, Some(max)) if value > max => format!("at most {}", shown(max)),
        _ => return Ok(()),
    };
    let message = format!("`{name}` = {} is out of its bounds", shown(value));
    Err(ModelError::new(message).at(place).help(bound))
}
