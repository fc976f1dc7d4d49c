//! Profiles of the residual force in one equation over rate, position, time, shaft order, frequency
//! and amplitude, with standard deviations.

use crate::ids::{EquationId, FamilyId};
use nalgebra::DVector;

use crate::fit::linearised::Linearisation;
use crate::residual_force::basis_functions::{Family, Over, Range};
use crate::residual_force::equations::OperatingPoint;
use crate::residual_force::family_regression::{FamilyRegression, noise};
use crate::residual_force::regression::{Each, Sizes, WindowSize};
use crate::residual_force::types::{Profile, ResidualForce};
use crate::thresholds;

/// Data from which profiles are computed.
pub(crate) struct Blocks<'b> {
    /// Linearised fit.
    pub of: Linearisation<'b>,
    /// Operating points of each window, sample and equation.
    pub operating_points: &'b [Vec<Vec<OperatingPoint>>],
    /// Equation of the profiles.
    pub equation: EquationId,
}

impl Blocks<'_> {
    /// Computes all profiles of the equation.
    pub fn profiles(&self, regressed: &FamilyRegression, range: &Range) -> ResidualForce {
        let [by_rate, by_position] = [0, 1].map(FamilyId::new);
        let decrease = [by_rate, by_position].map(|family| regressed.shared(family).decrease);
        let better = match decrease[1] > decrease[0] {
            true => by_position,
            false => by_rate,
        };
        let inflation = regressed.inflation(self.of, better);
        let over = |family: FamilyId| {
            let found = regressed.shared(family);
            Profile {
                over: regressed.families[family].bends.clone(),
                sd: deviations(&found, inflation),
                values: found.values.iter().copied().collect(),
                part: regressed.part(family),
                peak: None,
            }
        };
        let level = noise(regressed, decrease[0].max(decrease[1]));
        let mut order = Profile::default();
        let ids = FamilyId::first(regressed.families.len());
        for (id, family) in ids.zip(&regressed.families) {
            let Over::Order(number) = family.over else {
                continue;
            };
            let found = regressed.shared(id);
            let sd = deviations(&found, inflation);
            order.over.push(f64::from(number));
            order.values.push(found.values.norm());
            order
                .sd
                .push((0.5 * (sd[0] * sd[0] + sd[1] * sd[1])).sqrt());
            let part = regressed.part(id);
            if part > order.part {
                order.part = part;
                order.peak = Some(order.over.len() - 1);
            }
        }
        let frequency = self.over_frequency(regressed, level);
        ResidualForce {
            equations: Vec::new(),
            ranking: Vec::new(),
            best: self.equation,
            equation: self.equation,
            kind: None,
            part: 0.0,
            rate: over(by_rate),
            position: over(by_position),
            time: self.over_time(regressed, level),
            order,
            frequency,
            amplitude: self.by_amplitude(regressed, range, level),
        }
    }

    /// The force over the time of the first record.
    fn over_time(&self, regressed: &FamilyRegression, level: f64) -> Profile {
        let mut profile = Profile::default();
        let Some(family) = regressed.find(|over| over == Over::Time) else {
            return profile;
        };
        let found = regressed.regression.each(regressed.range(family), level);
        profile.part = found.part;
        for (id, sizes) in self.of.at.windows.iter().zip(&found.windows) {
            let window = &self.of.problem.train.list[*id];
            let (Some(sizes), 0) = (sizes, window.record) else {
                continue;
            };
            let bends = &regressed.families[family].bends;
            profile
                .over
                .extend(bends.iter().map(|bend| window.times[0] + bend));
            profile.values.extend(sizes.values.iter());
            profile.sd.extend(deviations(sizes, level));
            // Windows are apart from each other.
            profile.over.push(window.times[0] + bends[bends.len() - 1]);
            profile.values.push(f64::NAN);
            profile.sd.push(f64::NAN);
        }
        profile
    }

    /// The usual size over the frequency, of waves that differ from window to window, all at once:
    /// alone, a fast one would have to do what a slow one does. Which explains most is looked at
    /// one by one.
    fn over_frequency(&self, regressed: &FamilyRegression, level: f64) -> Profile {
        let mut profile = Profile::default();
        let frequency = |family: &Family| match family.over {
            Over::Frequency(frequency) => Some(frequency),
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
        let whole = regressed.range(first.0).start..regressed.range(last.0).end;
        let found = regressed.regression.each(whole.clone(), level);
        for (family, frequency) in waves {
            let range = regressed.range(family);
            let own = range.start - whole.start..range.end - whole.start;
            let (size, sd) = usual(&found, own, level);
            profile.over.push(frequency);
            profile.values.push(size);
            profile.sd.push(sd);
            let part = regressed.regression.each(range, level).part;
            if part > profile.part {
                profile.part = part;
                profile.peak = Some(profile.over.len() - 1);
            }
        }
        profile
    }

    /// What of the force goes with the rate in each window, at its root mean square there, over
    /// the largest rate.
    fn by_amplitude(&self, regressed: &FamilyRegression, range: &Range, level: f64) -> Profile {
        let mut profile = Profile::default();
        let Some(family) = regressed.find(|over| over == Over::Rate) else {
            return profile;
        };
        let bends = DVector::from_column_slice(&regressed.families[family].bends);
        let sizes = regressed
            .regression
            .in_windows(regressed.range(family), &bends);
        let correlation = self.of.fit.train.correlation;
        let mut points: Vec<(f64, f64, f64)> = Vec::new();
        for (operating_points, size) in self.operating_points.iter().zip(sizes) {
            let Some(WindowSize { value, variance }) = size else {
                continue;
            };
            let rates = operating_points.iter().map(|all| all[self.equation].rate);
            let largest = rates.clone().map(f64::abs).fold(0.0, f64::max);
            let square: f64 =
                rates.map(|r| r * r).sum::<f64>() / operating_points.len().max(1) as f64;
            let usual = square.sqrt();
            let sd = (level * correlation * variance).sqrt() * usual;
            points.push((largest.min(2.0 * range.rate), value * usual, sd));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A window that hardly shows the force says nothing of it.
        let mut sds: Vec<f64> = points.iter().map(|point| point.2).collect();
        sds.sort_by(f64::total_cmp);
        let most = 3.0 * sds.get(sds.len() / 2).copied().unwrap_or(0.0);
        for (largest, force, sd) in points.into_iter().filter(|point| point.2 <= most) {
            profile.over.push(largest);
            profile.values.push(force);
            profile.sd.push(sd);
        }
        profile
    }
}

/// One standard deviation of each size.
fn deviations(sizes: &Sizes, inflation: f64) -> Vec<f64> {
    let variances = sizes.covariance.diagonal();
    let pairs = variances.iter().zip(&sizes.values);
    pairs
        .map(|(v, size)| (inflation * v).sqrt().hypot(thresholds::STRAIGHT * size))
        .collect()
}

/// The usual size of some waves that differ from window to window, and one standard deviation.
fn usual(found: &Each, own: std::ops::Range<usize>, level: f64) -> (f64, f64) {
    let there = || found.windows.iter().flatten();
    let count = there().count().max(1) as f64;
    let sum = |of: &dyn Fn(&Sizes, usize) -> f64| -> f64 {
        let each = there().map(|sizes| own.clone().map(|k| of(sizes, k)).sum::<f64>());
        each.sum()
    };
    let square = sum(&|sizes, k| sizes.values[k].powi(2));
    let variance = sum(&|sizes, k| 0.5 * level * sizes.covariance[(k, k)]);
    ((square / count).sqrt(), (variance / count).sqrt())
}
