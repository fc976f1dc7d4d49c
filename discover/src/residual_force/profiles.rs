//! Profiles of the residual force in one equation over rate, position, time, shaft order, frequency
//! and amplitude, with standard deviations.

use crate::ids::{EquationId, FamilyId};
use nalgebra::DVector;

use crate::fit::linearised_fit::Linearisation;
use crate::residual_force::basis_functions::{BasisFamily, ForceArgument, OperatingRange};
use crate::residual_force::equations::OperatingPoint;
use crate::residual_force::family_regression::{FamilyRegression, compute_remaining_mean_square};
use crate::residual_force::regression::{Coefficients, WindowCoefficient, WindowCoefficients};
use crate::residual_force::types::{Profile, ResidualForce};
use crate::thresholds;

/// Inputs for the computation of profiles.
pub(crate) struct ProfileInputs<'b> {
    /// Linearised fit.
    pub linearisation: Linearisation<'b>,
    /// Operating points, indexed by window, sample and equation.
    pub operating_points: &'b [Vec<Vec<OperatingPoint>>],
    /// Equation of the profiles.
    pub equation: EquationId,
}

impl ProfileInputs<'_> {
    /// Computes all profiles of the equation.
    pub fn compute_profiles(
        &self,
        regressed: &FamilyRegression,
        range: &OperatingRange,
    ) -> ResidualForce {
        let [by_rate, by_position] = [0, 1].map(FamilyId::new);
        let decrease =
            [by_rate, by_position].map(|family| regressed.fit_shared_coefficients(family).decrease);
        let better = match decrease[1] > decrease[0] {
            true => by_position,
            false => by_rate,
        };
        let inflation = regressed.variance_inflation(self.linearisation, better);
        let over = |family: FamilyId| {
            let found = regressed.fit_shared_coefficients(family);
            Profile {
                arguments: regressed.families[family].knots.clone(),
                sd: compute_standard_deviations(&found, inflation),
                values: found.values.iter().copied().collect(),
                explained_fraction: regressed.explained_fraction(family),
                peak: None,
            }
        };
        let level = compute_remaining_mean_square(regressed, decrease[0].max(decrease[1]));
        let mut order = Profile::default();
        let ids = FamilyId::first(regressed.families.len());
        for (id, family) in ids.zip(&regressed.families) {
            let ForceArgument::Order(number) = family.argument else {
                continue;
            };
            let found = regressed.fit_shared_coefficients(id);
            let sd = compute_standard_deviations(&found, inflation);
            order.arguments.push(f64::from(number));
            order.values.push(found.values.norm());
            order
                .sd
                .push((0.5 * (sd[0] * sd[0] + sd[1] * sd[1])).sqrt());
            let part = regressed.explained_fraction(id);
            if part > order.explained_fraction {
                order.explained_fraction = part;
                order.peak = Some(order.arguments.len() - 1);
            }
        }
        let frequency = self.compute_frequency_profile(regressed, level);
        ResidualForce {
            equations: Vec::new(),
            ranking: Vec::new(),
            best_equation: self.equation,
            equation: self.equation,
            kind: None,
            explained_fraction: 0.0,
            rate: over(by_rate),
            position: over(by_position),
            time: self.compute_time_profile(regressed, level),
            order,
            frequency,
            amplitude: self.compute_amplitude_profile(regressed, range, level),
        }
    }

    /// Returns the profile over the time of the first record.
    fn compute_time_profile(&self, regressed: &FamilyRegression, level: f64) -> Profile {
        let mut profile = Profile::default();
        let Some(family) = regressed.find_family(|over| over == ForceArgument::Time) else {
            return profile;
        };
        let found = regressed
            .regression
            .fit_per_window(regressed.column_range(family), level);
        profile.explained_fraction = found.explained_fraction;
        for (id, sizes) in self.linearisation.point.windows.iter().zip(&found.windows) {
            let window = &self.linearisation.problem.train.windows[*id];
            let (Some(sizes), 0) = (sizes, window.record) else {
                continue;
            };
            let bends = &regressed.families[family].knots;
            profile
                .arguments
                .extend(bends.iter().map(|bend| window.times[0] + bend));
            profile.values.extend(sizes.values.iter());
            profile.sd.extend(compute_standard_deviations(sizes, level));
            // A NaN separates the curves of two windows.
            profile
                .arguments
                .push(window.times[0] + bends[bends.len() - 1]);
            profile.values.push(f64::NAN);
            profile.sd.push(f64::NAN);
        }
        profile
    }

    /// Returns the usual amplitude over frequency, for waves that differ between windows. They are
    /// fitted together, because a fast wave fitted by itself would also absorb slow waves. The
    /// explained fraction is computed for each wave separately.
    fn compute_frequency_profile(&self, regressed: &FamilyRegression, level: f64) -> Profile {
        let mut profile = Profile::default();
        let frequency = |family: &BasisFamily| match family.argument {
            ForceArgument::Frequency(frequency) => Some(frequency),
            _ => None,
        };
        let ids = FamilyId::first(regressed.families.len());
        let all = ids.zip(&regressed.families);
        let waves: Vec<(FamilyId, f64)> = all
            .filter_map(|(id, family)| Some((id, frequency(family)?)))
            .collect();
        let (Some(first), Some(last)) = (waves.first(), waves.last()) else {
            return profile;
        };
        let whole = regressed.column_range(first.0).start..regressed.column_range(last.0).end;
        let found = regressed.regression.fit_per_window(whole.clone(), level);
        for (family, frequency) in waves {
            let range = regressed.column_range(family);
            let own = range.start - whole.start..range.end - whole.start;
            let (size, sd) = compute_usual_amplitude(&found, own, level);
            profile.arguments.push(frequency);
            profile.values.push(size);
            profile.sd.push(sd);
            let part = regressed
                .regression
                .fit_per_window(range, level)
                .explained_fraction;
            if part > profile.explained_fraction {
                profile.explained_fraction = part;
                profile.peak = Some(profile.arguments.len() - 1);
            }
        }
        profile
    }

    /// Returns the part of the force proportional to the rate in each window, at the window's RMS
    /// rate relative to the largest rate.
    fn compute_amplitude_profile(
        &self,
        regressed: &FamilyRegression,
        range: &OperatingRange,
        level: f64,
    ) -> Profile {
        let mut profile = Profile::default();
        let Some(family) = regressed.find_family(|over| over == ForceArgument::Rate) else {
            return profile;
        };
        let bends = DVector::from_column_slice(&regressed.families[family].knots);
        let sizes = regressed
            .regression
            .fit_combination_per_window(regressed.column_range(family), &bends);
        let correlation = self.linearisation.fit.train.correlation_length;
        let mut points: Vec<(f64, f64, f64)> = Vec::new();
        for (operating_points, size) in self.operating_points.iter().zip(sizes) {
            let Some(WindowCoefficient { value, variance }) = size else {
                continue;
            };
            let rates = operating_points.iter().map(|all| all[self.equation].rate);
            let largest = rates.clone().map(f64::abs).fold(0.0, f64::max);
            let square: f64 =
                rates.map(|r| r * r).sum::<f64>() / operating_points.len().max(1) as f64;
            let usual = square.sqrt();
            let sd = (level * correlation * variance).sqrt() * usual;
            points.push((largest.min(2.0 * range.largest_rate), value * usual, sd));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A window with a large standard deviation is left out: it hardly shows the force.
        let mut sds: Vec<f64> = points.iter().map(|point| point.2).collect();
        sds.sort_by(f64::total_cmp);
        let most = 3.0 * sds.get(sds.len() / 2).copied().unwrap_or(0.0);
        for (largest, force, sd) in points.into_iter().filter(|point| point.2 <= most) {
            profile.arguments.push(largest);
            profile.values.push(force);
            profile.sd.push(sd);
        }
        profile
    }
}

/// Returns the standard deviation of each coefficient.
fn compute_standard_deviations(sizes: &Coefficients, inflation: f64) -> Vec<f64> {
    let variances = sizes.covariance.diagonal();
    let pairs = variances.iter().zip(&sizes.values);
    pairs
        .map(|(v, size)| {
            (inflation * v)
                .sqrt()
                .hypot(thresholds::LINEARISATION_ERROR * size)
        })
        .collect()
}

/// Returns the RMS over the windows of the amplitude of some waves, and its standard deviation.
fn compute_usual_amplitude(
    found: &WindowCoefficients,
    own: std::ops::Range<usize>,
    level: f64,
) -> (f64, f64) {
    let available = || found.windows.iter().flatten();
    let count = available().count().max(1) as f64;
    let sum = |of: &dyn Fn(&Coefficients, usize) -> f64| -> f64 {
        let each = available().map(|sizes| own.clone().map(|k| of(sizes, k)).sum::<f64>());
        each.sum()
    };
    let square = sum(&|sizes, k| sizes.values[k].powi(2));
    let variance = sum(&|sizes, k| 0.5 * level * sizes.covariance[(k, k)]);
    ((square / count).sqrt(), (variance / count).sqrt())
}
