//! The classical Runge-Kutta method of order 4.

/// Time of each of the four slopes, relative to the step.
const NODES: [f64; 4] = [0.0, 0.5, 0.5, 1.0];

/// Classical Runge-Kutta steps, with reused memory.
pub struct RungeKutta {
    slopes: [Vec<f64>; 4],
    trial: Vec<f64>,
}

impl RungeKutta {
    /// Allocates memory for this number of states.
    pub fn new(states: usize) -> Self {
        Self {
            slopes: [(); 4].map(|()| vec![0.0; states]),
            trial: vec![0.0; states],
        }
    }

    /// Advances a state from the time `begin` by the step `h`, s. `rates` receives the index of
    /// the slope (0 to 3), the time and the state, and writes the rates.
    pub fn step(
        &mut self,
        state: &mut [f64],
        (begin, h): (f64, f64),
        mut rates: impl FnMut(usize, f64, &[f64], &mut [f64]),
    ) {
        for (stage, part) in NODES.into_iter().enumerate() {
            self.trial.copy_from_slice(state);
            if stage > 0 {
                let slope = self.trial.iter_mut().zip(&self.slopes[stage - 1]);
                slope.for_each(|(x, k)| *x += part * h * k);
            }
            let slope = &mut self.slopes[stage];
            rates(stage, begin + part * h, &self.trial, slope);
        }
        for (index, x) in state.iter_mut().enumerate() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|stage: usize| self.slopes[stage][index]);
            *x += h / 6.0 * (a + 2.0 * (b + c) + d);
        }
    }
}
