//! Comparison of the equations: the equation in which a force explains most, its significance, and
//! the simple functions that describe the force.

use crate::ids::{EquationId, FamilyId};
use nalgebra::{DMatrix, DVector};

use crate::fit::linearised_fit::Linearisation;
use crate::residual_force::basis_functions::ForceArgument;
use crate::residual_force::family_regression::{FamilyRegression, compute_remaining_mean_square};
use crate::residual_force::types::{ForceKind, RankedEquation, SimpleFunction, SimpleTerm};
use crate::thresholds;

/// Comparison of the equations.
pub(crate) struct EquationRanking {
    equations: Vec<RankedEquation>,
    /// Best equation.
    pub best: EquationId,
    /// Best family in the best equation.
    pub family: FamilyId,
    /// True if the best family is a function of rate or position.
    pub is_state: bool,
    /// Explained fraction of the squares.
    pub explained_fraction: f64,
    /// True if the force is significant.
    pub is_significant: bool,
}

impl EquationRanking {
    /// Compares three families for each equation: over rate, position and time.
    pub fn from_families(
        regressed: &FamilyRegression,
        all: &[EquationId],
        of: Linearisation<'_>,
    ) -> Option<Self> {
        let (regression, count) = (&regressed.regression, all.len());
        let states: Vec<(f64, FamilyId)> = (0..count)
            .map(|number| {
                let part = |family: usize| {
                    let family = FamilyId::new(family);
                    (regressed.explained_fraction(family), family)
                };
                let (rate, position) = (part(3 * number), part(3 * number + 1));
                if rate.0 >= position.0 { rate } else { position }
            })
            .collect();
        let by_state = (0..count).max_by(|a, b| states[*a].0.total_cmp(&states[*b].0))?;
        let level = compute_remaining_mean_square(
            regressed,
            regressed
                .fit_shared_coefficients(states[by_state].1)
                .decrease,
        );
        let times: Vec<f64> = (0..count)
            .map(|number| {
                let family = FamilyId::new(3 * number + 2);
                regression
                    .fit_per_window(regressed.column_range(family), level)
                    .explained_fraction
            })
            .collect();
        let by_time = (0..count).max_by(|a, b| times[*a].total_cmp(&times[*b]))?;
        let is_state = states[by_state].0 > thresholds::MIN_STATE_FRACTION * times[by_time];
        // If the forces over rate or position of several equations explain nearly the same
        // fraction, the force over time selects the equation.
        let most = states[by_state].0;
        let as_well = |a: &usize| states[*a].0 >= most.min(thresholds::MIN_FRACTION_OF_BEST * most);
        let by_state = (0..count)
            .filter(as_well)
            .max_by(|a, b| (states[*a].0 + times[*a]).total_cmp(&(states[*b].0 + times[*b])))?;
        let (best, part, family) = match is_state {
            true => (by_state, states[by_state].0, states[by_state].1),
            false => (by_time, times[by_time], FamilyId::new(3 * by_time + 2)),
        };
        let correlation = regressed.compute_correlation_length(of, family, level);
        let mean_square =
            (1.0 - part).max(0.0) * regression.remaining_squares / regression.number_count;
        let whitened =
            part * regression.remaining_squares / (2.0 * mean_square.max(1.0) * correlation);
        let equations = (0..count).map(|number| RankedEquation {
            equation: all[number],
            fraction_by_state: states[number].0,
            fraction_by_time: times[number],
        });
        Some(Self {
            equations: equations.collect(),
            best: all[best],
            family,
            is_state,
            explained_fraction: part,
            is_significant: whitened > thresholds::MIN_INFORMATION_GAIN
                && part > thresholds::MIN_FORCE_FRACTION,
        })
    }

    /// Returns the equations, the best first.
    pub fn rank_equations(&self) -> Vec<RankedEquation> {
        let mut ranking = self.equations.clone();
        let order = |of: &RankedEquation| {
            if self.is_state {
                of.fraction_by_state
            } else {
                of.fraction_by_time
            }
        };
        ranking.sort_by(|a, b| order(b).total_cmp(&order(a)));
        ranking
    }
}

/// Returns the one or two simple functions that nearly describe a force over rate or position;
/// empty if more are needed.
pub(crate) fn find_simple_functions(
    regressed: &FamilyRegression,
    family: FamilyId,
    of: Linearisation<'_>,
) -> ForceKind {
    let over = regressed.families[family].argument;
    let bends = &regressed.families[family].knots;
    let half = bends.len() / 2;
    let is_rate = over == ForceArgument::Rate;
    let side = |k: usize| match is_rate {
        true if k < half => -1.0,
        true => 1.0,
        false => bends[k].signum(),
    };
    let column = |of: SimpleFunction| {
        let at = |k: usize| match of {
            SimpleFunction::Constant => 1.0,
            SimpleFunction::Sign => side(k),
            SimpleFunction::Linear => bends[k],
            SimpleFunction::Absolute => bends[k].abs(),
            SimpleFunction::SignedSquare => bends[k] * bends[k].abs(),
        };
        DVector::from_fn(bends.len(), |k, _| at(k))
    };
    let known: &[SimpleFunction] = match (is_rate, over) {
        (true, _) => &[
            SimpleFunction::Sign,
            SimpleFunction::Linear,
            SimpleFunction::Constant,
            SimpleFunction::SignedSquare,
            SimpleFunction::Absolute,
        ],
        (false, ForceArgument::Turn) => &[SimpleFunction::Constant],
        (false, _) => &[SimpleFunction::Linear, SimpleFunction::Constant],
    };
    let single = known.iter().map(|a| vec![*a]);
    let pairs = known.iter().enumerate().flat_map(|(number, a)| {
        let others = known[number + 1..].iter();
        others.map(move |b| vec![*a, *b])
    });
    let sets: Vec<Vec<SimpleFunction>> = single.chain(pairs).collect();
    let whole = regressed.fit_shared_coefficients(family).decrease;
    let fitted = |set: &Vec<SimpleFunction>| {
        let columns: Vec<DVector<f64>> = set.iter().map(|s| column(*s)).collect();
        let sizes = regressed.regression.fit_combinations(
            regressed.column_range(family),
            &DMatrix::from_columns(&columns),
        );
        (set.clone(), sizes)
    };
    let enough = |count: usize| {
        let of = sets.iter().filter(|set| set.len() == count).map(fitted);
        let best = of.max_by(|a, b| a.1.decrease.total_cmp(&b.1.decrease));
        best.filter(|(_, sizes)| sizes.decrease > thresholds::MIN_SIMPLE_FRACTION * whole)
    };
    let inflation = regressed.variance_inflation(of, family);
    let described = enough(1)
        .or_else(|| enough(2))
        .map_or_else(Vec::new, |(set, sizes)| {
            let sizes = (0..set.len()).map(|k| {
                let sd = (inflation * sizes.covariance[(k, k)]).sqrt();
                let straight = thresholds::LINEARISATION_ERROR * sizes.values[k];
                SimpleTerm {
                    function: set[k],
                    value: sizes.values[k],
                    sd: sd.hypot(straight),
                }
            });
            sizes.collect()
        });
    match is_rate {
        true => ForceKind::Rate(described),
        false => ForceKind::Position(described),
    }
}
