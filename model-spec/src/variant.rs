//! Questions to a model and changes of its numbers: the values of its parameters, one
//! parameter set to another value, the orders of its fields, the names of its states.

use crate::constants;
use crate::diagnostic::Diagnostic;
use crate::evaluate::evaluate;
use crate::model::{Expr, MAX_ORDER, Model, Parameter, ParameterValue, Range};
use crate::source::sha256;
use crate::span::Span;
use crate::suggest::did_you_mean;

/// The most names that a message suggests.
const MOST_NAMES: usize = 12;

/// Why a model cannot be had with these numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelError {
    /// What is wrong.
    pub message: String,
    /// What would be right, if known.
    pub help: Option<String>,
    /// The part of the specification it is about, if it is about one.
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

    /// The same as a finding on the model's source.
    pub fn diagnostic(self) -> Diagnostic {
        let diagnostic = Diagnostic::error(self.message).help_if(self.help);
        match self.span {
            Some(span) => diagnostic.at(span, ""),
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
    /// SHA-256 of all that the model was read from: of the specification's text, or, where it
    /// names tables, of the digits of its hash and of theirs in the order of the fields.
    pub fn hash(&self) -> String {
        let tables = self.fields.iter().filter_map(|field| field.basis.table());
        let tables: String = tables.map(|table| table.sha256.as_str()).collect();
        match tables.is_empty() {
            true => self.source.hash(),
            false => sha256(self.source.hash() + &tables),
        }
    }

    /// The highest order that every field has: a table has as many shapes as columns.
    pub fn highest_order(&self) -> usize {
        let tables = self.fields.iter().filter_map(|field| field.basis.table());
        tables.fold(MAX_ORDER, |order, table| order.min(table.shapes.len()))
    }

    /// The values of all parameters in SI, in the order of [`Model::parameters`].
    ///
    /// # Errors
    /// A value that is not finite or outside its parameter's bounds, by name.
    pub fn parameter_values(&self) -> Result<Vec<f64>, ModelError> {
        let values = self.evaluated_parameters();
        for &index in &self.parameter_order {
            check_value(&self.parameters[index], values[index])?;
        }
        Ok(values)
    }

    /// The values of all parameters in SI, admissible or not.
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

    /// The initial state in SI at these orders: values of coordinates, modes (0), then
    /// their rates, then the states of first order.
    ///
    /// # Errors
    /// As [`Model::parameter_values`], and initial values that are not finite.
    pub fn initial_state(&self, orders: &[usize]) -> Result<Vec<f64>, ModelError> {
        let parameters = self.parameter_values()?;
        let modes: usize = orders.iter().sum();
        let half = self.coordinates.len() + modes;
        let mut state = vec![0.0; 2 * half + self.states.len()];
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let given = [&coordinate.initial, &coordinate.initial_rate];
            for (expr, place) in given.into_iter().zip([index, half + index]) {
                state[place] = initial_value(&coordinate.name, expr.as_ref(), &parameters)?;
            }
        }
        for (first_order, place) in self.states.iter().zip(2 * half..) {
            let expr = first_order.initial.as_ref();
            state[place] = initial_value(&first_order.name, expr, &parameters)?;
        }
        Ok(state)
    }

    /// Where each coordinate lives, in SI; none for one that may be anywhere.
    ///
    /// # Errors
    /// As [`Model::parameter_values`].
    pub fn coordinate_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.coordinates.iter().map(|c| c.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// Intervals of the states of first order, in SI; `None` without a `range`.
    ///
    /// # Errors
    /// As [`Model::parameter_values`].
    pub fn state_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.states.iter().map(|state| state.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// Inputs where nobody gives them, in SI: of prescribed motion, which may stand in the energies,
    /// the middle of its range, or this number without one; 0 of all others.
    ///
    /// # Errors
    /// As [`Model::parameter_values`].
    pub fn typical_inputs(&self, without_range: f64) -> Result<Vec<f64>, ModelError> {
        let ranges = self.input_ranges()?;
        let typical = self.inputs.iter().zip(ranges).map(|(input, range)| {
            match (input.rate.is_some() && input.rate_of.is_none(), range) {
                (true, Some((low, high))) => 0.5 * (low + high),
                (true, None) => without_range,
                (false, _) => 0.0,
            }
        });
        Ok(typical.collect())
    }

    /// Where each input lives, in SI; none for one that may be anything.
    ///
    /// # Errors
    /// As [`Model::parameter_values`].
    pub fn input_ranges(&self) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let values = self.parameter_values()?;
        let ranges = self.inputs.iter().map(|input| input.range.as_ref());
        Ok(ranges
            .map(|range| range.map(|range| range.ends(&values)))
            .collect())
    }

    /// The same model with one parameter set to a number in its declared unit; what is
    /// computed from it follows.
    ///
    /// # Errors
    /// An unknown name, a number that is not finite or outside the parameter's bounds, or
    /// another value that then is not finite.
    pub fn with_parameter(&self, name: &str, value: f64) -> Result<Self, ModelError> {
        self.with_parameters(&[(name, value)])
    }

    /// The same model with several parameters set; only what they are together is checked.
    ///
    /// # Errors
    /// As [`Model::with_parameter`].
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
            return Err(error.help(self.parameters_like(name)));
        };
        if !value.is_finite() {
            let message = format!("`{name}` cannot be {value}");
            return Err(ModelError::new(message).help("give a finite number"));
        }
        let parameter = &mut self.parameters[index];
        parameter.value = ParameterValue::Number(parameter.unit.to_si(value));
        Ok(())
    }

    /// Which parameters may have been meant by a name: the nearest, those that share a part of
    /// it, or the first of all.
    pub(crate) fn parameters_like(&self, name: &str) -> String {
        let known = || self.parameters.iter().map(|known| known.name.as_str());
        if let Some(help) = did_you_mean(name, known()) {
            return help;
        }
        if self.coordinates.iter().any(|known| known.name == name) {
            return format!("`{name}` is a coordinate: its `initial` says where it begins");
        }
        if self.states.iter().any(|known| known.name == name) {
            return format!("`{name}` is a state: its `initial` says where it begins");
        }
        let alike: Vec<&str> = known().filter(|known| share_a_part(name, known)).collect();
        let (intro, names) = match alike.len() {
            0 => ("the parameters are", known().collect()),
            _ => ("did you mean one of", alike),
        };
        let more = match names.len().saturating_sub(MOST_NAMES) {
            0 => "",
            _ => ", ...",
        };
        let names: Vec<String> = names
            .iter()
            .take(MOST_NAMES)
            .map(|name| format!("`{name}`"))
            .collect();
        match names.as_slice() {
            [] => "the model has none".to_owned(),
            names => format!("{intro} {}{more}", names.join(", ")),
        }
    }

    /// The order of each field: its own, or `order` for all of them.
    ///
    /// # Errors
    /// An order above [`MAX_ORDER`], or other than 0 where there is no field.
    pub fn orders(&self, order: Option<usize>) -> Result<Vec<usize>, ModelError> {
        match order {
            Some(order) if order > MAX_ORDER => {
                let message = format!("the order {order} is above the limit");
                Err(ModelError::new(message).help(format!("the highest order is {MAX_ORDER}")))
            }
            Some(order) if order > self.highest_order() => {
                let shapes = self.highest_order();
                let message = format!("the order {order} asks for more shapes than a table has");
                Err(ModelError::new(message).help(format!("the table has {shapes}")))
            }
            Some(order) if self.fields.is_empty() && order > 0 => {
                let message = format!(
                    "the model `{}` has no field, so no order {order}",
                    self.name
                );
                Err(ModelError::new(message).help("leave the order out, or give 0"))
            }
            _ => {
                let own = self.fields.iter().map(|field| order.unwrap_or(field.order));
                Ok(own.collect())
            }
        }
    }

    /// The names of the states at these orders: coordinates, modes `q_1 ..`, then the
    /// rates `NAME_dot` in the same order, then the states of first order.
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

    /// Whether all numbers of the model have finite, admissible values.
    pub(crate) fn check_numbers(&self) -> Result<(), ModelError> {
        let values = self.parameter_values()?;
        let state = self.initial_state(&vec![0; self.fields.len()])?;
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
        self.check_restitutions(&values)?;
        for field in &self.fields {
            let (from, to) = (evaluate(&field.from, &values), evaluate(&field.to, &values));
            let length = to - from;
            if !(length.is_finite() && length > 0.0) {
                let message = format!("the field `{}` has the length {length} m", field.name);
                return Err(ModelError::new(message)
                    .at(field.to.span)
                    .help("`to` is greater than `from`"));
            }
        }
        constants::check(self, &values).map_err(|fault| {
            ModelError::new(fault.message)
                .at(fault.span)
                .help(fault.help)
        })
    }
}

impl Model {
    /// Whether every impact gives back a part of the speed.
    fn check_restitutions(&self, parameters: &[f64]) -> Result<(), ModelError> {
        for impact in &self.impacts {
            let value = evaluate(&impact.restitution, parameters);
            if !(0.0..=1.0).contains(&value) {
                let message = format!("the restitution of `{}` is {value}", impact.name);
                return Err(ModelError::new(message)
                    .at(impact.restitution.span)
                    .help("from 0, nothing comes back, to 1, all of the speed does"));
            }
        }
        Ok(())
    }
}

impl Range {
    /// Both ends in SI, with the values of all parameters in SI, in the order of the model.
    pub fn ends(&self, parameters: &[f64]) -> (f64, f64) {
        let end = |expr| evaluate(expr, parameters);
        (end(&self.low), end(&self.high))
    }
}

/// An initial value in SI: 0 where none is given.
fn initial_value(name: &str, expr: Option<&Expr>, parameters: &[f64]) -> Result<f64, ModelError> {
    let Some(expr) = expr else {
        return Ok(0.0);
    };
    let value = evaluate(expr, parameters);
    if value.is_finite() {
        return Ok(value);
    }
    let message = format!("the initial value of `{name}` comes out as {value}");
    Err(ModelError::new(message).at(expr.span))
}

/// Whether a range is one: finite, the lower end below the upper one.
fn check_range(name: &str, range: &Range, values: &[f64]) -> Result<(), ModelError> {
    let (low, high) = range.ends(values);
    if low.is_finite() && high.is_finite() && low < high {
        return Ok(());
    }
    let message = format!("the range of `{name}` comes out as {low} to {high}");
    Err(ModelError::new(message)
        .at(range.span)
        .help("give two finite ends, the lower one first"))
}

/// Checks that an initial value lies in its range.
fn check_inside(name: &str, range: &Range, values: &[f64], initial: f64) -> Result<(), ModelError> {
    let (low, high) = range.ends(values);
    if (low..=high).contains(&initial) {
        return Ok(());
    }
    let message = format!("`{name}` begins at {initial}, outside its range {low} to {high}");
    Err(ModelError::new(message)
        .at(range.span)
        .help("give an initial value inside, or a wider range"))
}

/// Whether two names have a part in common, as `backlash_sp` and `b_sp`: one of two letters or
/// more, or the whole of either.
fn share_a_part(one: &str, other: &str) -> bool {
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
        let message = format!("the value of `{name}` comes out as {value}");
        let error = ModelError::new(message).at(place);
        return Err(error.help("look for a division by 0 or a root of a negative number"));
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
