//! Checks the units of controllers.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::ids::ParameterId;
use crate::infer::{Inference, UnitPhrase};
use crate::model::{
    Controller, Expr, ExprKind, Function, MeasuredQuantity, Model, Parameter, ParameterValue,
    SampleTime, SampledExpression, SampledKind,
};
use crate::unit::Unit;

/// Checks that states and outputs have the units of their values, and times the unit of time.
pub(crate) fn check_units(model: &Model, found: &mut Diagnostics) {
    for controller in &model.controllers {
        let times = [
            (&controller.period, "period"),
            (&controller.offset, "offset"),
            (&controller.delay, "delay"),
        ];
        for (time, what) in times {
            check_time(model, controller, (time, what), found);
        }
        for state in &controller.states {
            let initial = state.initial.as_ref();
            let initial = initial.filter(|value| !matches!(value.kind, ExprKind::Number(_)));
            if let Some(initial) = initial {
                let subject = format!("the initial value of `{}`", state.name);
                expect(
                    &parameters(model),
                    initial,
                    state.unit.dimension,
                    &subject,
                    found,
                );
            }
        }
        let sampled = sampled_model(model, controller);
        let known = inference(&sampled);
        for state in &controller.states {
            let subject = format!("the next value of `{}`", state.name);
            let next = to_expression(&state.next);
            expect(&known, &next, state.unit.dimension, &subject, found);
        }
        for output in &controller.outputs {
            let input = &model.inputs[output.input];
            let subject = format!("the output `{}`", input.name);
            let value = to_expression(&output.value);
            expect(&known, &value, input.unit.dimension, &subject, found);
        }
    }
}

fn check_time(
    model: &Model,
    controller: &Controller,
    (time, what): (&SampleTime, &str),
    found: &mut Diagnostics,
) {
    if !matches!(time.value.kind, ExprKind::Number(_)) {
        let subject = format!("the {what} of the controller `{}`", controller.name);
        expect(
            &parameters(model),
            &time.value,
            Dimension::TIME,
            &subject,
            found,
        );
    }
}

fn parameters(model: &Model) -> Inference<'_> {
    inference(model)
}

fn inference(model: &Model) -> Inference<'_> {
    Inference {
        model,
        definitions: Vec::new(),
        coefficients: Vec::new(),
    }
}

/// Returns a model whose parameters are the measured quantities of a controller.
fn sampled_model(model: &Model, controller: &Controller) -> Model {
    let mut sampled = model.clone();
    let unit = |quantity: &MeasuredQuantity| -> Unit {
        let of = |unit: &Unit| Some(unit.dimension);
        let per_second = |unit: &Unit| unit.dimension.divide(Dimension::TIME);
        let dimension = match quantity {
            MeasuredQuantity::Time | MeasuredQuantity::Period => Some(Dimension::TIME),
            MeasuredQuantity::Parameter(id) => of(&model.parameters[*id].unit),
            MeasuredQuantity::Input(id) => of(&model.inputs[*id].unit),
            MeasuredQuantity::Coordinate(id) => of(&model.coordinates[*id].unit),
            MeasuredQuantity::CoordinateRate(id) => per_second(&model.coordinates[*id].unit),
            MeasuredQuantity::State(id) => of(&model.states[*id].unit),
            MeasuredQuantity::Mode { field, is_rate, .. } => {
                let unit = model.fields.get(*field).map(|field| &field.unit);
                unit.and_then(|unit| if *is_rate { per_second(unit) } else { of(unit) })
            }
            MeasuredQuantity::Observable(name) => match &**name {
                "energy" => Some(Dimension::ENERGY),
                "power" => Some(Dimension::POWER),
                name => {
                    let mut observables = model.observables.iter();
                    let known = observables.find(|known| known.name == name);
                    known.map(|known| known.unit.dimension)
                }
            },
            MeasuredQuantity::Own(place) => {
                let state = controller.states.get(*place);
                state.map(|state| state.unit.dimension)
            }
        };
        Unit::coherent(dimension.unwrap_or(Dimension::DIMENSIONLESS))
    };
    let parameter = |quantity: &MeasuredQuantity| Parameter {
        name: match quantity {
            MeasuredQuantity::Parameter(id) => model.parameters[*id].name.clone(),
            _ => String::new(),
        },
        unit: unit(quantity),
        doc: String::new(),
        origin: String::new(),
        value: ParameterValue::Number(0.0),
        min: None,
        max: None,
        uncertainty: None,
        span: controller.span,
    };
    sampled.parameters = controller.measured.iter().map(parameter).collect();
    sampled
}

/// Returns an expression with the same units, whose parameters are the measured quantities.
fn to_expression(sampled: &SampledExpression) -> Expr {
    let all =
        |arguments: &[&SampledExpression]| arguments.iter().map(|own| to_expression(own)).collect();
    let boxed = |own: &SampledExpression| Box::new(to_expression(own));
    let kind = match &sampled.kind {
        SampledKind::Number(value) => ExprKind::Number(*value),
        SampledKind::Measured(place) => ExprKind::Parameter(ParameterId::new(*place)),
        SampledKind::Negate(operand) => ExprKind::Negate(boxed(operand)),
        SampledKind::Binary(operator, left, right) => {
            ExprKind::Binary(*operator, boxed(left), boxed(right))
        }
        SampledKind::Call(function, arguments) => {
            ExprKind::Call(*function, arguments.iter().map(to_expression).collect())
        }
        SampledKind::Clamp([x, low, high]) => {
            let raised = Expr {
                kind: ExprKind::Call(Function::Max, all(&[x, low])),
                span: x.span,
            };
            ExprKind::Call(Function::Min, vec![raised, to_expression(high)])
        }
        SampledKind::Quantise([x, step]) => ExprKind::Call(Function::Min, all(&[x, step])),
    };
    Expr {
        kind,
        span: sampled.span,
    }
}

fn expect(
    known: &Inference<'_>,
    expr: &Expr,
    expected: Dimension,
    subject: &str,
    found: &mut Diagnostics,
) {
    let inferred = known.infer(expr);
    if let Some(Some(inferred)) = found.push_error(inferred)
        && inferred != expected
    {
        let cure = known.describe_cure(&[expr], inferred, expected);
        let (is, right) = (UnitPhrase(inferred), UnitPhrase(expected));
        found.push(
            Diagnostic::error(format!("{subject} is {is}, expected {right}"))
                .with_span(expr.span, is.to_string())
                .with_optional_help(cure),
        );
    }
}
