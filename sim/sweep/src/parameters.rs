//! The varied parameters as columns of a result.

use eomgen_model_spec::model::Model;

use crate::error::SweepError;
use crate::grid::Grid;
use crate::measure::Column;

/// The parameters that a grid varies as columns, in declared units.
///
/// # Errors
/// A name that is no parameter of the model.
pub fn columns(model: &Model, grid: &Grid) -> Result<Vec<Column>, SweepError> {
    let column = |name: &str| {
        let mut known = model.parameters.iter();
        let parameter = known
            .find(|known| known.name == name)
            .ok_or_else(|| SweepError::Request(format!("the model has no parameter `{name}`")))?;
        Ok(Column::new(
            name,
            parameter.unit.to_string(),
            &parameter.doc,
        ))
    };
    grid.names().map(column).collect()
}
