//! Inputs as functions of time: constant, sine or step. The rates of an input are the rates of its signal.

use std::f64::consts::TAU;
use std::sync::Arc;

use eomgen_sim::inputs::{HeldInputs, InputFunction};

/// Start of a step, s.
const STEP_START_S: f64 = 1.0;

/// Number of numbers that describe a signal for scripts.
pub const SIGNAL_LENGTH: usize = 8;

/// Form of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Constant value.
    Constant,
    /// Sine about the value.
    Sine,
    /// Polynomial of degree 5 that starts at the value; its first and second derivatives are 0 at both ends.
    Step,
}

/// Signal of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal {
    /// Indices of the input, its rate and its second derivative among the inputs; `None` if there is no such input.
    pub places: [Option<usize>; 3],
    /// Form.
    pub form: Form,
    /// Constant value, mean value of a sine, or start value of a step, SI.
    pub value: f64,
    /// Amplitude of a sine or height of a step, SI.
    pub change: f64,
    /// Period of a sine or duration of a step, s.
    pub duration: f64,
}

impl Signal {
    /// Reads a signal from its numbers: three indices (negative if there is none), form, value, change, period of the
    /// sine and duration of the step.
    pub fn from_numbers(numbers: &[f64; SIGNAL_LENGTH]) -> Self {
        let [places @ .., form, value, change, period, rise] = *numbers;
        let (form, duration) = match form {
            1.0 => (Form::Sine, period),
            2.0 => (Form::Step, rise),
            _ => (Form::Constant, 0.0),
        };
        Self {
            places: places.map(|index| (index >= 0.0).then_some(index as usize)),
            form,
            value,
            change,
            duration,
        }
    }

    /// Returns the value with its first and second derivatives at a time, s.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let Self {
            value,
            change,
            duration,
            ..
        } = *self;
        match self.form {
            Form::Constant => [value, 0.0, 0.0],
            Form::Sine => {
                let frequency = TAU / duration;
                let (sine, cosine) = (frequency * t).sin_cos();
                [
                    value + change * sine,
                    change * frequency * cosine,
                    -change * frequency * frequency * sine,
                ]
            }
            Form::Step => {
                let s = ((t - STEP_START_S) / duration).clamp(0.0, 1.0);
                [
                    value + change * s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s),
                    change / duration * 30.0 * s * s * (1.0 - s) * (1.0 - s),
                    change / (duration * duration) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
                ]
            }
        }
    }

    /// Returns the times at which a rate has a kink, s.
    fn kinks(&self) -> impl Iterator<Item = f64> + use<> {
        let kinks = [STEP_START_S, STEP_START_S + self.duration];
        let is_step = self.form == Form::Step;
        kinks.into_iter().filter(move |_| is_step)
    }
}

/// A signal, or one of its rates, as an input.
#[derive(Debug)]
struct SignalInput {
    signal: Signal,
    order: usize,
}

impl InputFunction for SignalInput {
    fn write(&self, t: f64, out: &mut [f64]) {
        out.fill(self.signal.at(t)[self.order]);
    }
}

/// Returns the inputs of signals from a time (s) on. Constant signals are held and may jump there from the
/// inputs `before`.
pub(crate) fn inputs(signals: &[Signal], (t, before): (f64, &[f64])) -> HeldInputs {
    let mut after = before.to_vec();
    for signal in signals {
        for (index, number) in signal.places.iter().zip(signal.at(t)) {
            if let Some(index) = index {
                after[*index] = number;
            }
        }
    }
    let mut inputs = HeldInputs::constant(after.clone()).with_held_step(t, before, &after);
    let varying = signals.iter().filter(|known| known.form != Form::Constant);
    for signal in varying.clone() {
        for (order, index) in signal.places.iter().enumerate() {
            if let Some(index) = index {
                let input = SignalInput {
                    signal: *signal,
                    order,
                };
                inputs = inputs.with_function(*index, 1, Arc::new(input));
            }
        }
    }
    inputs.with_jump_times(varying.flat_map(Signal::kinks).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_signals_are_derivatives() {
        let h = 1e-4;
        for form in [Form::Constant, Form::Sine, Form::Step] {
            let signal = Signal {
                places: [Some(0), None, None],
                form,
                value: 0.7,
                change: 1.3,
                duration: 0.9,
            };
            for step in 0..42 {
                let t = 0.05 + 0.0703 * f64::from(step);
                let [before, now, after] = [t - h, t, t + h].map(|t| signal.at(t));
                for order in 0..2 {
                    let rate = (after[order] - before[order]) / (2.0 * h);
                    assert!((rate - now[order + 1]).abs() < 1e-3, "{form:?} at {t}");
                }
            }
        }
    }

    #[test]
    fn step_ends_at_its_height() {
        let signal = Signal::from_numbers(&[0.0, -1.0, -1.0, 2.0, 0.7, 1.3, 0.9, 0.8]);
        assert_eq!(signal.places, [Some(0), None, None]);
        assert_eq!(signal.at(0.5), [0.7, 0.0, 0.0]);
        assert_eq!(signal.at(9.0), [2.0, 0.0, 0.0]);
    }

    #[test]
    fn constant_inputs_jump_and_others_vary() {
        let constant = Signal::from_numbers(&[0.0, -1.0, -1.0, 0.0, 3.0, 0.0, 1.0, 1.0]);
        let step = Signal::from_numbers(&[1.0, 2.0, -1.0, 2.0, 0.5, 1.0, 1.0, 2.0]);
        let inputs = inputs(&[constant, step], (0.5, &[1.0, 0.0, 0.0]));
        assert_eq!(inputs.evaluate(0.4)[0], 1.0);
        assert_eq!(*inputs.evaluate(0.5), [3.0, 0.5, 0.0]);
        assert_eq!(*inputs.evaluate(5.0), [3.0, 1.5, 0.0]);
        assert_eq!(inputs.next_change(0.5), Some(1.0));
        assert_eq!(inputs.next_change(1.0), Some(3.0));
    }
}
