//! Sections at events: a coordinate or a rate crosses a value in one direction. A periodic angle crosses the value once
//! per turn. The general solver locates these events like switches of the model.

use eomgen_model_spec::argument::Argument;
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;

use eomgen_codegen::program::evaluator::Enclosure;
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_model_spec::assignment::{Assignment, QuantityReader};
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_sim::ode::{Settings, SolveError, SurfaceMode, System, simulate};

use super::quantity::state_index;
use super::rotation::{MotionSamples, is_periodic_angle};
use crate::conditions::Start;
use crate::error::SweepError;
use crate::measure::Failure;

/// Number of parts of the simulated time. The simulation ends with the part that has the last crossing.
const TIME_PARTS: usize = 64;

/// Number of samples in each part, which give the extent of the motion.
const SAMPLES_PER_PART: usize = 64;

#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    name: String,
    state: usize,
    value: f64,
    is_upwards: bool,
}

impl Crossing {
    /// Parses `NAME=VALUE` (upwards), `NAME=VALUE:up` or `NAME=VALUE:down`.
    pub fn parse(model: &CompiledModel, text: &str) -> Result<Self, SweepError> {
        let refused = |reason: String| {
            SweepError::Request(format!(
                "{}: {reason}; expected NAME=VALUE, NAME=VALUE:up or \
                 NAME=VALUE:down, such as theta_dot=0:down",
                Argument::Section.with_text(text)
            ))
        };
        let (name, rest) = text
            .split_once('=')
            .ok_or_else(|| refused("no `=`".to_owned()))?;
        let (value, is_upwards) = match rest.split_once(':') {
            None => (rest, true),
            Some((value, "up")) => (value, true),
            Some((value, "down")) => (value, false),
            Some((_, other)) => return Err(refused(format!("\"{other}\" is not a direction"))),
        };
        let name = name.trim();
        let state = state_index(model, name).map_err(refused)?;
        let units = model.model().state_units(model.orders());
        let wrong = |found: Diagnostics| SweepError::Request(found.to_string());
        let given = Assignment::split(Argument::Section.name(), &format!("{name}={value}"));
        let given = given.map_err(wrong)?;
        let reader = QuantityReader::new(model.model()).map_err(wrong)?;
        Ok(Self {
            state,
            name: name.to_owned(),
            value: reader.read(&given, &units[state]).map_err(wrong)?,
            is_upwards,
        })
    }

    /// Returns the fraction of the step at which the motion crosses `value` in the required direction.
    fn crossing_fraction(&self, value: f64, before: &[f64], after: &[f64]) -> Option<f64> {
        let sign = if self.is_upwards { 1.0 } else { -1.0 };
        let above = |y: &[f64]| sign * (y[self.state] - value);
        let (from, to) = (above(before), above(after));
        (from <= 0.0 && to > 0.0).then(|| -from / (to - from))
    }

    /// Returns true if all crossings are at the same value, or at values with equal equations of motion.
    fn is_one_value(
        &self,
        (instance, start): (&Instance<'_>, &Start),
        seen: &CrossingResult,
    ) -> Result<bool, Failure> {
        let is_near = |point: &Vec<f64>| (point[self.state] - self.value).abs() < 0.5 * TAU;
        if !instance.is_angle(self.state) || seen.points.iter().all(is_near) {
            return Ok(true);
        }
        let looks = MotionSamples {
            start,
            times: &seen.times,
            states: &seen.points,
        };
        is_periodic_angle(instance, &looks, self.state)
    }
}

impl std::fmt::Display for Crossing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let direction = if self.is_upwards { "up" } else { "down" };
        write!(f, "{}={:?}:{direction}", self.name, self.value)
    }
}

pub struct CrossingResult {
    pub times: Vec<f64>,
    pub points: Vec<Vec<f64>>,
    /// States between the crossings, approximately from the first crossing on.
    pub states_between: Vec<Vec<f64>>,
}

/// Returns `kept` crossings after the first `transient` ones, in every turn of a periodic angle. `span` is in s.
/// `settings` contains the settings of the solver and a check that is called between its steps.
///
/// # Errors
/// [`Failure::FewCrossings`], or a motion that the solver does not support.
pub fn find_crossings(
    driven: (&Instance<'_>, &Start),
    crossing: &Crossing,
    (transient, kept): (usize, usize),
    span: (f64, f64),
    settings: (&Settings, &dyn Fn()),
) -> Result<CrossingResult, Failure> {
    let find = |in_every_turn| {
        let wanted = (transient, kept);
        follow_crossings(driven, (crossing, in_every_turn), wanted, span, settings)
    };
    let mut seen = find(driven.0.is_angle(crossing.state))?;
    if !crossing.is_one_value(driven, &seen)? {
        seen = find(false)?;
    }
    if seen.points.len() < transient + kept {
        return Err(Failure::FewCrossings(seen.points.len()));
    }
    for crossed in [transient + kept..seen.points.len(), 0..transient] {
        seen.points.drain(crossed.clone());
        seen.times.drain(crossed);
    }
    Ok(seen)
}

/// Returns crossings, in every turn or only at the value itself, until their number suffices.
fn follow_crossings(
    (instance, start): (&Instance<'_>, &Start),
    (crossing, in_every_turn): (&Crossing, bool),
    wanted: (usize, usize),
    span: (f64, f64),
    settings: (&Settings, &dyn Fn()),
) -> Result<CrossingResult, Failure> {
    let evaluator = RefCell::new(instance.evaluator()?);
    let Start { state, inputs } = start;
    let watched = SectionSystem {
        system: instance.driven_model(&evaluator, inputs, settings.0.tolerance)?,
        surface: Surface {
            crossing,
            turn_start: in_every_turn.then(Cell::default),
        },
        found_crossings: RefCell::default(),
    };
    let (initial, _) = instance.find_consistent_state(state, span.0, inputs)?;
    let between = watched.follow(&initial, span, wanted, settings)?;
    let (times, points) = watched.found_crossings.into_inner().into_iter().unzip();
    Ok(CrossingResult {
        times,
        points,
        states_between: between,
    })
}

struct Surface<'c> {
    crossing: &'c Crossing,
    /// Current turn, if every turn has a section. It changes only at crossings, so no crossing is skipped.
    turn_start: Option<Cell<f64>>,
}

impl Surface<'_> {
    /// Returns the values of the coordinate at both ends of a turn, which starts at the section.
    fn bounds(&self, turn: f64) -> (f64, f64) {
        let start = |turn: f64| self.crossing.value + TAU * turn;
        (start(turn), start(turn + 1.0))
    }

    fn set_turn(&self, y: &[f64]) {
        let Some(turn) = &self.turn_start else { return };
        let value = y[self.crossing.state];
        let rounded = ((value - self.crossing.value) / TAU).floor();
        let (from, to) = self.bounds(rounded);
        turn.set(match (value < from, value > to) {
            (true, _) => rounded - 1.0,
            (_, true) => rounded + 1.0,
            _ => rounded,
        });
    }

    /// Returns the guard. Its sign alternates between turns, which makes it continuous.
    fn guard(&self, y: &[f64]) -> f64 {
        let value = y[self.crossing.state];
        let Some(turn) = &self.turn_start else {
            return value - self.crossing.value;
        };
        let (from, to) = self.bounds(turn.get());
        let inside = (value - from).min(to - value);
        if turn.get().rem_euclid(2.0) == 0.0 {
            inside
        } else {
            -inside
        }
    }

    /// Returns the next value that the motion crosses in the direction of the section.
    fn next_value(&self) -> f64 {
        let Some(turn) = &self.turn_start else {
            return self.crossing.value;
        };
        let (from, to) = self.bounds(turn.get());
        if self.crossing.is_upwards { to } else { from }
    }
}

struct SectionSystem<'c, S> {
    system: S,
    surface: Surface<'c>,
    found_crossings: RefCell<Vec<(f64, Vec<f64>)>>,
}

impl<S: System> SectionSystem<'_, S> {
    /// Simulates up to the last crossing. Returns the samples from the first counted crossing on.
    fn follow(
        &self,
        initial: &[f64],
        (start, until): (f64, f64),
        (transient, kept): (usize, usize),
        (settings, check): (&Settings, &dyn Fn()),
    ) -> Result<Vec<Vec<f64>>, SolveError> {
        let (mut state, mut between, mut settings) = (initial.to_vec(), Vec::new(), *settings);
        let count = || self.found_crossings.borrow().len();
        for part in 0..TIME_PARTS {
            if count() >= transient + kept {
                break;
            }
            let length = until - start;
            let time = |share: f64| start + length * (part as f64 + share) / TIME_PARTS as f64;
            let span = (time(0.0), time(1.0));
            let samples: Vec<f64> = (0..=SAMPLES_PER_PART)
                .map(|look| match look {
                    SAMPLES_PER_PART => span.1,
                    _ => time(look as f64 / SAMPLES_PER_PART as f64),
                })
                .collect();
            self.surface.set_turn(&state);
            let motion = simulate(self, &state, span, &samples, &settings, &mut |_| check())?;
            let work = motion.statistics;
            let steps = work.steps + work.rejected_steps + work.trial_steps;
            settings.max_steps = settings.max_steps.saturating_sub(steps);
            if count() > transient {
                between.extend(motion.states);
            }
            state = motion.final_state;
        }
        Ok(between)
    }
}

impl<S: System> System for SectionSystem<'_, S> {
    fn state_count(&self) -> usize {
        self.system.state_count()
    }

    fn typical_sizes(&self) -> Vec<f64> {
        self.system.typical_sizes()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.rates(t, y, out);
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.jacobian(t, y, out);
    }

    fn guard_count(&self) -> usize {
        self.system.guard_count() + 1
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let (section, others) = match out.split_last_mut() {
            Some(split) => split,
            None => return,
        };
        *section = self.surface.guard(y);
        self.system.guards(t, y, others);
    }

    fn bound_guards(&self, t: (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) {
        if let Some((section, others)) = out.split_last_mut() {
            *section = Enclosure::UNKNOWN;
            self.system.bound_guards(t, state, others);
        }
    }

    fn is_singular(&self, guard: usize) -> bool {
        self.system.is_singular(guard)
    }

    fn has_energy_jump(&self, guard: usize) -> bool {
        self.system.has_energy_jump(guard)
    }

    fn find_indefinite_coordinate(&self, t: f64, y: &[f64]) -> Option<usize> {
        self.system.find_indefinite_coordinate(t, y)
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.system.next_breakpoint(t)
    }

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        self.system.project(t, y)
    }

    fn mark_corrected(&self, is_corrected: &mut [bool]) {
        self.system.mark_corrected(is_corrected);
    }

    fn apply_event(&self, (before, start): (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        let value = self.surface.next_value();
        if let Some(part) = self.surface.crossing.crossing_fraction(value, start, y) {
            let on = |from: f64, to: f64| from + part * (to - from);
            let state = start.iter().zip(&*y).map(|(from, to)| on(*from, *to));
            let point = (on(before, t), state.collect());
            self.found_crossings.borrow_mut().push(point);
        }
        self.surface.set_turn(y);
        self.system.apply_event((before, start), t, y)
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        let others = sides.and_then(|sides| sides.split_last());
        self.system.fix_sides(others.map(|(_, others)| others));
    }

    fn update_modes(&self, t: f64, y: &[f64]) {
        self.system.update_modes(t, y);
    }

    fn write_modes(&self, modes: &mut [SurfaceMode]) {
        if let Some((_, others)) = modes.split_last_mut() {
            self.system.write_modes(others);
        }
    }
}
