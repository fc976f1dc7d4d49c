//! Records of machines with constraints. Hand-written equations in independent coordinates are integrated by classical
//! Runge-Kutta steps. In each step, dry friction brings the second state, a speed, as close to zero as the bound of the
//! friction permits.

use crate::random_numbers::NormalNumbers;

/// Number of integration steps per sample.
const PARTS: usize = 40;

/// Measured quantity.
pub struct Channel {
    /// Name of the quantity: a coordinate of the specification with constraints.
    pub name: &'static str,
    /// Unit of the column, and its factor to SI.
    pub unit: (&'static str, f64),
    /// Standard deviation of the noise, SI.
    pub noise: f64,
}

/// Function that returns the rates of the state for a state and an input.
pub type Rates<const S: usize> = dyn Fn([f64; S], f64) -> [f64; S];

/// Function of the state that returns the lever arm of the dry friction on the second state, and the reciprocal inertia
/// of the second state.
pub type Lever<const S: usize> = dyn Fn([f64; S]) -> [f64; 2];

/// Machine with its specifications.
pub struct Machine<const S: usize, const C: usize> {
    /// Specification with constraints, without the hidden effect.
    pub specification: String,
    /// Specification of the machine in independent coordinates; its observables have the names of the channels with the
    /// suffix `_seen`.
    pub independent: String,
    /// Measured quantities.
    pub channels: [Channel; C],
    /// Uncertain parameters, as in a dataset file.
    pub sections: &'static str,
    /// Mean and amplitude of the input `u` in SI, and its unit.
    pub input: (f64, f64, &'static str),
    /// Rates in independent coordinates, without dry friction.
    pub rates: Box<Rates<S>>,
    /// Bound of the dry friction, and its lever arm.
    pub friction: (f64, Box<Lever<S>>),
    /// Measured quantities.
    pub observe: Box<dyn Fn([f64; S]) -> [f64; C]>,
    /// Initial states of the training record and the test record.
    pub initial: [[f64; S]; 2],
}

/// Sampling and window length of records.
#[derive(Clone, Copy)]
pub struct Sampling {
    /// Number of samples.
    pub samples: usize,
    /// Time between samples, in s.
    pub step: f64,
    /// Length of the windows, s; `None` for whole records.
    pub window: Option<f64>,
}

impl<const S: usize, const C: usize> Machine<S, C> {
    /// Returns the dataset file. The observable of a channel has the channel's name with the suffix `suffix`.
    pub fn dataset(&self, sampling: Sampling, suffix: &str) -> String {
        let mut text = format!(
            "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
             [inputs.u]\ncolumn = \"u\"\nunit = \"{}\"\n\n{}\n\n",
            self.input.2, self.sections
        );
        for Channel { name, unit, noise } in &self.channels {
            let (unit, noise) = (unit.0, noise / unit.1);
            text += &format!(
                "[channels.{name}]\ncolumn = \"{name}\"\nunit = \"{unit}\"\nnoise = {noise:e}\n\
                 observable = \"{name}{suffix}\"\n\n"
            );
        }
        if let Some(length) = sampling.window {
            text += &format!("[windows]\nlength = {length}\n");
        }
        text
    }

    /// Returns the training record and the test record.
    pub fn records(&self, sampling: Sampling) -> [String; 2] {
        [0, 1].map(|number| self.record(sampling, number))
    }

    fn record(&self, sampling: Sampling, number: usize) -> String {
        let mut noise = NormalNumbers::new(number as u64 + 7);
        let mut state = self.initial[number];
        let h = sampling.step / PARTS as f64;
        let names = self.channels.iter().map(|channel| channel.name);
        let mut text = format!("t,u,{}\n", names.collect::<Vec<&str>>().join(","));
        for sample in 0..sampling.samples {
            let t = sample as f64 * sampling.step;
            let input = self.input_at(t, number);
            text += &format!("{t:.6},{input:.12e}");
            for (value, channel) in (self.observe)(state).iter().zip(&self.channels) {
                let value = (value + channel.noise * noise.draw()) / channel.unit.1;
                text += &format!(",{value:.9e}");
            }
            text.push('\n');
            for _ in 0..PARTS {
                state = self.advance(state, input, h);
            }
        }
        text
    }

    fn input_at(&self, t: f64, number: usize) -> f64 {
        let (mean, amplitude, _) = self.input;
        let sine =
            |frequency: f64, phase: f64| (std::f64::consts::TAU * frequency * t + phase).sin();
        let turn = number as f64;
        let faster = 1.0 + 0.1 * turn;
        let sum = sine(0.7 * faster, 0.3 + turn)
            + sine(1.3 * faster, 1.1 + 2.0 * turn)
            + sine(2.1 * faster, 2.0);
        mean + amplitude * sum
    }

    fn advance(&self, state: [f64; S], input: f64, h: f64) -> [f64; S] {
        let along = |rates: [f64; S], by: f64| std::array::from_fn(|i| state[i] + by * rates[i]);
        let a = (self.rates)(state, input);
        let b = (self.rates)(along(a, 0.5 * h), input);
        let c = (self.rates)(along(b, 0.5 * h), input);
        let d = (self.rates)(along(c, h), input);
        let mut next: [f64; S] =
            std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        let (bound, lever) = &self.friction;
        let [lever, mobility] = lever(next);
        let stopping = next[1] / (lever * mobility + f64::MIN_POSITIVE);
        next[1] -= mobility * lever * stopping.clamp(-h * bound, h * bound);
        next
    }
}
