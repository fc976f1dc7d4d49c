//! Inputs and initial states of the machines. Inputs consist of slow sines that reverse the motion,
//! a frequency sweep, and steps. They are held between samples.

use crate::machines::two_bodies::Form;
use crate::machines::{Kind, Machine, Setup};
use crate::random::RandomStream;

/// Kind of excitation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// Reversals, a frequency sweep and steps.
    Usual,
    /// Motion in one direction.
    OneWay,
    /// Oscillation with a small amplitude.
    Gentle,
}

/// Input and initial state of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Input at each sample, SI.
    pub input: Vec<f64>,
    /// Initial state.
    pub start: Vec<f64>,
}

/// Ranges of frequencies and amplitudes for the components of an input.
struct InputComponents {
    /// Ranges of frequency (Hz) and amplitude of the slow sines.
    slow: ((f64, f64), (f64, f64)),
    /// Start and end frequency (Hz) and amplitude of the frequency sweep.
    sweep: (f64, f64, f64),
    /// Height of the steps and range of their duration (s).
    steps: (f64, (f64, f64)),
}

/// Draws input and initial state of record `place`; test records follow the training records.
pub fn drive(
    kind: Kind,
    setup: &Setup,
    manner: Excitation,
    place: usize,
    draw: &mut RandomStream,
) -> Drive {
    let samples = (setup.duration / setup.sample).round() as usize + 1;
    let test = place >= setup.records.0;
    let machine = kind.nominal();
    let mut start = vec![0.0; machine.state_size()];
    let input = match (kind, manner) {
        (Kind::Pendulum, _) => {
            let amplitudes = [(0.3, 0.6), (1.0, 1.5), (2.0, 2.6), (0.6, 0.9), (1.6, 2.0)];
            let (low, high) = amplitudes[place % amplitudes.len()];
            start[0] = std::f64::consts::PI + draw.sign() * draw.between(low, high);
            start[1] = draw.between(-0.5, 0.5);
            vec![0.0; samples]
        }
        (Kind::Stage, Excitation::OneWay) => {
            // The input varies the speed by half, so that the viscous friction is observable.
            start[1] = draw.between(0.3, 0.4);
            let lasting = viscous(&machine) * start[1];
            let slow = sample_sines(setup, samples, ((0.7, 1.5), (15.0, 30.0)), draw);
            let fast = sample_sines(setup, samples, ((3.0, 8.0), (30.0, 60.0)), draw);
            let all = slow.iter().zip(fast);
            all.map(|(slow, fast)| lasting + slow + fast).collect()
        }
        (Kind::TwoBodies { form, .. }, _) => {
            let Machine::TwoBodies(bodies) = &machine else {
                unreachable!("two bodies are two bodies");
            };
            combine_components(
                setup,
                samples,
                &two_body_components(form, bodies.usual_input()),
                draw,
            )
        }
        (Kind::Arm, Excitation::Gentle) => {
            sample_sines(setup, samples, ((2.5, 6.0), (0.4, 0.9)), draw)
        }
        (Kind::Stage, _) => combine_components(
            setup,
            samples,
            &InputComponents {
                slow: ((0.7, 3.0), (60.0, 160.0)),
                sweep: (3.0, 25.0, 80.0),
                steps: (80.0, (0.05, 0.2)),
            },
            draw,
        ),
        (Kind::Arm, _) => combine_components(
            setup,
            samples,
            &InputComponents {
                // Slow inputs avoid rattling of the teeth, which is not reproducible on real rigs.
                slow: ((0.8, 4.0), (1.0, 2.5)),
                sweep: (5.0, 16.0, 0.4),
                steps: (0.0, (0.1, 0.1)),
            },
            draw,
        ),
    };
    let part = if test { 0.8 } else { 1.0 };
    Drive {
        input: input
            .into_iter()
            .map(|value| round_as_recorded(part * value))
            .collect(),
        start,
    }
}

/// Returns the components of the input of a machine with two bodies. `usual`: usual magnitude of
/// the input.
fn two_body_components(form: Form, usual: f64) -> InputComponents {
    let (slow, sweep, lasting) = match form {
        Form::TwoMass => ((0.5, 2.0), (3.0, 20.0), (0.05, 0.2)),
        // The sweep crosses the resonance of the load.
        Form::Crane => ((0.3, 1.0), (0.5, 4.0), (0.2, 0.5)),
        Form::QuarterCar => ((0.5, 3.0), (3.0, 20.0), (0.05, 0.2)),
    };
    InputComponents {
        slow: (slow, (0.6 * usual, 1.6 * usual)),
        sweep: (sweep.0, sweep.1, usual),
        steps: (0.6 * usual, lasting),
    }
}

/// Rounds to the digits of the record, so that machine and record have the same input.
fn round_as_recorded(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

fn viscous(machine: &Machine) -> f64 {
    match machine {
        Machine::Stage(stage) => stage.viscous,
        _ => 0.0,
    }
}

/// Returns sines that start at their maxima. With this phase, motion from rest oscillates around
/// zero.
fn sample_sines(
    setup: &Setup,
    samples: usize,
    ((low, high), (small, large)): ((f64, f64), (f64, f64)),
    draw: &mut RandomStream,
) -> Vec<f64> {
    let parts: Vec<(f64, f64)> = (0..3)
        .map(|_| {
            (
                draw.between(low, high),
                draw.between(small, large) * draw.sign(),
            )
        })
        .collect();
    let at = |sample: usize| {
        let t = sample as f64 * setup.sample;
        let sine = |(f, a): &(f64, f64)| a * (2.0 * std::f64::consts::PI * f * t).cos();
        parts.iter().map(sine).sum()
    };
    (0..samples).map(at).collect()
}

fn combine_components(
    setup: &Setup,
    samples: usize,
    of: &InputComponents,
    draw: &mut RandomStream,
) -> Vec<f64> {
    let mut values = sample_sines(setup, samples, of.slow, draw);
    let (from, to, amplitude) = of.sweep;
    let turn = draw.between(0.0, 2.0 * std::f64::consts::PI);
    let (height, (short, long)) = of.steps;
    let (mut level, mut until) = (0.0, 0.0);
    for (sample, value) in values.iter_mut().enumerate() {
        let t = sample as f64 * setup.sample;
        let turns = from * t + (to - from) * t * t / (2.0 * setup.duration);
        *value += amplitude * (2.0 * std::f64::consts::PI * turns + turn).sin();
        if t >= until {
            level = draw.between(-height, height);
            until = t + draw.between(short, long);
        }
        *value += level;
    }
    values
}
