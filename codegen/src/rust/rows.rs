//! Values by row of the equations, written into an array.

use super::body::Body;
use super::emit_error::Emitted;
use super::expression::{assignment, infix};
use super::file::File;
use crate::program::RowValues;
use eomgen_model_spec::ids::FieldId;

/// Rows into `target` from a place on.
pub(super) fn write_row_values(
    file: &File<'_>,
    body: &mut Body<'_>,
    target: &str,
    first: usize,
    rows: &RowValues,
) -> Emitted<()> {
    for (place, id) in rows.scalars.iter().enumerate() {
        let value = body.scalar(*id)?;
        body.push(&assignment(&format!("{target}[{}]", first + place), value));
    }
    for (field, id) in FieldId::first(rows.modal.len()).zip(&rows.modal) {
        let order = file.program.fields[field].order;
        if order > 0 {
            let value = body.element(*id)?;
            let place = infix("+", first + file.program.mode_offset(field), "i");
            body.push_loop(
                "i",
                order,
                &assignment(&format!("{target}[{place}]"), value),
            );
        }
    }
    Ok(())
}
