//! Conversion of graph nodes to formulas.

use std::collections::{HashMap, HashSet};

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Model, ParameterValue};

use super::shared::{SharedExpressions, estimate_length, is_leaf};
use super::symbol::{Index, Symbol};
use super::tree::{Choice, Formula, MatrixPart, Term};
use crate::symbolic::graph::{Argument, Assembly, Bits, Graph, NodeId, Operation, Shape, Variable};

/// Largest length of an abridged formula in characters.
const MAX_ABRIDGED_LENGTH: u64 = 2000;

/// Smallest length of an omitted part in characters.
const MIN_OMITTED_LENGTH: u64 = 40;

/// Converter of graph nodes to formulas.
pub struct Reader<'a> {
    graph: &'a Graph,
    model: &'a Model,
    shared: &'a SharedExpressions,
    omitted: HashSet<NodeId>,
}

/// Returns the complete formula of a node; only named nodes are abbreviated. For large models, the formula can be
/// exponentially longer than the graph.
pub fn write_full_formula(graph: &Graph, model: &Model, id: NodeId) -> Formula {
    Reader::new(graph, model, &SharedExpressions::default()).formula(id)
}

/// Returns the formula of a node for a message or a comment; parts of a very long formula are omitted.
pub fn write_abridged_formula(graph: &Graph, model: &Model, id: NodeId) -> Formula {
    let shared = SharedExpressions::default();
    let mut reader = Reader::new(graph, model, &shared);
    let mut lengths = HashMap::new();
    for node in graph.reachable(&[id]) {
        if node == id || (graph.name(node).is_none() && !is_leaf(graph, node)) {
            let length = estimate_length(graph, node, &lengths);
            lengths.insert(node, length);
        }
    }
    reader.omit(id, MAX_ABRIDGED_LENGTH, &lengths);
    reader.formula(id)
}

impl<'a> Reader<'a> {
    /// Prepares a reader in which the nodes of `shared` are represented by their names.
    pub fn new(graph: &'a Graph, model: &'a Model, shared: &'a SharedExpressions) -> Self {
        Self {
            graph,
            model,
            shared,
            omitted: HashSet::new(),
        }
    }

    /// Returns the formula of a node, even if the node has a name in the specification. A shared node with a separate
    /// line is represented by its name.
    pub fn formula(&self, id: NodeId) -> Formula {
        match self.shared.name(id) {
            Some(name) => Formula::Symbol(self.indexed(Symbol::plain(name), id)),
            None => self.operation(id),
        }
    }

    /// Returns the name of a node, or its formula if it has none.
    pub fn expression(&self, id: NodeId) -> Formula {
        match self.graph.name(id) {
            Some(name) => Formula::Symbol(self.indexed(self.symbol(name), id)),
            None => self.formula(id),
        }
    }

    /// Returns name and formula of each shared node.
    pub fn lines(&self) -> impl Iterator<Item = (Formula, Formula)> {
        self.shared
            .nodes()
            .iter()
            .map(|id| (self.formula(*id), self.operation(*id)))
    }

    /// Returns the symbol for a name of the graph. The suffixes `_dot` and `_ddot` of rates become dots.
    pub fn symbol(&self, name: &str) -> Symbol {
        if let Some(entry) = self.read_factorisation_symbol(name) {
            return entry;
        }
        for (ending, dots) in [("_dot", 1), ("_ddot", 2)] {
            if let Some(stem) = name.strip_suffix(ending)
                && self.is_moving(stem)
            {
                return Symbol::plain(stem).with_dots(dots);
            }
        }
        Symbol::plain(name)
    }

    /// Returns the symbol for the name of an entry of the mass matrix or of a pivot; its subscripts are the
    /// symbols of the rows.
    fn read_factorisation_symbol(&self, name: &str) -> Option<Symbol> {
        let (head, rows) = name.split_once('_')?;
        match head {
            "pivot" => Some(Symbol::part_of(head, vec![self.row(rows, Index::I)?])),
            "M" => rows.match_indices('_').find_map(|(place, _)| {
                let row = self.row(&rows[..place], Index::I)?;
                let is_modal = !row.indices.is_empty();
                let index = if is_modal { Index::J } else { Index::I };
                let column = self.row(&rows[place + 1..], index)?;
                Some(Symbol::part_of(head, vec![row, column]))
            }),
            _ => None,
        }
    }

    /// Returns the symbol of an equation row; `index` is the mode index if the row belongs to a field.
    fn row(&self, name: &str, index: Index) -> Option<Symbol> {
        let model = self.model;
        if model.coordinates.iter().any(|known| known.name == name) {
            return Some(Symbol::plain(name));
        }
        let is_field = model.fields.iter().any(|known| known.coordinates == name);
        is_field.then(|| Symbol::plain(name).with_indices(&[index]))
    }

    fn is_moving(&self, name: &str) -> bool {
        let model = self.model;
        model.coordinates.iter().any(|known| known.name == name)
            || model.fields.iter().any(|known| known.coordinates == name)
            || model.definitions.iter().any(|known| known.name == name)
    }

    /// Marks operands as omitted until the formula of a node has at most `longest` characters.
    fn omit(&mut self, id: NodeId, longest: u64, lengths: &HashMap<NodeId, u64>) {
        if lengths.get(&id).is_none_or(|length| *length <= longest) {
            return;
        }
        let operands = self.graph.operands(self.graph.operation(id));
        let share = longest / (operands.len() as u64).max(1);
        for operand in operands {
            let too_long = lengths.get(&operand).is_some_and(|length| *length > share);
            if too_long && share < MIN_OMITTED_LENGTH {
                self.omitted.insert(operand);
            } else if too_long {
                self.omit(operand, share, lengths);
            }
        }
    }

    fn indexed(&self, symbol: Symbol, id: NodeId) -> Symbol {
        if !symbol.owners.is_empty() {
            return symbol;
        }
        match self.graph.shape(id) {
            Shape::Scalar => symbol,
            Shape::Vector(_) => symbol.with_indices(&[Index::I]),
            Shape::Matrix(..) => symbol.with_indices(&[Index::I, Index::J]),
        }
    }

    fn node(&self, id: NodeId) -> Formula {
        if self.omitted.contains(&id) {
            return Formula::Omitted;
        }
        self.expression(id)
    }

    fn nodes(&self, ids: &[NodeId]) -> Vec<Formula> {
        ids.iter().map(|id| self.node(*id)).collect()
    }

    fn boxed_formula(&self, id: NodeId) -> Box<Formula> {
        Box::new(self.node(id))
    }

    fn operation(&self, id: NodeId) -> Formula {
        match self.graph.operation(id) {
            Operation::Constant(bits) => Formula::Number(bits.value()),
            Operation::Parameter(index) => match self.unit_factor(id) {
                Some(factor) => Formula::Number(factor),
                None => Formula::from_name(&self.model.parameters[*index].name),
            },
            Operation::Coordinate(index) => {
                Formula::Symbol(self.variable(Variable::Coordinate(*index)))
            }
            Operation::Rate(index) => Formula::Symbol(self.variable(Variable::Rate(*index))),
            Operation::State(index) => Formula::Symbol(self.variable(Variable::State(*index))),
            Operation::Input(index) => Formula::Symbol(self.variable(Variable::Input(*index))),
            Operation::ModeCoordinates(field) => {
                Formula::Symbol(self.variable(Variable::ModeCoordinates(*field)))
            }
            Operation::ModeRates(field) => {
                Formula::Symbol(self.variable(Variable::ModeRates(*field)))
            }
            Operation::Time => Formula::from_name("t"),
            Operation::Argument(argument, variable) => {
                let operand = Formula::Symbol(self.variable(*variable));
                Formula::Operation(argument_name(*argument), vec![operand])
            }
            Operation::Table(index) => Formula::Table(self.graph.table(*index).kind),
            Operation::Sum(terms) => self.sum(terms),
            Operation::Product(factors) => self.product(factors),
            Operation::Call(function, arguments) => Formula::Call(*function, self.nodes(arguments)),
            Operation::Power(base, exponent) => {
                Formula::Power(self.boxed_formula(*base), self.boxed_formula(*exponent))
            }
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } => Formula::Choice(Box::new(Choice {
                a: self.node(*a),
                b: self.node(*b),
                then: self.node(*then),
                otherwise: self.node(*otherwise),
            })),
            Operation::Total(a) => Formula::Total(Index::I, self.boxed_formula(*a)),
            other => self.matrix_operation(other),
        }
    }

    /// Returns the SI value of a parameter that only carries the unit of a number in the specification; such numbers
    /// are printed in SI units.
    fn unit_factor(&self, id: NodeId) -> Option<f64> {
        let Operation::Parameter(index) = self.graph.operation(id) else {
            return None;
        };
        match &self.model.parameters[*index] {
            parameter if !parameter.is_unit_factor() => None,
            parameter => match parameter.value {
                ParameterValue::Number(value) => Some(value),
                ParameterValue::Expression(_) => None,
            },
        }
    }

    fn variable(&self, variable: Variable) -> Symbol {
        let model = self.model;
        let modes = |field: FieldId| {
            Symbol::plain(&model.fields[field].coordinates).with_indices(&[Index::I])
        };
        match variable {
            Variable::Coordinate(index) => Symbol::plain(&model.coordinates[index].name),
            Variable::Rate(index) => Symbol::plain(&model.coordinates[index].name).with_dots(1),
            Variable::State(index) => Symbol::plain(&model.states[index].name),
            Variable::Input(index) => Symbol::plain(&model.inputs[index].name),
            Variable::Parameter(index) => Symbol::plain(&model.parameters[index].name),
            Variable::Time => Symbol::plain("t"),
            Variable::ModeCoordinates(field) => modes(field),
            Variable::ModeRates(field) => modes(field).with_dots(1),
        }
    }

    fn sum(&self, terms: &[(Bits, NodeId)]) -> Formula {
        let term = |(factor, id): &(Bits, NodeId)| match self
            .graph
            .as_constant(*id)
            .or_else(|| self.unit_factor(*id))
        {
            Some(constant) => Term {
                factor: factor.value() * constant,
                of: None,
            },
            None => Term {
                factor: factor.value(),
                of: Some(self.node(*id)),
            },
        };
        Formula::Sum(terms.iter().map(term).collect())
    }

    fn product(&self, factors: &[(NodeId, i32)]) -> Formula {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let is_shown = |(id, _): &&(NodeId, i32)| self.unit_factor(*id) != Some(1.0);
        let mut shown: Vec<_> = factors.iter().filter(is_shown).copied().collect();
        // Coefficients are printed before varying factors.
        shown.sort_by_key(|(id, _)| !self.is_coefficient(*id));
        let is_reduced = shown.len() < factors.len();
        for (id, exponent) in shown {
            let (id, exponent) = match self.graph.operation(id) {
                Operation::PivotReciprocal(pivot) => (*pivot, -exponent),
                _ => (id, exponent),
            };
            let side = if exponent > 0 { &mut above } else { &mut below };
            side.push(match exponent.unsigned_abs() {
                1 => self.node(id),
                power => {
                    let power = Formula::Number(f64::from(power));
                    Formula::Power(self.boxed_formula(id), Box::new(power))
                }
            });
        }
        match is_reduced && above.len() == 1 && below.is_empty() {
            true => above.swap_remove(0),
            false => Formula::Quotient { above, below },
        }
    }

    fn is_coefficient(&self, id: NodeId) -> bool {
        self.graph.as_constant(id).is_some()
            || matches!(self.graph.operation(id), Operation::Parameter(_))
    }

    fn matrix_operation(&self, operation: &Operation) -> Formula {
        let operands = || self.nodes(&self.graph.operands(operation));
        match operation {
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => Formula::Applied(
                Box::new(self.transpose(*matrix, *transposed)),
                self.boxed_formula(*vector),
            ),
            Operation::Gram { .. } => Formula::Operation("gram", operands()),
            Operation::GramDiagonal { .. } => Formula::Operation("gram_ii", operands()),
            Operation::Assemble(assembly) => self.assembly(assembly),
            Operation::Cholesky(_) => Formula::Operation("cholesky", operands()),
            Operation::CholeskySolve(..) => Formula::Operation("solve", operands()),
            Operation::PivotReciprocal(pivot) => Formula::Quotient {
                above: Vec::new(),
                below: vec![self.node(*pivot)],
            },
            _ => Formula::Omitted,
        }
    }

    fn transpose(&self, matrix: NodeId, transposed: bool) -> Formula {
        if transposed {
            Formula::Transposed(self.boxed_formula(matrix))
        } else {
            self.node(matrix)
        }
    }

    fn assembly(&self, assembly: &Assembly) -> Formula {
        let diagonal = assembly.diagonal.into_iter();
        let mut parts: Vec<MatrixPart> = diagonal
            .map(|diagonal| MatrixPart::Diagonal(self.node(diagonal)))
            .collect();
        let outer = assembly.outer.iter();
        parts.extend(outer.map(|(u, v)| MatrixPart::Outer(self.node(*u), self.node(*v))));
        parts.extend(assembly.matrices.iter().map(|part| {
            MatrixPart::Scaled(
                self.node(part.row),
                self.transpose(part.matrix, part.transposed),
                self.node(part.column),
            )
        }));
        Formula::Matrix(parts)
    }
}

fn argument_name(argument: Argument) -> &'static str {
    match argument {
        Argument::Accelerations => "acceleration",
        Argument::Direction | Argument::PointDirection => "direction",
        Argument::Weights => "weight",
        Argument::Sides => "side",
    }
}
