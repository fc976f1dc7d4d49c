//! Columns of the varied parameters.

use eomgen_model_spec::model::Model;

use crate::error::SweepError;
use crate::measure::Column;
use crate::points::Points;

/// Returns one column per parameter that varies between points, in declared units.
pub fn columns(model: &Model, points: &Points) -> Result<Vec<Column>, SweepError> {
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
    points.names().into_iter().map(column).collect()
}
