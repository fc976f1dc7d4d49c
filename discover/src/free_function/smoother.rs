//! Extended smoother of a record: states of the model and unknown accelerations that follow random
//! walks (Rauch, Tung and Striebel, AIAA Journal 3, 1965; in the form of Bierman, Automatica 9, 1973,
//! which inverts no covariance). The smoothed motion follows a record within its noise even if the
//! model lacks an effect.

use nalgebra::{DMatrix, DVector};

/// Model near a sample, in scaled states and accelerations.
pub(super) struct LocalModel {
    /// State at the beginning of the step.
    pub state: DVector<f64>,
    /// State at the end of the step.
    pub end: DVector<f64>,
    /// Derivatives of the final state with respect to the initial state.
    pub transition: DMatrix<f64>,
    /// Derivatives of the final state with respect to accelerations that are constant during the
    /// step.
    pub drive: DMatrix<f64>,
}

/// Linearised outputs near a sample, in standard deviations of the noise.
pub(super) struct LocalOutputs {
    /// State at which the outputs are linearised.
    pub state: DVector<f64>,
    /// Measured minus expected outputs; NaN if missing.
    pub difference: DVector<f64>,
    /// Derivatives of the expected outputs with respect to the state.
    pub by_state: DMatrix<f64>,
}

/// Standard deviations of a smoother, in scaled units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widths {
    /// Standard deviation of each state at the first sample.
    pub first_state: f64,
    /// Standard deviation of the change of each acceleration from sample to sample.
    pub acceleration_step: f64,
}

/// Filter estimate at a sample.
struct FilteredSample {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    by_state: DMatrix<f64>,
    gain: DMatrix<f64>,
    /// Innovations multiplied by the inverse of their covariance.
    weighted: DVector<f64>,
    /// Transition matrix to the next sample.
    transition: DMatrix<f64>,
}

/// Smoothed record.
pub(super) struct SmoothedRecord {
    /// States at the samples, scaled.
    pub states: Vec<DVector<f64>>,
    /// Logarithm of the likelihood of the innovations.
    pub log_likelihood: f64,
}

/// Smooths a record of `samples` samples. The functions `outputs` and `model` linearise at a
/// sample; their argument is the filter estimate there.
pub(super) fn smooth(
    samples: usize,
    first: &DVector<f64>,
    accelerations: usize,
    widths: Widths,
    outputs: &mut dyn FnMut(usize, &DVector<f64>) -> Option<LocalOutputs>,
    model: &mut dyn FnMut(usize, &DVector<f64>) -> Option<LocalModel>,
) -> Option<SmoothedRecord> {
    let (states, all) = (first.len(), first.len() + accelerations);
    let mut mean = DVector::zeros(all);
    mean.rows_mut(0, states).copy_from(first);
    let mut covariance = DMatrix::zeros(all, all);
    for k in 0..all {
        covariance[(k, k)] = match k < states {
            true => widths.first_state.powi(2),
            // Accelerations are scaled, so the usual size is 1.
            false => 1.0,
        };
    }
    let mut filtered: Vec<FilteredSample> = Vec::with_capacity(samples);
    let mut log_likelihood = 0.0;
    for sample in 0..samples {
        let local = outputs(sample, &mean.rows(0, states).into_owned())?;
        let channels = local.difference.len();
        let moved = &local.by_state * (mean.rows(0, states) - &local.state);
        let mut by_state = DMatrix::zeros(channels, all);
        by_state
            .view_mut((0, 0), (channels, states))
            .copy_from(&local.by_state);
        let mut difference = &local.difference - moved;
        for channel in 0..channels {
            if !difference[channel].is_finite() {
                difference[channel] = 0.0;
                by_state.row_mut(channel).fill(0.0);
            }
        }
        let spread = &by_state * &covariance * by_state.transpose()
            + DMatrix::<f64>::identity(channels, channels);
        let factor = spread.cholesky()?;
        let weighted = factor.solve(&difference);
        let gain = factor.solve(&(&by_state * &covariance)).transpose();
        log_likelihood -= 0.5 * difference.dot(&weighted) + factor.ln_determinant() / 2.0;
        let before = mean.clone();
        mean += &gain * &difference;
        let after = &covariance - &gain * (&by_state * &covariance);
        let local = match sample + 1 < samples {
            true => Some(model(sample, &mean.rows(0, states).into_owned())?),
            false => None,
        };
        let mut transition = DMatrix::identity(all, all);
        let old = std::mem::replace(&mut covariance, after);
        if let Some(local) = local {
            transition
                .view_mut((0, 0), (states, states))
                .copy_from(&local.transition);
            transition
                .view_mut((0, states), (states, accelerations))
                .copy_from(&local.drive);
            let step = &local.transition * (mean.rows(0, states) - &local.state)
                + &local.drive * mean.rows(states, accelerations);
            mean.rows_mut(0, states).copy_from(&(local.end + step));
            covariance = &transition * covariance * transition.transpose();
            for k in states..all {
                covariance[(k, k)] += widths.acceleration_step.powi(2);
            }
            covariance = (&covariance + covariance.transpose()) / 2.0;
        }
        if mean.iter().any(|x| !x.is_finite()) {
            return None;
        }
        filtered.push(FilteredSample {
            mean: before,
            covariance: old,
            by_state,
            gain,
            weighted,
            transition,
        });
    }
    let mut smoothed = Vec::with_capacity(samples);
    let mut adjoint = DVector::zeros(all);
    for sample in filtered.iter().rev() {
        let carried = sample.transition.transpose() * adjoint;
        let remaining =
            &carried - sample.by_state.transpose() * (sample.gain.transpose() * &carried);
        adjoint = remaining - sample.by_state.transpose() * &sample.weighted;
        let state = &sample.mean - &sample.covariance * &adjoint;
        smoothed.push(state.rows(0, states).into_owned());
    }
    smoothed.reverse();
    Some(SmoothedRecord {
        states: smoothed,
        log_likelihood,
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{LocalModel, LocalOutputs, Widths, smooth};

    /// For a linear model the smoothed states are the least-squares solution of all equations at
    /// once.
    #[test]
    fn smoothed_states_solve_the_least_squares_problem() {
        let (h, samples) = (0.1, 12);
        let a = DMatrix::from_row_slice(2, 2, &[1.0, h, -0.3, 0.95]);
        let g = DMatrix::from_row_slice(2, 1, &[h * h / 2.0, h]);
        let c = DMatrix::from_row_slice(1, 2, &[5.0, 0.5]);
        let measured: Vec<f64> = (0..samples)
            .map(|k| f64::sin(0.9 * k as f64) * 3.0)
            .collect();
        let widths = Widths {
            first_state: 2.0,
            acceleration_step: 0.3,
        };
        let found = smooth(
            samples,
            &DVector::from_vec(vec![0.2, -0.1]),
            1,
            widths,
            &mut |k, state| {
                Some(LocalOutputs {
                    state: state.clone(),
                    difference: DVector::from_element(1, measured[k]) - &c * state,
                    by_state: c.clone(),
                })
            },
            &mut |_, state| {
                Some(LocalModel {
                    state: state.clone(),
                    end: &a * state,
                    transition: a.clone(),
                    drive: g.clone(),
                })
            },
        )
        .unwrap();
        // Unknowns: the first state, the first acceleration and its changes.
        let unknowns = 2 + samples;
        let mut rows: Vec<(DVector<f64>, f64)> = Vec::new();
        let unit = |k: usize, size: f64| {
            let mut row = DVector::zeros(unknowns);
            row[k] = 1.0 / size;
            row
        };
        rows.push((unit(0, 2.0), 0.2 / 2.0));
        rows.push((unit(1, 2.0), -0.1 / 2.0));
        rows.push((unit(2, 1.0), 0.0));
        (3..unknowns).for_each(|k| rows.push((unit(k, 0.3), 0.0)));
        let mut state = DMatrix::zeros(2, unknowns);
        state[(0, 0)] = 1.0;
        state[(1, 1)] = 1.0;
        let mut acceleration = DMatrix::zeros(1, unknowns);
        acceleration[(0, 2)] = 1.0;
        let mut states = Vec::new();
        for (k, value) in measured.iter().enumerate() {
            rows.push(((&c * &state).row(0).transpose(), *value));
            states.push(state.clone());
            state = &a * state + &g * &acceleration;
            if k + 3 < unknowns {
                acceleration[(0, k + 3)] += 1.0;
            }
        }
        let matrix = DMatrix::from_fn(rows.len(), unknowns, |r, k| rows[r].0[k]);
        let right = DVector::from_fn(rows.len(), |r, _| rows[r].1);
        let solution = (matrix.transpose() * &matrix)
            .cholesky()
            .unwrap()
            .solve(&(matrix.transpose() * right));
        for (smoothed, state) in found.states.iter().zip(&states) {
            assert!((smoothed - state * &solution).norm() < 1e-9);
        }
    }
}
