//! Directional derivatives of the oracle's equations and observables with respect to states, inputs and
//! parameters, by central differences of eighth order. The rows of the equations are differentiated
//! at constant accelerations, so that no linear solve adds its error.

use super::oracle::{Oracle, Side};
use super::sampler::Sample;
use eomgen_model_spec::model::{Model, ParameterValue};

/// Weights of f(k h) - f(-k h) for k = 1 .. 4 (Fornberg, "Generation of finite difference formulas on arbitrarily
/// spaced grids", Math. Comp. 51, 1988, table 1).
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Slope {
    pub value: f64,
    /// Largest addend of the quantity. A step of length 1 changes the quantity by at most a few times this scale.
    pub scale: f64,
}

#[derive(Clone, Debug)]
pub(super) struct Direction {
    pub state: Vec<f64>,
    pub inputs: Vec<f64>,
    /// Changes of the independent parameters, in the order of the model's parameters.
    pub parameters: Vec<f64>,
}

impl Direction {
    pub fn zero(states: usize, inputs: usize, parameters: usize) -> Self {
        Self {
            state: vec![0.0; states],
            inputs: vec![0.0; inputs],
            parameters: vec![0.0; parameters],
        }
    }

    fn changes_parameters(&self) -> bool {
        self.parameters.iter().any(|entry| *entry != 0.0)
    }
}

/// Returns central differences of eighth order; `None` if a value is missing or not finite.
pub(super) fn slopes(
    step: f64,
    mut at: impl FnMut(f64) -> Option<Vec<Slope>>,
) -> Option<Vec<Slope>> {
    let mut found: Vec<Slope> = Vec::new();
    for (count, weight) in (1..).zip(WEIGHTS) {
        for side in [1.0, -1.0] {
            let values = at(side * f64::from(count) * step)?;
            add_point(&mut found, values, (side * weight, step))?;
        }
    }
    Some(found)
}

/// Number of points of [`one_sided_slopes`].
const ONE_SIDED_POINTS: u32 = 8;

/// Returns one-sided differences of seventh order. All points are in the direction of the sign of `step`; the point 0
/// is not used. Returns `None` if a value is missing or not finite.
pub(super) fn one_sided_slopes(
    step: f64,
    mut at: impl FnMut(f64) -> Option<Vec<Slope>>,
) -> Option<Vec<Slope>> {
    let count = f64::from(ONE_SIDED_POINTS);
    let harmonic: f64 = (1..=ONE_SIDED_POINTS).map(|k| 1.0 / f64::from(k)).sum();
    let mut found: Vec<Slope> = Vec::new();
    // Derivative at 0 of the Lagrange polynomial of node k among 1 .. n: (-1)^k binomial(n, k) (H_n - 1/k).
    let mut binomial = 1.0;
    for k in (1..=ONE_SIDED_POINTS).map(f64::from) {
        binomial *= -(count + 1.0 - k) / k;
        let weight = binomial * (harmonic - 1.0 / k);
        add_point(&mut found, at(k * step)?, (weight, step))?;
    }
    Some(found)
}

/// Adds weighted values to slopes; `None` if a value is not finite.
fn add_point(
    slopes: &mut Vec<Slope>,
    values: Vec<Slope>,
    (weight, step): (f64, f64),
) -> Option<()> {
    slopes.resize(values.len(), Slope::default());
    for (slope, value) in slopes.iter_mut().zip(values) {
        if !value.value.is_finite() {
            return None;
        }
        slope.value += weight * value.value / step;
        slope.scale = slope.scale.max(value.scale);
    }
    Some(())
}

pub(super) struct DifferencePoint<'s> {
    pub oracle: &'s Oracle,
    pub model: &'s Model,
    pub order: usize,
    /// All parameters, in SI.
    pub parameters: &'s [f64],
    pub sample: &'s Sample,
    /// Accelerations and rates of first-order states at the sample, held constant.
    pub unknowns: Vec<f64>,
}

impl DifferencePoint<'_> {
    /// Returns the derivatives of all rows, then of all observables, along `direction`. Returns
    /// `None` if the regime or the domain of a function ends within four steps.
    pub fn slopes(&self, direction: &Direction, step: f64) -> Option<Vec<Slope>> {
        let here = sides(self.oracle, self.sample)?;
        slopes(step, |length| {
            let sample = self.displace_sample(direction, length);
            if !direction.changes_parameters() {
                return self.quantities(self.oracle, &sample, &here);
            }
            let parameters = self.displace_parameters(direction, length)?;
            let oracle = Oracle::new(self.model, self.order, &parameters).ok()?;
            self.quantities(&oracle, &sample, &here)
        })
    }

    fn displace_sample(&self, direction: &Direction, length: f64) -> Sample {
        let moved = |from: &[f64], direction: &[f64]| -> Vec<f64> {
            let entries = from.iter().zip(direction);
            entries.map(|(from, by)| from + length * by).collect()
        };
        Sample {
            state: moved(&self.sample.state, &direction.state),
            inputs: moved(&self.sample.inputs, &direction.inputs),
            ..self.sample.clone()
        }
    }

    fn displace_parameters(&self, direction: &Direction, length: f64) -> Option<Vec<f64>> {
        let mut model = self.model.clone();
        let known = self.parameters.iter().zip(&direction.parameters);
        for (parameter, (value, by)) in model.parameters.iter_mut().zip(known) {
            if let ParameterValue::Number(own) = &mut parameter.value {
                *own = value + length * by;
            }
        }
        model.parameter_values().ok()
    }

    fn quantities(&self, oracle: &Oracle, sample: &Sample, here: &[Side]) -> Option<Vec<Slope>> {
        if sides(oracle, sample)? != here {
            return None;
        }
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        let equations = oracle.equations(*time, state, inputs).ok()?;
        let rows = equations.residuals(&self.unknowns);
        let mut quantities: Vec<Slope> = rows
            .iter()
            .map(|row| Slope {
                value: row.value,
                scale: row.scale,
            })
            .collect();
        let observables = oracle.observables(*time, state, inputs).ok()?;
        quantities.extend(observables.iter().map(|observable| Slope {
            value: observable.value,
            scale: observable.magnitude,
        }));
        Some(quantities)
    }
}

fn sides(oracle: &Oracle, sample: &Sample) -> Option<Vec<Side>> {
    let values = oracle.switch_values(sample.time, &sample.state, &sample.inputs);
    Some(values.ok()?.iter().map(|value| value.side()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_sine_converge_with_order_eight() {
        let sine = |x: f64| {
            Some(vec![Slope {
                value: (0.7 + x).sin(),
                scale: 1.0,
            }])
        };
        let slope = slopes(1.0 / 16.0, sine).expect("a slope")[0];
        assert!((slope.value - 0.7_f64.cos()).abs() < 1e-12, "{slope:?}");
        // The error is proportional to the eighth power of the step size.
        let error = |step| (slopes(step, sine).expect("a slope")[0].value - 0.7_f64.cos()).abs();
        let order = (error(0.5) / error(0.25)).log2();
        assert!((order - 8.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn one_sided_differences_converge_to_the_slope_of_their_side() {
        let kink = |x: f64| {
            let value = if x < 0.0 { (0.7 + x).sin() } else { x.exp() };
            Some(vec![Slope { value, scale: 1.0 }])
        };
        for (step, expected) in [(1.0 / 64.0, 1.0), (-1.0 / 64.0, 0.7_f64.cos())] {
            let slope = one_sided_slopes(step, kink).expect("a slope")[0];
            assert!((slope.value - expected).abs() < 1e-9, "{step}: {slope:?}");
        }
    }

    #[test]
    fn missing_neighbour_gives_no_slope() {
        let edge = |x: f64| (x < 0.2).then(|| vec![Slope::default()]);
        assert!(slopes(0.1, edge).is_none());
        assert!(slopes(0.01, edge).is_some());
    }
}
