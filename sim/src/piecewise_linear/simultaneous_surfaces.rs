//! Several surfaces that hold or change a motion at the same time, for example two bodies that rub on the
//! ground and on each other. The effects of the surfaces depend on each other and are determined together.
//!
//! A function that is a linear combination of held functions is constant as well. It reaches its threshold
//! together with the last of them and equals it while they hold, whether its own surface sticks or exerts its
//! maximum force.

use nalgebra::{DMatrix, DVector};

use super::dependents::StateAt;
use super::event_function::Linear;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use super::transition::Limit;
use crate::sliding_modes::{Arrival, Rates, Sharing, Verdict, decide, solve_least_squares};

/// Largest relative residual of a function that is a combination of others, and of its threshold.
const DEPENDENCE_TOLERANCE: f64 = 1e-10;

/// Largest relative residual of rates that are the sum of the contributions of the surfaces.
const SUPERPOSITION_TOLERANCE: f64 = 1e-9;

/// Contributions of a surface to a rate below this fraction of the rate's terms are rounding.
const ROUNDING: f64 = 1e-12;

/// A surface whose function equals its threshold.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceContact {
    pub family: usize,
    pub rank: usize,
    pub arrival: Arrival,
}

impl Propagator {
    /// Returns the surfaces that a motion at a limit is on.
    pub(super) fn surfaces_at_limit(&self, limit: &Limit) -> Vec<SurfaceContact> {
        let visited = &self.regimes[limit.before];
        let rank = limit.rank(visited.cells[limit.family]);
        let is_held = matches!(visited.cells[limit.family], Cell::On(_));
        let mut met = vec![SurfaceContact {
            family: limit.family,
            rank,
            arrival: Arrival {
                side: limit.outward(),
                exceeds_limit: is_held,
            },
        }];
        for (family, cell) in visited.cells.iter().enumerate() {
            if let Some(rank) = cell.threshold_rank().filter(|_| family != limit.family) {
                let side = if *cell == Cell::AtLimit(rank, false) {
                    -1.0
                } else {
                    1.0
                };
                let arrival = Arrival {
                    side,
                    exceeds_limit: false,
                };
                met.push(SurfaceContact {
                    family,
                    rank,
                    arrival,
                });
            }
        }
        let known = met.clone();
        let functions = known.iter().map(|on| &visited.functions[on.family]);
        let functions: Vec<DVector<f64>> = functions.map(coefficients).collect();
        for (family, cell) in visited.cells.iter().enumerate() {
            let Cell::Between(above) = *cell else {
                continue;
            };
            if known.iter().any(|on| on.family == family) {
                continue;
            }
            let Some(factors) =
                find_combination(&functions, &coefficients(&visited.functions[family]))
            else {
                continue;
            };
            let threshold = |family: usize, rank: usize| {
                self.families[family].threshold(&visited.regime.system, rank)
            };
            let terms = known.iter().zip(&factors);
            let terms = terms.map(|(on, factor)| factor * threshold(on.family, on.rank));
            let (value, size) = terms.fold((0.0, 0.0_f64), |(sum, size), term| {
                (sum + term, size + term.abs())
            });
            let ranks = above.saturating_sub(1)..(above + 1).min(self.families[family].ranks.len());
            let met_at = |rank: &usize| {
                (threshold(family, *rank) - value).abs()
                    <= DEPENDENCE_TOLERANCE * size.max(value.abs())
            };
            if let Some(rank) = ranks.clone().find(met_at) {
                let side = if above == rank { 1.0 } else { -1.0 };
                let arrival = Arrival {
                    side,
                    exceeds_limit: false,
                };
                met.push(SurfaceContact {
                    family,
                    rank,
                    arrival,
                });
            }
        }
        met
    }

    /// Returns the cells beyond a limit at which the motion is on several surfaces, or `None` if their combined
    /// effect is not the sum of their single effects.
    pub(super) fn decide_simultaneously(
        &mut self,
        limit: &Limit,
        point: StateAt<'_>,
    ) -> Option<Vec<Cell>> {
        let met = self.surfaces_at_limit(limit);
        let cells = self.regimes[limit.before].cells.clone();
        self.decide_cells(&met, cells, point)
    }

    /// Returns the cells of a motion that starts on the thresholds `tied` (family and rank). The other families
    /// stay in `cells`.
    pub(super) fn start_together(
        &mut self,
        cells: &[Cell],
        tied: &[(usize, usize)],
        point: StateAt<'_>,
    ) -> Option<Vec<Cell>> {
        let met: Vec<SurfaceContact> = tied
            .iter()
            .map(|(family, rank)| SurfaceContact {
                family: *family,
                rank: *rank,
                arrival: Arrival {
                    side: -1.0,
                    exceeds_limit: false,
                },
            })
            .collect();
        self.decide_cells(&met, cells.to_vec(), point)
    }

    fn decide_cells(
        &mut self,
        met: &[SurfaceContact],
        mut cells: Vec<Cell>,
        point: StateAt<'_>,
    ) -> Option<Vec<Cell>> {
        let rates = self.compute_surface_rates(met, &cells, point)?;
        let arrivals: Vec<Arrival> = met.iter().map(|on| on.arrival).collect();
        let verdicts = decide(&rates, &arrivals)?;
        for (on, verdict) in met.iter().zip(verdicts) {
            cells[on.family] = match verdict {
                Verdict::Holds(_) => Cell::On(on.rank),
                Verdict::AtLimit(side) => Cell::AtLimit(on.rank, side > 0.0),
                Verdict::Releases(side) => Cell::Between(on.rank + usize::from(side > 0.0)),
            };
        }
        Some(cells)
    }

    /// Returns the rates of the surfaces' functions by the sides of the surfaces; the other families are in
    /// these cells.
    fn compute_surface_rates(
        &mut self,
        met: &[SurfaceContact],
        cells: &[Cell],
        point: StateAt<'_>,
    ) -> Option<Rates> {
        let mut low = cells.to_vec();
        for on in met {
            low[on.family] = Cell::Between(on.rank);
        }
        let mut all = low.clone();
        let at = |propagator: &mut Self, cells: &[Cell]| {
            let outline = propagator.outline(cells);
            (outline, propagator.outlines[outline].rates(point))
        };
        let (outline, below) = at(self, &low);
        let mut jumps = Vec::with_capacity(met.len());
        for on in met {
            let mut up = low.clone();
            up[on.family] = Cell::Between(on.rank + 1);
            all[on.family] = up[on.family];
            let values = at(self, &up).1.values;
            jumps.push(DVector::from_vec(values) - DVector::from_column_slice(&below.values));
        }
        let above = at(self, &all).1;
        let sum = jumps
            .iter()
            .fold(DVector::from_vec(below.values), |sum, jump| sum + jump);
        let states = sum.iter().zip(above.values.iter().zip(&above.sizes));
        let mut states = states.zip(&below.sizes);
        if !states.all(|((sum, (value, size)), other)| {
            (sum - value).abs() <= SUPERPOSITION_TOLERANCE * (size + other)
        }) {
            return None;
        }
        let middle = jumps
            .iter()
            .fold(DVector::from_vec(above.values), |sum, jump| {
                sum - jump * 0.5
            });
        let sizes = DVector::from_vec(above.sizes) + DVector::from_vec(below.sizes);
        let functions = |family: usize| &self.outlines[outline].functions[family];
        let count = met.len();
        let w = DMatrix::from_fn(count, count, |i, j| {
            let row = &functions(met[i].family).state;
            let by_side = 0.5 * row.dot(&jumps[j]);
            let size = row.abs().dot(&sizes);
            if by_side.abs() > ROUNDING * size {
                by_side
            } else {
                0.0
            }
        });
        let c = DVector::from_fn(count, |i, _| {
            let function = functions(met[i].family);
            function.state.dot(&middle) + self.explicit_rate(function, point.phases)
        });
        let sharing = Sharing::LeastSquares;
        Some(Rates { w, c, sharing })
    }
}

fn coefficients(function: &Linear) -> DVector<f64> {
    DVector::from_iterator(function.coefficients().count(), function.coefficients())
}

/// Returns the factors of a linear combination of functions that equals another function, if it exists.
fn find_combination(functions: &[DVector<f64>], wanted: &DVector<f64>) -> Option<DVector<f64>> {
    let count = functions.len();
    let products = DMatrix::from_fn(count, count, |i, j| functions[i].dot(&functions[j]));
    let right = DVector::from_fn(count, |i, _| functions[i].dot(wanted));
    let factors = solve_least_squares(&products, right);
    let terms = functions.iter().zip(&factors);
    let rest = terms.fold(wanted.clone(), |rest, (function, factor)| {
        rest - function * *factor
    });
    (rest.amax() <= DEPENDENCE_TOLERANCE * wanted.amax()).then_some(factors)
}
