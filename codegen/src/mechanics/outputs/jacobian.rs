//! Jacobians as blocks of structural nonzeros. A block has one row, or the rows of a field's modes; it has one
//! column, or the columns of a field's modes. All rows are differentiated together; therefore a common sum over all
//! modes is differentiated once.

use super::types::{Jacobian, JacobianBlock};
use crate::mechanics::equations::Equations;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::differentiate::{Direction, Tangent};
use crate::symbolic::graph::{Graph, NodeId, Operation, Space, Variable};
use crate::symbolic::matrix::StructuredMatrix;
use crate::symbolic::modal_derivative::ModalDerivative;
use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, ParameterId, StateId};

/// Rows of a Jacobian: nodes to differentiate, and possibly a diagonal block of ones.
pub(crate) struct JacobianRows {
    count: usize,
    /// First column of the diagonal block of ones in the first rows, if there is one.
    identity: Option<usize>,
    rows: Vec<EquationRow>,
}

/// One row, or one row for each mode of a field.
#[derive(Clone, Copy)]
struct EquationRow {
    first: usize,
    count: usize,
    node: NodeId,
    /// Field whose modes the rows belong to.
    field: Option<FieldId>,
}

impl JacobianRows {
    /// Returns one row for each of these scalars.
    pub(crate) fn from_scalars(nodes: &[NodeId]) -> Self {
        let rows = nodes.iter().enumerate().map(|(first, node)| EquationRow {
            first,
            count: 1,
            node: *node,
            field: None,
        });
        Self {
            count: nodes.len(),
            identity: None,
            rows: rows.collect(),
        }
    }
}

/// Returns rows of the degrees of freedom, from the row `first` on.
fn collect_rows(equations: &Equations, nodes: &RowNodes, first: usize) -> Vec<EquationRow> {
    let scalars = nodes.scalars.iter().enumerate();
    let scalars = scalars.map(|(index, node)| EquationRow {
        first: first + index,
        count: 1,
        node: *node,
        field: None,
    });
    let fields = FieldId::first(nodes.modal.len()).zip(&nodes.modal);
    let modal = fields.map(|(field, node)| EquationRow {
        first: first + mode_offset(equations, field),
        count: equations.graph.orders()[field],
        node: *node,
        field: Some(field),
    });
    scalars.chain(modal).collect()
}

/// Returns the rows of several lists, each with a row for each degree of freedom.
pub(super) fn stack_rows(equations: &Equations, lists: &[RowNodes]) -> JacobianRows {
    let degrees = degrees_of_freedom(equations);
    let rows = lists.iter().enumerate();
    let rows = rows.flat_map(|(index, nodes)| collect_rows(equations, nodes, index * degrees));
    JacobianRows {
        count: lists.len() * degrees,
        identity: None,
        rows: rows.collect(),
    }
}

/// Returns the rows of the state's rates. The rates of coordinates are themselves states and give the block of ones.
pub(crate) fn collect_rate_rows(equations: &Equations) -> JacobianRows {
    let degrees = degrees_of_freedom(equations);
    let mut rows = collect_rows(equations, &equations.accelerations.rows, degrees);
    let first_order = equations.state_rates.iter().enumerate();
    rows.extend(first_order.map(|(index, node)| EquationRow {
        first: 2 * degrees + index,
        count: 1,
        node: *node,
        field: None,
    }));
    JacobianRows {
        count: 2 * degrees + equations.state_rates.len(),
        identity: Some(degrees),
        rows,
    }
}

/// Returns the rows of the observables, then of energy and power.
pub(crate) fn collect_observable_rows(equations: &mut Equations) -> JacobianRows {
    let energy = equations.graph.add(equations.kinetic, equations.potential);
    let nodes = equations.observables.iter().copied();
    let nodes: Vec<NodeId> = nodes.chain([energy, equations.power]).collect();
    JacobianRows::from_scalars(&nodes)
}

pub(crate) fn differentiate_by_variables(
    equations: &mut Equations,
    rows: &JacobianRows,
    name: &'static str,
    inputs: bool,
) -> Jacobian<NodeId> {
    let variables = if inputs {
        InputId::first(equations.inputs)
            .map(Variable::Input)
            .collect()
    } else {
        list_state_variables(equations)
    };
    let mut blocks = Blocks::new(&mut equations.graph, rows, inputs);
    let mut column = 0;
    for variable in variables {
        column += blocks.add_variable_columns(variable, column);
    }
    blocks.jacobian(name, column)
}

pub(crate) fn differentiate_by_parameters(
    equations: &mut Equations,
    rows: &JacobianRows,
    name: &'static str,
) -> Jacobian<NodeId> {
    let independent: Vec<ParameterId> = ParameterId::first(equations.parameter_names.len())
        .filter(|index| equations.derived_parameters[*index].is_none())
        .collect();
    let mut blocks = Blocks::new(&mut equations.graph, rows, true);
    for (column, parameter) in independent.iter().enumerate() {
        blocks.add_parameter_column(&equations.derived_parameters, *parameter, column);
    }
    blocks.jacobian(name, independent.len())
}

/// Derives the derivative with respect to time, with constant state and inputs: a Jacobian of one column.
pub(crate) fn differentiate_by_time(
    equations: &mut Equations,
    rows: &JacobianRows,
    name: &'static str,
) -> Jacobian<NodeId> {
    let graph = &mut equations.graph;
    let mut direction = Direction::default();
    let time = graph.intern(Operation::Time);
    direction.seed(time, graph.one());
    let mut blocks = Blocks::new(graph, rows, true);
    blocks.push_along(&mut direction, 0);
    blocks.jacobian(name, 1)
}

/// Derives the derivatives of rates and observables along a direction, as one column. The rows of the coordinates are
/// left out, because they are components of the direction.
pub(super) fn differentiate_along_direction(
    equations: &mut Equations,
    tangent: &Tangent<'_>,
    name: &'static str,
) -> Jacobian<NodeId> {
    let mut rows = collect_rate_rows(equations);
    let observables = collect_observable_rows(equations);
    let first = rows.count;
    rows.count += observables.count;
    let shifted = observables.rows.into_iter().map(|row| EquationRow {
        first: first + row.first,
        ..row
    });
    rows.rows.extend(shifted);
    let mut blocks = Blocks::new(&mut equations.graph, &rows, true);
    blocks.push_along(&mut Direction::new(tangent), 0);
    blocks.jacobian(name, 1)
}

pub(crate) fn build_single_row_jacobian(
    graph: &Graph,
    name: &'static str,
    row: &[NodeId],
) -> Jacobian<NodeId> {
    let nonzeros = row
        .iter()
        .enumerate()
        .filter(|(_, id)| !graph.is_zero(**id));
    let entries = nonzeros.map(|(column, value)| JacobianBlock {
        row: 0,
        rows: 1,
        column,
        columns: 1,
        diagonal: false,
        value: *value,
    });
    Jacobian {
        name,
        rows: 1,
        columns: row.len(),
        entries: entries.collect(),
    }
}

pub(super) fn degrees_of_freedom(equations: &Equations) -> usize {
    mode_offset(equations, FieldId::new(equations.graph.orders().len()))
}

pub(super) fn mode_offset(equations: &Equations, field: FieldId) -> usize {
    let modes: usize = equations.graph.orders()[..field.index()].iter().sum();
    equations.forces.scalars.len() + modes
}

pub(super) fn list_state_variables(equations: &Equations) -> Vec<Variable> {
    let (coordinates, fields) = (equations.forces.scalars.len(), equations.forces.modal.len());
    CoordinateId::first(coordinates)
        .map(Variable::Coordinate)
        .chain(FieldId::first(fields).map(Variable::ModeCoordinates))
        .chain(CoordinateId::first(coordinates).map(Variable::Rate))
        .chain(FieldId::first(fields).map(Variable::ModeRates))
        .chain(StateId::first(equations.state_rates.len()).map(Variable::State))
        .collect()
}

struct Blocks<'a> {
    graph: &'a mut Graph,
    rows: &'a JacobianRows,
    entries: Vec<JacobianBlock<NodeId>>,
}

impl<'a> Blocks<'a> {
    fn new(graph: &'a mut Graph, rows: &'a JacobianRows, without_identity: bool) -> Self {
        let mut entries = Vec::new();
        if let (Some(column), false) = (rows.identity, without_identity) {
            entries.push(JacobianBlock {
                row: 0,
                rows: column,
                column,
                columns: column,
                diagonal: true,
                value: graph.one(),
            });
        }
        Self {
            graph,
            rows,
            entries,
        }
    }

    fn jacobian(mut self, name: &'static str, columns: usize) -> Jacobian<NodeId> {
        self.entries
            .retain(|entry| entry.rows > 0 && entry.columns > 0);
        self.entries.sort_by_key(|entry| (entry.row, entry.column));
        Jacobian {
            name,
            rows: self.rows.count,
            columns,
            entries: self.entries,
        }
    }

    /// Adds the blocks of a variable, starting at this column; returns the number of its columns.
    fn add_variable_columns(&mut self, variable: Variable, column: usize) -> usize {
        let leaf = self.graph.variable(variable);
        if let Some(mut derivative) = ModalDerivative::new(self.graph, leaf) {
            let columns = self.graph.length(self.graph.shape(leaf));
            for row in &self.rows.rows {
                self.add_mode_columns(&mut derivative, *row, column, columns);
            }
            return columns;
        }
        let mut direction = Direction::default();
        direction.seed(leaf, self.graph.one());
        self.push_along(&mut direction, column);
        1
    }

    fn add_parameter_column(
        &mut self,
        derived: &[Option<NodeId>],
        parameter: ParameterId,
        column: usize,
    ) {
        let mut direction = Direction::default();
        let leaf = self.graph.intern(Operation::Parameter(parameter));
        direction.seed(leaf, self.graph.one());
        let mut seeded = vec![false; derived.len()];
        for index in ParameterId::first(derived.len()) {
            seed_derived(self.graph, derived, index, &mut direction, &mut seeded);
        }
        self.push_along(&mut direction, column);
    }

    /// Adds a column: the derivatives of all rows along a direction.
    fn push_along(&mut self, direction: &mut Direction<'_>, column: usize) {
        for row in &self.rows.rows {
            let value = direction.derivative(self.graph, row.node);
            self.push(*row, (column, 1), false, value);
        }
    }

    fn add_mode_columns(
        &mut self,
        derivative: &mut ModalDerivative,
        row: EquationRow,
        column: usize,
        columns: usize,
    ) {
        let Some(field) = row.field else {
            let value = derivative.gradient(self.graph, row.node);
            self.push(row, (column, columns), false, value);
            return;
        };
        let matrix = derivative.derive_element_jacobian(self.graph, row.node, Space::Modes(field));
        match matrix {
            StructuredMatrix {
                diagonal: Some(diagonal),
                outer,
                matrices,
                ..
            } if outer.is_empty() && matrices.is_empty() => {
                self.push(row, (column, columns), true, diagonal);
            }
            matrix if matrix.is_zero() => {}
            matrix => {
                let value = matrix.assemble(self.graph);
                self.push(row, (column, columns), false, value);
            }
        }
    }

    fn push(
        &mut self,
        row: EquationRow,
        (column, columns): (usize, usize),
        diagonal: bool,
        value: NodeId,
    ) {
        if self.graph.is_zero(value) {
            return;
        }
        self.entries.push(JacobianBlock {
            row: row.first,
            rows: row.count,
            column,
            columns,
            diagonal,
            value,
        });
    }
}

/// Sets the derivatives of derived parameters along the direction, operands first.
pub(super) fn seed_derived(
    graph: &mut Graph,
    derived: &[Option<NodeId>],
    index: ParameterId,
    direction: &mut Direction<'_>,
    seeded: &mut [bool],
) {
    let (Some(expression), false) = (derived[index], seeded[index]) else {
        return;
    };
    seeded[index] = true;
    for node in graph.reachable(&[expression]) {
        if let Operation::Parameter(read) = *graph.operation(node) {
            seed_derived(graph, derived, read, direction, seeded);
        }
    }
    let slope = direction.derivative(graph, expression);
    let leaf = graph.intern(Operation::Parameter(index));
    direction.seed(leaf, slope);
}
