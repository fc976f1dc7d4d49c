//! Translation of the model's expressions to graph nodes. `translate_field_function` translates functions of the
//! position along a field.

use std::collections::HashMap;
use std::rc::Rc;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::ids::{ConstraintId, DefinitionId, FieldId, InputId, StateId};
use eomgen_model_spec::model::{Expr, ExprKind, Model};
use eomgen_model_spec::span::Span;

use crate::mechanics::fields::domain::Domain;
use crate::mechanics::fields::function::FieldFunction;
use crate::mechanics::fields::rule::FieldRule;
use crate::mechanics::fields::term::Atom;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::arguments::Arguments;
use crate::symbolic::differentiate::{Direction, KnownDerivatives};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Space};
use crate::symbolic::tables::TableKind;

/// Error of a derivation: location, cause and help.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeriveError {
    /// Location of the cause in the specification.
    pub span: Span,
    /// Description of the cause.
    pub message: String,
    /// Suggested correction, if there is one.
    pub help: Option<String>,
}

impl std::fmt::Display for DeriveError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for DeriveError {}

impl DeriveError {
    /// Returns the error as a diagnostic on the model's source.
    pub fn diagnostic(self) -> Diagnostic {
        Diagnostic::error(self.message)
            .with_span(self.span, "")
            .with_optional_help(self.help)
    }
}

/// Result of a derivation step.
pub type Derived<T> = Result<T, DeriveError>;

/// Translator of the expressions of one model into one graph.
pub struct Translator<'m> {
    /// Model.
    pub model: &'m Model,
    /// Graph that the translation extends.
    pub graph: Graph,
    definitions: HashMap<DefinitionId, NodeId>,
    state_rates: HashMap<StateId, NodeId>,
    coefficients: Vec<NodeId>,
    residuals: HashMap<ConstraintId, NodeId>,
    rules: Vec<Rc<FieldRule>>,
    multipliers: Vec<NodeId>,
    /// Arguments of dot() translated so far, with their locations.
    positions: Vec<(Span, NodeId)>,
    /// Known rates of nodes along the motion, with constant first-order states.
    rates: KnownDerivatives,
}

impl<'m> Translator<'m> {
    /// Starts a translation; `orders` are the truncation orders of the fields.
    pub fn new(model: &'m Model, orders: &[usize]) -> Self {
        let fields = FieldId::first(model.fields.len()).zip(orders);
        let rules: Vec<Rc<FieldRule>> = fields
            .map(|(field, order)| Rc::new(FieldRule::new(model, field, *order)))
            .collect();
        let nodes: Vec<usize> = rules.iter().map(|rule| rule.node_count()).collect();
        let mut graph = Graph::new(orders, &nodes);
        let rates = model.inputs.iter().map(|input| input.rate);
        graph.set_input_rates(rates.collect());
        graph.reserve_names(model.parameters.iter().map(|p| &p.name));
        graph.reserve_names(model.coordinates.iter().map(|c| &c.name));
        graph.reserve_names(model.inputs.iter().map(|i| &i.name));
        graph.reserve_names(model.states.iter().map(|s| &s.name));
        graph.reserve_names(model.definitions.iter().map(|d| &d.name));
        graph.reserve_names(model.observables.iter().map(|o| &o.name));
        graph.reserve_names(model.coefficients.iter().map(|c| &c.name));
        Self {
            model,
            graph,
            definitions: HashMap::new(),
            state_rates: HashMap::new(),
            coefficients: Vec::new(),
            residuals: HashMap::new(),
            rules,
            multipliers: Vec::new(),
            positions: Vec::new(),
            rates: KnownDerivatives::default(),
        }
    }

    /// Returns the arguments of dot() that were translated so far, with their locations.
    pub(crate) fn positions(&self) -> &[(Span, NodeId)] {
        &self.positions
    }

    /// Stores the nodes of the multipliers, which observables can contain.
    pub fn set_multipliers(&mut self, nodes: &[NodeId]) {
        self.multipliers = nodes.to_vec();
    }

    /// Returns the node of a constraint's expression.
    pub fn residual(&mut self, index: ConstraintId) -> Derived<NodeId> {
        if let Some(&known) = self.residuals.get(&index) {
            return Ok(known);
        }
        let model = self.model;
        let node = self.node(&model.constraints[index].zero)?;
        self.residuals.insert(index, node);
        Ok(node)
    }

    /// Stores the node of the next named coefficient, which later coefficients can contain.
    pub fn push_coefficient(&mut self, node: NodeId) {
        self.coefficients.push(node);
    }

    /// Returns the node of each definition used so far.
    pub fn definition_nodes(&self) -> Vec<Option<NodeId>> {
        DefinitionId::first(self.model.definitions.len())
            .map(|index| self.definitions.get(&index).copied())
            .collect()
    }

    /// Translates a scalar expression, or a vector inside a sum over modes.
    pub fn node(&mut self, expr: &Expr) -> Derived<NodeId> {
        match &expr.kind {
            ExprKind::Number(value) => Ok(self.graph.constant(*value)),
            ExprKind::Pi => Ok(self.graph.constant(std::f64::consts::PI)),
            ExprKind::Time => Ok(self.graph.intern(Operation::Time)),
            ExprKind::Parameter(index) => Ok(self.graph.intern(Operation::Parameter(*index))),
            ExprKind::Coordinate(index) => Ok(self.graph.intern(Operation::Coordinate(*index))),
            ExprKind::Input(index) => Ok(self.graph.intern(Operation::Input(*index))),
            ExprKind::State(index) => Ok(self.graph.intern(Operation::State(*index))),
            ExprKind::Definition(index) => self.definition(*index),
            ExprKind::Coefficient(index) => match self.coefficients.get(index.index()) {
                Some(&node) => Ok(node),
                None => Err(error(
                    expr,
                    "this coefficient is used before its definition",
                )),
            },
            ExprKind::ModeCoordinate(field) => {
                Ok(self.graph.intern(Operation::ModeCoordinates(*field)))
            }
            ExprKind::SingleMode { field, mode } => self.single_mode(expr, *field, *mode),
            ExprKind::Residual(index) => self.residual(*index),
            ExprKind::Multiplier(index) => match self.multipliers.get(index.index()) {
                Some(&node) => Ok(node),
                None => Err(error(expr, "this multiplier cannot be used here")),
            },
            ExprKind::Dot(operand) => self.dot(operand),
            ExprKind::Negate(operand) => {
                let inner = self.node(operand)?;
                Ok(self.graph.negate(inner))
            }
            ExprKind::Binary(operator, left, right) => {
                let (left, right) = (self.node(left)?, self.node(right)?);
                Ok(self.binary(*operator, left, right))
            }
            ExprKind::Call(function, arguments) => {
                let arguments = Arguments::from_operands(self.nodes(arguments)?)
                    .ok_or_else(|| error(expr, "a function takes one or two arguments"))?;
                Ok(self.graph.call(*function, arguments))
            }
            ExprKind::Integral { field, integrand } => self.integral(*field, integrand),
            ExprKind::At {
                field,
                value,
                position,
            } => self.translate_field_value(*field, value, position),
            ExprKind::Sum { field, summand } => {
                let inner = self.node(summand)?;
                Ok(self.graph.sum_over_space(Space::Modes(*field), inner))
            }
            ExprKind::Position(_)
            | ExprKind::Field(_)
            | ExprKind::ModeShape(_)
            | ExprKind::Diff(..) => Err(error(
                expr,
                "a function of the position must be inside integral(...) or at(...)",
            )),
        }
    }

    /// Returns the coordinate of one mode as a sum over all modes with factors 1 and 0.
    fn single_mode(&mut self, expr: &Expr, field: FieldId, mode: usize) -> Derived<NodeId> {
        let order = self.graph.orders()[field];
        if mode > order {
            let names = &self.model.fields[field];
            return Err(DeriveError {
                span: expr.span,
                message: format!(
                    "there is no mode {mode} of `{}` at order {order}",
                    names.name
                ),
                help: Some(format!(
                    "derive orders from {mode} on, or write a sum over the modes"
                )),
            });
        }
        let indicator = self
            .domain(field)?
            .table(&mut self.graph, TableKind::Indicator(mode));
        let modes = self.graph.intern(Operation::ModeCoordinates(field));
        let selected = self.graph.multiply(indicator, modes);
        Ok(self.graph.sum_over_space(Space::Modes(field), selected))
    }

    fn nodes(&mut self, expressions: &[Expr]) -> Derived<Vec<NodeId>> {
        expressions.iter().map(|e| self.node(e)).collect()
    }

    /// Returns the node of a binary operation.
    pub fn binary(&mut self, operator: BinaryOperator, left: NodeId, right: NodeId) -> NodeId {
        match operator {
            BinaryOperator::Add => self.graph.add(left, right),
            BinaryOperator::Subtract => self.graph.subtract(left, right),
            BinaryOperator::Multiply => self.graph.multiply(left, right),
            BinaryOperator::Divide => self.graph.divide(left, right),
            BinaryOperator::Power => self.graph.power(left, right),
        }
    }

    fn definition(&mut self, index: DefinitionId) -> Derived<NodeId> {
        if let Some(&known) = self.definitions.get(&index) {
            return Ok(known);
        }
        let definition = &self.model.definitions[index];
        let node = self.node(&definition.value)?;
        self.graph.set_name(node, &definition.name);
        self.definitions.insert(index, node);
        Ok(node)
    }

    /// Returns the time derivative of a coordinate, definition or modal coordinate.
    fn dot(&mut self, operand: &Expr) -> Derived<NodeId> {
        match operand.kind {
            ExprKind::Coordinate(index) => Ok(self.graph.intern(Operation::Rate(index))),
            ExprKind::ModeCoordinate(field) => Ok(self.graph.intern(Operation::ModeRates(field))),
            ExprKind::State(index) => self.state_rate(index),
            _ => {
                let node = self.node(operand)?;
                if self.graph.dependence(node).has(Dependence::RATE) {
                    return Err(DeriveError {
                        span: operand.span,
                        message: "dot() of an expression that contains a rate is an acceleration".into(),
                        help: Some("energies, forces and observables can contain rates, but no accelerations".into()),
                    });
                }
                if self.holds_input_without_rate(node) {
                    return Err(error(operand, "the rate of an input is unknown"));
                }
                self.positions.push((operand.span, node));
                let rates = self.collect_state_rates(node)?;
                let rate = self.find_rate_along(node, &rates);
                if let ExprKind::Definition(index) = operand.kind {
                    let name = format!("{}_dot", self.model.definitions[index].name);
                    self.graph.set_name(rate, &name);
                }
                Ok(rate)
            }
        }
    }

    /// Returns the rate of a node. Known rates are reused only if `rates` is empty, because `rates` differs between
    /// nodes.
    fn find_rate_along(&mut self, node: NodeId, rates: &HashMap<StateId, NodeId>) -> NodeId {
        let tangent = |graph: &mut Graph, leaf: NodeId| find_leaf_rate(graph, leaf, rates);
        if !rates.is_empty() {
            return Direction::new(&tangent).derivative(&mut self.graph, node);
        }
        let mut direction = Direction::resume(&tangent, std::mem::take(&mut self.rates));
        let rate = direction.derivative(&mut self.graph, node);
        self.rates = direction.into_known();
        rate
    }

    /// Returns the time derivative of a node along the motion with these accelerations.
    pub(crate) fn derive_rate_along_motion(
        &mut self,
        node: NodeId,
        accelerations: &RowNodes,
    ) -> Derived<NodeId> {
        let rates = self.collect_state_rates(node)?;
        let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
            Operation::Rate(index) => accelerations.scalars[index],
            Operation::ModeRates(field) => accelerations.modal[field],
            _ => find_leaf_rate(graph, leaf, &rates),
        };
        Ok(Direction::new(&tangent).derivative(&mut self.graph, node))
    }

    /// Returns true if a node contains an input without a given rate.
    pub(crate) fn holds_input_without_rate(&self, node: NodeId) -> bool {
        self.graph.dependence(node).has(Dependence::INPUT)
            && self.graph.reachable(&[node]).into_iter().any(|leaf| {
                matches!(*self.graph.operation(leaf), Operation::Input(input)
                    if self.graph.input_rate(input).is_none())
            })
    }

    /// Returns the rate of a state from the specification.
    pub fn state_rate(&mut self, index: StateId) -> Derived<NodeId> {
        if let Some(&known) = self.state_rates.get(&index) {
            return Ok(known);
        }
        let model = self.model;
        let state = &model.states[index];
        let node = self.node(&state.rate)?;
        self.graph
            .suggest_name(node, &format!("{}_dot", state.name));
        self.state_rates.insert(index, node);
        Ok(node)
    }

    fn collect_state_rates(&mut self, node: NodeId) -> Derived<HashMap<StateId, NodeId>> {
        if !self.graph.dependence(node).has(Dependence::STATE) {
            return Ok(HashMap::new());
        }
        let mut rates = HashMap::new();
        for leaf in self.graph.reachable(&[node]) {
            if let Operation::State(index) = *self.graph.operation(leaf) {
                rates.insert(index, self.state_rate(index)?);
            }
        }
        Ok(rates)
    }

    fn translate_field_value(
        &mut self,
        field: FieldId,
        value: &Expr,
        position: &Expr,
    ) -> Derived<NodeId> {
        let function = self.translate_field_function(field, value)?;
        let position = self.node(position)?;
        let domain = self.domain(field)?;
        function
            .evaluate_at(&mut self.graph, &domain, position)
            .map_err(|m| error(value, m))
    }

    fn integral(&mut self, field: FieldId, integrand: &Expr) -> Derived<NodeId> {
        let function = self.translate_field_function(field, integrand)?;
        let domain = self.domain(field)?;
        function
            .integral(&mut self.graph, &domain)
            .map_err(|m| error(integrand, m))
    }

    fn domain(&mut self, field: FieldId) -> Derived<Domain> {
        let spec = &self.model.fields[field];
        let from = self.node(&spec.from)?;
        let to = self.node(&spec.to)?;
        let length = self.graph.subtract(to, from);
        Ok(Domain {
            field,
            basis: spec.basis.clone(),
            from,
            to,
            length,
            rule: Rc::clone(&self.rules[field.index()]),
        })
    }

    fn translate_field_function(&mut self, field: FieldId, expr: &Expr) -> Derived<FieldFunction> {
        match &expr.kind {
            ExprKind::Position(_) => {
                let domain = self.domain(field)?;
                Ok(FieldFunction::position(&mut self.graph, &domain))
            }
            ExprKind::Field(_) | ExprKind::ModeShape(_) | ExprKind::Dot(_) | ExprKind::Diff(..) => {
                match read_field_atom(expr) {
                    Some(atom) => {
                        let domain = self.domain(field)?;
                        domain.check_derivative(atom).map_err(|m| error(expr, m))?;
                        Ok(FieldFunction::atom(&mut self.graph, &domain, atom))
                    }
                    None => Ok(FieldFunction::constant(self.node(expr)?)),
                }
            }
            ExprKind::Negate(operand) => {
                let inner = self.translate_field_function(field, operand)?;
                Ok(inner.scale(&mut self.graph, -1.0))
            }
            ExprKind::Binary(operator, left, right) => {
                let left_function = self.translate_field_function(field, left)?;
                let right_function = self.translate_field_function(field, right)?;
                let domain = self.domain(field)?;
                left_function
                    .binary(&mut self.graph, &domain, *operator, &right_function)
                    .map_err(|m| error(expr, m))
            }
            ExprKind::Call(function, arguments) => {
                let arguments = arguments
                    .iter()
                    .map(|a| self.translate_field_function(field, a))
                    .collect::<Derived<Vec<_>>>()?;
                let domain = self.domain(field)?;
                FieldFunction::call(&mut self.graph, &domain, *function, &arguments)
                    .map_err(|m| error(expr, m))
            }
            _ => Ok(FieldFunction::constant(self.node(expr)?)),
        }
    }
}

/// Returns the atom of `w`, `dot(w)`, `phi[i]` or a derivative of these by the position.
fn read_field_atom(expr: &Expr) -> Option<Atom> {
    match &expr.kind {
        ExprKind::Field(_) => Some(Atom::Coordinates(0)),
        ExprKind::ModeShape(_) => Some(Atom::Shapes(0)),
        ExprKind::Dot(inner) => match read_field_atom(inner)? {
            Atom::Coordinates(derivative) => Some(Atom::Rates(derivative)),
            _ => None,
        },
        ExprKind::Diff(inner, times) => Some(read_field_atom(inner)?.derivative_of_order(*times)),
        _ => None,
    }
}

/// Returns the time derivative of a node along the motion, without accelerations. Coordinates and inputs with given
/// rates change at these rates, time changes at rate 1, and other inputs are constant.
pub fn along_motion(graph: &mut Graph, node: NodeId) -> NodeId {
    let still = HashMap::new();
    let tangent = |graph: &mut Graph, leaf: NodeId| find_leaf_rate(graph, leaf, &still);
    Direction::new(&tangent).derivative(graph, node)
}

/// Returns the rate of a leaf; `rates` has the rates of first-order states, and missing rates are 0.
fn find_leaf_rate(graph: &mut Graph, leaf: NodeId, rates: &HashMap<StateId, NodeId>) -> NodeId {
    match *graph.operation(leaf) {
        Operation::Coordinate(index) => graph.intern(Operation::Rate(index)),
        Operation::ModeCoordinates(field) => graph.intern(Operation::ModeRates(field)),
        Operation::Time => graph.one(),
        Operation::Input(index) => find_input_rate(graph, index),
        Operation::State(index) => rates.get(&index).copied().unwrap_or_else(|| graph.zero()),
        _ => graph.zero(),
    }
}

/// Returns the time derivative of a node at constant state, due to explicit time and inputs with given rates.
pub fn explicit_rate(graph: &mut Graph, node: NodeId) -> NodeId {
    let moves = Dependence::TIME.join(Dependence::INPUT);
    if !graph.dependence(node).has(moves) {
        return graph.zero();
    }
    let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
        Operation::Time => graph.one(),
        Operation::Input(index) => find_input_rate(graph, index),
        _ => graph.zero(),
    };
    Direction::new(&tangent).derivative(graph, node)
}

fn find_input_rate(graph: &mut Graph, input: InputId) -> NodeId {
    match graph.input_rate(input) {
        Some(rate) => graph.intern(Operation::Input(rate)),
        None => graph.zero(),
    }
}

fn error(expr: &Expr, message: impl Into<String>) -> DeriveError {
    DeriveError {
        span: expr.span,
        message: message.into(),
        help: None,
    }
}
