//! What is seen on a section: a coordinate with its rate, or a rate with its coordinate.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::suggest::did_you_mean;

/// Where a coordinate or a rate stands in the state.
///
/// # Errors
/// There is none of this name; what is near to it.
pub fn place(model: &CompiledModel, name: &str) -> Result<usize, String> {
    let states = model.state_names();
    let place = states.iter().position(|known| known == name);
    place.ok_or_else(|| {
        let hint = did_you_mean(name, states.iter().map(String::as_str))
            .unwrap_or_else(|| format!("there are {}", states.join(", ")));
        let model = &model.model().name;
        format!("the model `{model}` has no coordinate and no rate `{name}`: {hint}")
    })
}

/// A coordinate with its rate, or a rate with its coordinate: the first is shown, both tell points
/// apart.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Of what is shown.
    pub name: String,
    /// The SI unit of that.
    pub unit: String,
    places: [usize; 2],
    /// Which of the two is the coordinate: the other is its rate.
    coordinate: usize,
}

impl Quantity {
    /// By its name.
    ///
    /// # Errors
    /// As [`place`].
    pub fn of(model: &CompiledModel, name: &str) -> Result<Self, String> {
        let shown = place(model, name)?;
        let (partner, coordinate) = match name.strip_suffix("_dot") {
            Some(coordinate) => (coordinate.to_owned(), 1),
            None => (format!("{name}_dot"), 0),
        };
        Ok(Self {
            coordinate,
            name: name.to_owned(),
            unit: model.state_units()[shown].clone(),
            places: [shown, place(model, &partner)?],
        })
    }

    /// Which of both is the coordinate, and its place in the state.
    pub fn coordinate(&self) -> (usize, usize) {
        (self.coordinate, self.places[self.coordinate])
    }

    /// Both, in a state.
    pub fn seen(&self, state: &[f64]) -> [f64; 2] {
        self.places.map(|place| state[place])
    }
}
