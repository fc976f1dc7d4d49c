//! What was requested beside the rates, against the oracle: inverse dynamics and bias forces
//! by its mass matrix and forces, Jacobians and their products by differences of its rows
//! along directions, the guards' rates by differences of the guards along its motion.

use super::super::certificate::{Check, Worst};
use super::super::differences::{Direction, Slope, Surroundings, slopes};
use super::super::oracle::{Equations, Oracle, OracleError};
use super::super::random::Random;
use super::super::requested::{JACOBIANS, Requested};
use super::super::sampler::{Sample, Sampler};
use super::super::sizes;
use super::super::variant::Variant;
use super::ROW_TOLERANCE;
use model_spec::model::{Model, ParameterValue};
use nalgebra::{DMatrix, DVector};

/// Deviation from a difference that passes, relative to the largest term of the row for a
/// change of the variable by its own size. The rows are known to 1e-14 of that; the longest
/// step that is tried divides it by 1/16, the shortest by 1/65536.
pub const DIFFERENCE_TOLERANCE: f64 = 1e-9;
/// The steps, in sizes of the variables: a long one for what is smooth, short ones for what
/// is not smooth as far.
const STEPS: [f64; 5] = [
    1.0 / 16.0,
    1.0 / 128.0,
    1.0 / 1024.0,
    1.0 / 8192.0,
    1.0 / 65536.0,
];
/// The most states, each of a regime of its own; with fewer regimes, the fewest.
const STATES: (usize, usize) = (9, 4);
/// The most directions at a state; of more variables, this many are drawn.
const DIRECTIONS: usize = 40;
/// The most coordinates with which all those are tried, and directions with more.
const SMALL: (usize, usize) = (12, 8);
/// The seed of states and directions.
const SEED: u64 = 0x4e0b_1a75;

/// What is judged.
pub(in super::super) struct Judged<'j> {
    /// The oracle.
    pub oracle: &'j Oracle,
    /// The model it was made of, its order and all parameters in SI.
    pub model: &'j Model,
    /// The order.
    pub order: usize,
    /// All parameters in SI.
    pub parameters: &'j [f64],
}

/// The checks of everything that was requested.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`].
pub(in super::super) fn check(
    judged: &Judged<'_>,
    variant: &mut dyn Variant,
    requested: &mut dyn Requested,
) -> Result<Vec<Check>, OracleError> {
    let names = requested.names();
    let mut rows = Rows::default();
    let mut random = Random::new(SEED);
    let samples = samples(judged.oracle)?;
    for (count, sample) in (1..).zip(&samples) {
        let place = format!("state {count}");
        let equations = judged
            .oracle
            .equations(sample.time, &sample.state, &sample.inputs)?;
        forces(
            &mut rows,
            &equations,
            requested,
            sample,
            &mut random,
            &place,
        );
        guard_rates(&mut rows, judged.oracle, variant, requested, sample, &place)?;
        let Some(accelerations) = equations.accelerations() else {
            continue;
        };
        let surroundings = Surroundings {
            oracle: judged.oracle,
            model: judged.model,
            order: judged.order,
            parameters: judged.parameters,
            sample,
            accelerations: accelerations.as_slice().to_vec(),
        };
        let known = Known::new(judged, &equations, requested, sample, &mut random);
        for direction in directions(judged, &names, count <= 2, &mut random)? {
            along(
                &mut rows,
                &surroundings,
                &known,
                requested,
                &direction,
                &place,
            );
        }
    }
    Ok(rows.into_checks(judged, &names, samples.len()))
}

/// Random states in several regimes.
fn samples(oracle: &Oracle) -> Result<Vec<Sample>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let (most, fewest) = STATES;
    let mut samples = Vec::new();
    let regimes = sampler.regimes()?;
    for regime in regimes
        .iter()
        .cycle()
        .take(regimes.len().clamp(fewest, most))
    {
        samples.extend(sampler.draw_in(regime)?.map(|drawn| drawn.sample));
    }
    Ok(samples)
}

/// Bias forces, and inverse dynamics at random accelerations.
fn forces(
    rows: &mut Rows,
    equations: &Equations,
    requested: &mut dyn Requested,
    sample: &Sample,
    random: &mut Random,
    place: &str,
) {
    let mut compare = |name, accelerations: &[f64], found: Option<Vec<f64>>| {
        let Some(found) = found else { return };
        let expected = equations.residuals(accelerations);
        let deviations = expected.iter().enumerate().map(|(row, expected)| {
            let found = found.get(row).copied().unwrap_or(f64::NAN);
            relative(found - expected.value, expected.scale)
        });
        rows.include(name, ROW_TOLERANCE, worst(deviations), place);
    };
    let still = vec![0.0; equations.size()];
    compare("bias_forces", &still, requested.bias_forces(sample));
    // As large as those of the motion, so that no row is inertia alone.
    let accelerations: Vec<f64> = match equations.accelerations() {
        Some(own) => own.iter().map(|a| a * random.away_from_zero()).collect(),
        None => still.iter().map(|_| random.away_from_zero()).collect(),
    };
    let found = requested.inverse_dynamics(sample, &accelerations);
    compare("inverse_dynamics", &accelerations, found);
}

/// The guards' rates against differences of the guards along the oracle's motion.
fn guard_rates(
    rows: &mut Rows,
    oracle: &Oracle,
    variant: &mut dyn Variant,
    requested: &mut dyn Requested,
    sample: &Sample,
    place: &str,
) -> Result<(), OracleError> {
    let Some(found) = requested
        .guard_rates(sample)
        .filter(|rates| !rates.is_empty())
    else {
        return Ok(());
    };
    let equations = oracle.equations(sample.time, &sample.state, &sample.inputs)?;
    let Some(accelerations) = equations.accelerations() else {
        return Ok(());
    };
    let rates = [&sample.state[oracle.size()..], accelerations.as_slice()].concat();
    let sizes = sizes::of_state(oracle)?;
    let fastest = rates
        .iter()
        .zip(&sizes)
        .map(|(rate, size)| (rate / size).abs());
    // The time in which no entry of the state moves by more than its size.
    let time = fastest.fold(1.0, f64::max).recip();
    let mut best = vec![f64::INFINITY; found.len()];
    for step in STEPS {
        let expected = slopes(step, |length| {
            let moved = length * time;
            let state = sample.state.iter().zip(&rates);
            let state: Vec<f64> = state.map(|(x, rate)| x + moved * rate).collect();
            let guards = variant
                .guards(sample.time + moved, &state, &sample.inputs)
                .ok()?;
            let slope = |value: f64| Slope {
                value,
                scale: value.abs(),
            };
            Some(guards.into_iter().map(slope).collect())
        });
        let Some(expected) = expected.filter(|expected| expected.len() == found.len()) else {
            continue;
        };
        for (best, (found, expected)) in best.iter_mut().zip(found.iter().zip(expected)) {
            let change = found * time;
            let scale = expected.scale.max(change.abs());
            *best = best.min(relative(change - expected.value, scale));
        }
    }
    rows.include("guard_rates", DIFFERENCE_TOLERANCE, worst(best), place);
    Ok(())
}

/// What is compared along every direction from one state.
struct Known {
    /// The oracle's mass matrix.
    mass: DMatrix<f64>,
    /// Jacobians by name.
    jacobians: Vec<(&'static str, DMatrix<f64>)>,
    /// One number per row of the equations.
    multipliers: DVector<f64>,
    /// The weights of the rates that belong to these.
    weights: Vec<f64>,
    by_state_and_inputs: Option<(Vec<f64>, Vec<f64>)>,
    by_parameters: Option<Vec<f64>>,
    /// Places of the independent parameters among all.
    independent: Vec<usize>,
}

impl Known {
    fn new(
        judged: &Judged<'_>,
        equations: &Equations,
        requested: &mut dyn Requested,
        sample: &Sample,
        random: &mut Random,
    ) -> Self {
        let mass = equations.mass.clone();
        let scales = equations.residuals(&vec![0.0; equations.size()]);
        // Weights M mu of the accelerations: mu times the rows says what their sum is.
        let multipliers = DVector::from_iterator(
            scales.len(),
            scales.iter().map(|row| {
                let scale = if row.scale > 0.0 { row.scale } else { 1.0 };
                random.away_from_zero() / scale
            }),
        );
        let velocities = sample.state.iter().skip(scales.len());
        let mut weights: Vec<f64> = velocities
            .map(|rate| random.away_from_zero() / rate.abs().max(f64::MIN_POSITIVE))
            .collect();
        weights.extend((&mass * &multipliers).iter());
        let jacobians = JACOBIANS.iter().filter_map(|name| {
            let found = requested.jacobian(name, sample)?;
            Some((*name, found))
        });
        Self {
            jacobians: jacobians.collect(),
            by_state_and_inputs: requested.vector_jacobian_product(sample, &weights),
            by_parameters: requested.vector_jacobian_product_by_parameters(sample, &weights),
            independent: places(judged.model, &requested.parameter_names()),
            mass,
            multipliers,
            weights,
        }
    }
}

/// Places of these names among a model's parameters.
fn places(model: &Model, names: &[String]) -> Vec<usize> {
    let place = |name: &String| {
        model
            .parameters
            .iter()
            .position(|known| known.name == *name)
    };
    names.iter().filter_map(place).collect()
}

/// Which variables a direction moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moved {
    State,
    Inputs,
    Parameters,
}

/// Directions in which to differentiate, each in one kind of variables: one variable after
/// the other, of many a few and sums of all.
fn directions(
    judged: &Judged<'_>,
    names: &[String],
    parameters_too: bool,
    random: &mut Random,
) -> Result<Vec<(Moved, Direction)>, OracleError> {
    let wanted = ["jacobians", "linearisation", "products"];
    if !names.iter().any(|name| wanted.contains(&name.as_str())) {
        return Ok(Vec::new());
    }
    let oracle = judged.oracle;
    let (states, inputs) = (2 * oracle.size(), oracle.input_count());
    let still = Direction::still(states, inputs, judged.parameters.len());
    let small = oracle.size() <= SMALL.0;
    let mut found = Vec::new();
    for entries in drawn(&sizes::of_state(oracle)?, small, random) {
        let direction = Direction {
            state: entries,
            ..still.clone()
        };
        found.push((Moved::State, direction));
    }
    for entries in drawn(&vec![1.0; inputs], small, random) {
        let direction = Direction {
            inputs: entries,
            ..still.clone()
        };
        found.push((Moved::Inputs, direction));
    }
    let independent = independent(judged);
    for entries in drawn(&independent, small, random) {
        let direction = Direction {
            parameters: entries,
            ..still.clone()
        };
        if small || parameters_too {
            found.push((Moved::Parameters, direction));
        }
    }
    Ok(found)
}

/// The sizes of independent parameters, 0 for derived ones and for those that are 0, which
/// have no size.
fn independent(judged: &Judged<'_>) -> Vec<f64> {
    let parameters = judged.model.parameters.iter().zip(judged.parameters);
    parameters
        .map(|(parameter, value)| match parameter.value {
            ParameterValue::Number(_) => value.abs(),
            ParameterValue::Expression(_) => 0.0,
        })
        .collect()
}

/// Vectors of these sizes: each entry by itself if there are few.
fn drawn(sizes: &[f64], small: bool, random: &mut Random) -> Vec<Vec<f64>> {
    let alone = |index: usize| {
        let entries = sizes.iter().enumerate();
        let entry = |(other, size): (usize, &f64)| if other == index { *size } else { 0.0 };
        entries.map(entry).collect::<Vec<f64>>()
    };
    let moving: Vec<usize> = (0..sizes.len())
        .filter(|index| sizes[*index] > 0.0)
        .collect();
    if small && moving.len() <= DIRECTIONS {
        return moving.into_iter().map(alone).collect();
    }
    let mut found: Vec<Vec<f64>> = (2..SMALL.1)
        .filter_map(|_| random.pick(&moving).map(|index| alone(*index)))
        .collect();
    for _ in 0..2 {
        found.push(
            sizes
                .iter()
                .map(|size| size * random.away_from_zero())
                .collect(),
        );
    }
    found
}

/// Everything that is known along one direction.
fn along(
    rows: &mut Rows,
    surroundings: &Surroundings<'_>,
    known: &Known,
    requested: &mut dyn Requested,
    (moved, direction): &(Moved, Direction),
    place: &str,
) {
    let Direction { state, inputs, .. } = direction;
    let product = match moved {
        Moved::Parameters => None,
        _ => requested.jacobian_vector_product(surroundings.sample, state, inputs),
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
        rows.include(name, DIFFERENCE_TOLERANCE, worst(deviations), place);
    }
}

impl Known {
    /// How far everything is from what the slopes along a direction say, row by row.
    fn deviations(
        &self,
        moved: Moved,
        direction: &Direction,
        product: Option<&[f64]>,
        slopes: &[Slope],
    ) -> Vec<(&'static str, Vec<f64>)> {
        let by = match moved {
            Moved::State => ("_by_state", &direction.state),
            Moved::Inputs => ("_by_inputs", &direction.inputs),
            Moved::Parameters => ("_by_parameters", &self.of_independent(direction)),
        };
        let mut found = Vec::new();
        for (name, jacobian) in &self.jacobians {
            if !name.ends_with(by.0) {
                continue;
            }
            let change = times(jacobian, by.1);
            found.push((
                *name,
                if name.starts_with("rates") {
                    self.of_rates(&change, direction, slopes)
                } else {
                    of_observables(&change, &slopes[self.mass.nrows()..])
                },
            ));
        }
        if let Some(product) = product {
            found.push((
                "jacobian_vector_product",
                self.of_rates(product, direction, slopes),
            ));
        }
        let weighted = match moved {
            Moved::State => self.by_state_and_inputs.as_ref().map(|found| &found.0),
            Moved::Inputs => self.by_state_and_inputs.as_ref().map(|found| &found.1),
            Moved::Parameters => self.by_parameters.as_ref(),
        };
        if let Some(weighted) = weighted {
            let name = match moved {
                Moved::Parameters => "vector_jacobian_product_by_parameters",
                _ => "vector_jacobian_product",
            };
            found.push((
                name,
                vec![self.of_weights(weighted, by.1, direction, slopes)],
            ));
        }
        found
    }

    /// What a direction does to the independent parameters alone.
    fn of_independent(&self, direction: &Direction) -> Vec<f64> {
        let places = self.independent.iter();
        places.map(|place| direction.parameters[*place]).collect()
    }

    /// Changes of the rates: those of the accelerations must undo the change of the rows.
    fn of_rates(&self, change: &[f64], direction: &Direction, slopes: &[Slope]) -> Vec<f64> {
        let size = self.mass.nrows();
        if change.len() != 2 * size {
            return vec![f64::INFINITY; 2 * size];
        }
        let (velocities, accelerations) = change.split_at(size);
        let same = velocities.iter().zip(&direction.state[size..]);
        let mut found: Vec<f64> = same.map(|(found, by)| relative(found - by, *by)).collect();
        for (row, slope) in slopes.iter().take(size).enumerate() {
            let masses = self.mass.row(row);
            let addends = masses.iter().zip(accelerations).map(|(mass, a)| mass * a);
            let scale = addends
                .clone()
                .fold(slope.scale, |scale, a| scale.max(a.abs()));
            found.push(relative(addends.sum::<f64>() + slope.value, scale));
        }
        found
    }

    /// The change of the weighted rates against that of the weighted rows.
    fn of_weights(
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
        for (weight, by) in self.weights.iter().zip(&direction.state[size..]) {
            found -= weight * by;
            scale = scale.max((weight * by).abs());
        }
        for (multiplier, slope) in self.multipliers.iter().zip(slopes) {
            found += multiplier * slope.value;
            scale = scale.max(multiplier.abs() * slope.scale);
        }
        relative(found, scale)
    }
}

/// A matrix times a vector; not a number for every row if they do not fit.
fn times(matrix: &DMatrix<f64>, vector: &[f64]) -> Vec<f64> {
    if matrix.ncols() != vector.len() {
        return vec![f64::NAN; matrix.nrows()];
    }
    let product = matrix * DVector::from_column_slice(vector);
    product.as_slice().to_vec()
}

fn of_observables(change: &[f64], slopes: &[Slope]) -> Vec<f64> {
    if change.len() != slopes.len() {
        return vec![f64::INFINITY; slopes.len()];
    }
    let pairs = change.iter().zip(slopes);
    pairs
        .map(|(found, slope)| relative(found - slope.value, slope.scale.max(found.abs())))
        .collect()
}

/// |difference|/scale, 0 for no difference at all; no number is infinitely far.
fn relative(difference: f64, scale: f64) -> f64 {
    let ratio = (difference / scale).abs();
    if difference == 0.0 {
        0.0
    } else if ratio.is_nan() {
        f64::INFINITY
    } else {
        ratio
    }
}

fn worst(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, f64::max)
}

/// The worst deviation of each check so far, in the order in which they first came.
#[derive(Default)]
struct Rows {
    found: Vec<(&'static str, f64, Worst)>,
}

impl Rows {
    fn include(&mut self, name: &'static str, tolerance: f64, deviation: f64, place: &str) {
        let worst = Worst::of(deviation, place);
        match self.found.iter_mut().find(|(known, ..)| *known == name) {
            Some((_, _, known)) => known.include(worst),
            None => self.found.push((name, tolerance, worst)),
        }
    }

    /// The checks, with a line for each that could not be made.
    fn into_checks(self, judged: &Judged<'_>, names: &[String], states: usize) -> Vec<Check> {
        let mut checks = Vec::new();
        for name in expected(names) {
            let found = self.found.iter().find(|(known, ..)| *known == name);
            checks.push(match found {
                Some((_, tolerance, worst)) => {
                    Check::made(name, worst.clone().among(states, "states"), *tolerance)
                }
                None => Check::skipped(name, DIFFERENCE_TOLERANCE, reason(judged, name)),
            });
        }
        checks
    }
}

/// The checks that belong to what was requested.
fn expected(names: &[String]) -> Vec<&'static str> {
    let has = |name: &str| names.iter().any(|known| known == name);
    let mut found = Vec::new();
    for name in ["bias_forces", "inverse_dynamics", "guard_rates"] {
        if has(name) {
            found.push(name);
        }
    }
    if has("jacobians") || has("linearisation") {
        found.extend(JACOBIANS);
    }
    if has("products") {
        found.extend([
            "jacobian_vector_product",
            "vector_jacobian_product",
            "vector_jacobian_product_by_parameters",
        ]);
    }
    found
}

/// Why a check that belongs to what was requested was not made.
fn reason(judged: &Judged<'_>, name: &str) -> &'static str {
    if name.ends_with("_by_inputs") && judged.oracle.input_count() == 0 {
        "the model has no input"
    } else if name == "guard_rates" && judged.oracle.switches().is_empty() {
        "the model has no piecewise function"
    } else {
        "no state was found whose neighbours are in its regime"
    }
}
