//! Comparison of two orders. If the added modes have zero amplitude and rate, the remaining rows of the larger order
//! must equal the rows of the smaller order. If all modes are zero, this is the rigid limit.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Oracle, OracleError, Residual};
use super::super::sampler::{Sample, SampledState, Sampler};
use super::super::variant::Variant;
use super::{MASS_TOLERANCE, ROW_TOLERANCE, mass_matrix, matrix_distance, unknowns};
use nalgebra::DMatrix;

const STATES: usize = 50;
const SEED: u64 = 0x0e57_ed00;

/// Compares mass matrices, velocity terms and forces of two orders. `oracle` belongs to the smaller order. The checks
/// have the names `name` with `_mass`, `_bias` and `_forces`.
pub fn check(
    name: &str,
    oracle: &Oracle,
    small: &mut dyn Variant,
    large: &mut dyn Variant,
) -> Result<[Check; 3], OracleError> {
    let mut worst: [Worst; 3] = Default::default();
    let mut sampler = Sampler::new(oracle, SEED)?;
    let kept = kept_rows(oracle.names(), &large.coordinate_names());
    for count in 1..=STATES {
        let Some(drawn) = sampler.draw_inside()? else {
            break;
        };
        let place = format!("state {count} of {STATES}");
        let deviations = compare(&drawn, small, large, &kept);
        for (index, worst) in worst.iter_mut().enumerate() {
            worst.include(match &deviations {
                Ok(deviations) => Worst::from_deviation(deviations[index], place.clone()),
                Err(message) => Worst::from_deviation(f64::INFINITY, message.clone()),
            });
        }
    }
    let [mass, bias, forces] = worst;
    Ok([
        Check::from_deviation(format!("{name}_mass"), mass, MASS_TOLERANCE),
        Check::from_deviation(format!("{name}_bias"), bias, ROW_TOLERANCE),
        Check::from_deviation(format!("{name}_forces"), forces, ROW_TOLERANCE),
    ])
}

fn kept_rows(small: &[String], large: &[String]) -> Vec<Option<usize>> {
    let place = |name| large.iter().position(|other| other == name);
    small.iter().map(place).collect()
}

fn compare(
    SampledState { sample, equations }: &SampledState,
    small: &mut dyn Variant,
    large: &mut dyn Variant,
    kept: &[Option<usize>],
) -> Result<[f64; 3], String> {
    let kept: Option<Vec<usize>> = kept.iter().copied().collect();
    let kept = kept.ok_or("a coordinate of the smaller order is missing in the larger order")?;
    let embedded = Sample {
        state: embed_state(&sample.state, &kept, large.coordinate_names().len()),
        ..sample.clone()
    };
    let own = evaluate_sides(small, sample)?;
    let other = evaluate_sides(large, &embedded)?.select_rows(&kept);
    let found = unknowns(small, sample.time, &sample.state, &sample.inputs)?;
    let scales = equations.residuals(&found);
    let rows = |own: &[f64], other: &[f64]| {
        let pairs = own.iter().zip(other).zip(&scales);
        let deviations = pairs.map(|((own, other), residual)| {
            let value = own - other;
            Residual { value, ..*residual }.relative()
        });
        deviations.fold(0.0, f64::max)
    };
    Ok([
        matrix_distance(&own.mass, &other.mass, equations),
        rows(&own.bias, &other.bias),
        rows(&own.forces, &other.forces),
    ])
}

fn embed_state(state: &[f64], kept: &[usize], size: usize) -> Vec<f64> {
    let mut embedded = vec![0.0; 2 * size];
    let (positions, rest) = state.split_at(kept.len());
    let (rates, first_order) = rest.split_at(kept.len());
    for ((row, position), rate) in kept.iter().zip(positions).zip(rates) {
        embedded[*row] = *position;
        embedded[size + row] = *rate;
    }
    embedded.extend(first_order);
    embedded
}

/// M, c and f of M q'' + c = f.
struct Sides {
    mass: DMatrix<f64>,
    bias: Vec<f64>,
    forces: Vec<f64>,
}

impl Sides {
    fn select_rows(&self, kept: &[usize]) -> Self {
        let rows = |all: &[f64]| kept.iter().map(|row| all[*row]).collect();
        Self {
            mass: DMatrix::from_fn(kept.len(), kept.len(), |row, column| {
                self.mass[(kept[row], kept[column])]
            }),
            bias: rows(&self.bias),
            forces: rows(&self.forces),
        }
    }
}

fn evaluate_sides(variant: &mut dyn Variant, sample: &Sample) -> Result<Sides, String> {
    let Sample {
        time,
        state,
        inputs,
    } = sample;
    let mut bias = vec![f64::NAN; variant.coordinate_names().len()];
    let mut forces = bias.clone();
    variant.bias_and_forces(*time, state, inputs, &mut bias, &mut forces)?;
    Ok(Sides {
        mass: mass_matrix(variant, *time, state, inputs)?,
        bias,
        forces,
    })
}
