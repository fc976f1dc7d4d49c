//! Removal of statements whose results are unused, for example after a regime has decided their branches.

use std::collections::HashSet;

use super::expression::{ArgumentStruct, Array, Expression};
use super::preparation::{Preparation, PreparedValue};
use super::stage::Outcome;
use super::statement::Statement;

/// Names that statements read.
#[derive(Debug, Default)]
pub struct UsedNames {
    names: HashSet<String>,
}

impl UsedNames {
    /// Collects the names that an outcome reads, and the names of the arrays that it returns.
    pub fn from_outcome(outcome: &Outcome) -> Self {
        let mut used = Self::default();
        for name in ["rates", "values", "product"] {
            used.names.insert(name.to_owned());
        }
        match outcome {
            Outcome::Number(value) => used.expression(value),
            Outcome::Observables(values) => values.iter().for_each(|value| used.expression(value)),
            Outcome::ArrayAndInputs(values) => {
                values.iter().for_each(|(_, value)| used.expression(value));
            }
            Outcome::Rates | Outcome::Array(..) | Outcome::MassMatrix => {}
        }
        used
    }

    /// Collects the names that the coefficients read.
    pub fn from_preparation(prepared: &Preparation) -> Self {
        let mut used = Self::default();
        for coefficient in &prepared.coefficients {
            match coefficient {
                PreparedValue::Number(value) => used.expression(value),
                PreparedValue::Numbers(array) => used.array(array),
            }
        }
        used.expression(&prepared.positive_definite);
        used
    }

    /// Returns true if the name is read.
    pub fn contains(&self, name: &str) -> bool {
        self.names.contains(name)
    }

    /// Keeps the statements whose results are read by later statements or by the outcome.
    pub fn retain(&mut self, statements: Vec<Statement>) -> Vec<Statement> {
        let kept = statements.into_iter().rev();
        let mut kept: Vec<Statement> = kept.filter_map(|one| self.filter_statement(one)).collect();
        kept.reverse();
        kept
    }

    fn filter_statement(&mut self, statement: Statement) -> Option<Statement> {
        let written = match &statement {
            Statement::Remainder { name, .. } => *name,
            Statement::Let(name, _)
            | Statement::Zeros(name, _)
            | Statement::Flag(name)
            | Statement::Sum { name, .. }
            | Statement::Cholesky { name, .. }
            | Statement::CholeskySolve { name, .. } => name,
            Statement::Assign(place, _) => &place.name,
            Statement::Loop { .. } => return self.filter_loop(statement),
        };
        if !self.names.contains(written) {
            return None;
        }
        match &statement {
            Statement::Let(_, value) | Statement::Assign(_, value) => self.expression(value),
            Statement::Sum { element, .. } => self.expression(element),
            Statement::Remainder { first, product, .. } => {
                self.expression(first);
                self.expression(product);
            }
            Statement::Cholesky { matrix, .. } => self.array(matrix),
            Statement::CholeskySolve { factor, right, .. } => {
                self.array(factor);
                self.array(right);
            }
            Statement::Zeros(..) | Statement::Flag(_) | Statement::Loop { .. } => {}
        }
        Some(statement)
    }

    fn filter_loop(&mut self, statement: Statement) -> Option<Statement> {
        let Statement::Loop { index, span, lines } = statement else {
            return Some(statement);
        };
        let lines = self.retain(lines);
        let is_needed = !lines.is_empty() && !span.is_empty();
        is_needed.then_some(Statement::Loop { index, span, lines })
    }

    fn expression(&mut self, expression: &Expression) {
        let all = |used: &mut Self, parts: &[Expression]| {
            parts.iter().for_each(|part| used.expression(part));
        };
        match expression {
            Expression::Name(name) | Expression::Flag(name) => self.name(name),
            Expression::Element(array, _) => self.array(array),
            Expression::Field(structure, _) => self.name(match structure {
                ArgumentStruct::Coefficients => "coefficients",
                ArgumentStruct::Parameters => "parameters",
                ArgumentStruct::Inputs => "inputs",
                ArgumentStruct::InputDirection => "input_direction",
                ArgumentStruct::Measured => "measured",
                ArgumentStruct::Memory => "memory",
            }),
            Expression::Shared(part) | Expression::Negate(part) => self.expression(part),
            Expression::Binary(_, a, b) => {
                self.expression(a);
                self.expression(b);
            }
            Expression::Call(_, parts) | Expression::Primitive(_, parts) => all(self, parts),
            Expression::Select(parts) => all(self, &**parts),
            Expression::Greater(parts) | Expression::And(parts) => all(self, &**parts),
            Expression::Positive(_) => self.name("regime"),
            Expression::Number(_) | Expression::True => {}
        }
    }

    fn array(&mut self, array: &Array) {
        match array {
            Array::Local(name) => self.name(name),
            Array::Coefficient(..) => self.name("coefficients"),
            Array::Filled(value, _) => self.expression(value),
            Array::Table(name, _) => self.name(name),
        }
    }

    fn name(&mut self, name: &str) {
        if !self.names.contains(name) {
            self.names.insert(name.to_owned());
        }
    }
}
