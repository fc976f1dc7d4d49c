//! Classical Runge-Kutta method with a fixed step size. Steps that contain a switch are only
//! accurate to second order, so that the steps must be much shorter than the fastest motion.

/// Right-hand side of equations of motion.
pub trait Motion {
    /// Computes the rates of a state at a time (s) for an input.
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]);
}

/// Buffers of the method.
pub struct Stepper {
    slopes: [Vec<f64>; 4],
    between: Vec<f64>,
}

impl Stepper {
    /// Allocates buffers for states of `size` numbers.
    pub fn new(size: usize) -> Self {
        Self {
            slopes: std::array::from_fn(|_| vec![0.0; size]),
            between: vec![0.0; size],
        }
    }

    /// Takes `count` steps over a time span (s) with a held input.
    pub fn advance(
        &mut self,
        motion: &impl Motion,
        from: f64,
        span: f64,
        count: usize,
        input: f64,
        state: &mut [f64],
    ) {
        let step = span / count as f64;
        for index in 0..count {
            self.step(motion, from + step * index as f64, step, input, state);
        }
    }

    fn step(&mut self, motion: &impl Motion, t: f64, step: f64, input: f64, state: &mut [f64]) {
        let [first, second, third, fourth] = &mut self.slopes;
        let between = &mut self.between;
        let mut lean = |slope: &[f64], part: f64, state: &[f64], into: &mut [f64], t: f64| {
            for ((b, s), k) in between.iter_mut().zip(state).zip(slope) {
                *b = s + part * k;
            }
            motion.rates(t, between, input, into);
        };
        motion.rates(t, state, input, first);
        lean(first, step / 2.0, state, second, t + step / 2.0);
        lean(second, step / 2.0, state, third, t + step / 2.0);
        lean(third, step, state, fourth, t + step);
        for (place, value) in state.iter_mut().enumerate() {
            let middle = second[place] + third[place];
            *value += step / 6.0 * (first[place] + 2.0 * middle + fourth[place]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Motion, Stepper};

    struct Oscillator;

    impl Motion for Oscillator {
        fn rates(&self, _: f64, state: &[f64], input: f64, rates: &mut [f64]) {
            rates[0] = state[1];
            rates[1] = input - state[0];
        }
    }

    #[test]
    fn error_decreases_with_fourth_power_of_step_size() {
        let error = |count: usize| {
            let mut state = [0.0, 0.0];
            Stepper::new(2).advance(&Oscillator, 0.0, 2.0, count, 1.0, &mut state);
            (state[0] - (1.0 - 2.0f64.cos())).abs()
        };
        let ratio = error(20) / error(40);
        // The expected ratio is 16; at these steps, higher-order terms change it by up to a fifth.
        assert!((13.0..19.0).contains(&ratio), "{ratio}");
    }
}
