//! History of the Adams method: modified divided differences of the rates at its last points, and the weights
//! for a step of any length.
//!
//! The formulas are those of Krogh in the notation of Hairer, Norsett and Wanner, "Solving Ordinary
//! Differential Equations I", section III.5, with the last point x_n, the new one x, and tau = x -
//! x_n:
//!
//! ```text
//! Phi_j   = (x_n - x_(n-1)) ... (x_n - x_(n-j)) y'[x_n, ..., x_(n-j)]
//! beta_j  = (x - x_n) ... (x - x_(n-j+1)) / ((x_n - x_(n-1)) ... (x_n - x_(n-j)))
//! y(x)    = y_n + tau (g_0 beta_0 Phi_0 + ... + g_(k-1) beta_(k-1) Phi_(k-1))
//! ```
//!
//! Here g_j is the integral of the j-th Newton polynomial over the step. `adams` selects length and
//! order.

/// Highest order of the predictor.
pub const MAX_ORDER: usize = 12;

/// Number of stored differences: two more than the highest order, for the decision about a higher order.
const DIFFERENCE_COUNT: usize = MAX_ORDER + 2;

/// Rates at the last points.
#[derive(Clone)]
pub struct History {
    /// x_n - x_(n-j), s.
    ages: Vec<f64>,
    /// Phi_j for each point; as many points as ages.
    differences: Vec<Vec<f64>>,
}

/// Coefficients of a step.
pub struct Weights {
    /// Length of the step, s.
    pub length: f64,
    beta: [f64; DIFFERENCE_COUNT],
    g: [f64; DIFFERENCE_COUNT],
}

impl Weights {
    /// Returns g_j.
    pub fn g(&self, j: usize) -> f64 {
        self.g.get(j).copied().unwrap_or(0.0)
    }

    /// Returns the error (s) of order q per unit of the q-th new difference: the contribution that the q-th
    /// corrector adds to the preceding one.
    pub fn error(&self, q: usize) -> f64 {
        q.checked_sub(1).map_or(0.0, |before| {
            self.length * (self.g(q) - self.g(before)).abs()
        })
    }
}

impl History {
    /// Creates an empty history.
    pub fn new() -> Self {
        Self {
            ages: Vec::with_capacity(DIFFERENCE_COUNT),
            differences: Vec::with_capacity(DIFFERENCE_COUNT),
        }
    }

    /// Returns the number of stored points.
    pub fn points(&self) -> usize {
        self.ages.len()
    }

    /// Forgets all points.
    pub fn clear(&mut self) {
        self.ages.clear();
        self.differences.clear();
    }

    /// Starts with one point and its rates.
    pub fn begin(&mut self, rates: &[f64]) {
        self.clear();
        self.ages.push(0.0);
        self.differences.push(rates.to_vec());
    }

    /// Returns the coefficients of a step of `length` s.
    pub fn weights(&self, length: f64) -> Weights {
        let mut beta = [0.0; DIFFERENCE_COUNT];
        let mut g = [0.0; DIFFERENCE_COUNT];
        // Row j of the scheme: entry q is c_(j,q+1), so g_j = c_(j,1).
        let mut row: [f64; DIFFERENCE_COUNT + 1] = std::array::from_fn(|q| 1.0 / (q + 1) as f64);
        let mut product = 1.0;
        for (j, (beta, g)) in beta.iter_mut().zip(&mut g).enumerate() {
            if let Some(age) = j.checked_sub(1).and_then(|before| self.ages.get(before)) {
                let reach = length + age;
                for q in 0..DIFFERENCE_COUNT - j {
                    row[q] -= row[q + 1] * (length / reach);
                }
                product *= self.ages.get(j).map_or(0.0, |age| reach / age);
            } else if j > 0 {
                break;
            }
            *g = row[0];
            *beta = product;
        }
        Weights { length, beta, g }
    }

    /// Adds the predictor of this order, y(x) - y_n, to `y`.
    pub fn predict(&self, weights: &Weights, order: usize, y: &mut [f64]) {
        for (j, difference) in self.differences.iter().enumerate().take(order) {
            let factor = weights.length * weights.g[j] * weights.beta[j];
            add_multiple(factor, difference, y);
        }
    }

    /// Replaces the rates at the new point by their modified difference of this `order`: the deviation from the
    /// extrapolation of the earlier rates.
    pub fn write_prediction_difference(&self, weights: &Weights, order: usize, rates: &mut [f64]) {
        for (j, difference) in self.differences.iter().enumerate().take(order) {
            add_multiple(-weights.beta[j], difference, rates);
        }
    }

    /// Returns the entries of beta_j Phi_j; zeros if unknown.
    pub fn extrapolate_difference(&self, weights: &Weights, j: usize) -> impl Iterator<Item = f64> {
        let beta = weights.beta.get(j).copied().unwrap_or(0.0);
        self.difference(j).map(move |difference| beta * difference)
    }

    /// Returns the entries of Phi_j; zeros if unknown.
    pub fn difference(&self, j: usize) -> impl Iterator<Item = f64> {
        let known = self.differences.get(j).map_or(&[][..], Vec::as_slice);
        known.iter().copied().chain(std::iter::repeat(0.0))
    }

    /// Returns the contribution of a unit of the new difference to y at the end of `inside`, s. This is a part
    /// of the integral of the Newton polynomial of this `order`. `inside` starts with the step of `length` s
    /// and ends within it.
    pub fn correction_inside(&self, inside: &Weights, order: usize, length: f64) -> f64 {
        let ratios = self.ages.iter().take(order);
        let ratios = ratios.map(|age| (inside.length + age) / (length + age));
        inside.length * inside.g(order) * ratios.product::<f64>()
    }

    /// Sets this history to `before` extended by a step with these weights to a point with these rates. Keeps
    /// the differences for a step of the next higher order.
    pub fn follow(&mut self, before: &Self, weights: &Weights, order: usize, rates: &[f64]) {
        let points = (before.points() + 1).min(order + 2).min(DIFFERENCE_COUNT);
        self.ages.clear();
        self.ages.push(0.0);
        let older = before.ages.iter().take(points - 1);
        self.ages.extend(older.map(|age| age + weights.length));
        self.differences.resize_with(points, Vec::new);
        let mut difference = rates.to_vec();
        for (j, index) in self.differences.iter_mut().enumerate() {
            index.clone_from(&difference);
            let continued = before.extrapolate_difference(weights, j);
            for (difference, continued) in difference.iter_mut().zip(continued) {
                *difference -= continued;
            }
        }
    }
}

/// Adds factor x to y.
fn add_multiple(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates y' = f(t) from 0 with steps of different lengths and a fixed `order`, from exact initial
    /// values.
    fn integrate(f: impl Fn(f64) -> f64, exact: impl Fn(f64) -> f64, order: usize) -> (f64, f64) {
        let mut history = History::new();
        history.begin(&[f(0.0)]);
        let (mut t, mut y) = (0.0, exact(0.0));
        for step in 0..3 * order {
            let weights = history.weights(0.1 + 0.05 * (1.7 * step as f64).sin());
            let order = order.min(history.points());
            let next = t + weights.length;
            let mut predicted = [y];
            history.predict(&weights, order, &mut predicted);
            let mut surprise = [f(next)];
            history.write_prediction_difference(&weights, order, &mut surprise);
            y = predicted[0] + weights.length * weights.g(order) * surprise[0];
            if step < order {
                y = exact(next);
            }
            t = next;
            let mut after = History::new();
            after.follow(&history, &weights, order, &[f(t)]);
            history = after;
        }
        (t, y)
    }

    #[test]
    fn corrected_steps_of_any_length_integrate_polynomials_exactly() {
        for order in 1..=MAX_ORDER {
            let power = order as i32;
            let exact = |t: f64| t.powi(power + 1) / f64::from(power + 1);
            let (t, y) = integrate(|t| t.powi(power), exact, order);
            // Rounding in differences of `order` neighbouring values: a few digits for the highest order.
            assert!((y / exact(t) - 1.0).abs() < 1e-11, "order {order}: {y}");
            // The method is not exact for the next degree, so the test detects a wrong order.
            let exact = |t: f64| t.powi(power + 2) / f64::from(power + 2);
            let (t, y) = integrate(|t| t.powi(power + 1), exact, order);
            assert!((y / exact(t) - 1.0).abs() > 1e-13, "order {order}: {y}");
        }
    }

    #[test]
    fn equal_steps_have_textbook_coefficients() {
        let mut history = History::new();
        history.begin(&[1.0]);
        for _ in 0..5 {
            let mut after = History::new();
            after.follow(&history, &history.weights(0.25), MAX_ORDER, &[1.0]);
            history = after;
        }
        let weights = history.weights(0.25);
        // Hairer, Norsett and Wanner, table III.1.1.
        let expected = [1.0, 1.0 / 2.0, 5.0 / 12.0, 3.0 / 8.0, 251.0 / 720.0];
        for (j, expected) in expected.into_iter().enumerate() {
            assert!((weights.g(j) - expected).abs() < 1e-15, "g_{j}");
            assert!((weights.beta[j] - 1.0).abs() < 1e-15, "beta_{j}");
        }
    }
}
