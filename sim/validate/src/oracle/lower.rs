//! Conversion of the checked model's expressions to [`Tree`]. Parameters are replaced by numbers and domains by sets of
//! positions, constants are folded, and unsupported expressions are rejected.

use super::OracleError;
use super::evaluate::Pass;
use super::fold::{binary_tree, fold_constants};
use super::knots::switch_positions;
use super::places::{FieldDomain, PlaceSet};
use super::powers::highest_power;
use super::scene::{Direction, Scene};
use super::system::{Integral, System};
use super::tree::{Leaf, Tree};
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Field, Model};

pub(super) struct Lowering<'m> {
    pub system: System,
    parameters: &'m [f64],
    /// Index of each input's rate among the inputs, if given.
    input_rates: Vec<Option<usize>>,
    quadratures: Vec<usize>,
    /// Name of the current expression, for errors.
    subject: String,
}

impl<'m> Lowering<'m> {
    fn new(model: &Model, parameters: &'m [f64], subject: &str) -> Self {
        Self {
            system: System {
                size: model.coordinates.len(),
                ..System::default()
            },
            parameters,
            input_rates: input_rate_indices(model),
            quadratures: Vec::new(),
            subject: subject.to_owned(),
        }
    }

    /// Creates the converter with domains, definitions and first-order states of `model`.
    pub fn from_model(
        model: &Model,
        order: usize,
        parameters: &'m [f64],
    ) -> Result<Self, OracleError> {
        let mut lowering = Self::new(model, parameters, "");
        let power = highest_power(model);
        for (id, field) in FieldId::first(model.fields.len()).zip(&model.fields) {
            let knots = |ends| switch_positions(model, id, parameters, ends);
            lowering.add_field(field, order, power, &knots)?;
        }
        let count = model.definitions.len();
        lowering.system.definitions = vec![Tree::Constant(f64::NAN); count];
        lowering
            .system
            .dependences
            .resize_with(count, Default::default);
        for index in model.definition_order.iter().map(|id| id.index()) {
            let Some(definition) = model.definitions.get(index) else {
                continue;
            };
            let tree = lowering.lower_term(&definition.name, &definition.value)?;
            let dependence = lowering.system.dependence(&tree);
            if let Some(entry) = lowering.system.definitions.get_mut(index) {
                *entry = tree;
            }
            if let Some(entry) = lowering.system.dependences.get_mut(index) {
                *entry = dependence;
            }
        }
        for state in &model.states {
            let addends = lowering
                .lower_term(&state.name, &state.rate)?
                .into_addends();
            lowering.system.state_rates.push(addends);
        }
        Ok(lowering)
    }

    pub fn lower_term(&mut self, name: &str, expression: &Expr) -> Result<Tree, OracleError> {
        name.clone_into(&mut self.subject);
        let tree = self.lower(expression, None)?;
        let dependence = self.system.dependence(&tree);
        if dependence.has_position
            || !dependence.leaves.is_empty()
            || !dependence.indices.is_empty()
        {
            return Err(self.misplaced_error());
        }
        Ok(tree)
    }

    fn add_field(
        &mut self,
        field: &Field,
        order: usize,
        power: usize,
        knots: &dyn Fn([f64; 2]) -> Vec<f64>,
    ) -> Result<(), OracleError> {
        field.name.clone_into(&mut self.subject);
        let (from, to) = (
            self.evaluate_constant(&field.from)?,
            self.evaluate_constant(&field.to)?,
        );
        if !(to - from).is_finite() || to == from {
            return Err(OracleError::NonFiniteConstant(format!(
                "the length of {}",
                field.name
            )));
        }
        let domain = FieldDomain::new(
            [from, to],
            &field.basis,
            self.system.size,
            order,
            power,
            &knots([from, to]),
        );
        let number = self.system.domains.len();
        self.quadratures.push(self.system.places.len());
        self.system
            .places
            .push(PlaceSet::from_quadrature(number, &domain));
        self.system.size += order;
        self.system.domains.push(domain);
        Ok(())
    }

    fn evaluate_constant(&mut self, expression: &Expr) -> Result<f64, OracleError> {
        match self.lower(expression, None)? {
            Tree::Constant(value) if value.is_finite() => Ok(value),
            _ => Err(OracleError::NonFiniteConstant(self.subject.clone())),
        }
    }

    fn misplaced_error(&self) -> OracleError {
        OracleError::MisplacedField(self.subject.clone())
    }

    /// Converts an expression; `set` is the enclosing set of positions.
    fn lower(&mut self, expression: &Expr, set: Option<usize>) -> Result<Tree, OracleError> {
        Ok(match &expression.kind {
            ExprKind::Dot(operand) => self.lower_dot(operand, set)?,
            ExprKind::Diff(operand, times) => self.lower_diff(operand, *times, set)?,
            ExprKind::At {
                field,
                value,
                position,
            } => self.lower_at(field.index(), value, position)?,
            ExprKind::Integral { field, integrand } => {
                self.lower_integral(field.index(), integrand)?
            }
            ExprKind::Sum { field, summand } => self.lower_sum(field.index(), summand, set)?,
            ExprKind::Negate(operand) => {
                fold_constants(Tree::Negate(self.lower(operand, set)?.into()))
            }
            ExprKind::Binary(operator, left, right) => {
                let (left, right) = (self.lower(left, set)?, self.lower(right, set)?);
                fold_constants(binary_tree(*operator, left, right))
            }
            ExprKind::Call(function, arguments) => {
                let arguments: Result<_, _> = arguments
                    .iter()
                    .map(|argument| self.lower(argument, set))
                    .collect();
                fold_constants(Tree::Call(*function, arguments?))
            }
            name => self.lower_name(name, set)?,
        })
    }

    fn lower_name(&mut self, kind: &ExprKind, set: Option<usize>) -> Result<Tree, OracleError> {
        Ok(match kind {
            ExprKind::Number(number) => Tree::Constant(*number),
            ExprKind::Pi => Tree::Constant(std::f64::consts::PI),
            ExprKind::Time => Tree::Time,
            ExprKind::Position(field) => Tree::Position {
                set: self.enclosing_set(field.index(), set)?,
            },
            ExprKind::Parameter(index) => Tree::Constant(
                self.parameters
                    .get(index.index())
                    .copied()
                    .unwrap_or(f64::NAN),
            ),
            ExprKind::Coordinate(index) => Tree::Coordinate(index.index()),
            ExprKind::Input(index) => self.lower_input(index.index()),
            ExprKind::State(index) => Tree::State(index.index()),
            ExprKind::Multiplier(index) => Tree::Multiplier(index.index()),
            ExprKind::Residual(index) => {
                let known = self.system.residuals.get(index.index()).cloned();
                known.ok_or_else(|| self.misplaced_error())?
            }
            ExprKind::Definition(index) => match self.system.definitions.get(index.index()) {
                Some(Tree::Constant(value)) => Tree::Constant(*value),
                _ => Tree::Definition(index.index()),
            },
            ExprKind::Field(field) => self.lower_leaf(field.index(), 0, set)?,
            ExprKind::ModeCoordinate(field) => Tree::Mode {
                field: field.index(),
            },
            ExprKind::ModeShape(field) => self.lower_shape(field.index(), 0, set)?,
            ExprKind::SingleMode { field, mode } => self.lower_single_mode(field.index(), *mode),
            _ => return Err(self.misplaced_error()),
        })
    }

    /// Returns the sum over the modes of a field with the factor 1 for one of them, and 0 for the others.
    fn lower_single_mode(&self, field: usize, mode: usize) -> Tree {
        let modes = self.system.modes(field).len();
        let values = (1..=modes).map(|number| if number == mode { 1.0 } else { 0.0 });
        let factors = Tree::PerMode {
            field,
            values: values.collect(),
        };
        Tree::Sum {
            field,
            body: Box::new(Tree::Binary(
                BinaryOperator::Multiply,
                factors.into(),
                Tree::Mode { field }.into(),
            )),
        }
    }

    fn lower_input(&self, input: usize) -> Tree {
        let rate_of = |input: usize| self.input_rates.get(input).copied().flatten();
        match rate_of(input) {
            None => Tree::Input(input),
            Some(rate) => Tree::PrescribedInput {
                input,
                rate,
                second: rate_of(rate),
            },
        }
    }

    /// Returns the enclosing set of positions if it belongs to `field`.
    fn enclosing_set(&self, field: usize, set: Option<usize>) -> Result<usize, OracleError> {
        set.filter(|set| {
            self.system
                .places
                .get(*set)
                .is_some_and(|places| places.field == field)
        })
        .ok_or_else(|| self.misplaced_error())
    }

    fn require_leaf(&mut self, leaf: Leaf, set: Option<usize>) -> Result<usize, OracleError> {
        let set = self.enclosing_set(leaf.field, set)?;
        let places = self.system.places.get_mut(set);
        if let Some((places, domain)) = places.zip(self.system.domains.get(leaf.field)) {
            places.compute_shapes(leaf.derivative, domain);
        }
        Ok(set)
    }

    fn lower_leaf(
        &mut self,
        field: usize,
        derivative: u8,
        set: Option<usize>,
    ) -> Result<Tree, OracleError> {
        let leaf = Leaf { field, derivative };
        let set = self.require_leaf(leaf, set)?;
        Ok(Tree::Field { leaf, set })
    }

    fn lower_shape(
        &mut self,
        field: usize,
        derivative: u8,
        set: Option<usize>,
    ) -> Result<Tree, OracleError> {
        let leaf = Leaf { field, derivative };
        let set = self.require_leaf(leaf, set)?;
        Ok(Tree::Shape { leaf, set })
    }

    fn lower_dot(&mut self, operand: &Expr, set: Option<usize>) -> Result<Tree, OracleError> {
        let operand = self.lower(operand, set)?;
        let dependence = self.system.dependence(&operand);
        if dependence.has_dot {
            return Err(OracleError::Acceleration(self.subject.clone()));
        }
        if dependence.has_input {
            return Err(OracleError::InputRate(self.subject.clone()));
        }
        Ok(match operand {
            Tree::Constant(_) | Tree::PerMode { .. } | Tree::Shape { .. } => Tree::Constant(0.0),
            Tree::State(index) => Tree::StateRate(index),
            operand => Tree::Dot(operand.into()),
        })
    }

    /// Converts a derivative by position. The operand is a field, a field's rate, a shape, or another derivative by
    /// position.
    fn lower_diff(
        &mut self,
        operand: &Expr,
        times: u8,
        set: Option<usize>,
    ) -> Result<Tree, OracleError> {
        match &operand.kind {
            ExprKind::Field(field) => self.lower_leaf(field.index(), times, set),
            ExprKind::ModeShape(field) => self.lower_shape(field.index(), times, set),
            ExprKind::Dot(inner) => Ok(Tree::Dot(self.lower_diff(inner, times, set)?.into())),
            ExprKind::Diff(inner, more) => self.lower_diff(inner, times.saturating_add(*more), set),
            _ => Err(self.misplaced_error()),
        }
    }

    fn lower_at(
        &mut self,
        field: usize,
        value: &Expr,
        position: &Expr,
    ) -> Result<Tree, OracleError> {
        let position = self.evaluate_constant(position)?;
        let domain = self
            .system
            .domains
            .get(field)
            .ok_or_else(|| self.misplaced_error())?;
        let set = self.system.places.len();
        let places = PlaceSet::from_position(field, domain, position);
        self.system.places.push(places);
        let body = self.lower(value, Some(set))?;
        Ok(self.sum_over_places(set, body, false))
    }

    fn lower_integral(&mut self, field: usize, integrand: &Expr) -> Result<Tree, OracleError> {
        let set = *self
            .quadratures
            .get(field)
            .ok_or_else(|| self.misplaced_error())?;
        let body = self.lower(integrand, Some(set))?;
        Ok(self.sum_over_places(set, body, true))
    }

    /// Creates a sum over positions. If the sum is constant, the result is a number, or one number per mode.
    fn sum_over_places(&mut self, set: usize, body: Tree, keep: bool) -> Tree {
        let dependence = self.system.dependence(&body);
        let mut tree = Tree::Places {
            set,
            body: body.clone().into(),
            integral: None,
        };
        let indices: Vec<usize> = dependence.indices.iter().copied().collect();
        if dependence.is_constant() {
            match indices.as_slice() {
                [] => tree = Tree::Constant(self.evaluate(&tree)),
                [field] => tree = self.evaluate_per_mode(*field, tree),
                _ => {}
            }
        } else if keep
            && indices.is_empty()
            && !dependence.has_nested_operator
            && dependence.states.is_empty()
        {
            tree = Tree::Places {
                set,
                body: body.clone().into(),
                integral: Some(self.system.integrals.len()),
            };
            self.system.integrals.push(Integral {
                set,
                body,
                coordinates: dependence.coordinates.into_iter().collect(),
                leaves: dependence.leaves.into_iter().collect(),
            });
        }
        tree
    }

    fn lower_sum(
        &mut self,
        field: usize,
        summand: &Expr,
        set: Option<usize>,
    ) -> Result<Tree, OracleError> {
        let body = self.lower(summand, set)?;
        let dependence = self.system.dependence(&body);
        let closed = dependence.indices.iter().all(|index| *index == field);
        let tree = Tree::Sum {
            field,
            body: body.into(),
        };
        if dependence.is_constant() && closed && !dependence.has_position {
            return Ok(Tree::Constant(self.evaluate(&tree)));
        }
        Ok(tree)
    }

    fn evaluate_per_mode(&self, field: usize, tree: Tree) -> Tree {
        let modes = self.system.modes(field).len();
        let values = (0..modes).map(|mode| self.evaluate_at_mode(&tree, field, mode));
        Tree::PerMode {
            field,
            values: values.collect(),
        }
    }

    fn evaluate(&self, tree: &Tree) -> f64 {
        let scene = Scene::new(&self.system, 0.0, &[], None, &[]);
        Pass::new(&scene, Direction::Zero, Direction::Zero)
            .value(tree)
            .re
            .value
    }

    fn evaluate_at_mode(&self, tree: &Tree, field: usize, mode: usize) -> f64 {
        let scene = Scene::new(&self.system, 0.0, &[], None, &[]);
        Pass::new(&scene, Direction::Zero, Direction::Zero).value_at_mode(tree, field, mode)
    }
}

/// Returns the index of each input's rate among the inputs, if given.
pub(super) fn input_rate_indices(model: &Model) -> Vec<Option<usize>> {
    let rates = model.inputs.iter().map(|input| input.rate);
    rates.map(|rate| rate.map(|rate| rate.index())).collect()
}
