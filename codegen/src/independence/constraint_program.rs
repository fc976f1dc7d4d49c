//! Program of the constraint derivatives of a model.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Constraint, Model, RESIDUAL};

use crate::mechanics::equations::Equations;
use crate::mechanics::outputs::{Jacobian, JacobianBlock, Outputs};
use crate::program::Program;
use crate::program::lowering::lower_with_outputs;
use crate::symbolic::graph::{NodeId, Space};

/// Returns the program whose Jacobian holds the constraint derivatives, or `None` for a model without constraints.
/// `parameters` are the values of the specification in SI units.
pub fn constraint_program(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
) -> Option<Program> {
    let rows = &equations.constraint_rows;
    let first = rows.first()?;
    let mut entries = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let mut add = |column: usize, columns: usize, value: NodeId| {
            if !equations.graph.is_zero(value) && columns > 0 {
                entries.push(JacobianBlock {
                    row: index,
                    rows: 1,
                    column,
                    columns,
                    diagonal: false,
                    value,
                });
            }
        };
        for (column, value) in row.scalars.iter().enumerate() {
            add(column, 1, *value);
        }
        let mut column = row.scalars.len();
        for (field, value) in FieldId::first(row.modal.len()).zip(&row.modal) {
            let columns = equations.graph.size(Space::Modes(field));
            add(column, columns, *value);
            column += columns;
        }
    }
    let modes: usize = equations.graph.orders().iter().sum();
    let outputs = Outputs {
        jacobians: vec![Jacobian {
            name: "constraints",
            rows: rows.len(),
            columns: first.scalars.len() + modes,
            entries,
        }],
        ..Outputs::default()
    };
    Some(lower_with_outputs(model, equations, parameters, &outputs))
}

/// Returns the indices of the residuals of a model's constraints among the observables of a program.
pub fn find_residual_indices(model: &Model, program: &Program) -> Vec<usize> {
    let index = |constraint: &Constraint| {
        let name = format!("{RESIDUAL}{}", constraint.name);
        let mut known = program.observables.iter();
        known.position(|observable| observable.name == name)
    };
    model.constraints.iter().filter_map(index).collect()
}
