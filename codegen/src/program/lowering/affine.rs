//! Program of the coefficients of a piecewise-linear model; it has only prepared values.

use eomgen_model_spec::model::Model;

use super::quantities::{program_parameters, quantity};
use super::values::Lowering;
use crate::mechanics::affine::{AffineEquations, AffineRow};
use crate::program::affine::{AffineLayout, AffineProgram, AffineRowValues};
use crate::program::{
    Domain, MassBlocks, Outputs, Program, ProgramField, ProgramParameter, Quantity, RowValues,
    Trace, ValueId,
};

/// Lowers the coefficients of `equations`, which belong to `model`.
pub fn lower_affine(
    model: &Model,
    equations: &AffineEquations,
    parameter_values: &[f64],
) -> AffineProgram {
    let mut lowering = Lowering::new(
        &equations.graph,
        &equations.derived_parameters,
        &equations.parameter_names,
    );
    let mut rows = |rows: &[AffineRow]| -> Vec<AffineRowValues> {
        rows.iter().map(|row| values(&mut lowering, row)).collect()
    };
    let (scalars, modal) = (rows(&equations.scalars), rows(&equations.modal));
    let (first_order, guards) = (rows(&equations.first_order), rows(&equations.guards));
    let phases = equations
        .phases
        .iter()
        .map(|phase| [lowering.value(phase.rate), lowering.value(phase.offset)])
        .collect();
    let half_widths = equations
        .half_widths
        .iter()
        .map(|id| lowering.value(*id))
        .collect();
    let pivots = equations
        .pivots
        .iter()
        .filter(|id| equations.graph.dependence(**id).is_parameter_only())
        .map(|id| lowering.value(*id))
        .collect();
    let mut parameters = program_parameters(model, parameter_values);
    parameters.extend((0..guards.len()).map(side_parameter));
    AffineProgram {
        layout: AffineLayout {
            scalars,
            modal,
            first_order,
            guards,
            guard_functions: equations.guard_functions.clone(),
            guard_groups: equations.guard_groups.clone(),
            guards_rest: equations.guards_rest.clone(),
            phases,
            half_widths,
            inputs: model.inputs.len(),
        },
        program: Program {
            name: model.name.clone(),
            specification: model.name.clone(),
            title: model.title.clone(),
            spec_hash: model.hash(),
            parameters,
            coordinates: model
                .coordinates
                .iter()
                .map(|c| quantity(&c.name, &c.unit.text, &c.doc))
                .collect(),
            fields: fields(model, equations.graph.orders()),
            first_order: model
                .states
                .iter()
                .map(|s| quantity(&s.name, &s.unit.text, &s.doc))
                .collect(),
            inputs: Vec::new(),
            observables: Vec::new(),
            tables: lowering.tables,
            values: lowering.values,
            accelerations: RowValues::default(),
            first_order_rates: Vec::new(),
            mass: MassBlocks::default(),
            velocity_terms: RowValues::default(),
            forces: RowValues::default(),
            observable_values: Vec::new(),
            guards: Vec::new(),
            impacts: Vec::new(),
            pivots,
            coefficient_values: Vec::new(),
            domain: Domain::default(),
            controllers: Vec::new(),
            outputs: Outputs::default(),
            trace: Trace::default(),
        },
    }
}

fn fields(model: &Model, orders: &[usize]) -> Vec<ProgramField> {
    let fields = model.fields.iter().zip(orders);
    fields
        .map(|(field, order)| ProgramField {
            coordinates: field.coordinates.clone(),
            unit: field.unit.text.clone(),
            order: *order,
        })
        .collect()
}

fn side_parameter(guard: usize) -> ProgramParameter {
    ProgramParameter {
        quantity: Quantity {
            name: format!("side_{guard}"),
            unit: "1".to_owned(),
            doc: "1 if the switching function is positive, else 0".to_owned(),
        },
        origin: String::new(),
        value: 0.0,
    }
}

fn values(lowering: &mut Lowering<'_>, row: &AffineRow) -> AffineRowValues {
    let mut all = |nodes: &[crate::symbolic::graph::NodeId]| -> Vec<ValueId> {
        nodes.iter().map(|id| lowering.value(*id)).collect()
    };
    AffineRowValues {
        coordinates: all(&row.coordinates),
        mode_coordinates: all(&row.mode_coordinates),
        rates: all(&row.rates),
        mode_rates: all(&row.mode_rates),
        states: all(&row.states),
        inputs: all(&row.inputs),
        sines: all(&row.sines),
        cosines: all(&row.cosines),
        constant: all(&[row.constant])[0],
    }
}
