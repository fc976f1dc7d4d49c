//! Segments of a reference motion, each with a free initial state: the residuals of the linearised
//! model and the responses to changes of the accelerations, with initial states eliminated.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::fit_result::Fit;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::variable_projection::StateProjection;
use crate::free_function::reference_motion::{ReferenceMotion, ReferenceRecord};
use crate::ids::WindowId;
use crate::thresholds;

/// Changes of the accelerations and of the rates of first-order states during the steps of each
/// record: a column per step.
pub(crate) type Drive = Vec<DMatrix<f64>>;

/// Change of the outputs due to a nuisance, through the accelerations and directly. Unit: standard
/// deviations of the noise per standard deviation of the prior.
pub(crate) struct NuisanceResponse {
    /// Changes of the accelerations.
    pub drive: Option<Drive>,
    /// Direct changes of the outputs of each record, one row per sample and one column per channel.
    pub outputs: Vec<DMatrix<f64>>,
    /// True if the nuisance has a prior.
    pub has_prior: bool,
}

/// Segments of a reference motion.
pub(crate) struct Segments {
    /// Number of training records.
    training: usize,
    list: Vec<Segment>,
    /// Weight of the prior of each nuisance.
    prior_weights: Vec<f64>,
    /// Fit of the nuisances without added columns.
    pub nuisance_fit: LinearFit,
}

struct Segment {
    record: usize,
    first: usize,
    samples: usize,
    projection: StateProjection,
    nuisances: DMatrix<f64>,
}

/// Products of the columns: nuisances, added columns, residual.
pub(super) struct Products {
    /// Products over the training records.
    pub train: DMatrix<f64>,
    /// Products over the test records.
    pub test: DMatrix<f64>,
}

/// Linear fit of the added columns.
#[derive(Clone, Debug)]
pub(crate) struct LinearFit {
    /// Coefficients of the added columns.
    pub coefficients: Vec<f64>,
    /// RMS residual of the training records, in standard deviations.
    pub train_rms: f64,
    /// RMS residual of the test records, in standard deviations.
    pub test_rms: f64,
}

impl LinearFit {
    /// Returns the root mean square of the training and the test RMS.
    pub fn rms(&self) -> f64 {
        (0.5 * (self.train_rms.powi(2) + self.test_rms.powi(2))).sqrt()
    }
}

impl Segments {
    /// Splits the records into segments of a given length, s.
    pub fn split_motion(
        motion: &ReferenceMotion,
        fit: &Fit,
        nuisances: &[NuisanceResponse],
        length: f64,
    ) -> Self {
        let mut indices = Vec::new();
        for (number, record) in motion.records.iter().enumerate() {
            let steps = record.steps.len();
            let mean_step = (record.times[steps] - record.times[0]) / steps.max(1) as f64;
            let states = record.states[0].len();
            let least = thresholds::MIN_SEGMENT_SAMPLES.max(2 * states);
            let samples =
                ((length / mean_step).round() as usize).clamp(least, 1 + steps.max(least));
            let mut first = 0;
            while first + samples / 2 <= steps {
                let end = (first + samples).min(steps + 1);
                indices.push((number, first, end - first));
                first = end;
            }
        }
        let build = |&(record, first, samples): &(usize, usize, usize)| {
            build_segment(&motion.records[record], record, first, samples, nuisances)
        };
        let list: Vec<Segment> = indices.par_iter().map(build).collect();
        let weights = nuisances.iter().map(|nuisance| match nuisance.has_prior {
            true => fit.prior_weight,
            false => 0.0,
        });
        let mut segments = Self {
            training: motion.training,
            list,
            prior_weights: weights.collect(),
            nuisance_fit: LinearFit {
                coefficients: Vec::new(),
                train_rms: f64::INFINITY,
                test_rms: f64::INFINITY,
            },
        };
        segments.nuisance_fit = segments.fit_drives(motion, &[], None);
        segments
    }

    /// Returns the number of measured values of the training records and of the test records.
    fn count_measured_values(&self) -> (f64, f64) {
        let (mut train, mut test) = (0.0, 0.0);
        for segment in &self.list {
            let count = segment.projection.residual.len() as f64;
            match segment.record < self.training {
                true => train += count,
                false => test += count,
            }
        }
        (f64::max(train, 1.0), f64::max(test, 1.0))
    }

    /// Fits the sizes of drives. `fixed`: drive whose size is 1.
    pub fn fit_drives(
        &self,
        motion: &ReferenceMotion,
        drives: &[Drive],
        fixed: Option<&Drive>,
    ) -> LinearFit {
        let products = self.products(motion, drives, fixed);
        let penalty = DMatrix::zeros(drives.len(), drives.len());
        let solution = self.solve(&products, &penalty);
        let rms = self.evaluate(&products, &solution);
        let nuisances = self.prior_weights.len();
        LinearFit {
            coefficients: solution
                .rows(nuisances, drives.len())
                .iter()
                .copied()
                .collect(),
            train_rms: rms.0,
            test_rms: rms.1,
        }
    }

    /// Minimises the sum of squares of the training records with priors and a penalty on the added
    /// columns. The last number of the solution, the factor of the residual, is 1.
    pub(super) fn solve(&self, products: &Products, penalty: &DMatrix<f64>) -> DVector<f64> {
        let train = &products.train;
        let (unknowns, nuisances) = (train.ncols() - 1, self.prior_weights.len());
        let gram = DMatrix::from_fn(unknowns, unknowns, |r, c| {
            let added = match (r < nuisances, c < nuisances) {
                (true, true) if r == c => self.prior_weights[r],
                (false, false) => penalty[(r - nuisances, c - nuisances)],
                _ => 0.0,
            };
            let ridge = match r == c {
                true => thresholds::MIN_COLUMN_REMAINDER * train[(r, r)] + f64::MIN_POSITIVE,
                false => 0.0,
            };
            train[(r, c)] + added + ridge
        });
        let scale: Vec<f64> = (0..unknowns)
            .map(|k| gram[(k, k)].sqrt().max(f64::MIN_POSITIVE.sqrt()))
            .collect();
        let scaled = DMatrix::from_fn(unknowns, unknowns, |r, c| {
            gram[(r, c)] / (scale[r] * scale[c])
        });
        let right = DVector::from_fn(unknowns, |r, _| -train[(r, unknowns)] / scale[r]);
        let solution = match scaled.cholesky() {
            Some(factor) => factor.solve(&right),
            None => DVector::from_element(unknowns, f64::NAN),
        };
        DVector::from_fn(unknowns + 1, |k, _| match k < unknowns {
            true => solution[k] / scale[k],
            false => 1.0,
        })
    }

    /// Returns the RMS residuals of the training and of the test records, in standard deviations.
    pub(super) fn evaluate(&self, products: &Products, solution: &DVector<f64>) -> (f64, f64) {
        let left = |products: &DMatrix<f64>| (products * solution).dot(solution).max(0.0);
        let (train, test) = self.count_measured_values();
        (
            (left(&products.train) / train).sqrt(),
            (left(&products.test) / test).sqrt(),
        )
    }

    /// Returns the products of the training records with the nuisances eliminated.
    pub(super) fn eliminate_nuisances(&self, products: &Products) -> Option<DMatrix<f64>> {
        let (nuisances, all) = (self.prior_weights.len(), products.train.ncols());
        let own = all - nuisances;
        let train = &products.train;
        let added = train.view((nuisances, nuisances), (own, own)).into_owned();
        if nuisances == 0 {
            return Some(added);
        }
        let mut gram = train.view((0, 0), (nuisances, nuisances)).into_owned();
        for (k, weight) in self.prior_weights.iter().enumerate() {
            let ridge = thresholds::MIN_COLUMN_REMAINDER * gram[(k, k)] + f64::MIN_POSITIVE;
            gram[(k, k)] += weight + ridge;
        }
        let across = train.view((0, nuisances), (nuisances, own)).into_owned();
        Some(added - across.transpose() * gram.cholesky()?.solve(&across))
    }

    /// Returns the number of samples per independent sample in the training residuals of a
    /// solution: 1 plus twice the sum of the autocorrelations up to the first negligible one.
    pub(super) fn compute_correlation_length(
        &self,
        motion: &ReferenceMotion,
        drives: &[Drive],
        solution: &DVector<f64>,
    ) -> f64 {
        let mut sums: Vec<f64> = Vec::new();
        for segment in self.list.iter().filter(|s| s.record < self.training) {
            let record = &motion.records[segment.record];
            let channels = record.differences[segment.first].len();
            let all: Vec<&DMatrix<f64>> =
                drives.iter().map(|drive| &drive[segment.record]).collect();
            let response = compute_responses(record, segment.first, segment.samples, &all);
            let nuisances = segment.nuisances.ncols();
            let residual = &segment.projection.residual
                + &segment.nuisances * solution.rows(0, nuisances)
                + response * solution.rows(nuisances, drives.len());
            let residual = segment.projection.project(&residual);
            sums.resize(sums.len().max(segment.samples), 0.0);
            for (lag, sum) in sums.iter_mut().enumerate().take(segment.samples) {
                let pairs = residual.iter().zip(residual.iter().skip(lag * channels));
                *sum += pairs.map(|(a, b)| a * b).sum::<f64>();
            }
        }
        let Some(square) = sums.first().copied().filter(|square| *square > 0.0) else {
            return 1.0;
        };
        let correlations = sums.iter().skip(1).map(|sum| sum / square);
        let positive = correlations.take_while(|r| *r > thresholds::MIN_LAG_CORRELATION);
        1.0 + 2.0 * positive.sum::<f64>()
    }

    /// Returns the number of measured values of the training records.
    pub(super) fn count_training_values(&self) -> f64 {
        self.count_measured_values().0
    }

    /// Computes the products of the columns. `fixed`: drive whose size is 1.
    pub(super) fn products(
        &self,
        motion: &ReferenceMotion,
        drives: &[Drive],
        fixed: Option<&Drive>,
    ) -> Products {
        let unknowns = self.prior_weights.len() + drives.len();
        let zero = || DMatrix::zeros(unknowns + 1, unknowns + 1);
        let mut products = Products {
            train: zero(),
            test: zero(),
        };
        for segment in &self.list {
            let record = &motion.records[segment.record];
            let all: Vec<&DMatrix<f64>> = (drives.iter().chain(fixed))
                .map(|drive| &drive[segment.record])
                .collect();
            let response = compute_responses(record, segment.first, segment.samples, &all);
            let nuisances = segment.nuisances.ncols();
            let mut matrix = DMatrix::zeros(response.nrows(), unknowns + 1);
            matrix
                .columns_mut(0, nuisances)
                .copy_from(&segment.nuisances);
            matrix
                .columns_mut(nuisances, drives.len())
                .copy_from(&response.columns(0, drives.len()));
            let mut residual = segment.projection.residual.clone();
            if fixed.is_some() {
                residual += response.column(drives.len());
            }
            matrix.set_column(unknowns, &residual);
            let found = segment.projection.compute_products(&matrix);
            match segment.record < self.training {
                true => products.train += found,
                false => products.test += found,
            }
        }
        products
    }
}

/// Returns the rows of a segment without a measurement.
fn is_missing(record: &ReferenceRecord, first: usize, channels: usize, row: usize) -> bool {
    !record.differences[first + row / channels][row % channels].is_finite()
}

/// Returns the responses of the outputs of a segment, one column per drive.
fn compute_responses(
    record: &ReferenceRecord,
    first: usize,
    samples: usize,
    drives: &[&DMatrix<f64>],
) -> DMatrix<f64> {
    let channels = record.differences[first].len();
    let states = record.states[0].len();
    let mut found = DMatrix::zeros(samples * channels, drives.len());
    if drives.is_empty() {
        return found;
    }
    let slots = drives[0].nrows();
    let mut motion = DMatrix::zeros(states, drives.len());
    let mut next = motion.clone();
    let mut accelerations = DMatrix::zeros(slots, drives.len());
    for sample in 0..samples {
        let mut rows = found.rows_mut(sample * channels, channels);
        rows.gemm(1.0, &record.by_state[first + sample], &motion, 0.0);
        if sample + 1 == samples {
            break;
        }
        let step = &record.steps[first + sample];
        for (column, drive) in drives.iter().enumerate() {
            accelerations.set_column(column, &drive.column(first + sample));
        }
        next.gemm(1.0, &step.transition, &motion, 0.0);
        next.gemm(1.0, &step.drive, &accelerations, 1.0);
        std::mem::swap(&mut motion, &mut next);
    }
    for row in 0..found.nrows() {
        if is_missing(record, first, channels, row) {
            found.row_mut(row).fill(0.0);
        }
    }
    found
}

fn build_segment(
    record: &ReferenceRecord,
    number: usize,
    first: usize,
    samples: usize,
    nuisances: &[NuisanceResponse],
) -> Segment {
    let channels = record.differences[first].len();
    let states = record.states[0].len();
    let rows = samples * channels;
    let mut residual = DVector::zeros(rows);
    let directions = record.initial_directions(first);
    let mut by_state = DMatrix::zeros(rows, directions.ncols());
    let mut motion = directions.clone();
    let mut defect = DVector::<f64>::zeros(states);
    for sample in 0..samples {
        let outputs = &record.by_state[first + sample];
        let difference = &record.differences[first + sample] + outputs * &defect;
        let changes = outputs * &motion;
        for channel in 0..channels {
            let row = sample * channels + channel;
            if !is_missing(record, first, channels, row) {
                residual[row] = difference[channel];
                by_state.set_row(row, &changes.row(channel));
            }
        }
        if sample + 1 < samples {
            let step = &record.steps[first + sample];
            motion = &step.transition * motion;
            defect = &step.transition * defect + &step.defect;
        }
    }
    let mut columns = DMatrix::zeros(rows, nuisances.len());
    for (column, nuisance) in nuisances.iter().enumerate() {
        if let Some(drive) = &nuisance.drive {
            let response = compute_responses(record, first, samples, &[&drive[number]]);
            columns.set_column(column, &response.column(0));
        }
        for row in 0..rows {
            if !is_missing(record, first, channels, row) {
                let outputs = &nuisance.outputs[number];
                columns[(row, column)] += outputs[(first + row / channels, row % channels)];
            }
        }
    }
    let linear = WindowDerivatives {
        residual,
        by_state,
        directions,
        by_unknown: DMatrix::zeros(rows, 0),
        end_state: Vec::new(),
    };
    let free = InitialStatePrior::default();
    Segment {
        record: number,
        first,
        samples,
        projection: StateProjection::new(&linear, &free, WindowId::new(0), &record.states[first]),
        nuisances: columns,
    }
}
