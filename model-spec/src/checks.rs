//! Checks of the whole model: unused names, channels of sensors, tables of shapes, and the drawing.

use crate::diagnostic::{DeclarationKind, Diagnostic, Diagnostics, quote};
use crate::dimension::Dimension;
use crate::evaluate::evaluate;
use crate::ids::InputId;
use crate::infer::UnitPhrase;
use crate::model::{
    Basis, CoefficientKind, Expr, ExprKind, Input, MeasuredQuantity, Model, ObservedRate, Ordinate,
    ParameterValue, STABILISATION_RATE,
};
use crate::suggest::did_you_mean;

/// Reports sensors on channels that the model does not have.
pub fn check_sensors(model: &Model, found: &mut Diagnostics) {
    if model.sensors.is_empty() {
        return;
    }
    let coordinates = || model.coordinates.iter();
    let rates = coordinates().map(|c| format!("{}_dot", c.name));
    let accelerations = coordinates().map(|c| format!("{}_ddot", c.name));
    let mut channels: Vec<String> = vec!["energy".to_owned(), "power".to_owned()];
    for (observable, of) in model.observables.iter().enumerate() {
        channels.push(of.name.clone());
        channels.extend([1, 2].map(|times| ObservedRate { observable, times }.name(model)));
    }
    channels.extend(
        model
            .coordinates
            .iter()
            .map(|coordinate| coordinate.name.clone()),
    );
    channels.extend(rates.chain(accelerations));
    channels.extend(model.states.iter().map(|state| state.name.clone()));
    // Inputs are channels, too: a record can contain them.
    channels.extend(model.inputs.iter().map(|input| input.name.clone()));
    for sensor in &model.sensors {
        if !channels.contains(&sensor.observable) {
            let message = format!(
                "the model has no quantity {} to measure",
                quote(&sensor.observable)
            );
            let near = did_you_mean(&sensor.observable, channels.iter().map(String::as_str));
            let rule = "a channel is an observable or a coordinate, its rate (NAME_dot) or acceleration \
                        (NAME_ddot), a state, or an input";
            found.push(
                Diagnostic::error(message)
                    .with_span(sensor.span, "not a channel of this model")
                    .with_help(near.unwrap_or_else(|| rule.to_owned())),
            );
        }
    }
}

/// Reports tables of shapes that do not span the domain of their field, at the declared values.
pub fn check_tables(model: &Model, found: &mut Diagnostics) {
    let Ok(parameters) = model.parameter_values() else {
        return;
    };
    for field in &model.fields {
        let Basis::Table { table, span } = &field.basis else {
            continue;
        };
        let [from, to] = [&field.from, &field.to].map(|end| evaluate(end, &parameters));
        if let Err(fault) = table.check_span(from, to) {
            let (line, column) = (fault.line, fault.column);
            let message = format!("{}:{line}:{column}: {}", table.file, fault.message);
            found.push(Diagnostic::error(message).with_span(*span, "this table").with_help(
                "the first x of the table must equal `from`, and the last x must equal `to`, in m",
            ));
        }
    }
}

/// Reports points of a drawing with an ordinate that is not a length.
pub fn check_drawing(model: &Model, found: &mut Diagnostics) {
    let points = model.drawing.iter().flat_map(|drawing| &drawing.points);
    let placed = points.flat_map(|point| {
        let [x, y] = point.spans;
        [(point.x, x), (point.y, y)]
    });
    for (ordinate, span) in placed {
        let (name, unit) = match ordinate {
            Ordinate::Number(_) => continue,
            Ordinate::Coordinate(id) => {
                let coordinate = &model.coordinates[id];
                (&coordinate.name, &coordinate.unit)
            }
            Ordinate::Observable(id) => {
                let observable = &model.observables[id];
                (&observable.name, &observable.unit)
            }
        };
        if unit.dimension != Dimension::LENGTH {
            let is = UnitPhrase(unit.dimension);
            found.push(
                Diagnostic::error(format!(
                    "`{name}` is {is}, but the coordinates of a point are in m"
                ))
                .with_span(span, is.to_string())
                .with_help("add the length to [observables] and use its name"),
            );
        }
    }
}

/// Returns the inputs that no expression contains and no controller measures or drives. Given rates of an input may
/// be unused. If a rate is used, the input counts as used.
pub fn list_unused_inputs(model: &Model) -> Vec<&Input> {
    let used = UsageMarks::of(model);
    let used_with_rates = |input: InputId| {
        let rates = std::iter::successors(Some(input), |of| model.inputs[*of].rate);
        rates.into_iter().any(|of| used.inputs[of])
    };
    InputId::first(model.inputs.len())
        .filter(|input| model.inputs[*input].rate_of.is_none() && !used_with_rates(*input))
        .map(|input| &model.inputs[input])
        .collect()
}

pub fn warn_unused(model: &Model, warnings: &mut Diagnostics) {
    let used = UsageMarks::of(model);
    let parameters = model.parameters.iter().map(|p| (&p.name, p.span));
    let definitions = model.definitions.iter().map(|d| (&d.name, d.span));
    let mut warn = |kind, name: &str, span| warnings.push(Diagnostic::unused(kind, name, span));
    for ((name, span), used) in parameters.zip(used.parameters) {
        // The stabilisation rate is part of every constraint.
        let stabilises = !model.constraints.is_empty() && name == STABILISATION_RATE;
        if !used && !stabilises {
            warn(DeclarationKind::Parameter, name, span);
        }
    }
    for input in list_unused_inputs(model) {
        warn(DeclarationKind::Input, &input.name, input.span);
    }
    for ((name, span), used) in definitions.zip(used.definitions) {
        // Generated definitions of a frame, which have the frame's span, may be unused.
        let written = model.source.text.get(span.start..span.end);
        if !used && written.is_some_and(|written| written.contains(name.as_str())) {
            warn(DeclarationKind::Definition, name, span);
        }
    }
}

struct UsageMarks {
    parameters: Vec<bool>,
    inputs: Vec<bool>,
    definitions: Vec<bool>,
}

impl UsageMarks {
    /// Marks the names that a model uses.
    fn of(model: &Model) -> Self {
        let mut used = Self {
            parameters: vec![false; model.parameters.len()],
            inputs: vec![false; model.inputs.len()],
            definitions: vec![false; model.definitions.len()],
        };
        for_each_expression(model, &mut |expr| expr.visit(&mut |part| used.mark(part)));
        used.mark_controllers(model);
        used
    }

    /// Marks the quantities that controllers measure and drive.
    fn mark_controllers(&mut self, model: &Model) {
        for controller in &model.controllers {
            for output in &controller.outputs {
                self.inputs[output.input] = true;
            }
            for quantity in &controller.measured {
                match quantity {
                    MeasuredQuantity::Parameter(index) => self.parameters[*index] = true,
                    MeasuredQuantity::Input(index) => self.inputs[*index] = true,
                    _ => {}
                }
            }
        }
    }

    fn mark(&mut self, part: &Expr) {
        match part.kind {
            ExprKind::Parameter(index) => self.parameters[index] = true,
            ExprKind::Input(index) => self.inputs[index] = true,
            ExprKind::Definition(index) => self.definitions[index] = true,
            _ => {}
        }
    }
}

impl Model {
    /// Calls `see` with each expression of the model, but not with subexpressions.
    pub fn for_each_expression<'m>(&'m self, see: &mut impl FnMut(&'m Expr)) {
        for_each_expression(self, see);
    }
}

pub fn for_each_expression<'m>(model: &'m Model, see: &mut impl FnMut(&'m Expr)) {
    for parameter in &model.parameters {
        if let ParameterValue::Expression(expr) = &parameter.value {
            see(expr);
        }
    }
    for coordinate in &model.coordinates {
        let initial = coordinate.initial.iter();
        initial.chain(&coordinate.initial_rate).for_each(&mut *see);
    }
    for state in &model.states {
        see(&state.rate);
        state.initial.iter().for_each(&mut *see);
    }
    let coordinates = model.coordinates.iter().map(|c| &c.range);
    let inputs = model.inputs.iter().map(|input| &input.range);
    let states = model.states.iter().map(|state| &state.range);
    for range in coordinates.chain(inputs).chain(states).flatten() {
        see(&range.low);
        see(&range.high);
    }
    for field in &model.fields {
        see(&field.from);
        see(&field.to);
    }
    for definition in &model.definitions {
        see(&definition.value);
    }
    let terms = model.kinetic.iter().chain(&model.potential);
    for term in terms.chain(&model.dissipation) {
        see(&term.value);
    }
    for force in &model.forces {
        see(&force.on);
        see(&force.value);
    }
    for constraint in &model.constraints {
        see(&constraint.zero);
    }
    for impact in &model.impacts {
        see(&impact.when);
        see(&impact.restitution);
        if let Some(friction) = &impact.friction {
            see(&friction.coefficient);
            see(&friction.slip);
        }
    }
    for observable in &model.observables {
        see(&observable.value);
    }
    for controller in &model.controllers {
        let times = [&controller.period, &controller.offset, &controller.delay];
        times.into_iter().for_each(|time| see(&time.value));
        let initial = controller
            .states
            .iter()
            .filter_map(|state| state.initial.as_ref());
        initial.for_each(&mut *see);
    }
    for coefficient in &model.coefficients {
        for_each_of_coefficient(&coefficient.kind, see);
    }
}

fn for_each_of_coefficient<'m>(kind: &'m CoefficientKind, see: &mut impl FnMut(&'m Expr)) {
    match kind {
        CoefficientKind::Value(value) => see(value),
        CoefficientKind::Factor { of, by, times } => {
            see(of);
            see(by);
            times.iter().for_each(see);
        }
    }
}
