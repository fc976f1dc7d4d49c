//! Recomputation of a step of the method in `tableau` from its start, and its adjoint: the product of
//! derivatives with respect to the end with the Jacobian of the step (E. Hairer, C. Lubich and G. Wanner,
//! "Geometric Numerical Integration", section VI.4).

use super::tableau::{END_SLOPE, INCREMENTS, NODES, STAGES};

/// A step of the Runge-Kutta method of order 8, with reused memory.
pub struct RepeatedStep {
    start: f64,
    length: f64,
    /// States at the nodes.
    states: Vec<Vec<f64>>,
    /// Rates at the nodes; the adjoint replaces them by their weights.
    slopes: Vec<Vec<f64>>,
    end: Vec<f64>,
    products: Vec<Vec<f64>>,
}

impl RepeatedStep {
    /// Allocates memory for this number of states.
    pub fn new(states: usize) -> Self {
        let nodes = || vec![vec![0.0; states]; STAGES];
        Self {
            start: 0.0,
            length: 0.0,
            states: nodes(),
            slopes: nodes(),
            end: vec![0.0; states],
            products: nodes(),
        }
    }

    /// Computes the step of `length` s from a time (s) and a state; `rates` writes the rates at a time and a state.
    ///
    /// # Errors
    /// The error of `rates`.
    pub fn compute<E>(
        &mut self,
        (t, start): (f64, &[f64]),
        length: f64,
        mut rates: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        (self.start, self.length) = (t, length);
        for stage in 0..STAGES {
            let state = &mut self.states[stage];
            state.copy_from_slice(start);
            for (slope, coefficient) in INCREMENTS[stage] {
                add(state, length * coefficient, &self.slopes[*slope]);
            }
            rates(t + NODES[stage] * length, state, &mut self.slopes[stage])?;
        }
        self.end.copy_from_slice(start);
        for (slope, coefficient) in INCREMENTS[END_SLOPE] {
            add(&mut self.end, length * coefficient, &self.slopes[*slope]);
        }
        Ok(())
    }

    /// Returns the state at the end of the step.
    pub fn end(&self) -> &[f64] {
        &self.end
    }

    /// Replaces the derivatives of a scalar with respect to the end of the step by the derivatives with respect
    /// to its start. `product` writes the product of weights with the Jacobian of the rates at a time and a
    /// state.
    ///
    /// # Errors
    /// The error of `product`.
    pub fn pull_back<E>(
        &mut self,
        weights: &mut [f64],
        mut product: impl FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let coefficient = |terms: &[(usize, f64)], stage: usize| {
            let found = terms.iter().find(|(slope, _)| *slope == stage);
            found.map_or(0.0, |(_, coefficient)| self.length * coefficient)
        };
        for stage in (0..STAGES).rev() {
            let own = &mut self.slopes[stage];
            own.fill(0.0);
            add(own, coefficient(INCREMENTS[END_SLOPE], stage), weights);
            for (terms, product) in INCREMENTS.iter().zip(&self.products).skip(stage + 1) {
                add(own, coefficient(terms, stage), product);
            }
            let t = self.start + NODES[stage] * self.length;
            product(t, &self.states[stage], own, &mut self.products[stage])?;
        }
        for part in &self.products {
            add(weights, 1.0, part);
        }
        Ok(())
    }
}

fn add(sum: &mut [f64], factor: f64, values: &[f64]) {
    if factor != 0.0 {
        for (slot, value) in sum.iter_mut().zip(values) {
            *slot += factor * value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rates of a pendulum with drag, and the products with their Jacobian.
    fn rates(t: f64, y: &[f64], out: &mut [f64]) -> Result<(), ()> {
        out.copy_from_slice(&[y[1], -y[0].sin() - 0.1 * y[1] * y[1] + t.cos()]);
        Ok(())
    }

    fn product(_: f64, y: &[f64], weights: &[f64], out: &mut [f64]) -> Result<(), ()> {
        out.copy_from_slice(&[
            -y[0].cos() * weights[1],
            weights[0] - 0.2 * y[1] * weights[1],
        ]);
        Ok(())
    }

    #[test]
    fn adjoint_is_the_derivative_of_the_end_by_the_start() -> Result<(), ()> {
        let (start, length, small) = ([0.4, -0.7], 0.3, 1e-6);
        let mut step = RepeatedStep::new(2);
        for weighted in 0..2 {
            step.compute((0.2, &start), length, rates)?;
            let mut weights = [0.0; 2];
            weights[weighted] = 1.0;
            step.pull_back(&mut weights, product)?;
            for by in 0..2 {
                let mut end = |side: f64| {
                    let mut moved = start;
                    moved[by] += side * small;
                    step.compute((0.2, &moved), length, rates)?;
                    Ok(step.end()[weighted])
                };
                let difference = (end(1.0)? - end(-1.0)?) / (2.0 * small);
                assert!((weights[by] - difference).abs() < 1e-9, "{weighted} {by}");
            }
        }
        Ok(())
    }
}
