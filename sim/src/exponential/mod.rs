//! Exponential integrator with event location, for models that are piecewise linear except for
//! small terms, at a fixed step.
//!
//! A step propagates the linear part exactly with a matrix that is computed once per regime. Nonlinear terms
//! are held constant over the step and corrected at its end (exponential Heun method, order 2; Hochbruck and
//! Ostermann, *Exponential integrators*, Acta Numerica 19 (2010)). The cubic through both ends of a step
//! locates crossings of surfaces; such a step is made in parts. The error is a small fraction of typical sensor
//! noise. The method is several times faster than exact propagation and also propagates tangent vectors. Files:
//!
//! | task | files |
//! | --- | --- |
//! | matrices of a step | `regime`, `regime_rates`, `parameter_derivatives`, `kernels` |
//! | surfaces and events | `surfaces`, `crossing`, `partial_steps`, `release` |
//! | prescribed motions | `prescribed_motions` |
//! | nonlinear terms | `remainder`, `remainder_search` |
//! | tangent vectors | `tangents`, `slopes`, `differences` |

mod crossing;
mod differences;
#[cfg(test)]
mod holding_tests;
mod kernels;
mod parameter_derivatives;
mod partial_steps;
mod prescribed_motions;
#[cfg(test)]
mod prescribed_tests;
mod regime;
mod regime_rates;
mod release;
mod remainder;
mod remainder_search;
mod slopes;
mod surfaces;
mod tangents;
mod types;

use std::collections::HashMap;

use crate::inputs::HeldInputs;
use eomgen_codegen::program::affine::AffineEvaluator;

use crossing::find_first_crossing;
pub use parameter_derivatives::MovedParameters;
use parameter_derivatives::compute_regime_derivatives;
use prescribed_motions::PrescribedMotions;
use regime::Regime;
use regime_rates::is_held_in_varying_direction;
pub use remainder::Force;
use remainder::{RegimeDifference, Remainder};
use slopes::Slopes;
use surfaces::{Side, Surfaces, dot};
pub use tangents::{Directions, DrivingAccelerations, NoDrives, Tangents};
use types::Motion;
pub use types::{ExponentialIntegrator, Options, SampleCallback, UnsupportedModel};

/// Largest angle of the fastest mode in a step, rad. The cubic through the ends of a step then locates a
/// crossing to a hundredth of the step, as a start for the refinement.
const MAX_TURN_RAD: f64 = 1.5;

/// Minimum number of steps between two samples. Nonlinear forces are held over a step, so it must be short
/// compared with the motion, which the samples resolve.
const MIN_STEPS_PER_SAMPLE: f64 = 4.0;

/// Maximum number of steps between two samples; a model that needs more is rejected.
const MAX_STEPS_PER_SAMPLE: f64 = 256.0;

/// Largest relative deviation of an interval from a whole number of steps that is ignored. Rounded or jittering
/// clocks of records cause such deviations.
const MAX_CLOCK_JITTER: f64 = 1e-4;

/// Message for a regime without matrices.
const UNSUPPORTED_REGIME: &str =
    "the matrices of a regime are not finite, or a surface holds the motion in an unsupported way";

impl ExponentialIntegrator {
    /// Prepares a model at its parameters, for samples with the interval `sample` (s). `refinement` multiplies
    /// the number of steps that the linear part needs.
    ///
    /// # Errors
    /// An unsupported model, or a motion that is too fast for the samples.
    pub fn new(
        mut evaluator: AffineEvaluator,
        sample: f64,
        refinement: f64,
    ) -> Result<Self, UnsupportedModel> {
        let surfaces = Surfaces::new(&mut evaluator).ok_or(UnsupportedModel::UnsupportedTerms)?;
        let system = evaluator.system(&vec![0.0; evaluator.guard_count()]);
        if !system.phases.is_empty()
            || !evaluator.half_widths_are_nonnegative()
            || !evaluator.pivots_are_positive()
        {
            return Err(UnsupportedModel::UnsupportedTerms);
        }
        let mut held = (0..surfaces.guards.len())
            .flat_map(|surface| [Side::Below, Side::Above].map(|others| (surface, others)));
        if held.any(|(surface, others)| {
            is_held_in_varying_direction(&mut evaluator, &surfaces, surface, others)
        }) {
            return Err(UnsupportedModel::VaryingHoldingDirection);
        }
        let turns = sample * regime::fastest_rate(&mut evaluator, &surfaces) / MAX_TURN_RAD;
        let steps = turns.ceil().max(MIN_STEPS_PER_SAMPLE) * refinement;
        if steps.is_nan() || steps > MAX_STEPS_PER_SAMPLE {
            return Err(UnsupportedModel::TooManySteps(steps));
        }
        Ok(Self {
            typical_sizes: vec![1.0; evaluator.states()],
            states: evaluator.states(),
            prescribed: PrescribedMotions::new(&evaluator),
            degrees: evaluator.degrees_of_freedom(),
            forced: evaluator.model_states() - evaluator.degrees_of_freedom(),
            surfaces,
            regimes: Vec::new(),
            known: HashMap::new(),
            step: sample / steps,
            most_crossings: usize::MAX,
            crossings: 0,
            evaluator,
            own: Vec::new(),
            last_linear_sides: (Vec::new(), 0),
            regime_difference: RegimeDifference::default(),
            own_parameters: Vec::new(),
            moved: Vec::new(),
        })
    }

    /// Sets the typical sizes of the states, 1 by default. They scale finite differences for
    /// states near 0.
    pub fn with_typical_sizes(mut self, sizes: &[f64]) -> Self {
        self.typical_sizes = sizes.to_vec();
        self
    }

    /// Creates tangent vectors of the model. Those of parameters and those driven by accelerations start at 0.
    pub fn create_tangents<'d>(
        &self,
        directions: Directions,
        drives: &'d mut dyn DrivingAccelerations,
    ) -> Tangents<'d> {
        let sizes = (self.states, self.degrees, self.forced);
        Tangents::new(sizes, self.prescribed.clone(), directions, drives)
    }

    /// Adds tangent vectors of parameters. For each parameter, `moved` has parameter values with this parameter
    /// changed in one or both directions from `own`, the parameters of the evaluator.
    pub fn set_moved_parameters(&mut self, own: &[f64], moved: Vec<Vec<MovedParameters>>) {
        self.regimes.clear();
        self.known.clear();
        self.last_linear_sides = (Vec::new(), 0);
        self.own_parameters = own.to_vec();
        self.moved = moved;
    }

    /// Limits the number of events of a motion, such as surface crossings.
    pub fn limit_crossings(&mut self, most: usize) {
        self.most_crossings = most;
    }

    /// Simulates from `initial` at the first sample (s, ascending) to the last. Calls `show` with
    /// the index of each sample, the state and the tangent vectors.
    ///
    /// # Errors
    /// A message if the motion cannot be simulated.
    pub fn simulate(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        mut options: Options<'_, '_>,
        show: &mut SampleCallback<'_>,
    ) -> Result<(), String> {
        let Some(begin) = samples.first() else {
            return Ok(());
        };
        self.crossings = 0;
        let mut motion = self.start(*begin, initial, inputs, &mut options)?;
        let own = initial.len();
        show(0, &motion.state[..own], options.tangents.as_deref());
        for (index, end) in samples.iter().enumerate().skip(1) {
            while motion.t < *end {
                // Times of samples and of inputs may differ because of rounding.
                let near = motion.t + 1e-3 * self.step;
                let change = inputs
                    .next_change(near)
                    .filter(|next| *next < *end - 1e-3 * self.step);
                let until = change.unwrap_or(*end);
                let middle = 0.5 * (motion.t + until);
                let mut values = inputs.last_sample(middle).to_vec();
                let at = (motion.t, middle);
                self.prescribed
                    .set(inputs, at, &mut motion.state, &mut values);
                self.simulate_interval(&mut motion, until, &values, &mut options)?;
                motion.t = until;
            }
            if motion.state.iter().any(|x| !x.is_finite()) {
                return Err("the state diverged".to_owned());
            }
            show(index, &motion.state[..own], options.tangents.as_deref());
        }
        Ok(())
    }

    fn start(
        &mut self,
        t: f64,
        initial: &[f64],
        inputs: &HeldInputs,
        options: &mut Options<'_, '_>,
    ) -> Result<Motion, String> {
        let inside = t + 1e-3 * self.step;
        let mut values = inputs.last_sample(inside).to_vec();
        let mut state = initial.to_vec();
        state.resize(self.states, 0.0);
        self.prescribed
            .set(inputs, (t, inside), &mut state, &mut values);
        let mut given = vec![1.0];
        given.extend(&values);
        let count = self.surfaces.guards.len();
        let mut motion = Motion {
            t,
            state,
            sides: vec![Side::Below; count],
            regime: 0,
            given,
            base: Vec::new(),
            event_values: Vec::new(),
            remainder: Remainder::zero(self.forced, count),
            next: Vec::new(),
            later: Remainder::zero(self.forced, count),
            change: Vec::new(),
        };
        motion.regime = self.regime(&motion.sides)?;
        let functions = &self.regimes[motion.regime].functions;
        if let Some(force) = &mut options.force {
            let surfaces = (&self.surfaces, &functions[..]);
            let at = (t, &motion.state[..], &motion.given[..]);
            let later = &mut motion.later;
            later.find((&mut **force, &self.prescribed), surfaces, at);
        }
        let functions = functions.iter().zip(&motion.later.moved);
        let distances: Vec<f64> = functions
            .map(|(row, moved)| row.evaluate(&motion.state, &motion.given) + moved)
            .collect();
        let sides = distances.iter().map(|distance| Side::from_value(*distance));
        motion.sides = sides.collect();
        motion.regime = self.regime(&motion.sides)?;
        let alone = &mut Options {
            force: None,
            tangents: None,
        };
        for (surface, distance) in distances.into_iter().enumerate() {
            if distance == 0.0 {
                self.cross(&mut motion, t, (surface, 0.0), alone)?;
                if motion.sides[surface] == Side::Above {
                    self.cross(&mut motion, t, (surface, 0.0), alone)?;
                }
            }
        }
        if let Some(force) = &mut options.force {
            self.find_remainder(&mut motion, t, &mut **force)?;
        }
        if let Some(tangents) = &mut options.tangents {
            tangents.begin(&self.regimes[motion.regime], (t, &motion.state, &values));
            if options.force.is_some() {
                tangents.slopes = Some(Slopes::new(self.states, self.forced, count));
            }
        }
        Ok(motion)
    }

    /// Returns the index of the regime with these sides; creates the regime if necessary.
    fn regime(&mut self, sides: &[Side]) -> Result<usize, String> {
        self.find_or_create_regime(sides)
            .ok_or_else(|| UNSUPPORTED_REGIME.to_owned())
    }

    fn find_or_create_regime(&mut self, sides: &[Side]) -> Option<usize> {
        if let Some(known) = self.known.get(sides) {
            return *known;
        }
        let index = self.new_regime(sides).map(|regime| {
            self.regimes.push(regime);
            self.regimes.len() - 1
        });
        self.known.insert(sides.to_vec(), index);
        index
    }

    fn new_regime(&mut self, sides: &[Side]) -> Option<Regime> {
        let mut regime = Regime::new(&mut self.evaluator, &self.surfaces, sides, self.step)?;
        if !self.moved.is_empty() {
            regime.by_parameter = compute_regime_derivatives(
                &mut self.evaluator,
                &self.surfaces,
                sides,
                self.step,
                (&self.own_parameters, &self.moved),
            )?;
        }
        Some(regime)
    }

    /// Simulates with constant inputs until a time, s.
    fn simulate_interval(
        &mut self,
        motion: &mut Motion,
        until: f64,
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        motion.given.truncate(1);
        motion.given.extend(inputs);
        if let Some(force) = &mut options.force {
            let t = motion.t;
            self.find_remainder(motion, t, &mut **force)?;
        }
        self.prepare(motion);
        if let Some(tangents) = &mut options.tangents {
            let at = (motion.t, &motion.state[..], inputs);
            tangents.update_drives(&self.regimes[motion.regime], at);
        }
        let begin = motion.t;
        let count = ((until - begin) / self.step).ceil().max(1.0);
        let rounded = ((until - begin) / self.step).round();
        let whole =
            (rounded * self.step - (until - begin)).abs() < MAX_CLOCK_JITTER * (until - begin);
        let count = if whole { rounded.max(1.0) } else { count };
        let length = (until - begin) / count;
        for index in 1..=count as usize {
            self.release(motion, begin + (index - 1) as f64 * length, options)?;
            let end = begin + index as f64 * length;
            if !(whole && self.try_whole_step(motion, end, options)?) {
                self.make_partial_steps(motion, length, end, inputs, options)?;
            }
        }
        self.advance_neighbours(motion, until, options)
    }

    /// Computes the contribution of the current inputs to a step in the current regime, and the surfaces'
    /// functions.
    fn prepare(&self, motion: &mut Motion) {
        let regime = &self.regimes[motion.regime];
        motion.base.clear();
        motion.base.resize(regime.step.rows, 0.0);
        regime
            .step_given
            .add_product(&motion.given, &mut motion.base);
        self.evaluate_events(motion);
    }

    /// Evaluates the surfaces' functions and their rates at the current state. The rates do not include the
    /// change of the functions by the nonlinear remainder.
    fn evaluate_events(&self, motion: &mut Motion) {
        let regime = &self.regimes[motion.regime];
        let degrees = self.degrees;
        motion.event_values.clear();
        let rows = regime.functions.iter().zip(&motion.remainder.moved);
        motion
            .event_values
            .extend(rows.map(|(row, moved)| row.evaluate(&motion.state, &motion.given) + moved));
        for (row, function) in regime.rates.iter().zip(&regime.functions) {
            let forced = dot(&function.state[degrees..], &motion.remainder.force);
            motion
                .event_values
                .push(row.evaluate(&motion.state, &motion.given) + forced);
        }
    }

    /// Makes a whole step if it contains no event. Returns false otherwise.
    fn try_whole_step(
        &mut self,
        motion: &mut Motion,
        end: f64,
        options: &mut Options<'_, '_>,
    ) -> Result<bool, String> {
        let n = self.states;
        let regime = &self.regimes[motion.regime];
        motion.next.clear();
        motion.next.extend_from_slice(&motion.base);
        regime.step.add_product(&motion.state, &mut motion.next);
        if let Some(force) = &mut options.force {
            let held = &motion.remainder.force;
            regime.step_force.add_product(held, &mut motion.next);
            let here = (motion.regime, &motion.sides[..]);
            let at = (end, &motion.next[..n], &motion.given[..]);
            self.compute_remainder(here, at, &mut **force, &mut motion.later)?;
            let pairs = motion.later.force.iter().zip(&motion.remainder.force);
            motion.change.clear();
            motion
                .change
                .extend(pairs.map(|(new, old)| 0.5 * (new - old)));
            let regime = &self.regimes[motion.regime];
            regime
                .step_force
                .add_product(&motion.change, &mut motion.next);
        }
        let regime = &self.regimes[motion.regime];
        let surfaces = motion.sides.len();
        let (function, rate) = motion.event_values.split_at(surfaces);
        let crossed = (0..surfaces).any(|index| {
            let later = motion.later.moved[index];
            let slope = (later - motion.remainder.moved[index]) / self.step;
            let ends = (
                (function[index], rate[index] + slope),
                (
                    motion.next[n + index] + later,
                    motion.next[n + surfaces + index] + slope,
                ),
            );
            find_first_crossing(motion.sides[index], ends, self.step).is_some()
        });
        let begin = (&motion.state[..], &motion.remainder);
        let ends = (begin, (&motion.next[..n], &motion.later));
        if crossed || self.find_first_release(motion, ends, self.step).is_some() {
            return Ok(false);
        }
        motion.state.copy_from_slice(&motion.next[..n]);
        motion
            .event_values
            .copy_from_slice(&motion.next[n..n + 2 * surfaces]);
        if options.force.is_some() {
            std::mem::swap(&mut motion.remainder, &mut motion.later);
            for index in 0..surfaces {
                let row = &regime.functions[index].state[self.degrees..];
                motion.event_values[index] += motion.remainder.moved[index];
                motion.event_values[surfaces + index] += dot(row, &motion.remainder.force);
            }
        }
        if options.tangents.as_deref_mut().is_some_and(Tangents::step) {
            self.advance_neighbours(motion, end, options)?;
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests;
