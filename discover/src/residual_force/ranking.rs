//! Comparison of the equations: the equation in which a force explains most, its significance, and
//! the simple functions that describe the force.

use crate::ids::{EquationId, FamilyId};
use nalgebra::{DMatrix, DVector};

use crate::fit::linearised::Linearisation;
use crate::residual_force::basis_functions::Over;
use crate::residual_force::family_regression::{FamilyRegression, noise};
use crate::residual_force::types::{Kind, RankedEquation, Simple, SimplePart};
use crate::thresholds;

/// Comparison of the equations.
pub(crate) struct Ranking {
    equations: Vec<RankedEquation>,
    /// Best equation.
    pub best: EquationId,
    /// Best family of the best equation.
    pub family: FamilyId,
    /// Whether that family is a function of rate or position.
    pub is_state: bool,
    /// Explained fraction of the squares.
    pub part: f64,
    /// Whether the force is significant.
    pub stands_out: bool,
}

impl Ranking {
    /// Compares three families for each equation: over rate, position and time.
    pub fn of(
        regressed: &FamilyRegression,
        all: &[EquationId],
        of: Linearisation<'_>,
    ) -> Option<Self> {
        let (regression, count) = (&regressed.regression, all.len());
        let states: Vec<(f64, FamilyId)> = (0..count)
            .map(|number| {
                let part = |family: usize| {
                    let family = FamilyId::new(family);
                    (regressed.part(family), family)
                };
                let (rate, position) = (part(3 * number), part(3 * number + 1));
                if rate.0 >= position.0 { rate } else { position }
            })
            .collect();
        let by_state = (0..count).max_by(|a, b| states[*a].0.total_cmp(&states[*b].0))?;
        let level = noise(regressed, regressed.shared(states[by_state].1).decrease);
        let times: Vec<f64> = (0..count)
            .map(|number| {
                let family = FamilyId::new(3 * number + 2);
                regression.each(regressed.range(family), level).part
            })
            .collect();
        let by_time = (0..count).max_by(|a, b| times[*a].total_cmp(&times[*b]))?;
        let is_state = states[by_state].0 > thresholds::STATE_EXPLAINS * times[by_time];
        // What explains as much over rate or position is distinguished by what it explains over time.
        let most = states[by_state].0;
        let as_well = |a: &usize| states[*a].0 >= most.min(thresholds::AS_WELL * most);
        let by_state = (0..count)
            .filter(as_well)
            .max_by(|a, b| (states[*a].0 + times[*a]).total_cmp(&(states[*b].0 + times[*b])))?;
        let (best, part, family) = match is_state {
            true => (by_state, states[by_state].0, states[by_state].1),
            false => (by_time, times[by_time], FamilyId::new(3 * by_time + 2)),
        };
        let correlation = regressed.correlation(of, family, level);
        let mean_square = (1.0 - part).max(0.0) * regression.squares / regression.numbers;
        let whitened = part * regression.squares / (2.0 * mean_square.max(1.0) * correlation);
        let equations = (0..count).map(|number| RankedEquation {
            equation: all[number],
            by_state: states[number].0,
            by_time: times[number],
        });
        Some(Self {
            equations: equations.collect(),
            best: all[best],
            family,
            is_state,
            part,
            stands_out: whitened > thresholds::INFORMATION && part > thresholds::STANDS_OUT,
        })
    }

    /// Returns the equations, the best first.
    pub fn ranking(&self) -> Vec<RankedEquation> {
        let mut ranking = self.equations.clone();
        let order = |of: &RankedEquation| {
            if self.is_state {
                of.by_state
            } else {
                of.by_time
            }
        };
        ranking.sort_by(|a, b| order(b).total_cmp(&order(a)));
        ranking
    }
}

/// Returns the one or two simple functions that nearly describe a force over rate or position;
/// empty if more are needed.
pub(crate) fn simple(
    regressed: &FamilyRegression,
    family: FamilyId,
    of: Linearisation<'_>,
) -> Kind {
    let over = regressed.families[family].over;
    let bends = &regressed.families[family].bends;
    let half = bends.len() / 2;
    let is_rate = over == Over::Rate;
    let side = |k: usize| match is_rate {
        true if k < half => -1.0,
        true => 1.0,
        false => bends[k].signum(),
    };
    let column = |of: Simple| {
        let at = |k: usize| match of {
            Simple::Constant => 1.0,
            Simple::Sign => side(k),
            Simple::Linear => bends[k],
            Simple::Size => bends[k].abs(),
            Simple::Square => bends[k] * bends[k].abs(),
        };
        DVector::from_fn(bends.len(), |k, _| at(k))
    };
    let known: &[Simple] = match (is_rate, over) {
        (true, _) => &[
            Simple::Sign,
            Simple::Linear,
            Simple::Constant,
            Simple::Square,
            Simple::Size,
        ],
        (false, Over::Turn) => &[Simple::Constant],
        (false, _) => &[Simple::Linear, Simple::Constant],
    };
    let single = known.iter().map(|a| vec![*a]);
    let pairs = known.iter().enumerate().flat_map(|(number, a)| {
        let others = known[number + 1..].iter();
        others.map(move |b| vec![*a, *b])
    });
    let sets: Vec<Vec<Simple>> = single.chain(pairs).collect();
    let whole = regressed.shared(family).decrease;
    let fitted = |set: &Vec<Simple>| {
        let columns: Vec<DVector<f64>> = set.iter().map(|s| column(*s)).collect();
        let sizes = regressed
            .regression
            .sums(regressed.range(family), &DMatrix::from_columns(&columns));
        (set.clone(), sizes)
    };
    let enough = |count: usize| {
        let of = sets.iter().filter(|set| set.len() == count).map(fitted);
        let best = of.max_by(|a, b| a.1.decrease.total_cmp(&b.1.decrease));
        best.filter(|(_, sizes)| sizes.decrease > thresholds::IS_SIMPLE * whole)
    };
    let inflation = regressed.inflation(of, family);
    let described = enough(1)
        .or_else(|| enough(2))
        .map_or_else(Vec::new, |(set, sizes)| {
            let sizes = (0..set.len()).map(|k| {
                let sd = (inflation * sizes.covariance[(k, k)]).sqrt();
                let straight = thresholds::STRAIGHT * sizes.values[k];
                SimplePart {
                    function: set[k],
                    value: sizes.values[k],
                    sd: sd.hypot(straight),
                }
            });
            sizes.collect()
        });
    match is_rate {
        true => Kind::Rate(described),
        false => Kind::Position(described),
    }
}
