//! Exact measure of size: the residual after a fit of the machine without the effect. Initial
//! states of all windows are free; declared parameters and sensors have priors and bounds (see
//! `linear`). Because impacts cause many local minima, a fit starts with short initial segments of
//! the windows.

use nalgebra::{DMatrix, DVector};

use super::linear::{Perturbations, SECANTS, SLOPES, Step, move_along, step};
use super::windows::{Span, list_spans, outputs, simulate_window, states, with_sensor_errors};
use crate::hidden::{HiddenEffect, Sensors};
use crate::inputs::Drive;
use crate::machines::{Machine, Setup};

/// Successive fractions of the windows that are fitted.
const SEGMENT_FRACTIONS: [f64; 3] = [0.1, 0.3, 1.0];

const MAX_STEPS: usize = 6;

/// Relative decrease of the cost at which the steps end.
const MIN_COST_DECREASE: f64 = 0.05;

/// Step fractions that are tried in order until one decreases the cost.
const STEP_FRACTIONS: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// Further fractions of the step for windows that improve more with a smaller step.
const WINDOW_FRACTIONS: [f64; 3] = [0.5, 0.2, 0.0];

/// Problem: fit of the machine without the effect.
pub struct Fit<'a> {
    plain: &'a Machine,
    pub(super) setup: &'a Setup,
    pub(super) drives: &'a [Drive],
    /// True values of the declared parameters, as deviations in standard deviations of their
    /// priors.
    truth: DVector<f64>,
}

/// Records of a machine with the effect, divided into windows.
pub struct Records {
    pub(super) windows: Vec<Window>,
    /// Range of the states along each of [`Machine::directions`].
    pub(super) ranges: Vec<f64>,
}

/// Window of the records.
pub struct Window {
    pub(super) span: Span,
    start: Vec<f64>,
    /// Sensor readings, relative to the noise.
    pub(super) seen: DVector<f64>,
}

/// Estimate of all unknowns.
#[derive(Clone)]
pub struct Estimate {
    /// Deviations of the declared parameters, then gain, bias and delay of each sensor, in standard
    /// deviations of their priors.
    pub(super) shared: DVector<f64>,
    pub(super) windows: Vec<WindowEstimate>,
}

/// Initial state and residual, relative to the noise.
#[derive(Clone)]
pub struct WindowEstimate {
    pub(super) start: Vec<f64>,
    pub(super) residual: DVector<f64>,
}

impl Window {
    fn initial_segment(&self, part: f64) -> Self {
        let count = (self.span.count as f64 * part).ceil() as usize;
        let channels = self.seen.len() / self.span.count;
        Self {
            span: Span { count, ..self.span },
            start: self.start.clone(),
            seen: self.seen.rows(0, count * channels).into_owned(),
        }
    }
}

impl Records {
    fn initial_segments(&self, part: f64) -> Self {
        let beginning = |window: &Window| window.initial_segment(part);
        Self {
            windows: self.windows.iter().map(beginning).collect(),
            ranges: self.ranges.clone(),
        }
    }
}

impl WindowEstimate {
    fn squares(&self) -> f64 {
        self.residual.norm_squared()
    }
}

impl Estimate {
    /// Returns the RMS residual relative to the noise.
    pub fn floors(&self) -> f64 {
        let count: usize = self.windows.iter().map(|w| w.residual.len()).sum();
        (self.squares() / count as f64).sqrt()
    }

    fn squares(&self) -> f64 {
        self.windows.iter().map(WindowEstimate::squares).sum()
    }

    fn cost(&self) -> f64 {
        self.squares() + self.shared.norm_squared()
    }
}

impl<'a> Fit<'a> {
    /// Prepares the fit of a machine. `declared`: factors of the true values on its declared
    /// parameters.
    pub fn new(
        plain: &'a Machine,
        setup: &'a Setup,
        drives: &'a [Drive],
        declared: &[(String, f64)],
    ) -> Self {
        let deviation = |(name, relative): &(&str, f64)| {
            let known = declared.iter().find(|(other, _)| other == name);
            known.map_or(0.0, |(_, factor)| (factor - 1.0) / relative)
        };
        let truth: Vec<f64> = setup.uncertain.iter().map(deviation).collect();
        Self {
            plain,
            setup,
            drives,
            truth: truth.into(),
        }
    }

    /// Returns the residual of an effect after the fit, in noise floors; NaN if the simulation
    /// fails. The better of two fits is used. A fit of whole windows with derivatives is accurate
    /// for smooth motion. A fit with secants that starts with initial segments is better for motion
    /// with impacts.
    pub fn floors(&self, hidden: &HiddenEffect) -> f64 {
        let records = self.simulate_records(hidden);
        let begin = self.initial_estimate(&records);
        if !begin.floors().is_finite() {
            return f64::NAN;
        }
        let whole = self.fit_estimate(&records, begin.clone(), SLOPES);
        let grown = self.fit_growing_segments(&records, begin, SECANTS);
        whole.floors().min(grown.floors())
    }

    fn fit_growing_segments(
        &self,
        records: &Records,
        mut estimate: Estimate,
        perturbations: Perturbations,
    ) -> Estimate {
        for part in SEGMENT_FRACTIONS {
            let beginnings = records.initial_segments(part);
            estimate = self.fit_estimate(
                &beginnings,
                self.with_residuals(&beginnings, estimate),
                perturbations,
            );
        }
        estimate
    }

    fn simulate_records(&self, hidden: &HiddenEffect) -> Records {
        let mut machine = self.plain.clone();
        let mut sensors = Sensors::ideal(self.setup.channels.len());
        hidden.hide(&mut machine, self.setup, &mut sensors);
        let all: Vec<_> = (self.drives.iter())
            .map(|drive| states(&machine, self.setup, drive))
            .collect();
        let window = |span: Span| {
            let samples = &all[span.record][span.first..span.first + span.count];
            let seen = outputs(&machine, self.setup, samples);
            Window {
                span,
                start: self.plain.plain_state(&samples[0]),
                seen: with_sensor_errors(&seen, self.setup, &sensors),
            }
        };
        Records {
            windows: list_spans(self.setup, self.drives)
                .into_iter()
                .map(window)
                .collect(),
            ranges: self.compute_ranges(all.iter().flatten()),
        }
    }

    fn compute_ranges<'s>(&self, states: impl Iterator<Item = &'s Vec<f64>>) -> Vec<f64> {
        let directions: Vec<DVector<f64>> =
            (self.plain.directions().into_iter().map(DVector::from)).collect();
        let of = DMatrix::from_columns(&directions)
            .pseudo_inverse(1e-12)
            .expect("the tolerance is positive");
        let mut ends = vec![(f64::MAX, f64::MIN); directions.len()];
        for state in states {
            let parts = &of * DVector::from_column_slice(state);
            for (end, part) in ends.iter_mut().zip(parts.iter()) {
                *end = (end.0.min(*part), end.1.max(*part));
            }
        }
        ends.into_iter().map(|(low, high)| high - low).collect()
    }

    /// Returns the estimate with the true parameters and initial states.
    fn initial_estimate(&self, records: &Records) -> Estimate {
        let unknowns = self.truth.len() + 3 * self.setup.channels.len();
        let begin = |window: &Window| WindowEstimate {
            start: window.start.clone(),
            residual: window.seen.clone(),
        };
        let estimate = Estimate {
            windows: records.windows.iter().map(begin).collect(),
            shared: self.truth.clone().resize_vertically(unknowns, 0.0),
        };
        self.with_residuals(records, estimate)
    }

    /// Returns the estimate with its residuals for other segments of the windows.
    fn with_residuals(&self, records: &Records, mut estimate: Estimate) -> Estimate {
        let (machine, sensors) = self.with(&estimate.shared);
        for (window, fitted) in records.windows.iter().zip(&mut estimate.windows) {
            fitted.residual = self.residual(&machine, &sensors, window, &fitted.start);
        }
        estimate
    }

    fn fit_estimate(
        &self,
        records: &Records,
        mut estimate: Estimate,
        perturbations: Perturbations,
    ) -> Estimate {
        for _ in 0..MAX_STEPS {
            let before = estimate.cost();
            let mut step = step(self, records, &estimate, perturbations);
            let better = |step: &Step, part: f64| {
                let moved = self.take_step(records, &estimate, step, part);
                (moved.cost() < before).then_some(moved)
            };
            let moved = STEP_FRACTIONS.iter().find_map(|part| better(&step, *part));
            let moved = moved.or_else(|| {
                step.shared.fill(0.0);
                better(&step, 1.0)
            });
            let Some(moved) = moved else {
                break;
            };
            estimate = moved;
            if estimate.cost() > (1.0 - MIN_COST_DECREASE) * before {
                break;
            }
        }
        estimate
    }

    pub(super) fn with(&self, shared: &DVector<f64>) -> (Machine, Sensors) {
        let mut machine = self.plain.clone();
        for (place, (name, relative)) in self.setup.uncertain.iter().enumerate() {
            let factor = |deviations: f64| 1.0 + relative * deviations;
            machine.scale(name, factor(shared[place]) / factor(self.truth[place]));
        }
        let of_sensors = &shared.as_slice()[self.truth.len()..];
        (machine, Sensors::within_priors(self.setup, of_sensors))
    }

    pub(super) fn parameters(&self) -> usize {
        self.truth.len()
    }

    pub(super) fn residual(
        &self,
        machine: &Machine,
        sensors: &Sensors,
        window: &Window,
        start: &[f64],
    ) -> DVector<f64> {
        let run = simulate_window(machine, self.setup, self.drives, start, window.span);
        &window.seen - with_sensor_errors(&run, self.setup, sensors)
    }

    /// Returns the estimate after a fraction of a step. The step of the initial state is smaller
    /// for windows that improve more with it.
    fn take_step(&self, records: &Records, from: &Estimate, step: &Step, part: f64) -> Estimate {
        let shared = &from.shared + part * &step.shared;
        let (machine, sensors) = self.with(&shared);
        let directions = self.plain.directions();
        let list = records.windows.iter().zip(&from.windows).zip(&step.starts);
        let windows = list.map(|((window, old), start)| {
            let trial = |part: f64| {
                let moves = directions.iter().zip(start.iter());
                let start = moves.fold(old.start.clone(), |state, (direction, by)| {
                    move_along(&state, direction, part * by)
                });
                WindowEstimate {
                    residual: self.residual(&machine, &sensors, window, &start),
                    start,
                }
            };
            let mut best = trial(part);
            for less in WINDOW_FRACTIONS {
                if best.squares() < old.squares() {
                    break;
                }
                let other = trial(part * less);
                if other.squares() < best.squares() {
                    best = other;
                }
            }
            best
        });
        Estimate {
            windows: windows.collect(),
            shared,
        }
    }
}
