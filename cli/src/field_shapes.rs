//! Mode shapes of fields at evenly spaced positions.

use eomgen_codegen::mechanics::fields::modes::table;
use eomgen_codegen::symbolic::tables::TableKind;
use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::evaluate::evaluate;
use eomgen_model_spec::model::Field;

use crate::error::{Error, Result};

/// Field with its mode shapes at evenly spaced positions.
pub struct FieldShapes<'m> {
    pub field: &'m Field,
    /// Positions from the start to the end of the field, in SI.
    pub positions: Vec<f64>,
    /// Values of the mode shapes: one row for each position, one number for each mode.
    pub functions: Vec<Vec<f64>>,
    /// Index of the field's first modal coordinate in the state.
    pub first: usize,
}

/// Returns the mode shapes of all fields that have modes, at `intervals` + 1 positions.
pub fn field_shapes(compiled: &CompiledModel, intervals: usize) -> Result<Vec<FieldShapes<'_>>> {
    let model = compiled.model();
    let values = model.parameter_values();
    let values = values.map_err(|error| Error::model(&model.source, error))?;
    let shares: Vec<f64> = (0..=intervals)
        .map(|n| n as f64 / intervals as f64)
        .collect();
    let mut first = model.coordinates.len();
    let mut shapes = Vec::new();
    for (field, order) in model.fields.iter().zip(compiled.orders()) {
        let [from, to] = [&field.from, &field.to].map(|end| evaluate(end, &values));
        let functions = |s: &f64| {
            let (bits, derivative) = (s.to_bits(), 0);
            table(
                &field.basis,
                *order,
                TableKind::ShapeAtPlace { bits, derivative },
            )
        };
        if *order > 0 {
            shapes.push(FieldShapes {
                field,
                positions: shares.iter().map(|s| from + s * (to - from)).collect(),
                functions: shares.iter().map(functions).collect(),
                first,
            });
        }
        first += order;
    }
    Ok(shapes)
}
