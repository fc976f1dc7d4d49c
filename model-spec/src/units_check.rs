//! Checks the units of a model: energies are in J, the dissipation in W, a force times its
//! displacement in J; parameters, initial values and observables as declared. `infer` computes
//! the unit of an expression.

use crate::ast::BinaryOperator;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::infer::{Inference, UnitPhrase};
use crate::model::{
    CoefficientKind, Expr, ExprKind, Model, ParameterValue, Range, STABILISATION_RATE, Term,
    written_name,
};
use crate::resolve::ResolvedModel;
use crate::unit::Unit;

/// Checks the units of all expressions, and sets the units of definitions and observables.
pub fn check(resolved: &mut ResolvedModel, found: &mut Diagnostics) {
    let mut units = Units {
        known: Inference {
            definitions: vec![None; resolved.model.definitions.len()],
            coefficients: Vec::new(),
            model: &resolved.model,
        },
        model: &resolved.model,
        found,
    };
    units.check_parameters();
    units.check_coordinates();
    units.check_inputs();
    units.check_fields();
    // A wrong unit of gravity would be reported at the rotations of frames, whose definitions contain it.
    if units.check_required_units(&resolved.required_units)
        && units.check_definitions()
        && units.check_shorthands(&resolved.required_units, &resolved.same_unit_vectors)
    {
        units.check_states();
        units.check_energies();
        units.check_forces();
        units.check_stabilisation_rate();
        units.check_coefficients();
    }
    let observables = units.check_observables(&resolved.declared_units);
    let constraints: Vec<Unit> = units.check_constraints();
    let impacts: Vec<Unit> = units.check_impacts();
    let definitions = units.known.definitions;
    for (impact, unit) in resolved.model.impacts.iter_mut().zip(impacts) {
        impact.unit = unit;
    }
    for (constraint, unit) in resolved.model.constraints.iter_mut().zip(constraints) {
        constraint.unit = unit;
    }
    for (definition, dimension) in resolved.model.definitions.iter_mut().zip(definitions) {
        definition.unit = Unit::coherent(dimension.unwrap_or(Dimension::DIMENSIONLESS));
    }
    for (observable, unit) in resolved.model.observables.iter_mut().zip(observables) {
        observable.unit = unit;
    }
}

struct Units<'m, 'f> {
    model: &'m Model,
    known: Inference<'m>,
    found: &'f mut Diagnostics,
}

impl Units<'_, '_> {
    fn check_parameters(&mut self) {
        for parameter in &self.model.parameters {
            if let ParameterValue::Expression(expr) = &parameter.value {
                let declared = format!("declared in {}", parameter.unit);
                let subject = format!("the value of `{}`", parameter.name);
                self.expect(expr, parameter.unit.dimension, &subject, &declared);
            }
        }
    }

    fn check_coordinates(&mut self) {
        for coordinate in &self.model.coordinates {
            let own = coordinate.unit.dimension;
            if let Some(expr) = &coordinate.initial {
                let subject = format!("the initial value of `{}`", coordinate.name);
                self.expect_quantity(expr, own, &subject);
            }
            if let (Some(expr), Some(rate)) =
                (&coordinate.initial_rate, own.divide(Dimension::TIME))
            {
                let subject = format!("the initial rate of `{}`", coordinate.name);
                self.expect_quantity(expr, rate, &subject);
            }
            self.check_range(coordinate.range.as_ref(), own, &coordinate.name);
        }
    }

    fn check_inputs(&mut self) {
        for input in &self.model.inputs {
            self.check_range(input.range.as_ref(), input.unit.dimension, &input.name);
        }
    }

    fn check_states(&mut self) {
        for state in &self.model.states {
            let own = state.unit.dimension;
            if let Some(expr) = &state.initial {
                let subject = format!("the initial value of `{}`", state.name);
                self.expect_quantity(expr, own, &subject);
            }
            if let Some(rate) = own.divide(Dimension::TIME) {
                let subject = format!("the rate of `{}`", state.name);
                let because = format!("expected {}: {} per s", UnitPhrase(rate), state.unit);
                self.expect(&state.rate, rate, &subject, &because);
            }
            self.check_range(state.range.as_ref(), own, &state.name);
        }
    }

    fn check_range(&mut self, range: Option<&Range>, expected: Dimension, name: &str) {
        let ends = range.map(|range| [("lower", &range.low), ("upper", &range.high)]);
        for (end, expr) in ends.into_iter().flatten() {
            self.expect_quantity(expr, expected, &format!("the {end} end of `{name}`"));
        }
    }

    fn check_fields(&mut self) {
        for field in &self.model.fields {
            let subject = |end: &str| format!("the {end} of the field `{}`", field.name);
            self.expect_quantity(&field.from, Dimension::LENGTH, &subject("start"));
            self.expect_quantity(&field.to, Dimension::LENGTH, &subject("end"));
        }
    }

    fn check_definitions(&mut self) -> bool {
        let mut all = true;
        for &index in &self.model.definition_order {
            let inferred = self.known.infer(&self.model.definitions[index].value);
            match self.found.push_error(inferred) {
                Some(inferred) => self.known.definitions[index] = inferred,
                None => all = false,
            }
        }
        all
    }

    fn check_energies(&mut self) {
        let model = self.model;
        self.check_terms(&model.kinetic, "the kinetic energy", Dimension::ENERGY, "J");
        self.check_terms(
            &model.potential,
            "the potential energy",
            Dimension::ENERGY,
            "J",
        );
        self.check_terms(&model.dissipation, "the dissipation", Dimension::POWER, "W");
    }

    fn check_terms(&mut self, terms: &[Term], of: &str, expected: Dimension, unit: &str) {
        for term in terms {
            let subject = format!("this term of {of}");
            self.expect(&term.value, expected, &subject, &format!("expected {unit}"));
        }
    }

    fn check_forces(&mut self) {
        for force in &self.model.forces {
            let inferred = self.known.infer(&force.on);
            let Some(on) = self.found.push_error(inferred) else {
                continue;
            };
            let on = on.unwrap_or(Dimension::DIMENSIONLESS);
            let Some(expected) = Dimension::ENERGY.divide(on) else {
                continue;
            };
            let name = written_name(&force.name, force.span, &self.model.source);
            let subject = format!("the force `{name}`");
            let works = match force.on.kind {
                ExprKind::Coordinate(index) => self.model.coordinates[index].unit.to_string(),
                _ => on.to_string(),
            };
            let because =
                format!("expected {expected}: multiplied by its displacement ({works}) it is J");
            self.expect(&force.value, expected, &subject, &because);
        }
    }

    /// Checks the unit of a declared stabilisation rate.
    fn check_stabilisation_rate(&mut self) {
        let model = self.model;
        let declared = model
            .parameters
            .iter()
            .find(|p| p.name == STABILISATION_RATE);
        let (Some(parameter), false) = (declared, model.constraints.is_empty()) else {
            return;
        };
        if let ParameterValue::Expression(value) = &parameter.value {
            let message = format!("`{STABILISATION_RATE}` must be a number: it is set at run time");
            self.found.push(
                Diagnostic::error(message)
                    .with_span(value.span, "this depends on other parameters")
                    .with_help("give a number"),
            );
        }
        if Dimension::DIMENSIONLESS.divide(Dimension::TIME) != Some(parameter.unit.dimension) {
            let message = format!("`{STABILISATION_RATE}` is in {}", parameter.unit);
            self.found.push(
                Diagnostic::error(message)
                    .with_span(parameter.span, "expected 1/s")
                    .with_help("it is the decay rate of constraint residuals: unit = \"1/s\""),
            );
        }
    }

    fn check_constraints(&mut self) -> Vec<Unit> {
        let mut units = Vec::with_capacity(self.model.constraints.len());
        for constraint in &self.model.constraints {
            let inferred = self.known.infer(&constraint.zero);
            let inferred = self.found.push_error(inferred).flatten();
            units.push(Unit::coherent(inferred.unwrap_or(Dimension::DIMENSIONLESS)));
        }
        units
    }

    /// Returns the unit of every distance. Checks that restitutions and coefficients of friction are
    /// dimensionless, and that slips are in the unit of the distance per second.
    fn check_impacts(&mut self) -> Vec<Unit> {
        let mut units = Vec::with_capacity(self.model.impacts.len());
        for impact in &self.model.impacts {
            let subject = format!("the restitution of `{}`", impact.name);
            self.expect_quantity(&impact.restitution, Dimension::DIMENSIONLESS, &subject);
            let inferred = self.known.infer(&impact.when);
            let inferred = self.found.push_error(inferred).flatten();
            if let Some(friction) = &impact.friction {
                let subject = format!("the friction of `{}`", impact.name);
                self.expect_quantity(&friction.coefficient, Dimension::DIMENSIONLESS, &subject);
                let speed = inferred.and_then(|distance| distance.divide(Dimension::TIME));
                if let Some(speed) = speed {
                    let subject = format!("the slip of `{}`", impact.name);
                    let because = format!("expected {}", UnitPhrase(speed));
                    self.expect(&friction.slip, speed, &subject, &because);
                }
            }
            units.push(Unit::coherent(inferred.unwrap_or(Dimension::DIMENSIONLESS)));
        }
        units
    }

    fn check_observables(&mut self, declared: &[Option<Unit>]) -> Vec<Unit> {
        let mut units = Vec::with_capacity(declared.len());
        for (observable, declared) in self.model.observables.iter().zip(declared) {
            let inferred = match declared {
                Some(unit) => {
                    let subject = format!("the observable `{}`", observable.name);
                    let expected = format!("declared in {unit}");
                    self.expect(&observable.value, unit.dimension, &subject, &expected);
                    unit.clone()
                }
                None => {
                    let inferred = self.known.infer(&observable.value);
                    let inferred = match observable.value.kind {
                        // If the constraint has an error, it is reported at the constraint.
                        ExprKind::Multiplier(_) | ExprKind::Residual(_) => inferred.ok(),
                        _ => self.found.push_error(inferred),
                    }
                    .flatten();
                    Unit::coherent(inferred.unwrap_or(Dimension::DIMENSIONLESS))
                }
            };
            units.push(inferred);
        }
        units
    }

    fn check_coefficients(&mut self) {
        for coefficient in &self.model.coefficients {
            let inferred = match &coefficient.kind {
                CoefficientKind::Value(value) => self.known.infer(value),
                CoefficientKind::Factor { of, by, times } => {
                    self.known.factor(of, by, times.as_ref())
                }
            };
            let dimension = self.found.push_error(inferred).flatten();
            self.known.coefficients.push(dimension);
        }
    }

    /// Checks the units of the quantities in shorthands. Returns false after an error; the energies of the shorthand
    /// are then not checked, because they would repeat the error.
    fn check_shorthands(
        &mut self,
        required: &[(Expr, Dimension, String)],
        vectors: &[Vec<Expr>],
    ) -> bool {
        let clean = self.found.is_empty();
        for vector in vectors {
            self.expect_same_unit(vector);
        }
        self.check_required_units(required);
        !clean || self.found.is_empty()
    }

    /// Checks the units of the quantities that have a unit. Returns false after an error.
    fn check_required_units(&mut self, required: &[(Expr, Dimension, String)]) -> bool {
        let clean = self.found.is_empty();
        for (value, dimension, subject) in required {
            let expected = format!("expected {}", UnitPhrase(*dimension));
            self.expect(value, *dimension, subject, &expected);
        }
        // A quotient with the divisor 0 has no unit; the module `constants` reports this error.
        let has_unit = |(value, ..): &(Expr, Dimension, String)| !self.divides_by_zero(value);
        let all_have_units = required.iter().all(has_unit);
        !clean || self.found.is_empty() && all_have_units
    }

    /// Returns true if a divisor in an expression is a number 0, which has no unit.
    fn divides_by_zero(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Binary(operator, left, right) => {
                let is_zero = *operator == BinaryOperator::Divide
                    && matches!(self.known.infer(right), Ok(None));
                is_zero || self.divides_by_zero(left) || self.divides_by_zero(right)
            }
            ExprKind::Negate(operand) => self.divides_by_zero(operand),
            ExprKind::Call(_, arguments) => arguments.iter().any(|part| self.divides_by_zero(part)),
            _ => false,
        }
    }

    /// Checks that the components of a vector have equal units.
    fn expect_same_unit(&mut self, components: &[Expr]) {
        let mut first: Option<(Dimension, &Expr)> = None;
        for component in components {
            let inferred = self.known.infer(component);
            let Some(own) = self.found.push_error(inferred).flatten() else {
                continue;
            };
            match first {
                None => first = Some((own, component)),
                Some((dimension, _)) if dimension == own => {}
                Some((dimension, other)) => {
                    let message = "the components of a vector have different units";
                    self.found.push(
                        Diagnostic::error(message)
                            .with_span(component.span, UnitPhrase(own).to_string())
                            .with_related_span(other.span, UnitPhrase(dimension).to_string())
                            .with_optional_help(self.known.describe_cure(
                                &[component, other],
                                own,
                                dimension,
                            )),
                    );
                    return;
                }
            }
        }
    }

    /// Checks the unit of a quantity. A number without a unit is in SI.
    fn expect_quantity(&mut self, expr: &Expr, expected: Dimension, subject: &str) {
        if !matches!(expr.kind, ExprKind::Number(_)) {
            self.expect(
                expr,
                expected,
                subject,
                &format!("expected {}", UnitPhrase(expected)),
            );
        }
    }

    fn expect(&mut self, expr: &Expr, expected: Dimension, subject: &str, because: &str) {
        let inferred = self.known.infer(expr);
        if let Some(Some(inferred)) = self.found.push_error(inferred)
            && inferred != expected
        {
            let cure = self.known.describe_cure(&[expr], inferred, expected);
            self.found.push(
                Diagnostic::error(format!("{subject} is {}, {because}", UnitPhrase(inferred)))
                    .with_span(expr.span, UnitPhrase(inferred).to_string())
                    .with_optional_help(cure),
            );
        }
    }
}
