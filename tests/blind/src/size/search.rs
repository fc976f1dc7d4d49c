//! Search for the size of an effect with a given number of noise floors.

use crate::hidden::HiddenEffect;

/// Search for a size. Sizes are scaled proportionally until two of them bracket the level; then
/// logarithms are interpolated.
pub struct Search {
    level: f64,
    /// Required relative accuracy of the level.
    right: f64,
    below: Option<(f64, f64)>,
    above: Option<(f64, f64)>,
    /// Best size so far, and its noise floors.
    best: (f64, f64),
}

impl Search {
    /// Starts a search for a level. `right`: required relative accuracy.
    pub fn new(level: f64, right: f64) -> Self {
        Self {
            level,
            right,
            below: None,
            above: None,
            best: (0.0, f64::INFINITY),
        }
    }

    /// Evaluates sizes from `start` up to `largest`. Returns the best size and its noise floors.
    pub fn run(
        mut self,
        mut hidden: HiddenEffect,
        largest: f64,
        most_looks: usize,
        floors: impl Fn(&HiddenEffect) -> f64,
    ) -> (f64, f64) {
        self.record_size(hidden.amount, floors(&hidden));
        for _ in 1..most_looks {
            let next = self.next_size().min(largest);
            if self.is_found() || self.best.0 == next {
                break;
            }
            hidden.amount = next;
            self.record_size(next, floors(&hidden));
        }
        self.best
    }

    fn distance(&self, floors: f64) -> f64 {
        (floors / self.level).ln().abs()
    }

    fn is_found(&self) -> bool {
        self.distance(self.best.1) < self.right
    }

    /// Stores the result for a size. `floors` is NaN if the simulation failed.
    fn record_size(&mut self, amount: f64, floors: f64) {
        let nearer = self.distance(floors) < self.distance(self.best.1);
        if floors.is_finite() && (nearer || self.best.1.is_infinite()) {
            self.best = (amount, floors);
        }
        if floors < self.level {
            if self.below.is_none_or(|(known, _)| amount > known) {
                self.below = Some((amount, floors));
            }
        } else if self.above.is_none_or(|(known, _)| amount < known) {
            self.above = Some((amount, floors));
        }
    }

    fn next_size(&self) -> f64 {
        match (self.below, self.above) {
            (Some(below), Some(above)) => {
                let part = (self.level / below.1).ln() / (above.1 / below.1).ln();
                // Keeps a distance from both ends of the bracket, because a strongly curved
                // function would stall the search.
                let part = if part.is_finite() {
                    part.clamp(0.1, 0.9)
                } else {
                    0.5
                };
                below.0 * (above.0 / below.0).powf(part)
            }
            (Some((amount, floors)), None) => amount * (self.level / floors).min(20.0),
            (None, Some((amount, floors))) => {
                let factor = self.level / floors;
                amount
                    * if factor.is_finite() {
                        factor.max(0.05)
                    } else {
                        0.05
                    }
            }
            (None, None) => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Search;

    #[test]
    fn search_converges_for_curved_functions() {
        for floors in [
            |a: f64| 3.0 * a,
            |a: f64| 1e4 * a * a,
            |a: f64| if a < 0.02 { a } else { 1e3 * a.powi(3) },
            |a: f64| if a > 0.5 { f64::NAN } else { 40.0 * a },
        ] {
            let mut search = Search::new(6.0, 0.02);
            let mut amount = 0.3;
            for _ in 0..12 {
                search.record_size(amount, floors(amount));
                if search.is_found() {
                    break;
                }
                amount = search.next_size();
            }
            assert!(search.is_found(), "{:?}", search.best);
        }
    }
}
