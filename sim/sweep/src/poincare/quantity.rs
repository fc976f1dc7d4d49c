//! Quantity on a section: a coordinate with its rate, or a rate with its coordinate.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::foreign::suggest_state;

pub fn state_index(model: &CompiledModel, name: &str) -> Result<usize, String> {
    let states = model.state_names();
    let place = states.iter().position(|known| known == name);
    place.ok_or_else(|| {
        let hint = suggest_state(name, states.iter().map(String::as_str))
            .unwrap_or_else(|| format!("it has {}", states.join(", ")));
        let model = &model.model().name;
        format!("the model `{model}` has no coordinate and no rate `{name}`: {hint}")
    })
}

/// Coordinate with its rate, or rate with its coordinate. Only the first one is reported.
#[derive(Clone, Debug)]
pub struct Quantity {
    pub name: String,
    /// SI unit of the reported quantity.
    pub unit: String,
    state_indices: [usize; 2],
    /// Index of the coordinate in the pair; the other entry is its rate.
    coordinate: usize,
}

impl Quantity {
    pub fn from_name(model: &CompiledModel, name: &str) -> Result<Self, String> {
        let shown = state_index(model, name)?;
        let (partner, coordinate) = match name.strip_suffix("_dot") {
            Some(coordinate) => (coordinate.to_owned(), 1),
            None => (format!("{name}_dot"), 0),
        };
        Ok(Self {
            coordinate,
            name: name.to_owned(),
            unit: model.state_units()[shown].clone(),
            state_indices: [shown, state_index(model, &partner)?],
        })
    }

    /// Returns the index of the coordinate in the pair, and its index in the state.
    pub fn coordinate(&self) -> (usize, usize) {
        (self.coordinate, self.state_indices[self.coordinate])
    }

    pub fn values_in_state(&self, state: &[f64]) -> [f64; 2] {
        self.state_indices.map(|place| state[place])
    }
}
