//! Assignment of one value per row of the equations to the elements of an array.

use super::body::Body;
use super::emit_error::EmitResult;
use super::index::Index;
use super::statement::Place;
use crate::program::RowValues;
use eomgen_model_spec::ids::FieldId;

/// Writes `rows` into `target`, beginning at index `first`.
pub(super) fn write_row_values(
    body: &mut Body<'_>,
    target: &str,
    first: usize,
    rows: &RowValues,
) -> EmitResult<()> {
    for (place, id) in rows.scalars.iter().enumerate() {
        let value = body.scalar(*id)?;
        body.assign(Place::new(target, [Index::Number(first + place)]), value);
    }
    for (field, id) in FieldId::first(rows.modal.len()).zip(&rows.modal) {
        let order = body.program.fields[field].order;
        if order > 0 {
            let value = body.element(*id)?;
            let place = Index::from_first(first + body.program.mode_offset(field), "i");
            body.assign_each(order, Place::new(target, [place]), value);
        }
    }
    Ok(())
}
