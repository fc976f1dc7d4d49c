//! Lowering of the controllers of a model.

use std::collections::HashMap;

use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::ids::ParameterId;
use eomgen_model_spec::model::{
    Controller, Expr, ExprKind, MeasuredQuantity, Model, ParameterValue, SampleTime,
    SampledExpression, SampledKind,
};
use eomgen_model_spec::span::Span;
use eomgen_model_spec::unit::Unit;

use super::quantities::{quantity, si_unit};
use crate::program::{ControlOp, MeasuredSource, Program, ProgramController, Quantity};

/// Lowers the controllers of a model with the program of its equations.
///
/// # Errors
/// A measured mode that does not exist at the order of the program, with its location.
pub fn lower_controllers(
    model: &Model,
    program: &Program,
) -> Result<Vec<ProgramController>, Diagnostic> {
    let controllers = model.controllers.iter();
    controllers
        .map(|controller| lower_controller(model, program, controller))
        .collect()
}

fn lower_controller(
    model: &Model,
    program: &Program,
    controller: &Controller,
) -> Result<ProgramController, Diagnostic> {
    let mut lowering = ControlLowering {
        model,
        program,
        controller,
        values: Vec::new(),
        parameters: HashMap::new(),
        measured: Vec::new(),
        sources: Vec::new(),
    };
    let times = [&controller.period, &controller.offset, &controller.delay];
    let times = times.map(|time| lowering.time(time));
    let initial = controller.states.iter().map(|state| match &state.initial {
        Some(initial) => lowering.expression(initial),
        None => lowering.push(ControlOp::Constant(0.0)),
    });
    let initial = initial.collect();
    let output_values = controller.outputs.iter();
    let output_values = output_values.map(|output| lowering.sampled(&output.value));
    let output_values = output_values.collect::<Result<_, _>>()?;
    let next = controller.states.iter();
    let next = next.map(|state| lowering.sampled(&state.next));
    let next = next.collect::<Result<_, _>>()?;
    let driven = controller.outputs.iter().map(|output| output.input.index());
    let driven: Vec<usize> = driven.collect();
    let states = controller.states.iter();
    Ok(ProgramController {
        name: controller.name.clone(),
        doc: controller.doc.clone(),
        states: states
            .map(|state| quantity(&state.name, &state.unit.text, &state.doc))
            .collect(),
        outputs: (driven.iter().map(|index| program.inputs[*index].clone())).collect(),
        driven,
        times,
        initial,
        next,
        output_values,
        measured: lowering.measured,
        sources: lowering.sources,
        values: lowering.values,
    })
}

struct ControlLowering<'m> {
    model: &'m Model,
    program: &'m Program,
    controller: &'m Controller,
    values: Vec<ControlOp>,
    /// Operations of the parameters.
    parameters: HashMap<ParameterId, usize>,
    measured: Vec<Quantity>,
    sources: Vec<MeasuredSource>,
}

impl ControlLowering<'_> {
    fn push(&mut self, op: ControlOp) -> usize {
        let is_leaf = op.operands().is_empty() && !matches!(op, ControlOp::Constant(_));
        let mut known = self.values.iter();
        if let Some(index) = known.position(|known| is_leaf && *known == op) {
            return index;
        }
        self.values.push(op);
        self.values.len() - 1
    }

    fn time(&mut self, time: &SampleTime) -> usize {
        match time.value.kind {
            ExprKind::Number(value) => self.push(ControlOp::Constant(time.unit.to_si(value))),
            _ => self.expression(&time.value),
        }
    }

    fn parameter(&mut self, id: ParameterId) -> usize {
        if let Some(known) = self.parameters.get(&id) {
            return *known;
        }
        let model = self.model;
        let parameter = &model.parameters[id];
        let value = match &parameter.value {
            ParameterValue::Number(_) => {
                let independent = &self.program.parameters;
                let index = (independent.iter()).position(|p| p.quantity.name == parameter.name);
                match index {
                    Some(index) => self.push(ControlOp::Parameter(index)),
                    None => self.push(ControlOp::Constant(f64::NAN)),
                }
            }
            ParameterValue::Expression(value) => self.expression(value),
        };
        self.parameters.insert(id, value);
        value
    }

    /// Lowers an expression of parameters.
    fn expression(&mut self, expr: &Expr) -> usize {
        match &expr.kind {
            ExprKind::Number(value) => self.push(ControlOp::Constant(*value)),
            ExprKind::Pi => self.push(ControlOp::Constant(std::f64::consts::PI)),
            ExprKind::Parameter(id) => self.parameter(*id),
            ExprKind::Negate(operand) => {
                let operand = self.expression(operand);
                self.push(ControlOp::Negate(operand))
            }
            ExprKind::Binary(operator, left, right) => {
                let is_square = matches!(right.kind, ExprKind::Number(2.0));
                let left = self.expression(left);
                let right = match is_square && *operator == BinaryOperator::Power {
                    true => None,
                    false => Some(self.expression(right)),
                };
                self.binary(*operator, left, right)
            }
            ExprKind::Call(function, arguments) => {
                let places: Vec<usize> = arguments.iter().map(|a| self.expression(a)).collect();
                self.push(ControlOp::Call(*function, places))
            }
            // A checked model has no other leaves in expressions of parameters.
            _ => self.push(ControlOp::Constant(f64::NAN)),
        }
    }

    /// Adds a binary operation; if `right` is missing, the operation is a square.
    fn binary(&mut self, operator: BinaryOperator, left: usize, right: Option<usize>) -> usize {
        let Some(right) = right else {
            return self.push(ControlOp::Multiply(left, left));
        };
        self.push(match operator {
            BinaryOperator::Add => ControlOp::Add(left, right),
            BinaryOperator::Subtract => ControlOp::Subtract(left, right),
            BinaryOperator::Multiply => ControlOp::Multiply(left, right),
            BinaryOperator::Divide => ControlOp::Divide(left, right),
            BinaryOperator::Power => ControlOp::Elementary(Elementary::Pow, [left, right]),
        })
    }

    /// Lowers an expression of sampled quantities.
    fn sampled(&mut self, expr: &SampledExpression) -> Result<usize, Diagnostic> {
        Ok(match &expr.kind {
            SampledKind::Number(value) => self.push(ControlOp::Constant(*value)),
            SampledKind::Measured(index) => {
                let controller = self.controller;
                self.measured(&controller.measured[*index], expr.span)?
            }
            SampledKind::Negate(operand) => {
                let operand = self.sampled(operand)?;
                self.push(ControlOp::Negate(operand))
            }
            SampledKind::Binary(operator, left, right) => {
                let is_square = matches!(right.kind, SampledKind::Number(2.0));
                let left = self.sampled(left)?;
                let right = match is_square && *operator == BinaryOperator::Power {
                    true => None,
                    false => Some(self.sampled(right)?),
                };
                self.binary(*operator, left, right)
            }
            SampledKind::Call(function, arguments) => {
                let places = arguments.iter().map(|argument| self.sampled(argument));
                let places: Vec<usize> = places.collect::<Result<_, _>>()?;
                self.push(ControlOp::Call(*function, places))
            }
            SampledKind::Clamp([x, low, high]) => {
                let x = self.sampled(x)?;
                let low = self.sampled(low)?;
                let high = self.sampled(high)?;
                // The result is NaN if x is NaN, and `high` if `low` exceeds `high`.
                let raised = self.push(ControlOp::Select([low, x, low, x]));
                self.push(ControlOp::Select([raised, high, high, raised]))
            }
            SampledKind::Quantise([x, step]) => {
                let x = self.sampled(x)?;
                let step = self.sampled(step)?;
                self.push(ControlOp::Elementary(Elementary::Quantise, [x, step]))
            }
        })
    }

    fn measured(&mut self, measured: &MeasuredQuantity, span: Span) -> Result<usize, Diagnostic> {
        let program = self.program;
        let (source, described) = match measured {
            MeasuredQuantity::Period => return Ok(self.push(ControlOp::Period)),
            MeasuredQuantity::Parameter(id) => return Ok(self.parameter(*id)),
            MeasuredQuantity::Own(index) => return Ok(self.push(ControlOp::State(*index))),
            MeasuredQuantity::Time => (MeasuredSource::Time, quantity("t", "s", "time")),
            MeasuredQuantity::Input(id) => {
                let index = id.index();
                (MeasuredSource::Input(index), program.inputs[index].clone())
            }
            MeasuredQuantity::Observable(name) => {
                let mut all = program.observables.iter();
                let index = all.position(|known| known.name == *name);
                let index = index.unwrap_or_default();
                let described = program.observables[index].clone();
                (MeasuredSource::Observable(index), described)
            }
            part => {
                let name = part.state_name(self.model).unwrap_or_default();
                let names = program.state_names();
                let index = names.iter().position(|known| *known == name);
                let index = index.ok_or_else(|| self.describe_missing_mode(part, &name, span))?;
                let described = quantity(&name, &self.state_unit(part), "");
                (MeasuredSource::State(index), described)
            }
        };
        let known = self.sources.iter().position(|known| *known == source);
        let index = known.unwrap_or_else(|| {
            self.sources.push(source);
            self.measured.push(described);
            self.sources.len() - 1
        });
        Ok(self.push(ControlOp::Measured(index)))
    }

    fn state_unit(&self, part: &MeasuredQuantity) -> String {
        let per_second = |unit: &Unit| {
            let rate = unit.rate_unit();
            rate.map_or_else(String::new, |rate| si_unit(&rate))
        };
        match part {
            MeasuredQuantity::Coordinate(id) => si_unit(&self.model.coordinates[*id].unit),
            MeasuredQuantity::CoordinateRate(id) => per_second(&self.model.coordinates[*id].unit),
            MeasuredQuantity::State(id) => si_unit(&self.model.states[*id].unit),
            MeasuredQuantity::Mode { field, is_rate, .. } => match self.model.fields.get(*field) {
                Some(field) if *is_rate => per_second(&field.unit),
                Some(field) => si_unit(&field.unit),
                None => String::new(),
            },
            _ => String::new(),
        }
    }

    fn describe_missing_mode(&self, part: &MeasuredQuantity, name: &str, span: Span) -> Diagnostic {
        let missing = Diagnostic::error(format!("the model has no mode `{name}`"));
        let MeasuredQuantity::Mode { field, number, .. } = part else {
            return missing.with_span(span, "unknown");
        };
        let order = self
            .program
            .fields
            .get(*field)
            .map_or(0, |field| field.order);
        let field = self.model.fields.get(*field);
        let field = field.map_or("", |field| &*field.name);
        missing
            .with_span(span, format!("the field `{field}` has {order} modes here"))
            .with_help(format!("give an order of {number} or more"))
    }
}
