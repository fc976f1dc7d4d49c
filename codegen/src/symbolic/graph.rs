//! Hash-consed expression graph: every distinct expression is stored once. Differentiation and emission therefore
//! process shared parts once.
//!
//! A node is a scalar, a vector over an index space (a field's modes, or its quadrature nodes) or a matrix over two
//! of them; element-wise operations broadcast scalars. A sum over modes is a single node; therefore the size of the
//! graph does not depend on the truncation order. `operation` defines the operations, `simplify` their
//! simplification, `differentiate` their derivatives.

use std::collections::{HashMap, HashSet};

use eomgen_model_spec::ids::{FieldId, InputId};

use crate::symbolic::node_map::NodeMap;
pub use crate::symbolic::operation::{
    Argument, Assembly, Bits, Dependence, NodeId, Operation, ScaledMatrix, Shape, Space, Variable,
};
use crate::symbolic::orders::Orders;
use crate::symbolic::switches::{FlatGuard, is_switch};
use crate::symbolic::tables::{Table, TableKind};

#[derive(Clone)]
struct Node {
    operation: Operation,
    shape: Shape,
    dependence: Dependence,
    /// Variables that the node depends on, as a 64-bit set; several variables can share a bit.
    variables: u64,
    critical_path: u32,
    has_reciprocal_root: bool,
    holds_switch: bool,
}

/// Graph of one variant: nodes, constant tables and sizes of the index spaces.
#[derive(Clone)]
pub struct Graph {
    nodes: Vec<Node>,
    known: NodeMap<Operation, NodeId>,
    /// Nodes of the constants 0 and 1, if they exist.
    pub(super) zero_and_one: [Option<NodeId>; 2],
    tables: Vec<Table>,
    orders: Vec<usize>,
    /// For each input, the input that is its rate, if there is one.
    input_rates: Vec<Option<InputId>>,
    node_counts: Vec<usize>,
    names: HashMap<NodeId, String>,
    taken: HashSet<String>,
    pub(crate) orders_at_zeros: Orders,
    /// Nodes that set a factor of a derivative to 0 on the flat side of a switch; see [`FlatGuard`].
    pub(super) flat_guards: HashMap<NodeId, FlatGuard>,
}

impl Graph {
    /// Creates an empty graph for fields with these truncation orders and numbers of quadrature nodes.
    pub fn new(orders: &[usize], node_counts: &[usize]) -> Self {
        Self {
            nodes: Vec::new(),
            known: NodeMap::default(),
            zero_and_one: [None; 2],
            tables: Vec::new(),
            orders: orders.to_vec(),
            input_rates: Vec::new(),
            node_counts: node_counts.to_vec(),
            names: HashMap::new(),
            taken: HashSet::new(),
            orders_at_zeros: Orders::default(),
            flat_guards: HashMap::new(),
        }
    }

    /// Reserves names for the quantities of the specification.
    pub fn reserve_names<'n>(&mut self, names: impl Iterator<Item = &'n String>) {
        self.taken.extend(names.cloned());
    }

    /// Returns the names in use, of nodes and of quantities.
    pub fn taken_names(&self) -> impl Iterator<Item = &str> {
        self.taken.iter().map(String::as_str)
    }

    /// Sets, for each input, the input that is its rate, if there is one.
    pub(crate) fn set_input_rates(&mut self, rates: Vec<Option<InputId>>) {
        self.input_rates = rates;
    }

    pub(crate) fn input_rate(&self, input: InputId) -> Option<InputId> {
        self.input_rates.get(input.index()).copied().flatten()
    }

    /// Returns the truncation order of each field.
    pub fn orders(&self) -> &[usize] {
        &self.orders
    }

    /// Returns the size of an index space.
    pub fn size(&self, space: Space) -> usize {
        match space {
            Space::Modes(field) => self.orders[field],
            Space::Nodes(field) => self.node_counts[field],
        }
    }

    /// Returns the number of elements of a node of this shape.
    pub fn length(&self, shape: Shape) -> usize {
        match shape {
            Shape::Scalar => 1,
            Shape::Vector(space) => self.size(space),
            Shape::Matrix(rows, columns) => self.size(rows) * self.size(columns),
        }
    }

    /// Returns the operation of a node.
    pub fn operation(&self, id: NodeId) -> &Operation {
        &self.nodes[id.0 as usize].operation
    }

    /// Returns the shape of a node.
    pub fn shape(&self, id: NodeId) -> Shape {
        self.nodes[id.0 as usize].shape
    }

    /// Returns the dependence of a node.
    pub fn dependence(&self, id: NodeId) -> Dependence {
        self.nodes[id.0 as usize].dependence
    }

    /// Returns the length of the critical path to a node: the largest number of nested elementary functions of the
    /// state. Each has the latency of some dozen additions.
    pub fn critical_path(&self, id: NodeId) -> u32 {
        self.nodes[id.0 as usize].critical_path
    }

    /// Returns true if a node contains the reciprocal of a root that is infinite at the zero of the root.
    pub(crate) fn has_reciprocal_root(&self, id: NodeId) -> bool {
        self.nodes[id.0 as usize].has_reciprocal_root
    }

    /// Returns true if a node contains an operation that switches.
    pub(crate) fn holds_switch(&self, id: NodeId) -> bool {
        self.nodes[id.0 as usize].holds_switch
    }

    /// Returns a table of constants.
    pub fn table(&self, index: usize) -> &Table {
        &self.tables[index]
    }

    /// Returns the number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns true if there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the name of a node, if it has one.
    pub fn name(&self, id: NodeId) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }

    /// Names a node after a quantity of the specification. Leaves and named nodes keep their names.
    pub fn set_name(&mut self, id: NodeId, name: &str) {
        let compound = !self.operands(self.operation(id)).is_empty();
        if compound && !self.names.contains_key(&id) {
            self.taken.insert(name.to_owned());
            self.names.insert(id, name.to_owned());
        }
    }

    /// Names a node, unless the name is in use.
    pub fn suggest_name(&mut self, id: NodeId, name: &str) {
        if !self.taken.contains(name) {
            self.set_name(id, name);
        }
    }

    /// Returns the node of an operation without simplification.
    pub(crate) fn intern(&mut self, operation: Operation) -> NodeId {
        if let Some(&id) = self.known.get(&operation) {
            return id;
        }
        let shape = self.compute_shape(&operation);
        let dependence = self.compute_dependence(&operation);
        let critical_path = self.compute_critical_path(&operation, dependence);
        let has_reciprocal_root = self.holds_reciprocal_root(&operation);
        let variables = self.compute_variables(&operation, dependence);
        let operands = self.operands(&operation);
        let holds_switch =
            is_switch(&operation) || operands.iter().any(|id| self.holds_switch(*id));
        let id = NodeId(self.nodes.len() as u32);
        self.known.insert(operation.clone(), id);
        self.nodes.push(Node {
            operation,
            shape,
            dependence,
            variables,
            critical_path,
            has_reciprocal_root,
            holds_switch,
        });
        id
    }

    /// Returns the node of a table of constants.
    pub fn constants(
        &mut self,
        field: FieldId,
        kind: TableKind,
        values: impl FnOnce() -> Vec<f64>,
    ) -> NodeId {
        let index = match self
            .tables
            .iter()
            .position(|t| t.field == field && t.kind == kind)
        {
            Some(index) => index,
            None => {
                self.tables.push(Table {
                    field,
                    kind,
                    values: values(),
                });
                self.tables.len() - 1
            }
        };
        self.intern(Operation::Table(index))
    }

    fn compute_shape(&self, operation: &Operation) -> Shape {
        match operation {
            Operation::Constant(_)
            | Operation::Parameter(_)
            | Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::State(_)
            | Operation::Input(_)
            | Operation::Time
            | Operation::Total(_) => Shape::Scalar,
            Operation::ModeCoordinates(field)
            | Operation::ModeRates(field)
            | Operation::Argument(
                _,
                Variable::ModeCoordinates(field) | Variable::ModeRates(field),
            ) => Shape::Vector(Space::Modes(*field)),
            Operation::Argument(..) => Shape::Scalar,
            Operation::Table(index) => self.tables[*index].shape(),
            Operation::Apply {
                matrix, transposed, ..
            } => match (self.shape(*matrix), transposed) {
                (Shape::Matrix(rows, _), false) => Shape::Vector(rows),
                (Shape::Matrix(_, columns), true) => Shape::Vector(columns),
                (other, _) => other,
            },
            Operation::Gram { left, right, .. } => match (self.shape(*left), self.shape(*right)) {
                (Shape::Matrix(_, a), Shape::Matrix(_, b)) => Shape::Matrix(a, b),
                (other, _) => other,
            },
            Operation::GramDiagonal { left, .. } => match self.shape(*left) {
                Shape::Matrix(_, columns) => Shape::Vector(columns),
                other => other,
            },
            Operation::Assemble(assembly) => Shape::Matrix(assembly.rows, assembly.columns),
            Operation::Cholesky(matrix) => self.shape(*matrix),
            Operation::CholeskySolve(factor, right) => {
                match (self.shape(*factor), self.shape(*right)) {
                    (Shape::Matrix(rows, _), Shape::Matrix(_, columns)) => {
                        Shape::Matrix(rows, columns)
                    }
                    (Shape::Matrix(rows, _), _) => Shape::Vector(rows),
                    (other, _) => other,
                }
            }
            Operation::Sum(_)
            | Operation::Product(_)
            | Operation::Call(..)
            | Operation::Power(..)
            | Operation::PivotReciprocal(_)
            | Operation::Select { .. } => self
                .operands(operation)
                .into_iter()
                .map(|id| self.shape(id))
                .find(|shape| *shape != Shape::Scalar)
                .unwrap_or(Shape::Scalar),
        }
    }

    fn compute_dependence(&self, operation: &Operation) -> Dependence {
        match operation {
            Operation::Parameter(_) => Dependence::PARAMETER,
            Operation::Coordinate(_) | Operation::ModeCoordinates(_) => Dependence::COORDINATE,
            Operation::Rate(_) | Operation::ModeRates(_) => Dependence::RATE,
            Operation::State(_) => Dependence::STATE,
            Operation::Input(_) => Dependence::INPUT,
            Operation::Time => Dependence::TIME,
            Operation::Argument(..) => Dependence::ARGUMENT,
            _ => self
                .operands(operation)
                .into_iter()
                .map(|id| self.dependence(id))
                .fold(Dependence::NONE, Dependence::join),
        }
    }

    /// Returns false only if `id` cannot depend on `of`, because it does not depend on all variables of `of`.
    pub(crate) fn may_depend_on(&self, id: NodeId, of: NodeId) -> bool {
        let [own, needed] = [id, of].map(|id| self.nodes[id.0 as usize].variables);
        own & needed == needed
    }

    fn compute_variables(&self, operation: &Operation, dependence: Dependence) -> u64 {
        let operands = self.operands(operation);
        if operands.is_empty() && dependence != Dependence::NONE {
            return 1 << (self.nodes.len() % 64);
        }
        let of = |id: &NodeId| self.nodes[id.0 as usize].variables;
        operands.iter().fold(0, |bits, id| bits | of(id))
    }

    fn compute_critical_path(&self, operation: &Operation, dependence: Dependence) -> u32 {
        if dependence.is_parameter_only() {
            return 0;
        }
        let own = match operation {
            Operation::Call(function, _) => !function.has_switches(),
            Operation::Power(..) => true,
            _ => false,
        };
        let operands = self.operands(operation);
        let inner = operands.into_iter().map(|id| self.critical_path(id)).max();
        u32::from(own) + inner.unwrap_or(0)
    }

    /// Returns the operands of an operation.
    pub fn operands(&self, operation: &Operation) -> Vec<NodeId> {
        match operation {
            Operation::Constant(_)
            | Operation::Parameter(_)
            | Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::State(_)
            | Operation::Input(_)
            | Operation::Time
            | Operation::ModeCoordinates(_)
            | Operation::ModeRates(_)
            | Operation::Argument(..)
            | Operation::Table(_) => Vec::new(),
            Operation::Sum(terms) => terms.iter().map(|(_, id)| *id).collect(),
            Operation::Product(factors) => factors.iter().map(|(id, _)| *id).collect(),
            Operation::Call(_, arguments) => arguments.to_vec(),
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } => vec![*a, *b, *then, *otherwise],
            Operation::Total(a) | Operation::Cholesky(a) | Operation::PivotReciprocal(a) => {
                vec![*a]
            }
            Operation::Power(a, b) | Operation::CholeskySolve(a, b) => vec![*a, *b],
            Operation::Apply { matrix, vector, .. } => vec![*matrix, *vector],
            Operation::Gram {
                left,
                weight,
                right,
            }
            | Operation::GramDiagonal {
                left,
                weight,
                right,
            } => vec![*left, *weight, *right],
            Operation::Assemble(assembly) => assembly.operands(),
        }
    }

    /// Returns the leaf of a variable.
    pub fn variable(&mut self, variable: Variable) -> NodeId {
        self.intern(match variable {
            Variable::Coordinate(index) => Operation::Coordinate(index),
            Variable::ModeCoordinates(field) => Operation::ModeCoordinates(field),
            Variable::Rate(index) => Operation::Rate(index),
            Variable::ModeRates(field) => Operation::ModeRates(field),
            Variable::State(index) => Operation::State(index),
            Variable::Input(index) => Operation::Input(index),
            Variable::Parameter(index) => Operation::Parameter(index),
            Variable::Time => Operation::Time,
        })
    }

    /// Counts the uses of each node as an operand among the nodes that `roots` depend on.
    pub fn uses(&self, roots: &[NodeId]) -> HashMap<NodeId, usize> {
        let mut uses = HashMap::new();
        for id in self.reachable(roots) {
            for operand in self.operands(self.operation(id)) {
                *uses.entry(operand).or_insert(0) += 1;
            }
        }
        uses
    }

    /// Returns every node that `roots` depend on, operands first. The time is proportional to the number of
    /// these nodes.
    pub fn reachable(&self, roots: &[NodeId]) -> Vec<NodeId> {
        let size = roots.iter().map(|root| root.0 as usize + 1).max();
        let mut seen = vec![false; size.unwrap_or(0)];
        let mut found = Vec::new();
        let mut waiting = roots.to_vec();
        while let Some(id) = waiting.pop() {
            let is_new = !std::mem::replace(&mut seen[id.0 as usize], true);
            if is_new {
                found.push(id);
                waiting.extend(self.operands(self.operation(id)));
            }
        }
        // Operands have smaller indices than their uses.
        found.sort_unstable();
        found
    }
}
