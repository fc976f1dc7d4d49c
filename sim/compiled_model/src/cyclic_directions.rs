//! Cyclic directions: displacements on which no rate depends. Along them a machine can turn or travel steadily.
//!
//! A displacement q + s n along a cyclic direction n changes no acceleration, for any s. A coordinate that the
//! equations do not contain is a cyclic direction; two wheels that roll on each other share one. The candidates span
//! the null space of the derivatives of the accelerations with respect to the coordinates. Finite displacements from
//! the state and from a displaced state confirm each candidate.

use eomgen_codegen::independence::vectors::find_max_magnitude;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::dimension::Dimension;

use crate::displacements::generic_weight;
use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::OperatingPoint;

/// Pivots below this fraction of the largest entry count as 0.
const MIN_PIVOT: f64 = 1e-10;

/// Largest change of a rate that counts as zero, relative to its largest term.
const MAX_UNCHANGED_FRACTION: f64 = 1e-9;

/// Displacements along a candidate, relative to the scale of its coordinate.
/// They cover a turn of an angle.
const DISPLACEMENTS: [f64; 12] = [
    0.37, 0.8, 1.2, 1.57, 2.0, 2.5, 3.0, -0.4, -0.9, -1.5, -2.0, -2.6,
];

/// Displacement of the second state at which cyclic directions are confirmed, relative to natural scales or typical
/// sizes.
const NEIGHBOUR_FRACTION: f64 = 0.1;

/// Accelerations and rates of first-order states at a state.
struct SizedRates {
    rates: Vec<f64>,
    /// Derivatives with respect to the coordinates.
    rows: Vec<Vec<f64>>,
    /// Largest term of each rate at the state itself, without displacement.
    sizes: Vec<f64>,
}

impl SizedRates {
    fn is_finite(&self) -> bool {
        let all = self.rows.iter().flatten().chain(&self.rates);
        all.into_iter().all(|entry| entry.is_finite())
    }
}

impl Instance<'_> {
    /// Finds the independent cyclic directions at a state. Each direction has one entry per coordinate and mode in SI
    /// units; one entry is 1.
    ///
    /// # Errors
    /// See [`Instance::jacobian_evaluator`].
    pub fn find_cyclic_directions(&self, at: &OperatingPoint) -> Result<Vec<Vec<f64>>, Error> {
        let degrees = self.model().program().degrees_of_freedom();
        let scales = self.compute_natural_scales()?;
        let here = self.evaluate_sized_rates(at, &scales)?;
        if !here.is_finite() {
            return Ok(Vec::new());
        }
        let mut found = compute_null_space_basis(&here.rows, degrees);
        if found.is_empty() {
            return Ok(found);
        }
        // At a symmetric state the derivative with respect to a coordinate may vanish although the equations contain
        // the coordinate.
        let mut moved = at.clone();
        for (value, part) in moved.state.iter_mut().zip(self.generic_direction()?) {
            *value += NEIGHBOUR_FRACTION * part;
        }
        let there = self.evaluate_sized_rates(&moved, &scales)?;
        let mut points = vec![(at, here)];
        if there.is_finite() {
            points.push((&moved, there));
        }
        let mut evaluator = self.interpreter()?;
        found.retain(|direction| {
            let mut points = points.iter();
            points.all(|(at, rates)| self.is_cyclic(&mut evaluator, at, rates, direction, &scales))
        });
        Ok(found)
    }

    /// Returns a direction of states; each entry is 0.5 to 1.5 times its natural scale or typical size. The direction
    /// is parallel to no surface that is simple in the coordinates.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub(crate) fn generic_direction(&self) -> Result<Vec<f64>, Error> {
        let scales = self.compute_natural_scales()?;
        let sizes = self.model().typical_sizes().iter().enumerate();
        let part = |(place, size): (usize, &f64)| {
            generic_weight(place) * scales.get(place).copied().flatten().unwrap_or(*size)
        };
        Ok(sizes.map(part).collect())
    }

    /// Returns the rates at a state with their derivatives and their largest terms.
    fn evaluate_sized_rates(
        &self,
        at: &OperatingPoint,
        scales: &[Option<f64>],
    ) -> Result<SizedRates, Error> {
        let degrees = self.model().program().degrees_of_freedom();
        let rates = self.compute_accelerations(&mut self.interpreter()?, at);
        let matrix = self.state_space_evaluator()?.evaluate(at.point())?.a;
        let states = at.state.len();
        let row = |row: usize| &matrix[(degrees + row) * states..][..states];
        let rows: Vec<Vec<f64>> = (0..rates.len())
            .map(|r| row(r)[..degrees].to_vec())
            .collect();
        let sizes = (0..rates.len()).map(|r| {
            let terms = row(r).iter().zip(&at.state);
            let terms = terms.map(|(entry, value)| (entry * value).abs());
            // At symmetric positions all terms may vanish; the scaled derivatives do not.
            let scaled = rows[r].iter().zip(scales);
            let scaled = scaled.map(|(entry, scale)| (entry * scale.unwrap_or(0.0)).abs());
            terms.chain(scaled).fold(rates[r].abs(), f64::max)
        });
        let sizes = sizes.collect();
        Ok(SizedRates { rates, rows, sizes })
    }

    /// Returns true if no displacement along a direction changes a rate.
    fn is_cyclic(
        &self,
        evaluator: &mut Evaluator,
        at: &OperatingPoint,
        here: &SizedRates,
        direction: &[f64],
        scales: &[Option<f64>],
    ) -> bool {
        let first = direction.iter().position(|speed| *speed == 1.0);
        let first = first.unwrap_or(0);
        DISPLACEMENTS.iter().all(|part| {
            let way = part * scales[first].unwrap_or(1.0);
            let mut moved = at.clone();
            for (value, speed) in moved.state.iter_mut().zip(direction) {
                *value += way * speed;
            }
            let there = self.compute_accelerations(evaluator, &moved);
            (0..there.len()).all(|r| {
                let added = here.rows[r].iter().zip(direction);
                let added = added.map(|(entry, speed)| (entry * way * speed).abs());
                let size = added.fold(here.sizes[r], f64::max);
                (here.rates[r] - there[r]).abs() <= MAX_UNCHANGED_FRACTION * size
            })
        })
    }

    /// Returns true if a full turn of a coordinate changes no rate at the given points.
    ///
    /// # Errors
    /// See [`Instance::evaluator`].
    pub fn repeats_after_turn(
        &self,
        coordinate: usize,
        points: &[OperatingPoint],
    ) -> Result<bool, Error> {
        let mut evaluator = self.interpreter()?;
        // Without Jacobians, the terms of the rates are unknown.
        let mut state_space = self.state_space_evaluator().ok();
        let mut pairs = Vec::with_capacity(points.len());
        let mut sizes = Vec::with_capacity(points.len());
        for at in points {
            let mut turned = at.clone();
            turned.state[coordinate] += std::f64::consts::TAU;
            pairs.push([at, &turned].map(|at| self.compute_accelerations(&mut evaluator, at)));
            // In steady motion the terms of a rate cancel. The derivative times one radian does not cancel.
            let matrix = state_space
                .as_mut()
                .and_then(|found| found.evaluate(at.point()).ok());
            let degrees = self.model().program().degrees_of_freedom();
            sizes.push(matrix.map_or(Vec::new(), |matrix| {
                let rows = matrix.a.chunks_exact(at.state.len()).skip(degrees);
                rows.map(|row| row[coordinate].abs()).collect()
            }));
        }
        let count = pairs.first().map_or(0, |[rates, _]| rates.len());
        Ok((0..count).all(|row| {
            let terms = sizes.iter().filter_map(|sizes: &Vec<f64>| sizes.get(row));
            let size = pairs
                .iter()
                .map(|[rates, _]| rates[row].abs())
                .chain(terms.copied())
                .fold(0.0, f64::max);
            let mut differences = pairs.iter().map(|[a, b]| (a[row] - b[row]).abs());
            differences.all(|difference| difference <= MAX_UNCHANGED_FRACTION * size)
        }))
    }

    /// Returns true if a coordinate is dimensionless, as an angle is.
    pub fn is_angle(&self, coordinate: usize) -> bool {
        let mut units = self.model().model().coordinates.iter();
        units
            .nth(coordinate)
            .is_some_and(|known| known.unit.dimension.is_dimensionless())
    }

    /// Returns the accelerations and the rates of first-order states.
    fn compute_accelerations(&self, evaluator: &mut Evaluator, at: &OperatingPoint) -> Vec<f64> {
        let mut rates = vec![0.0; at.state.len()];
        let OperatingPoint { t, state, inputs } = at;
        evaluator.rates(
            Point {
                t: *t,
                state,
                inputs,
            },
            &mut rates,
        );
        rates.split_off(self.model().program().degrees_of_freedom())
    }

    /// Returns natural scales of displacements for coordinates and modes, SI: the width of the declared range, 1 for a
    /// dimensionless quantity, otherwise `None`.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub(crate) fn compute_natural_scales(&self) -> Result<Vec<Option<f64>>, Error> {
        let model = self.model().model();
        let ranges = model
            .coordinate_ranges()
            .map_err(|error| Error::from_model_error(model, error))?;
        let of_kind = |dimension: Dimension| dimension.is_dimensionless().then_some(1.0);
        let coordinates = model
            .coordinates
            .iter()
            .zip(ranges)
            .map(|(coordinate, range)| {
                let width = range.map(|(low, high)| high - low);
                width.or(of_kind(coordinate.unit.dimension))
            });
        let fields = model.fields.iter().zip(self.model().orders());
        let modes = fields
            .flat_map(|(field, order)| std::iter::repeat_n(of_kind(field.unit.dimension), *order));
        Ok(coordinates.chain(modes).collect())
    }
}

/// Returns a basis of the null space of a matrix given by rows. Each vector has a 1 at an index at which the others are
/// 0. Rows and columns may have different units.
fn compute_null_space_basis(rows: &[Vec<f64>], columns: usize) -> Vec<Vec<f64>> {
    let row_sizes = rows.iter().map(find_max_magnitude);
    let mut matrix: Vec<Vec<f64>> = rows
        .iter()
        .zip(row_sizes)
        .filter(|(_, size)| *size > 0.0)
        .map(|(row, size)| row.iter().map(|entry| entry / size).collect())
        .collect();
    let units: Vec<f64> = (0..columns)
        .map(
            |column| match find_max_magnitude(matrix.iter().map(|row| &row[column])) {
                0.0 => 1.0,
                size => 1.0 / size,
            },
        )
        .collect();
    for row in &mut matrix {
        row.iter_mut()
            .zip(&units)
            .for_each(|(entry, unit)| *entry *= unit);
    }
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    let is_taken = |pivots: &[(usize, usize)], row| pivots.iter().any(|(taken, _)| *taken == row);
    loop {
        let free = (0..matrix.len()).filter(|row| !is_taken(&pivots, *row));
        let entries = free.flat_map(|row| (0..columns).map(move |column| (row, column)));
        let best = entries.max_by(|a, b| matrix[a.0][a.1].abs().total_cmp(&matrix[b.0][b.1].abs()));
        let Some((row, column)) = best.filter(|(r, c)| matrix[*r][*c].abs() > MIN_PIVOT) else {
            break;
        };
        let pivot = matrix[row][column];
        let reduced: Vec<f64> = matrix[row].iter().map(|entry| entry / pivot).collect();
        for (other, entries) in matrix.iter_mut().enumerate() {
            let factor = entries[column];
            if other == row || factor == 0.0 {
                continue;
            }
            for (entry, from) in entries.iter_mut().zip(&reduced) {
                *entry -= factor * from;
            }
            entries[column] = 0.0;
        }
        matrix[row] = reduced;
        pivots.push((row, column));
    }
    let free = (0..columns).filter(|column| pivots.iter().all(|(_, taken)| taken != column));
    free.map(|column| {
        let mut direction = vec![0.0; columns];
        direction[column] = 1.0;
        for (row, pivot) in &pivots {
            direction[*pivot] = -matrix[*row][column] * units[*pivot] / units[column];
        }
        direction
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use crate::{CompiledModel, Orders};

    /// Specification of two wheels in elastic contact that turn together, an unrestrained rack and a pendulum.
    const MACHINE: &str = r#"
[model]
name = "machine"
[parameters]
J = { value = 2, unit = "kg m^2" }
m = { value = 3, unit = "kg" }
r_1 = { value = 50, unit = "mm" }
r_2 = { value = 150, unit = "mm" }
k = { value = 1e6, unit = "N/m" }
w = { value = 4, unit = "N m" }
[coordinates]
phi_1 = { unit = "rad", initial = 0.3 }
phi_2 = { unit = "rad", initial = 0.2 }
x = { unit = "m" }
theta = { unit = "rad", initial = "pi/2" }
[kinetic]
wheels = "1/2*J*(dot(phi_1)^2 + dot(phi_2)^2)"
rack = "1/2*m*dot(x)^2"
pendulum = "1/2*J*dot(theta)^2"
[potential]
contact = "1/2*k*(r_1*phi_1 - r_2*phi_2)^2"
weight = "-w*cos(theta)"
"#;

    #[test]
    fn coordinate_that_drops_out_at_one_state_is_not_cyclic() {
        // The stiffness depends on the angle, but the rates do not depend on it at x = 0.
        let text = "[model]\nname = \"mathieu\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                    J = { value = 1000, unit = \"kg m^2\" }\nk = { value = 100, unit = \"N/m\" }\n\
                    [coordinates]\nx = { unit = \"m\" }\na = { unit = \"rad\", initial_rate = 10 }\n\
                    b = { unit = \"rad\" }\n\
                    [kinetic]\nT = \"1/2*m*dot(x)^2 + 1/2*J*(dot(a)^2 + dot(b)^2)\"\n\
                    [potential]\nV = \"1/2*k*(1 + 0.5*cos(2*a))*x^2\"\n";
        let model = CompiledModel::from_text("mathieu.toml", text, Orders::Declared);
        let model = model.expect("a model");
        let run = model.with_declared_parameters().expect("an instance");
        let at = run.operating_point(&[]).expect("a point");
        let found = run.find_cyclic_directions(&at).expect("directions");
        assert_eq!(found, [[0.0, 0.0, 1.0]]);
    }

    #[test]
    fn coupled_wheels_and_free_rack_are_cyclic_directions() {
        let model = CompiledModel::from_text("machine.toml", MACHINE, Orders::Declared);
        let model = model.expect("a model");
        let run = model.with_declared_parameters().expect("an instance");
        let at = run.operating_point(&[]).expect("a point");
        let found = run.find_cyclic_directions(&at).expect("directions");
        assert_eq!(found.len(), 2, "{found:?}");
        let wheels = found
            .iter()
            .find(|direction| direction[2] == 0.0)
            .expect("the wheels");
        assert!(
            (wheels[0] / wheels[1] - 3.0).abs() < 1e-9 && wheels[3] == 0.0,
            "{wheels:?}"
        );
        assert!(found.contains(&vec![0.0, 0.0, 1.0, 0.0]), "{found:?}");
        let points = [at];
        let repeats = |coordinate| {
            run.repeats_after_turn(coordinate, &points)
                .expect("an answer")
        };
        assert_eq!([0, 1, 3].map(repeats), [false, false, true]);
    }
}
