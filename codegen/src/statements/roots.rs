//! Values that each part of the file computes or reads.

use std::collections::BTreeSet;

use crate::program::{Jacobian, Op, Program, RowValues, ValueId};

/// Returns the values that the mass matrix function computes or reads.
pub(super) fn collect_mass_roots(program: &Program) -> Vec<ValueId> {
    let mass = &program.mass;
    let mut roots: Vec<ValueId> = mass.scalars.iter().flatten().copied().collect();
    roots.extend(mass.coupling.iter().flatten());
    // Modal blocks are assembled from their parts in the stage. As whole matrices they would be stored in the
    // coefficients.
    for block in mass.modal.iter().flatten().flatten() {
        roots.extend(program.value(*block).op.operands());
    }
    roots
}

/// Returns the values that the stages with coefficients compute or read.
pub fn collect_stage_roots(program: &Program) -> Vec<ValueId> {
    let mut roots = program.rate_roots();
    roots.extend(&program.observable_values);
    roots.extend(program.guards.iter().map(|g| g.value));
    roots.extend(collect_mass_roots(program));
    roots.extend(collect_output_roots(program));
    roots
}

/// Returns the coefficients that stages read directly, without constants and tables.
pub fn collect_coefficients(program: &Program) -> Vec<ValueId> {
    let roots = collect_stage_roots(program);
    let mut read: BTreeSet<ValueId> = program
        .reachable(&roots)
        .into_iter()
        .filter(|id| !program.value(*id).parameter_only)
        .flat_map(|id| program.value(id).op.operands())
        .collect();
    read.extend(roots);
    read.retain(|id| {
        let value = program.value(*id);
        value.parameter_only && !matches!(value.op, Op::Constant(_) | Op::Table(_))
    });
    read.into_iter()
        .filter(|id| program.value(*id).extent.length() > 0)
        .collect()
}

fn collect_output_roots(program: &Program) -> Vec<ValueId> {
    let outputs = &program.outputs;
    let rows = [&outputs.bias_forces, &outputs.inverse_dynamics];
    let mut roots: Vec<ValueId> = rows
        .into_iter()
        .flatten()
        .flat_map(RowValues::all)
        .collect();
    roots.extend(outputs.guard_rates.iter().flatten());
    if let Some(products) = &outputs.products {
        roots.extend(products.forward_roots());
        roots.extend(products.reverse.iter().map(|(_, id)| *id));
        roots.extend(products.by_parameters.entries.iter().map(|e| e.value));
    }
    if let Some(derivative) = &outputs.gradient_derivative {
        roots.extend(derivative.rows.iter().map(|row| row.value));
    }
    if let Some(known) = &outputs.reactions {
        roots.extend(known.rate_roots());
        roots.extend(known.function_roots());
        roots.extend(known.effect_roots());
    }
    for jacobian in &outputs.jacobians {
        roots.extend(collect_entry_roots(program, jacobian));
    }
    roots.retain(|id| !matches!(program.value(*id).op, Op::Constant(_)));
    roots
}

/// Returns the values of the structural nonzeros of a Jacobian. An assembled block is replaced by its parts.
pub(super) fn collect_entry_roots(program: &Program, jacobian: &Jacobian<ValueId>) -> Vec<ValueId> {
    let entries = jacobian.entries.iter();
    entries
        .flat_map(|entry| {
            let value = program.value(entry.value);
            match value.op {
                Op::Assemble { .. } => value.op.operands(),
                _ => vec![entry.value],
            }
        })
        .collect()
}
