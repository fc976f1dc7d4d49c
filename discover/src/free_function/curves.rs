//! Curves: for each pair of a direction (equation, state or input) and a variable, the free
//! function that explains the records best. The responses are those of the model linearised along
//! the reference motion.

use eomgen_codegen::program::evaluator::Point;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::fit_result::Fit;
use crate::free_function::hat_functions::HatFunctions;
use crate::free_function::reference_motion::{ReferenceMotion, ReferenceRecord};
use crate::free_function::scene::Scene;
use crate::free_function::segments::{Drive, Products, Segments};
use crate::ids::EquationId;
use crate::residual_force::equations::{EquationEvaluator, EquationSet};
use crate::thresholds;

/// Free function of a variable in an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the equation, state or input to which the function is added.
    pub equation: String,
    /// Variable of the function.
    pub variable: String,
    /// Unit of the variable.
    pub variable_unit: String,
    /// Unit of the function.
    pub unit: String,
    /// Knots in the unit of the variable, ascending.
    pub knots: Vec<f64>,
    /// Values at the knots; the function is linear between knots.
    pub values: Vec<f64>,
    /// Standard deviation of each value.
    pub band: Vec<f64>,
    /// True if the variable belongs to the direction, for example the rate of an equation.
    pub is_own_variable: bool,
    /// RMS residual of the training records, in standard deviations of the noise.
    pub train_rms: f64,
    /// RMS residual of the test records, in standard deviations of the noise.
    pub test_rms: f64,
    /// Increase of the logarithm of the evidence compared with the model without a function.
    pub log_evidence: f64,
}

/// Quantity to which the free function is added.
#[derive(Clone, Debug)]
enum Direction {
    /// Force in an equation.
    Equation(EquationId),
    /// Rate of a first-order state, by its index among the accelerations.
    State(usize),
    /// Input, by its index.
    Input(usize),
}

/// Variable of a function.
#[derive(Clone, Debug, PartialEq)]
enum Variable {
    Position(EquationId),
    Rate(EquationId),
    /// State, by its index.
    State(usize),
    Input(usize),
}

/// Quantity with its name and unit.
#[derive(Clone, Debug)]
struct NamedQuantity<T> {
    of: T,
    name: String,
    unit: String,
}

/// Unit responses and values of the variables along a record, at both ends of each step.
struct RecordSamples {
    /// Accelerations for each direction; one column per end of a step.
    accelerations: Vec<DMatrix<f64>>,
    /// Values of each variable.
    values: Vec<Vec<f64>>,
}

/// Fits a curve for every direction and variable, sorted by decreasing evidence.
pub(crate) fn fit_curves(scene: &Scene<'_>) -> Vec<Curve> {
    let Scene {
        problem,
        fit,
        motion,
        segments,
        ..
    } = scene;
    let Some(equations) = EquationSet::derive_with_springs(problem, fit) else {
        return Vec::new();
    };
    let (directions, variables) = list_pairs(&equations, fit);
    let sampled: Vec<RecordSamples> = motion
        .records
        .iter()
        .map(|record| sample_record(record, &equations, &directions, &variables))
        .collect();
    let pairs: Vec<(usize, usize)> = (0..directions.len())
        .flat_map(|direction| (0..variables.len()).map(move |variable| (direction, variable)))
        .collect();
    let built = pairs.par_iter().filter_map(|(direction, variable)| {
        problem.stop.check_not_stopped().ok()?;
        PairProducts::build(
            motion,
            segments,
            &sampled,
            (*direction, *variable),
            &variables,
        )
    });
    let built: Vec<PairProducts> = built.collect();
    let least =
        |pair: &PairProducts| pair.compute_least_squares() / segments.count_training_values();
    let Some(best) = built.iter().min_by(|a, b| least(a).total_cmp(&least(b))) else {
        return Vec::new();
    };
    // The variance uses the effective sample size. With the plain sample size, every pair would be
    // accepted on coloured noise.
    let drives = best.build_pair_drives(motion, &sampled);
    let none = DMatrix::zeros(drives.len(), drives.len());
    let solution = segments.solve(&best.products, &none);
    let correlation = segments.compute_correlation_length(motion, &drives, &solution);
    let variance = correlation * least(best).max(1.0);
    let curves = built
        .iter()
        .filter_map(|pair| pair.fit(segments, variance, (&directions, &variables)));
    let mut curves: Vec<Curve> = curves.collect();
    curves.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    curves
}

/// Normal equations of one pair of direction and variable.
struct PairProducts {
    direction: usize,
    variable: usize,
    functions: HatFunctions,
    products: Products,
    /// Products of the columns over the training records, with the nuisances eliminated.
    reduced: DMatrix<f64>,
}

/// Lists the directions and variables of a model.
fn list_pairs(
    equations: &EquationSet,
    fit: &Fit,
) -> (Vec<NamedQuantity<Direction>>, Vec<NamedQuantity<Variable>>) {
    let model = fit.model.specification();
    let degrees = fit.model.degrees_of_freedom();
    let (mut directions, mut variables) = (Vec::new(), Vec::new());
    for (number, equation) in equations.list.iter().enumerate() {
        let id = EquationId::new(number);
        directions.push(NamedQuantity {
            of: Direction::Equation(id),
            name: equation.name.clone(),
            unit: equation.force_unit().to_owned(),
        });
        variables.push(NamedQuantity {
            of: Variable::Position(id),
            name: equation.name.clone(),
            unit: equation.unit.to_owned(),
        });
        variables.push(NamedQuantity {
            of: Variable::Rate(id),
            name: format!("dot({})", equation.name),
            unit: equation.rate_unit().to_owned(),
        });
    }
    for (number, state) in model.states.iter().enumerate() {
        let unit = &state.unit.text;
        directions.push(NamedQuantity {
            of: Direction::State(degrees + number),
            name: format!("dot({})", state.name),
            unit: format!("{unit}/s"),
        });
        variables.push(NamedQuantity {
            of: Variable::State(2 * degrees + number),
            name: state.name.clone(),
            unit: unit.clone(),
        });
    }
    for (number, input) in model.inputs.iter().enumerate() {
        // The input is left out if its rates are prescribed too: the rates would not match a
        // changed input.
        if input.rate.is_none() && input.rate_of.is_none() {
            directions.push(NamedQuantity {
                of: Direction::Input(number),
                name: input.name.clone(),
                unit: input.unit.text.clone(),
            });
        }
        variables.push(NamedQuantity {
            of: Variable::Input(number),
            name: input.name.clone(),
            unit: input.unit.text.clone(),
        });
    }
    (directions, variables)
}

fn sample_record(
    record: &ReferenceRecord,
    equations: &EquationSet,
    directions: &[NamedQuantity<Direction>],
    variables: &[NamedQuantity<Variable>],
) -> RecordSamples {
    let mut evaluator = equations.create_evaluator();
    let columns = 2 * record.steps.len();
    let slots = record.steps.first().map_or(0, |step| step.drive.ncols());
    let mut sampled = RecordSamples {
        accelerations: vec![DMatrix::zeros(slots, columns); directions.len()],
        values: vec![vec![0.0; columns]; variables.len()],
    };
    let (mut operating_points, mut unit) = (Vec::new(), Vec::new());
    for column in 0..columns {
        let point = record.end_point(column / 2, column % 2 == 1);
        evaluator.append_operating_points(point, &mut operating_points);
        evaluator.append_accelerations(point, &mut unit);
        for (direction, out) in directions.iter().zip(&mut sampled.accelerations) {
            let own = match direction.of {
                Direction::Equation(id) => {
                    DVector::from_row_slice(&unit[id.index() * slots..(id.index() + 1) * slots])
                }
                Direction::State(slot) => DVector::from_fn(slots, |row, _| match row == slot {
                    true => 1.0,
                    false => 0.0,
                }),
                Direction::Input(input) => respond_to_input(&mut evaluator, point, input, slots),
            };
            out.set_column(column, &own);
        }
        for (variable, out) in variables.iter().zip(&mut sampled.values) {
            out[column] = match variable.of {
                Variable::Position(id) => operating_points[id].position,
                Variable::Rate(id) => operating_points[id].rate,
                Variable::State(state) => point.state[state],
                Variable::Input(input) => point.inputs[input],
            };
        }
    }
    sampled
}

/// Returns the derivatives of the accelerations with respect to an input.
fn respond_to_input(
    evaluator: &mut EquationEvaluator,
    point: Point<'_>,
    input: usize,
    slots: usize,
) -> DVector<f64> {
    let states = point.state.len();
    let mut rates = [vec![0.0; states], vec![0.0; states]];
    let step = thresholds::REFERENCE_QUOTIENT_IN_RANGES
        * point.inputs[input]
            .abs()
            .max(thresholds::REFERENCE_QUOTIENT_IN_RANGES);
    for (rates, sign) in rates.iter_mut().zip([1.0, -1.0]) {
        let mut inputs = point.inputs.to_vec();
        inputs[input] += sign * step;
        let moved = Point {
            inputs: &inputs,
            ..point
        };
        evaluator.compute_rates(moved, rates);
    }
    let first = states - slots;
    DVector::from_fn(slots, |row, _| {
        (rates[0][first + row] - rates[1][first + row]) / (2.0 * step)
    })
}

impl PairProducts {
    fn build(
        motion: &ReferenceMotion,
        segments: &Segments,
        sampled: &[RecordSamples],
        (direction, variable): (usize, usize),
        variables: &[NamedQuantity<Variable>],
    ) -> Option<Self> {
        let mut values: Vec<f64> = sampled[..motion.training]
            .iter()
            .flat_map(|record| record.values[variable].iter().copied())
            .collect();
        let bends_at_zero = !matches!(variables[variable].of, Variable::State(_));
        let functions = HatFunctions::over_values(&mut values, bends_at_zero)?;
        let drives = build_drives(motion, sampled, (direction, variable), &functions);
        let products = segments.products(motion, &drives, None);
        let reduced = segments.eliminate_nuisances(&products)?;
        (reduced.iter().all(|x| x.is_finite())).then_some(Self {
            direction,
            variable,
            functions,
            products,
            reduced,
        })
    }

    fn build_pair_drives(&self, motion: &ReferenceMotion, sampled: &[RecordSamples]) -> Vec<Drive> {
        let pair = (self.direction, self.variable);
        build_drives(motion, sampled, pair, &self.functions)
    }

    /// Returns the Gram matrix and the right-hand side of the coefficients, and the sum of squares
    /// without a function.
    fn split_products(&self) -> (DMatrix<f64>, DVector<f64>, f64) {
        let count = self.reduced.ncols() - 1;
        (
            self.reduced.view((0, 0), (count, count)).into_owned(),
            self.reduced
                .view((0, count), (count, 1))
                .column(0)
                .into_owned(),
            self.reduced[(count, count)],
        )
    }

    /// Returns the sum of squares of the training residuals with the smallest penalty on the
    /// function.
    fn compute_least_squares(&self) -> f64 {
        let (gram, slope, squares) = self.split_products();
        let small = thresholds::CURVE_PENALTY_DECADES.0;
        let penalty =
            self.functions.penalty() * compute_penalty_weight(&gram, &self.functions, small);
        match (gram + penalty).cholesky() {
            Some(factor) => (squares - slope.dot(&factor.solve(&slope))).max(0.0),
            None => squares,
        }
    }

    /// Fits the function with the likeliest penalty. `variance`: variance of the residuals times
    /// the number of samples per independent sample.
    fn fit(
        &self,
        segments: &Segments,
        variance: f64,
        (directions, variables): (&[NamedQuantity<Direction>], &[NamedQuantity<Variable>]),
    ) -> Option<Curve> {
        let (gram, slope, _) = self.split_products();
        let penalty = self.functions.penalty();
        let base = penalty.clone().cholesky()?.ln_determinant();
        let count = gram.ncols();
        let (low, high) = thresholds::CURVE_PENALTY_DECADES;
        let decades = (0..=(high - low).round() as usize).map(|k| low + k as f64);
        let evidence = |decade: f64| {
            let weight = compute_penalty_weight(&gram, &self.functions, decade);
            let matrix = &gram + &penalty * weight;
            let factor = matrix.cholesky()?;
            let gain = slope.dot(&factor.solve(&slope)) / (2.0 * variance);
            let volume = base + count as f64 * weight.ln() - factor.ln_determinant();
            Some((gain + 0.5 * volume, weight, factor))
        };
        let (log_evidence, weight, factor) = decades
            .filter_map(evidence)
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let solution = segments.solve(&self.products, &(&penalty * weight));
        let (train_rms, test_rms) = segments.evaluate(&self.products, &solution);
        let nuisances = solution.len() - 1 - count;
        let covariance = factor.inverse() * variance;
        let (on, over) = (&directions[self.direction], &variables[self.variable]);
        Some(Curve {
            equation: on.name.clone(),
            variable: over.name.clone(),
            variable_unit: over.unit.clone(),
            unit: on.unit.clone(),
            knots: self.functions.knots.clone(),
            values: solution.rows(nuisances, count).iter().copied().collect(),
            band: (0..count)
                .map(|k| covariance[(k, k)].max(0.0).sqrt())
                .collect(),
            is_own_variable: is_own_variable(&on.of, &over.of),
            train_rms,
            test_rms,
            log_evidence,
        })
    }
}

fn is_own_variable(direction: &Direction, variable: &Variable) -> bool {
    match (direction, variable) {
        (Direction::Equation(on), Variable::Position(of) | Variable::Rate(of)) => on == of,
        (Direction::Input(on), Variable::Input(of)) => on == of,
        _ => false,
    }
}

/// Returns the weight of the penalty, 10^`decade` times the information of the records.
fn compute_penalty_weight(gram: &DMatrix<f64>, functions: &HatFunctions, decade: f64) -> f64 {
    let size = gram.trace() / functions.penalty().trace();
    size.max(f64::MIN_POSITIVE.sqrt()) * 10f64.powf(decade)
}

fn build_drives(
    motion: &ReferenceMotion,
    sampled: &[RecordSamples],
    (direction, variable): (usize, usize),
    functions: &HatFunctions,
) -> Vec<Drive> {
    let count = functions.knots.len();
    let mut drives: Vec<Drive> = vec![Vec::new(); count];
    let mut weights = [vec![0.0; count], vec![0.0; count]];
    for (record, sampled) in motion.records.iter().zip(sampled) {
        let accelerations = &sampled.accelerations[direction];
        let values = &sampled.values[variable];
        let steps = record.steps.len();
        let mut own = vec![DMatrix::zeros(accelerations.nrows(), steps); count];
        for step in 0..steps {
            let [begin, end] = &mut weights;
            functions.write_weights(values[2 * step], begin);
            functions.write_weights(values[2 * step + 1], end);
            for (knot, drive) in own.iter_mut().enumerate() {
                if begin[knot] == 0.0 && end[knot] == 0.0 {
                    continue;
                }
                let mut column = drive.column_mut(step);
                column.axpy(0.5 * begin[knot], &accelerations.column(2 * step), 0.0);
                column.axpy(0.5 * end[knot], &accelerations.column(2 * step + 1), 1.0);
            }
        }
        drives
            .iter_mut()
            .zip(own)
            .for_each(|(drive, own)| drive.push(own));
    }
    drives
}
