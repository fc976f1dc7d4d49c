//! Lowering of the equations' graph to a program. Sums and products become binary operations in a fixed
//! order; values that depend only on parameters are prepared once.
//!
//! A term `c P X` of a sum has a number c, a factor P of parameters and a state-dependent factor X. It is computed as
//! the prepared coefficient |c| P times X, and added or subtracted according to the sign of c.

mod affine;
mod arithmetic;
mod controllers;
mod outputs;
mod quantities;
mod values;

use eomgen_model_spec::model::Model;

use crate::mechanics::equations::Equations;
use crate::mechanics::outputs::Outputs;
use crate::mechanics::rows::RowNodes;
use crate::program::{Extent, Op, Program, ProgramField, ProgramGuard, Trace, ValueId};
use crate::symbolic::formula::write_abridged_formula;
use crate::symbolic::graph::NodeId;
pub use affine::lower_affine;
pub use controllers::lower_controllers;
use quantities::{domain, program_observables, program_parameters, quantity};
use values::Lowering;

/// Lowers the equations to the program of one variant.
pub fn lower(model: &Model, equations: &Equations, parameter_values: &[f64]) -> Program {
    lower_with_outputs(model, equations, parameter_values, &Outputs::default())
}

/// Lowers the equations with additional outputs, which do not change the other values.
pub fn lower_with_outputs(
    model: &Model,
    equations: &Equations,
    parameter_values: &[f64],
    outputs: &Outputs<NodeId, RowNodes>,
) -> Program {
    lower_with_values(model, equations, parameter_values, outputs).0
}

/// Lowers the equations with additional outputs. Also returns pairs of node and value.
pub(crate) fn lower_with_values(
    model: &Model,
    equations: &Equations,
    parameter_values: &[f64],
    outputs: &Outputs<NodeId, RowNodes>,
) -> (Program, Vec<(NodeId, ValueId)>) {
    let mut lowering = Lowering::new(
        &equations.graph,
        &equations.derived_parameters,
        &equations.parameter_names,
    );
    lowering.uses = equations.graph.uses(&equations.rate_nodes());
    for roots in functions(equations, outputs) {
        lowering.association.extend(&equations.graph, &roots);
    }
    let accelerations = lowering.rows(&equations.accelerations.rows);
    let first_order_rates = equations
        .state_rates
        .iter()
        .map(|id| lowering.value(*id))
        .collect();
    lowering.uses.clear();
    let mass = lowering.mass(equations);
    let velocity_terms = lowering.rows(&equations.velocity_terms);
    let forces = lowering.rows(&equations.forces);
    let mut observable_values: Vec<ValueId> = equations
        .observables
        .iter()
        .map(|id| lowering.value(*id))
        .collect();
    let kinetic = lowering.value(equations.kinetic);
    let potential = lowering.value(equations.potential);
    let energy = lowering.emit(Op::Add(kinetic, potential), Extent::Scalar);
    observable_values.push(energy);
    observable_values.push(lowering.value(equations.power));
    let guards = equations
        .guards
        .iter()
        .enumerate()
        .map(|(index, guard)| ProgramGuard {
            formula: write_abridged_formula(&equations.graph, model, guard.value).to_string(),
            value: lowering.value(guard.value),
            is_corner: equations
                .corners
                .iter()
                .any(|corner| corner.guard == index && corner.moves_rates),
        })
        .collect();
    let pivots = equations
        .accelerations
        .pivots
        .iter()
        .filter(|id| equations.graph.dependence(**id).is_parameter_only())
        .map(|id| lowering.value(*id))
        .collect();
    let coefficient_values = equations
        .coefficients
        .iter()
        .map(|coefficient| lowering.value(coefficient.value))
        .collect();
    let impacts = equations.impacts.iter();
    let impacts = impacts.map(|impact| lowering.impact(impact)).collect();
    let outputs = lowering.outputs(outputs);
    let values = lowering.lowered.into_iter().collect();
    let program = Program {
        name: model.name.clone(),
        specification: model.name.clone(),
        title: model.title.clone(),
        spec_hash: model.hash(),
        parameters: program_parameters(model, parameter_values),
        coordinates: model
            .coordinates
            .iter()
            .map(|c| quantity(&c.name, &c.unit.text, &c.doc))
            .collect(),
        fields: model
            .fields
            .iter()
            .zip(equations.graph.orders())
            .map(|(field, order)| ProgramField {
                coordinates: field.coordinates.clone(),
                unit: field.unit.text.clone(),
                order: *order,
            })
            .collect(),
        first_order: model
            .states
            .iter()
            .map(|s| quantity(&s.name, &s.unit.text, &s.doc))
            .collect(),
        inputs: model
            .inputs
            .iter()
            .map(|i| quantity(&i.name, &i.unit.text, &i.doc))
            .collect(),
        observables: program_observables(model),
        tables: lowering.tables,
        values: lowering.values,
        accelerations,
        first_order_rates,
        mass,
        velocity_terms,
        forces,
        observable_values,
        guards,
        impacts,
        pivots,
        coefficient_values,
        domain: domain(model, equations.graph.orders(), parameter_values),
        controllers: Vec::new(),
        outputs,
        trace: Trace::default(),
    };
    (program, values)
}

/// Returns the roots of each function of a program, the rates first. The multiplication order of shared factors is
/// optimised within one function.
fn functions(equations: &Equations, outputs: &Outputs<NodeId, RowNodes>) -> Vec<Vec<NodeId>> {
    let mass = &equations.mass;
    let scalars = mass.scalars.iter().flatten().copied().collect();
    let mut functions = vec![
        equations.rate_nodes(),
        scalars,
        equations.velocity_terms.nodes(),
        equations.forces.nodes(),
        equations.observables.clone(),
        vec![equations.kinetic, equations.potential],
        vec![equations.power],
    ];
    let rows = [&outputs.bias_forces, &outputs.inverse_dynamics];
    functions.extend(rows.into_iter().flatten().map(RowNodes::nodes));
    functions
}
