//! Ranges and scales of the state and the inputs.

use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::{Model, Range};

/// Ranges and scales of the state and of the inputs, in SI.
#[derive(Clone, Debug)]
pub struct Ranges {
    /// Range of each state entry; `None` for modes, rates and entries without a `range`.
    pub state: Vec<Option<(f64, f64)>>,
    /// Range of each input.
    pub inputs: Vec<Option<(f64, f64)>>,
    /// For each first-order state, the magnitudes of the parameters of equal dimension.
    pub first_order_scales: Vec<Vec<f64>>,
    /// For each input, the magnitudes of the parameters of equal dimension.
    pub input_scales: Vec<Vec<f64>>,
}

impl Ranges {
    pub(super) fn from_model(model: &Model, order: usize, parameters: &[f64]) -> Self {
        let ends = |range: &Option<Range>| range.as_ref().map(|range| range.ends(parameters));
        let scale = |dimension| parameter_sizes(model, parameters, dimension);
        let mut state: Vec<_> = model.coordinates.iter().map(|c| ends(&c.range)).collect();
        state.resize(2 * (state.len() + order * model.fields.len()), None);
        state.extend(model.states.iter().map(|state| ends(&state.range)));
        let (states, inputs) = (model.states.iter(), model.inputs.iter());
        Self {
            state,
            inputs: inputs.clone().map(|input| ends(&input.range)).collect(),
            first_order_scales: states.map(|state| scale(state.unit.dimension)).collect(),
            input_scales: inputs.map(|input| scale(input.unit.dimension)).collect(),
        }
    }
}

/// Returns the nonzero magnitudes of parameters of a dimension; none for a dimensionless one.
fn parameter_sizes(model: &Model, parameters: &[f64], dimension: Dimension) -> Vec<f64> {
    let known = model.parameters.iter().zip(parameters);
    let of_dimension = known.filter(|(parameter, _)| {
        dimension != Dimension::DIMENSIONLESS && parameter.unit.dimension == dimension
    });
    of_dimension
        .map(|(_, value)| value.abs())
        .filter(|size| *size > 0.0 && size.is_finite())
        .collect()
}
