//! Records of machines on a base with prescribed motion. Hand-written equations are integrated by the midpoint rule
//! with small steps. In each step, dry friction brings the first speed as close to zero as the bounds of the friction
//! permit.

use crate::random_numbers::NormalNumbers;

/// Number of samples per record.
const SAMPLES_PER_RECORD: usize = 1500;

/// Motion of the base: a sum of sines times a factor that increases from 0 to 1.
struct Base {
    /// Amplitude (m), frequency (Hz) and phase (rad) of each sine.
    sines: [[f64; 3]; 3],
    /// Time in which the factor increases, in s.
    rise: f64,
}

impl Base {
    /// Returns position, velocity and acceleration at the time `t`, in s.
    fn evaluate(&self, t: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for [amplitude, frequency, phase] in self.sines {
            let w = std::f64::consts::TAU * frequency;
            let (sin, cos) = (w * t + phase).sin_cos();
            let sine = [sin, w * cos, -w * w * sin];
            for (slot, value) in sum.iter_mut().zip(sine) {
                *slot += amplitude * value;
            }
        }
        // Factor: a polynomial whose first two derivatives are 0 at both ends.
        let r = (t / self.rise).min(1.0);
        let factor = r.powi(3) * (10.0 - 15.0 * r + 6.0 * r * r);
        let rate = 30.0 * (r * (1.0 - r)).powi(2) / self.rise;
        let second = 60.0 * r * (1.0 - r) * (1.0 - 2.0 * r) / self.rise.powi(2);
        [
            factor * sum[0],
            rate * sum[0] + factor * sum[1],
            second * sum[0] + 2.0 * rate * sum[1] + factor * sum[2],
        ]
    }
}

/// Function that returns the forces for a motion of the base (position, rate, second derivative), positions and rates.
pub type Forces<const N: usize> = dyn Fn([f64; 3], [f64; N], [f64; N]) -> [f64; N];

/// Machine with its specification and dataset file.
pub struct Machine<const N: usize, const C: usize> {
    /// Specification, without the hidden effect.
    pub specification: String,
    /// Names of the channels.
    pub channels: [&'static str; C],
    /// Standard deviation of the channels' noise in SI, and the unit of the channels.
    pub noise: (f64, &'static str),
    /// Uncertain parameters, as in a dataset file.
    pub sections: &'static str,
    /// Largest amplitude (m) and frequencies (Hz) of the base.
    pub base: (f64, [f64; 3]),
    /// Inertia of each coordinate.
    pub inertia: [f64; N],
    /// Bound of the dry friction on the first coordinate.
    pub friction: f64,
    /// Forces without dry friction.
    pub force: Box<Forces<N>>,
    /// Factors of the coordinates in each channel, which is a linear combination.
    pub observed: [[f64; N]; C],
    /// Initial position of the first coordinate in the training and in the test record.
    pub initial: [f64; 2],
}

/// Units and sampling of the records.
#[derive(Clone, Copy)]
pub struct Recording {
    /// Time between samples, in s.
    pub step: f64,
    /// Number of integration steps per sample.
    pub parts: usize,
    /// Unit of the column of the base motion, and its factor to m.
    pub unit: (&'static str, f64),
}

impl<const N: usize, const C: usize> Machine<N, C> {
    /// Returns the dataset file.
    pub fn dataset(&self, recording: Recording) -> String {
        let mut text = format!(
            "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
             [inputs.s]\ncolumn = \"s\"\nunit = \"{}\"\n\n{}\n\n",
            recording.unit.0, self.sections
        );
        let (noise, unit) = self.noise;
        for channel in self.channels {
            text += &format!(
                "[channels.{channel}]\ncolumn = \"{channel}\"\nunit = \"{unit}\"\nnoise = {noise}\n"
            );
        }
        text
    }

    /// Returns the training record and the test record.
    pub fn records(&self, recording: Recording) -> [String; 2] {
        [0, 1].map(|number| self.record(recording, number))
    }

    fn record(&self, recording: Recording, number: usize) -> String {
        let (amplitude, frequencies) = self.base;
        let turn = number as f64;
        let sine = |place: usize| {
            let frequency = frequencies[place] * (1.0 + 0.07 * turn * (place as f64 - 1.0));
            [
                amplitude / (1.0 + place as f64),
                frequency,
                0.3 + turn * 0.8 + place as f64,
            ]
        };
        let base = Base {
            sines: [0, 1, 2].map(sine),
            rise: 0.5 / frequencies[0],
        };
        let mut noise = NormalNumbers::new(number as u64 + 7);
        let (mut q, mut v) = ([0.0; N], [0.0; N]);
        q[0] = self.initial[number];
        let h = recording.step / recording.parts as f64;
        let mut text = format!("t,s,{}\n", self.channels.join(","));
        for sample in 0..SAMPLES_PER_RECORD {
            let t = sample as f64 * recording.step;
            text += &format!("{t:.6},{:.12e}", base.evaluate(t)[0] / recording.unit.1);
            for factors in &self.observed {
                let products = factors.iter().zip(&q).map(|(a, b)| a * b);
                let value = products.sum::<f64>() + self.noise.0 * noise.draw();
                text += &format!(",{value:.9e}");
            }
            text.push('\n');
            for part in 0..recording.parts {
                let begin = t + part as f64 * h;
                let first = (self.force)(base.evaluate(begin), q, v);
                let middle = std::array::from_fn(|i| q[i] + 0.5 * h * v[i]);
                let rate = std::array::from_fn(|i| v[i] + 0.5 * h * first[i] / self.inertia[i]);
                let force = (self.force)(base.evaluate(begin + 0.5 * h), middle, rate);
                for i in 0..N {
                    let mut next = v[i] + h * force[i] / self.inertia[i];
                    if i == 0 {
                        let most = h * self.friction / self.inertia[0];
                        next -= next.clamp(-most, most);
                    }
                    q[i] += 0.5 * h * (v[i] + next);
                    v[i] = next;
                }
            }
        }
        text
    }
}
