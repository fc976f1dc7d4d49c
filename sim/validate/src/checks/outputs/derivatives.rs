//! Comparison of Jacobians and their products with directional differences of the oracle's rows.

use super::check_context::CheckContext;
use super::directions::VariableKind;
use super::rows::{
    DIFFERENCE_TOLERANCE, OutputFindings, STEPS, relative_deviation, worst_deviation,
};
use crate::differences::{DifferencePoint, Direction, Slope};
use crate::oracle::Equations;
use crate::outputs::{JACOBIANS, Outputs};
use crate::random::Random;
use crate::sampler::Sample;
use eomgen_model_spec::model::Model;
use nalgebra::{DMatrix, DVector};

pub(super) struct OutputValues {
    mass: DMatrix<f64>,
    jacobians: Vec<(&'static str, DMatrix<f64>)>,
    /// Random multipliers mu, one per row of the equations.
    multipliers: DVector<f64>,
    /// Weights M mu of the rates.
    weights: Vec<f64>,
    weighted_by_state_and_inputs: Option<(Vec<f64>, Vec<f64>)>,
    weighted_by_parameters: Option<Vec<f64>>,
    /// Indices of the independent parameters among all.
    independent_parameters: Vec<usize>,
}

impl OutputValues {
    pub fn new(
        judged: &CheckContext<'_>,
        equations: &Equations,
        outputs: &mut dyn Outputs,
        sample: &Sample,
        random: &mut Random,
    ) -> Self {
        let mass = equations.mass.clone();
        let scales = equations.residuals(&[]);
        // If the accelerations have the weights M mu, the weighted rates equal mu times the rows.
        let multipliers = DVector::from_iterator(
            scales.len(),
            scales.iter().map(|row| {
                let scale = if row.scale > 0.0 { row.scale } else { 1.0 };
                random.away_from_zero() / scale
            }),
        );
        let velocities = sample.state.iter().skip(mass.nrows()).take(mass.nrows());
        let mut weights: Vec<f64> = velocities
            .map(|rate| random.away_from_zero() / rate.abs().max(f64::MIN_POSITIVE))
            .collect();
        let (of_degrees, of_states) = multipliers.as_slice().split_at(mass.nrows());
        weights.extend((&mass * DVector::from_column_slice(of_degrees)).iter());
        weights.extend(of_states);
        let jacobians = JACOBIANS.iter().filter_map(|name| {
            let found = outputs.jacobian(name, sample)?;
            Some((*name, found))
        });
        Self {
            jacobians: jacobians.collect(),
            weighted_by_state_and_inputs: outputs.vector_jacobian_product(sample, &weights),
            weighted_by_parameters: outputs.vector_jacobian_product_by_parameters(sample, &weights),
            independent_parameters: parameter_indices(judged.model, &outputs.parameter_names()),
            mass,
            multipliers,
            weights,
        }
    }
}

pub(super) fn parameter_indices(model: &Model, names: &[String]) -> Vec<usize> {
    let place = |name: &String| {
        model
            .parameters
            .iter()
            .position(|known| known.name == *name)
    };
    names.iter().filter_map(place).collect()
}

/// Compares all values along one direction. The smallest deviation of several step sizes counts.
pub(super) fn compare_along(
    rows: &mut OutputFindings,
    surroundings: &DifferencePoint<'_>,
    known: &OutputValues,
    outputs: &mut dyn Outputs,
    (moved, direction): &(VariableKind, Direction),
    place: &str,
) {
    let Direction { state, inputs, .. } = direction;
    let product = match moved {
        VariableKind::Parameters => None,
        _ => outputs.jacobian_vector_product(surroundings.sample, state, inputs),
    };
    let mut best: Vec<(&str, Vec<f64>)> = Vec::new();
    for step in STEPS {
        let Some(slopes) = surroundings.slopes(direction, step) else {
            continue;
        };
        let found = known.deviations(*moved, direction, product.as_deref(), &slopes);
        if best.is_empty() {
            best = found;
        } else {
            for ((_, best), (_, found)) in best.iter_mut().zip(found) {
                for (best, found) in best.iter_mut().zip(found) {
                    *best = best.min(found);
                }
            }
        }
        if best
            .iter()
            .flat_map(|(_, rows)| rows)
            .all(|row| *row < 0.01 * DIFFERENCE_TOLERANCE)
        {
            break;
        }
    }
    for (name, deviations) in best {
        rows.include(
            name,
            DIFFERENCE_TOLERANCE,
            worst_deviation(deviations),
            place,
        );
    }
}

impl OutputValues {
    fn deviations(
        &self,
        moved: VariableKind,
        direction: &Direction,
        product: Option<&[f64]>,
        slopes: &[Slope],
    ) -> Vec<(&'static str, Vec<f64>)> {
        let by = match moved {
            VariableKind::State => ("_by_state", &direction.state),
            VariableKind::Inputs => ("_by_inputs", &direction.inputs),
            VariableKind::Parameters => ("_by_parameters", &self.independent_entries(direction)),
        };
        let mut found = Vec::new();
        for (name, jacobian) in &self.jacobians {
            if !name.ends_with(by.0) {
                continue;
            }
            let change = multiply(jacobian, by.1);
            found.push((
                *name,
                if name.starts_with("rates") {
                    self.rate_deviations(&change, direction, slopes)
                } else {
                    observable_deviations(&change, &slopes[self.multipliers.len()..])
                },
            ));
        }
        if let Some(product) = product {
            found.push((
                "jacobian_vector_product",
                self.rate_deviations(product, direction, slopes),
            ));
        }
        let weighted = match moved {
            VariableKind::State => self
                .weighted_by_state_and_inputs
                .as_ref()
                .map(|found| &found.0),
            VariableKind::Inputs => self
                .weighted_by_state_and_inputs
                .as_ref()
                .map(|found| &found.1),
            VariableKind::Parameters => self.weighted_by_parameters.as_ref(),
        };
        if let Some(weighted) = weighted {
            let name = match moved {
                VariableKind::Parameters => "vector_jacobian_product_by_parameters",
                _ => "vector_jacobian_product",
            };
            found.push((
                name,
                vec![self.weighted_deviation(weighted, by.1, direction, slopes)],
            ));
        }
        found
    }

    fn independent_entries(&self, direction: &Direction) -> Vec<f64> {
        let places = self.independent_parameters.iter();
        places.map(|place| direction.parameters[*place]).collect()
    }

    /// Returns the deviations of the rates: M times the change of the accelerations must cancel the change of the rows.
    fn rate_deviations(&self, change: &[f64], direction: &Direction, slopes: &[Slope]) -> Vec<f64> {
        let size = self.mass.nrows();
        let count = size + self.multipliers.len();
        if change.len() != count {
            return vec![f64::INFINITY; count];
        }
        let (velocities, rest) = change.split_at(size);
        let (accelerations, first_order) = rest.split_at(size);
        let same = velocities.iter().zip(&direction.state[size..]);
        let mut found: Vec<f64> = same
            .map(|(found, by)| relative_deviation(found - by, *by))
            .collect();
        for (row, slope) in slopes.iter().take(size).enumerate() {
            let masses = self.mass.row(row);
            let addends = masses.iter().zip(accelerations).map(|(mass, a)| mass * a);
            let scale = addends
                .clone()
                .fold(slope.scale, |scale, a| scale.max(a.abs()));
            found.push(relative_deviation(
                addends.sum::<f64>() + slope.value,
                scale,
            ));
        }
        for (rate, slope) in first_order.iter().zip(&slopes[size..]) {
            found.push(relative_deviation(
                rate + slope.value,
                slope.scale.max(rate.abs()),
            ));
        }
        found
    }

    /// Returns the deviation between the changes of the weighted rates and of the weighted rows.
    fn weighted_deviation(
        &self,
        weighted: &[f64],
        by: &[f64],
        direction: &Direction,
        slopes: &[Slope],
    ) -> f64 {
        if weighted.len() != by.len() {
            return f64::INFINITY;
        }
        let size = self.mass.nrows();
        let (mut found, mut scale) = (0.0, 0.0_f64);
        for (weighted, by) in weighted.iter().zip(by) {
            found += weighted * by;
            scale = scale.max((weighted * by).abs());
        }
        for (weight, by) in self.weights[..size].iter().zip(&direction.state[size..]) {
            found -= weight * by;
            scale = scale.max((weight * by).abs());
        }
        for (multiplier, slope) in self.multipliers.iter().zip(slopes) {
            found += multiplier * slope.value;
            scale = scale.max(multiplier.abs() * slope.scale);
        }
        relative_deviation(found, scale)
    }
}

/// Returns the product of a matrix and a vector; NaN in every row if the sizes do not match.
pub(super) fn multiply(matrix: &DMatrix<f64>, vector: &[f64]) -> Vec<f64> {
    if matrix.ncols() != vector.len() {
        return vec![f64::NAN; matrix.nrows()];
    }
    let product = matrix * DVector::from_column_slice(vector);
    product.as_slice().to_vec()
}

pub(super) fn observable_deviations(change: &[f64], slopes: &[Slope]) -> Vec<f64> {
    if change.len() != slopes.len() {
        return vec![f64::INFINITY; slopes.len()];
    }
    let pairs = change.iter().zip(slopes);
    pairs
        .map(|(found, slope)| relative_deviation(found - slope.value, slope.scale.max(found.abs())))
        .collect()
}
