//! Builds a model from raw entries: parses units, resolves names, and sorts entries by their references.
//! `quantities`, `fields`, `coefficients` and `drawing` build the entries of their sections; `motion`, `units_check`
//! and `checks` check the result.

mod coefficients;
mod drawing;
mod fields;
mod quantities;

use crate::control::resolve_controller;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::expression::{Resolver, Scope};
use crate::ids::{ConstraintId, DefinitionId, ParameterId};
use crate::model::{
    Constraint, ContactFriction, Controller, Definition, Expr, ExprKind, Force, Impact, MULTIPLIER,
    Model, Observable, Parameter, ParameterValue, RESIDUAL, Sensor, Term,
};
use crate::names::Names;
use crate::order::{Reference, cycle_error, sort_by_references};
use crate::quantity::{Name, Quantity, StringValue};
use crate::rate_order::{Expanded, rate_order};
use crate::raw::{Document, RawController, RawImpact, RawSensor, RawTerm};
use crate::source::Source;
use crate::space::{Inertia, Requirements};
use crate::span::Span;
use crate::unit::Unit;

/// Model before the check of units; definitions and observables are still dimensionless.
pub struct ResolvedModel {
    pub model: Model,
    /// Declared units of the observables, in their order.
    pub declared_units: Vec<Option<Unit>>,
    /// Quantities of shorthands, each with its required unit and its name in messages.
    pub required_units: Vec<(Expr, Dimension, String)>,
    /// Components of vectors; the components of one vector must have equal units.
    pub same_unit_vectors: Vec<Vec<Expr>>,
    pub inertias: Vec<Inertia<Expr>>,
}

pub fn resolve(
    document: Document,
    requirements: Requirements,
    source: &Source,
) -> Result<ResolvedModel, Diagnostics> {
    let mut found = Diagnostics::new(source.clone());
    let names = Names::declare(&document, &mut found);
    let mut builder = Builder { names, found };
    let mut resolved = builder.build_model(document, source);
    builder.resolve_requirements(requirements, &mut resolved);
    if builder.found.is_empty() {
        Ok(resolved)
    } else {
        Err(builder.found)
    }
}

struct Builder {
    names: Names,
    found: Diagnostics,
}

impl Builder {
    fn build_model(&mut self, document: Document, source: &Source) -> ResolvedModel {
        let drawing = self.build_drawing(&document);
        let inputs: Vec<Name> = document
            .inputs
            .iter()
            .map(|input| input.name.clone())
            .collect();
        let observables = self.build_all(document.observables, Self::build_observable);
        let (mut observables, mut declared): (Vec<_>, Vec<_>) = observables.into_iter().unzip();
        let constraints = self.build_all(document.constraints, Self::build_constraint);
        observables.extend(build_constraint_observables(&constraints));
        declared.resize(observables.len(), None);
        let parameters = self.build_all(document.parameters, Self::build_parameter);
        let definitions = self.build_all(document.definitions, Self::build_definition);
        let mut model = Model {
            name: document.name.text,
            title: document.title,
            source: source.clone(),
            settings: Vec::new(),
            coordinates: self.build_all(document.coordinates, Self::build_coordinate),
            inputs: self.build_all(document.inputs, Self::build_input),
            states: self.build_all(document.states, Self::build_state),
            fields: self.build_all(document.fields, Self::build_field),
            kinetic: self.build_all(document.kinetic, Self::build_term),
            potential: self.build_all(document.potential, Self::build_term),
            // `requirements` sets this field after the names are resolved.
            rigid_tree: None,
            dissipation: self.build_all(document.dissipation, Self::build_term),
            forces: self.build_all(document.forces, Self::build_force),
            constraints,
            impacts: self.build_all(document.impacts, Self::build_impact),
            observables,
            coefficients: self.build_coefficients(document.coefficients),
            sensors: document.sensors.into_iter().map(build_sensor).collect(),
            controllers: self.build_controllers(document.controllers, &inputs),
            drawing,
            parameter_order: Vec::new(),
            definition_order: Vec::new(),
            parameters,
            definitions,
        };
        if model.title.is_empty() {
            model.title.clone_from(&model.name);
        }
        if self.found.is_empty() {
            self.sort_entries(&mut model);
        }
        ResolvedModel {
            model,
            declared_units: declared,
            required_units: Vec::new(),
            same_unit_vectors: Vec::new(),
            inertias: Vec::new(),
        }
    }

    fn build_controllers(&mut self, all: Vec<RawController>, inputs: &[Name]) -> Vec<Controller> {
        let mut controllers: Vec<Controller> = Vec::with_capacity(all.len());
        let mut driven = Vec::new();
        for raw in all {
            let found = &mut self.found;
            let controller = resolve_controller(raw, &self.names, inputs, &driven, found);
            if let Some(controller) = controller {
                driven.extend(controller.outputs.iter().cloned());
                controllers.push(controller);
            }
        }
        controllers
    }

    fn resolve_requirements(&mut self, requirements: Requirements, resolved: &mut ResolvedModel) {
        if !self.found.is_empty() {
            return;
        }
        for requirement in requirements.units {
            if let Some(value) = self.resolve_expression(&requirement.value, Scope::Motion) {
                let required_units = (value, requirement.dimension, requirement.subject);
                resolved.required_units.push(required_units);
            }
        }
        for vector in requirements.same_unit_vectors {
            let mut component = |value: &Quantity| self.resolve_expression(value, Scope::Motion);
            let components: Option<Vec<Expr>> = vector.iter().map(&mut component).collect();
            resolved.same_unit_vectors.extend(components);
        }
        for inertia in requirements.inertias {
            let mut constant = |value: &Quantity| self.resolve_expression(value, Scope::Parameters);
            let mass = match &inertia.mass {
                Some(mass) => match constant(mass) {
                    None => continue,
                    mass => mass,
                },
                None => None,
            };
            let elements: Option<Vec<Expr>> = inertia.elements.iter().map(constant).collect();
            resolved.inertias.extend(elements.map(|elements| Inertia {
                elements,
                mass,
                body: inertia.body,
                span: inertia.span,
            }));
        }
        if let Some(tree) = requirements.rigid_tree.filter(|_| self.found.is_empty()) {
            let mut resolver = Resolver::new(&self.names, Scope::Motion);
            let tree = tree.try_map(|syntax| resolver.resolve(syntax));
            resolved.model.rigid_tree = self.found.push_error(tree);
        }
    }

    fn build_all<R, T>(
        &mut self,
        raw: Vec<R>,
        build: impl Fn(&mut Self, R) -> Option<T>,
    ) -> Vec<T> {
        let mut built = Vec::with_capacity(raw.len());
        for entry in raw {
            if self.found.is_full() {
                break;
            }
            built.extend(build(self, entry));
        }
        built
    }

    fn sort_entries(&mut self, model: &mut Model) {
        let references: Vec<_> = model.parameters.iter().map(parameter_references).collect();
        let named = |index: usize| model.parameters[index].name.as_str();
        match sort_by_references(&references) {
            Ok(sorted) => {
                model.parameter_order = sorted.into_iter().map(ParameterId::new).collect()
            }
            Err(circle) => self.found.push(cycle_error("parameter", &circle, named)),
        }
        let references: Vec<_> = model
            .definitions
            .iter()
            .map(definition_references)
            .collect();
        let named = |index: usize| model.definitions[index].name.as_str();
        match sort_by_references(&references) {
            Ok(sorted) => {
                model.definition_order = sorted.into_iter().map(DefinitionId::new).collect()
            }
            Err(circle) => self.found.push(cycle_error("definition", &circle, named)),
        }
        // Cycles of definitions without rates were reported above.
        if self.found.is_empty() && !model.states.is_empty() {
            self.reject_cyclic_rates(model);
        }
    }

    fn reject_cyclic_rates(&mut self, model: &Model) {
        let Err(circle) = rate_order(model) else {
            return;
        };
        let named = |index: usize| match circle[index].0 {
            Expanded::Definition(id) | Expanded::RatesWithin(id) => {
                model.definitions[id].name.as_str()
            }
            Expanded::Rate(id) => model.states[id].name.as_str(),
        };
        let places: Vec<Reference> = (0..circle.len()).map(|at| (at, circle[at].1)).collect();
        let diagnostic = cycle_error("rate of the state", &places, named);
        self.found.push(diagnostic);
    }

    fn parse_unit(&mut self, written: Option<StringValue>) -> Option<Unit> {
        let Some(written) = written else {
            return Some(Unit::coherent(Dimension::DIMENSIONLESS));
        };
        let unit = Unit::parse(&written.text).map_err(|error| {
            Diagnostic::error(error.message)
                .with_span(written.span, "not a unit")
                .with_optional_help(error.help)
        });
        self.found.push_error(unit)
    }

    /// Parses a unit with scale 1.
    fn parse_coherent_unit(&mut self, written: Option<StringValue>) -> Option<Unit> {
        let span = written
            .as_ref()
            .map_or_else(Span::default, |written| written.span);
        let unit = self.parse_unit(written)?;
        if unit.is_coherent() {
            return Some(unit);
        }
        let right = match unit.text.as_str() {
            "deg" => "rad".to_owned(),
            _ => unit.dimension.to_string(),
        };
        self.found.push(
            Diagnostic::error(format!("the unit `{unit}` is not a coherent SI unit"))
                .with_span(span, "only parameters may have such a unit")
                .with_help(format!("write unit = \"{right}\"")),
        );
        None
    }

    fn resolve_expression(&mut self, quantity: &Quantity, scope: Scope) -> Option<Expr> {
        let resolved = quantity
            .syntax()
            .and_then(|syntax| Resolver::new(&self.names, scope).resolve(&syntax));
        self.found.push_error(resolved)
    }

    fn build_definition(&mut self, raw: RawTerm) -> Option<Definition> {
        Some(Definition {
            value: self.resolve_expression(&raw.value, Scope::Motion)?,
            name: raw.name.text,
            unit: Unit::coherent(Dimension::DIMENSIONLESS),
            doc: raw.doc,
            span: raw.name.span,
        })
    }

    fn build_term(&mut self, raw: RawTerm) -> Option<Term> {
        Some(Term {
            value: self.resolve_expression(&raw.value, Scope::Motion)?,
            name: raw.name.text,
            doc: raw.doc,
            origin: raw.origin,
            span: raw.name.span,
        })
    }

    fn build_force(&mut self, (raw, on): (RawTerm, Quantity)) -> Option<Force> {
        let on = self.resolve_expression(&on, Scope::Motion);
        let term = self.build_term(raw)?;
        Some(Force {
            name: term.name,
            on: on?,
            value: term.value,
            doc: term.doc,
            origin: term.origin,
            span: term.span,
        })
    }

    fn build_constraint(&mut self, raw: RawTerm) -> Option<Constraint> {
        Some(Constraint {
            zero: self.resolve_expression(&raw.value, Scope::Motion)?,
            // `motion` and `units_check` set both.
            is_nonholonomic: false,
            unit: Unit::coherent(Dimension::DIMENSIONLESS),
            name: raw.name.text,
            doc: raw.doc,
            origin: raw.origin,
            span: raw.name.span,
        })
    }

    fn build_impact(&mut self, impact: RawImpact) -> Option<Impact> {
        let raw = impact.distance;
        let restitution = self.resolve_expression(&impact.restitution, Scope::Parameters);
        let friction = match impact.friction {
            Some(friction) => {
                let coefficient = self.resolve_expression(&friction.coefficient, Scope::Parameters);
                let slip = self.resolve_expression(&friction.slip, Scope::Motion);
                Some(ContactFriction {
                    coefficient: coefficient?,
                    slip: slip?,
                })
            }
            None => None,
        };
        Some(Impact {
            when: self.resolve_expression(&raw.value, Scope::Motion)?,
            restitution: restitution?,
            friction,
            // `units_check` sets the unit.
            unit: Unit::coherent(Dimension::DIMENSIONLESS),
            name: raw.name.text,
            doc: raw.doc,
            origin: raw.origin,
            span: raw.name.span,
        })
    }

    fn build_observable(
        &mut self,
        (raw, unit): (RawTerm, Option<StringValue>),
    ) -> Option<(Observable, Option<Unit>)> {
        let declared = match unit {
            Some(written) => Some(self.parse_coherent_unit(Some(written))?),
            None => None,
        };
        let observable = Observable {
            rate_of: None,
            value: self.resolve_expression(&raw.value, Scope::Motion)?,
            name: raw.name.text,
            unit: Unit::coherent(Dimension::DIMENSIONLESS),
            doc: raw.doc,
            span: raw.name.span,
        };
        Some((observable, declared))
    }
}

fn build_sensor(raw: RawSensor) -> Sensor {
    let (observable, span) = match raw.observable {
        Some(written) => (written.text, written.span),
        None => (raw.channel.text.clone(), raw.channel.span),
    };
    Sensor {
        channel: raw.channel.text,
        observable,
        gain: raw.gain,
        bias: raw.bias,
        delay: raw.delay,
        span,
    }
}

/// Returns the multiplier and the residual of each constraint as observables.
fn build_constraint_observables(constraints: &[Constraint]) -> Vec<Observable> {
    let observable =
        |prefix: &str, kind: ExprKind, doc: &str, constraint: &Constraint| Observable {
            rate_of: None,
            name: format!("{prefix}{}", constraint.name),
            value: Expr {
                kind,
                span: constraint.span,
            },
            unit: Unit::coherent(Dimension::DIMENSIONLESS),
            doc: format!("{doc} of the constraint {}", constraint.name),
            span: constraint.span,
        };
    let each = ConstraintId::first(constraints.len()).zip(constraints);
    each.flat_map(|(id, constraint)| {
        [
            observable(
                MULTIPLIER,
                ExprKind::Multiplier(id),
                "multiplier",
                constraint,
            ),
            observable(RESIDUAL, ExprKind::Residual(id), "residual", constraint),
        ]
    })
    .collect()
}

fn parameter_references(parameter: &Parameter) -> Vec<Reference> {
    let mut list = Vec::new();
    if let ParameterValue::Expression(expr) = &parameter.value {
        expr.visit(&mut |part| {
            if let ExprKind::Parameter(index) = part.kind {
                list.push((index.index(), part.span));
            }
        });
    }
    list
}

fn definition_references(definition: &Definition) -> Vec<Reference> {
    let mut list = Vec::new();
    definition.value.visit(&mut |part| {
        if let ExprKind::Definition(index) = part.kind {
            list.push((index.index(), part.span));
        }
    });
    list
}
