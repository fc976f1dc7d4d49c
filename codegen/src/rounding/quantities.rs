//! Quantities that have bounds: entries of the mass matrix, velocity terms, forces and rates, with their units.

use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

use crate::program::{Program, RowValues, ValueId};

/// Number that the emitted code computes.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Name, such as `mass_matrix[theta, phi]` or `rates[theta_dot]`.
    pub name: String,
    /// SI unit; `None` if the unit of a coordinate is not known.
    pub unit: Option<String>,
    /// Value of the program that contains the number.
    pub value: ValueId,
    /// Index of the element in the value; a scalar has the same number for all indices.
    pub index: usize,
}

/// Returns the upper half of the mass matrix, the velocity terms, the forces and the rates. Entries of the mass matrix
/// that are always 0 and the rates of the coordinates, which are states, are left out.
pub fn quantities(program: &Program) -> Vec<Quantity> {
    let rows = Rows::new(program);
    let mut all = rows.mass_matrix(program);
    let joule = dimension("J");
    let per_row = |row: usize| joule?.divide(rows.dimensions[row]?);
    all.extend(rows.entries("velocity_terms", &program.velocity_terms, per_row));
    all.extend(rows.entries("forces", &program.forces, per_row));
    all.extend(rows.rates(program));
    all
}

/// Returns the accelerations and the rates of the first-order states.
pub(super) fn rates(program: &Program) -> Vec<Quantity> {
    Rows::new(program).rates(program)
}

fn dimension(unit: &str) -> Option<Dimension> {
    Unit::parse(unit).ok().map(|unit| unit.dimension)
}

/// Names and dimensions of the coordinates and modes, and the field and mode of each mode.
struct Rows {
    names: Vec<String>,
    dimensions: Vec<Option<Dimension>>,
    scalars: usize,
    modes: Vec<(usize, usize)>,
}

impl Rows {
    fn new(program: &Program) -> Self {
        let mut names = program.state_names();
        names.truncate(program.degrees_of_freedom());
        let coordinates = program.coordinates.iter();
        let mut dimensions: Vec<_> = coordinates.map(|c| dimension(&c.unit)).collect();
        let mut modes = Vec::new();
        for (place, field) in program.fields.iter().enumerate() {
            dimensions.extend((0..field.order).map(|_| dimension(&field.unit)));
            modes.extend((0..field.order).map(|mode| (place, mode)));
        }
        Self {
            names,
            dimensions,
            scalars: program.coordinates.len(),
            modes,
        }
    }

    fn entries(
        &self,
        kind: &str,
        rows: &RowValues,
        unit: impl Fn(usize) -> Option<Dimension>,
    ) -> Vec<Quantity> {
        let places = (0..self.names.len()).map(|row| match row.checked_sub(self.scalars) {
            None => (rows.scalars[row], 0),
            Some(mode) => (rows.modal[self.modes[mode].0], self.modes[mode].1),
        });
        let places = places.enumerate();
        places
            .map(|(row, (value, index))| Quantity {
                name: format!("{kind}[{}]", self.names[row]),
                unit: unit(row).map(|unit| unit.to_string()),
                value,
                index,
            })
            .collect()
    }

    fn rates(&self, program: &Program) -> Vec<Quantity> {
        let per_second = dimension("1/s");
        let acceleration = |row: usize| {
            let unit = self.dimensions[row]?;
            unit.multiply(per_second?)?.multiply(per_second?)
        };
        let mut rates = self.entries("rates", &program.accelerations, acceleration);
        for (rate, name) in rates.iter_mut().zip(&self.names) {
            rate.name = format!("rates[{name}_dot]");
        }
        let first_order = program.first_order.iter().zip(&program.first_order_rates);
        rates.extend(first_order.map(|(state, value)| {
            Quantity {
                name: format!("rates[{}]", state.name),
                unit: dimension(&state.unit)
                    .and_then(|unit| unit.multiply(per_second?))
                    .map(|unit| unit.to_string()),
                value: *value,
                index: 0,
            }
        }));
        rates
    }

    fn mass_matrix(&self, program: &Program) -> Vec<Quantity> {
        let mut all = Vec::new();
        for row in 0..self.names.len() {
            for column in row..self.names.len() {
                let Some((value, index)) = self.find_mass_entry(program, row, column) else {
                    continue;
                };
                let unit = || {
                    let (second, joule) = (dimension("s")?, dimension("J")?);
                    let both = self.dimensions[row]?.multiply(self.dimensions[column]?)?;
                    joule.multiply(second.multiply(second)?)?.divide(both)
                };
                all.push(Quantity {
                    name: format!("mass_matrix[{}, {}]", self.names[row], self.names[column]),
                    unit: unit().map(|unit| unit.to_string()),
                    value,
                    index,
                });
            }
        }
        all
    }

    /// Returns value and index of an entry of the mass matrix; `None` if it is always 0.
    fn find_mass_entry(
        &self,
        program: &Program,
        row: usize,
        column: usize,
    ) -> Option<(ValueId, usize)> {
        let mass = &program.mass;
        let mode = |place: usize| Some(self.modes[place.checked_sub(self.scalars)?]);
        match (mode(row), mode(column)) {
            (None, None) => Some((mass.scalars[row][column], 0)),
            (None, Some((field, index))) => Some((mass.coupling[row][field], index)),
            (Some((first, r)), Some((second, c))) => {
                let block = mass.modal[first][second]?;
                Some((block, r * program.fields[second].order + c))
            }
            (Some(_), None) => None,
        }
    }
}
