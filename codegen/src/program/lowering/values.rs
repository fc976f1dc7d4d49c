//! Lowering of nodes to values; each node is lowered once.

use eomgen_model_spec::ids::ParameterId;
use std::collections::HashMap;
use std::hash::{Hash, Hasher};

use crate::mechanics::equations::Equations;
use crate::mechanics::rows::RowNodes;
use crate::program::{
    Extent, Friction, Impact, MassBlocks, Op, ProgramTable, RowValues, ScaledValue, Value, ValueId,
};
use crate::symbolic::association::Association;
use crate::symbolic::graph::{Assembly, Graph, NodeId, Operation, Shape, Variable};
use crate::symbolic::node_map::NodeMap;

/// Key of a value: operation and extent; constants are compared by their bits.
struct Computation {
    op: Op,
    extent: Extent,
}

impl PartialEq for Computation {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&self.op, &other.op) {
            (Op::Constant(a), Op::Constant(b)) => a.to_bits() == b.to_bits(),
            (a, b) => a == b,
        };
        same && self.extent == other.extent
    }
}

impl Eq for Computation {}

impl Hash for Computation {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::mem::discriminant(&self.op).hash(state);
        match &self.op {
            Op::Constant(number) => number.to_bits().hash(state),
            Op::Table(place) | Op::Parameter(place) => place.hash(state),
            Op::Coordinate(coordinate) | Op::Rate(coordinate) => coordinate.hash(state),
            Op::ModeCoordinates(field) | Op::ModeRates(field) => field.hash(state),
            Op::State(index) => index.hash(state),
            Op::Input(input) => input.hash(state),
            Op::Argument(argument, variable) => (argument, variable).hash(state),
            op => op.operands().hash(state),
        }
    }
}

pub(super) struct Lowering<'g> {
    pub(super) graph: &'g Graph,
    derived: &'g [Option<NodeId>],
    /// Index of each parameter among the independent parameters.
    independent: Vec<usize>,
    parameter_names: Vec<String>,
    pub(super) values: Vec<Value>,
    known: NodeMap<Computation, ValueId>,
    pub(super) lowered: NodeMap<NodeId, ValueId>,
    pub(super) tables: Vec<ProgramTable>,
    table_places: HashMap<usize, usize>,
    /// Number of uses of each node by the accelerations, while these are lowered; empty afterwards.
    pub(super) uses: HashMap<NodeId, usize>,
    pub(super) association: Association,
}

impl<'g> Lowering<'g> {
    /// Starts the lowering of `graph`. `names` are the names of its parameters; `derived` are the expressions of
    /// derived parameters.
    pub(super) fn new(graph: &'g Graph, derived: &'g [Option<NodeId>], names: &[String]) -> Self {
        let mut next = 0;
        let independent = derived
            .iter()
            .map(|derived| {
                let place = next;
                next += usize::from(derived.is_none());
                place
            })
            .collect();
        Self {
            graph,
            derived,
            independent,
            parameter_names: names.to_vec(),
            values: Vec::new(),
            known: NodeMap::default(),
            lowered: NodeMap::default(),
            tables: Vec::new(),
            table_places: HashMap::new(),
            uses: HashMap::new(),
            association: Association::default(),
        }
    }

    pub(super) fn rows(&mut self, rows: &RowNodes) -> RowValues {
        RowValues {
            scalars: rows.scalars.iter().map(|id| self.value(*id)).collect(),
            modal: rows.modal.iter().map(|id| self.value(*id)).collect(),
        }
    }

    pub(super) fn impact(
        &mut self,
        impact: &Impact<NodeId, RowNodes>,
    ) -> Impact<ValueId, RowValues> {
        Impact {
            distance: self.value(impact.distance),
            rate: self.value(impact.rate),
            workless_rate: self.value(impact.workless_rate),
            acceleration: self.value(impact.acceleration),
            restitution: self.value(impact.restitution),
            row: self.rows(&impact.row),
            column: self.rows(&impact.column),
            delassus: impact.delassus.iter().map(|id| self.value(*id)).collect(),
            friction: impact.friction.as_ref().map(|one| self.friction(one)),
        }
    }

    fn friction(&mut self, friction: &Friction<NodeId, RowNodes>) -> Friction<ValueId, RowValues> {
        let delassus = friction.delassus.iter().map(|id| self.value(*id));
        let delassus = delassus.collect();
        Friction {
            coefficient: self.value(friction.coefficient),
            slip: self.value(friction.slip),
            workless_slip: self.value(friction.workless_slip),
            acceleration: self.value(friction.acceleration),
            column: self.rows(&friction.column),
            delassus,
        }
    }

    pub(super) fn mass(&mut self, equations: &Equations) -> MassBlocks {
        let mass = &equations.mass;
        let block = |rows: &Vec<NodeId>, lowering: &mut Self| {
            rows.iter()
                .map(|id| lowering.value(*id))
                .collect::<Vec<_>>()
        };
        MassBlocks {
            scalars: mass.scalars.iter().map(|row| block(row, self)).collect(),
            coupling: mass.coupling.iter().map(|row| block(row, self)).collect(),
            modal: mass
                .modal
                .iter()
                .map(|row| {
                    row.iter()
                        .map(|matrix| {
                            (!matrix.is_zero()).then(|| self.assembly(&matrix.assembly()))
                        })
                        .collect()
                })
                .collect(),
        }
    }

    fn extent(&self, shape: Shape) -> Extent {
        match shape {
            Shape::Scalar => Extent::Scalar,
            Shape::Vector(space) => Extent::Vector(self.graph.size(space)),
            Shape::Matrix(rows, columns) => {
                Extent::Matrix(self.graph.size(rows), self.graph.size(columns))
            }
        }
    }

    /// Adds a value, or returns an existing equal value.
    pub(super) fn emit(&mut self, op: Op, extent: Extent) -> ValueId {
        let key = Computation { op, extent };
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let op = key.op.clone();
        let parameter_only = match op {
            Op::Constant(_) | Op::Table(_) | Op::Parameter(_) => true,
            Op::Coordinate(_)
            | Op::Rate(_)
            | Op::ModeCoordinates(_)
            | Op::ModeRates(_)
            | Op::State(_)
            | Op::Input(_)
            | Op::Time
            | Op::Argument(..) => false,
            _ => op
                .operands()
                .iter()
                .all(|id| self.values[id.0].parameter_only),
        };
        let id = ValueId(self.values.len());
        self.values.push(Value {
            op,
            extent,
            parameter_only,
            name: None,
        });
        self.known.insert(key, id);
        id
    }

    pub(super) fn join(&self, a: ValueId, b: ValueId) -> Extent {
        match self.values[a.0].extent {
            Extent::Scalar => self.values[b.0].extent,
            other => other,
        }
    }

    pub(super) fn binary(
        &mut self,
        op: fn(ValueId, ValueId) -> Op,
        a: ValueId,
        b: ValueId,
    ) -> ValueId {
        let extent = self.join(a, b);
        self.emit(op(a, b), extent)
    }

    pub(super) fn constant(&mut self, value: f64) -> ValueId {
        self.emit(Op::Constant(value), Extent::Scalar)
    }

    pub(super) fn value(&mut self, id: NodeId) -> ValueId {
        if let Some(&known) = self.lowered.get(&id) {
            return known;
        }
        let value = self.lower_node(id);
        self.lowered.insert(id, value);
        if let Some(name) = self.graph.name(id)
            && self.values[value.0].name.is_none()
        {
            self.values[value.0].name = Some(name.to_owned());
        }
        value
    }

    fn lower_node(&mut self, id: NodeId) -> ValueId {
        let graph = self.graph;
        let op = match graph.operation(id) {
            Operation::Constant(bits) => return self.constant(bits.value()),
            Operation::Parameter(index) => return self.parameter(*index),
            Operation::Table(index) => return self.table(*index),
            Operation::Sum(terms) => return self.sum(terms),
            Operation::Product(_) => return self.term(1.0, id).1,
            Operation::Assemble(assembly) => return self.assembly(assembly),
            Operation::Coordinate(index) => Op::Coordinate(*index),
            Operation::Rate(index) => Op::Rate(*index),
            Operation::State(index) => Op::State(*index),
            Operation::Input(index) => Op::Input(*index),
            Operation::Time => Op::Time,
            Operation::Argument(argument, Variable::Parameter(index)) => {
                let place = ParameterId::new(self.independent[*index]);
                Op::Argument(*argument, Variable::Parameter(place))
            }
            Operation::Argument(argument, variable) => Op::Argument(*argument, *variable),
            Operation::ModeCoordinates(field) => Op::ModeCoordinates(*field),
            Operation::ModeRates(field) => Op::ModeRates(*field),
            Operation::Call(function, arguments) => {
                Op::Call(*function, arguments.map(|a| self.value(a)))
            }
            Operation::Power(base, exponent) => Op::Power(self.value(*base), self.value(*exponent)),
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } => Op::Select {
                a: self.value(*a),
                b: self.value(*b),
                then: self.value(*then),
                otherwise: self.value(*otherwise),
            },
            Operation::Total(a) => Op::Total(self.value(*a)),
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => Op::Apply {
                matrix: self.value(*matrix),
                transposed: *transposed,
                vector: self.value(*vector),
            },
            Operation::Gram {
                left,
                weight,
                right,
            } => Op::Gram {
                left: self.value(*left),
                weight: self.value(*weight),
                right: self.value(*right),
            },
            Operation::GramDiagonal {
                left,
                weight,
                right,
            } => Op::GramDiagonal {
                left: self.value(*left),
                weight: self.value(*weight),
                right: self.value(*right),
            },
            Operation::Cholesky(matrix) => Op::Cholesky(self.value(*matrix)),
            Operation::CholeskySolve(factor, right) => {
                Op::CholeskySolve(self.value(*factor), self.value(*right))
            }
            Operation::PivotReciprocal(pivot) => Op::PivotReciprocal(self.value(*pivot)),
        };
        let extent = self.extent(graph.shape(id));
        self.emit(op, extent)
    }

    fn assembly(&mut self, assembly: &Assembly) -> ValueId {
        let op = Op::Assemble {
            diagonal: assembly.diagonal.map(|id| self.value(id)),
            outer: assembly
                .outer
                .iter()
                .map(|(u, v)| (self.value(*u), self.value(*v)))
                .collect(),
            matrices: assembly
                .matrices
                .iter()
                .map(|m| ScaledValue {
                    row: self.value(m.row),
                    matrix: self.value(m.matrix),
                    transposed: m.transposed,
                    column: self.value(m.column),
                })
                .collect(),
        };
        let extent = self.extent(Shape::Matrix(assembly.rows, assembly.columns));
        self.emit(op, extent)
    }

    fn parameter(&mut self, index: ParameterId) -> ValueId {
        let value = match self.derived[index] {
            Some(expression) => self.value(expression),
            None => {
                let place = self.independent[index];
                self.emit(Op::Parameter(place), Extent::Scalar)
            }
        };
        let name = &mut self.values[value.0].name;
        if name.is_none() {
            *name = Some(self.parameter_names[index].clone());
        }
        value
    }

    fn table(&mut self, index: usize) -> ValueId {
        let table = self.graph.table(index);
        let extent = self.extent(table.shape());
        let place = match self.table_places.get(&index) {
            Some(&place) => place,
            None => {
                self.tables.push(ProgramTable {
                    doc: crate::symbolic::table_text::doc(table),
                    name: crate::symbolic::table_text::write_constant_name(table),
                    extent,
                    values: table.values.clone(),
                });
                self.table_places.insert(index, self.tables.len() - 1);
                self.tables.len() - 1
            }
        };
        self.emit(Op::Table(place), extent)
    }
}
