//! Propagation from switch to switch. `visited_regimes` creates the regimes, `adjacent_regimes` finds the
//! regimes beyond their limits.

use std::collections::HashMap;

use eomgen_codegen::program::affine::AffineEvaluator;
use fearless_simd::Simd;

use crate::registers::dispatch_registers;
use nalgebra::{Complex, DVector};

use super::clock::Clock;
use super::dependents::{DecisionCause, StateAt};
use super::error::ExactError;
use super::event_function::Linear;
use super::flow::Flow;
use super::outline::Outline;
use super::parallel_guards::{Cell, ParallelGuards, find_families};
use super::regime::Regime;
use super::search::{SearchResult, SearchStatistics, find_jumped_function, search};
use super::switching::find_switched_rate;
use super::transition::{Limit, Transition};
use super::visited_regimes::VisitedRegime;
use crate::inputs::HeldInputs;
use crate::ode::SolveError;

/// Number of switches at one time after which the motion is advanced by the shortest step.
const MAX_SIMULTANEOUS_SWITCHES: u32 = 16;

/// Decays slower than the switching by this factor are treated as polynomials: as modes they would have large
/// amplitudes that cancel.
const SLOW_DECAY_RATIO: f64 = 1e-2;

/// Largest number of steps of a motion, equivalent to hours; a longer motion is rejected.
const MAX_STEPS: f64 = 1e8;

/// Number of switches over which their rate is averaged.
const SWITCHES_AVERAGED: u64 = 1024;

/// Exact propagator at fixed parameters.
pub struct Propagator {
    pub(super) evaluator: AffineEvaluator,
    pub(super) families: Vec<ParallelGuards>,
    pub(super) regimes: Vec<VisitedRegime>,
    pub(super) known: HashMap<Vec<Cell>, usize>,
    /// True for each family whose function depends on the sides of others, or only on inputs.
    pub(super) dependent: Vec<bool>,
    pub(super) outlines: Vec<Outline>,
    pub(super) outlined: HashMap<Vec<Cell>, usize>,
    /// Index of the saltation matrix, `None` if it is not constant. The key is the regime before, the index of
    /// the function, true for its upper limit, and the regime after.
    pub(super) saltation_of: HashMap<(usize, usize, bool, usize), Option<usize>>,
    flow: Flow,
    pub(super) inputs: usize,
    pub(super) states: usize,
    pub(super) phases: Vec<[f64; 2]>,
    pub(super) saltations: Vec<DVector<f64>>,
    /// Largest rate of decays that are slow compared with the switching, 1/s.
    pub(super) slow: f64,
    /// Maximum average number of events per second; the simulation stops if it is exceeded.
    pub max_switch_rate: f64,
}

/// A motion in progress.
#[derive(Clone, Debug)]
pub struct Motion {
    pub(super) clock: Clock,
    pub(super) state: Vec<f64>,
    pub(super) regime: usize,
    at_once: u32,
    /// Families whose functions may have jumped beyond their limits.
    jumped: Option<JumpedFamilies>,
    /// Number of switches so far, and the time at which the current average started.
    switches: u64,
    averaged_from: f64,
    /// Functions that are leaving a surface that held the motion.
    pub(super) departing: Vec<Departure>,
    /// Work done so far.
    pub(super) effort: SearchStatistics,
    /// State at the start of the current segment.
    before: Vec<f64>,
    /// exp(i theta) of the phases at the current time.
    phases: Vec<Complex<f64>>,
}

/// A function that is leaving a surface that held the motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    pub family: usize,
    /// Errors of value and rate, once known. They are determined at the release: the distance from the surface
    /// that grows later is no error.
    pub errors: Option<[f64; 2]>,
}

/// Families whose functions may have jumped beyond their limits.
#[derive(Clone, Copy, Debug)]
enum JumpedFamilies {
    /// All families.
    Any,
    /// All families except this one.
    AnyBut(usize),
    /// Families whose function is held on a threshold.
    Held,
}

impl JumpedFamilies {
    fn includes(self, family: usize, cells: &[Cell]) -> bool {
        match self {
            Self::Any => true,
            Self::AnyBut(one) => family != one,
            Self::Held => matches!(cells[family], Cell::On(_)),
        }
    }
}

/// Observer of a motion.
pub(super) trait Follow {
    /// Observes a segment in one regime. `flow` is at the end of the segment and may be moved.
    fn observe_segment(&mut self, segment: &Segment<'_>, flow: &mut Flow);

    /// Observes a change from one regime to another at a switching surface.
    fn observe_switch(&mut self, change: &Change<'_>);
}

/// Motion within one regime.
pub(super) struct Segment<'a> {
    pub regime: &'a Regime,
    /// Time at the start.
    pub start: Clock,
    /// State at the start.
    pub state: &'a [f64],
    /// Duration, s.
    pub tau: f64,
    /// True if a surface held the motion.
    pub is_held: bool,
}

/// A change of regime.
pub(super) struct Change<'a> {
    pub before: &'a Regime,
    pub after: &'a Regime,
    /// Function that reached its limit, in the regime before the change.
    pub function: &'a Linear,
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    pub phases: &'a [Complex<f64>],
    /// Part of the function's rate that is due to time, not to the rates of the state, 1/s times its unit.
    pub explicit_rate: f64,
    /// Vector u of the saltation matrix I + u grad g, if it is constant.
    pub saltation: Option<&'a DVector<f64>>,
    /// Time, s.
    pub t: f64,
    /// Families of surfaces, and the cell of each family in both regimes.
    pub families: &'a [ParallelGuards],
    pub cells: (&'a [Cell], &'a [Cell]),
}

impl Motion {
    /// Returns the time reached, s.
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Returns the state.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Returns the number of events up to now.
    pub fn switch_count(&self) -> u64 {
        self.switches
    }
}

impl Propagator {
    pub(super) fn new(mut evaluator: AffineEvaluator) -> Result<Self, ExactError> {
        let sides = vec![0.0; evaluator.guard_count()];
        let system = evaluator.system(&sides);
        if !evaluator.half_widths_are_nonnegative() {
            return Err(ExactError::NegativeHalfWidth);
        }
        if !evaluator.pivots_are_positive() {
            return Err(ExactError::NotPositiveDefinite);
        }
        if system.guards.constant.iter().any(|c| !c.is_finite()) {
            return Err(ExactError::NotFinite);
        }
        let families = find_families(&evaluator, &system);
        let rests = evaluator.guards_rest();
        let rests =
            |family: &ParallelGuards| family.ranks.iter().flatten().any(|guard| rests[*guard]);
        Ok(Self {
            dependent: families.iter().map(rests).collect(),
            outlines: Vec::new(),
            outlined: HashMap::new(),
            saltation_of: HashMap::new(),
            families,
            regimes: Vec::new(),
            known: HashMap::new(),
            flow: Flow::default(),
            inputs: evaluator.inputs(),
            states: evaluator.states(),
            phases: system.phases.clone(),
            saltations: Vec::new(),
            slow: SLOW_DECAY_RATIO * find_switched_rate(&mut evaluator, &system),
            max_switch_rate: crate::ode::Settings::default().max_switch_rate,
            evaluator,
        })
    }

    /// Returns the number of states.
    pub fn state_count(&self) -> usize {
        self.states
    }

    /// Starts a motion from a state at a time (s).
    ///
    /// # Errors
    /// An invalid state, or a regime that cannot be prepared.
    pub fn start(
        &mut self,
        t: f64,
        state: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Motion, ExactError> {
        if state.len() != self.states || state.iter().any(|y| !y.is_finite()) || !t.is_finite() {
            let problem = format!(
                "expected {} finite initial values and a finite time",
                self.states
            );
            return Err(SolveError::Request { problem }.into());
        }
        // The result must not depend on motions computed before.
        for visited in &mut self.regimes {
            visited.step = 0;
        }
        let clock = Clock::new(t);
        let regime = self.find_regime_at(clock, state, held_inputs(inputs, t, self.inputs))?;
        Ok(Motion {
            clock,
            state: state.to_vec(),
            regime,
            at_once: 0,
            jumped: None,
            departing: Vec::new(),
            switches: 0,
            averaged_from: t,
            effort: SearchStatistics::default(),
            before: state.to_vec(),
            phases: self.phases_at(clock),
        })
    }

    pub(super) fn phases_at(&self, clock: Clock) -> Vec<Complex<f64>> {
        self.phases
            .iter()
            .map(|phase| clock.phase(*phase))
            .collect()
    }

    /// Propagates the motion to a time, s, or to the next switch if that is earlier. Returns true if the time
    /// was reached.
    pub(super) fn advance(
        &mut self,
        motion: &mut Motion,
        end: f64,
        inputs: &HeldInputs,
        follow: &mut dyn Follow,
    ) -> Result<bool, ExactError> {
        let now = motion.time();
        let breakpoint = inputs.next_change(now).filter(|next| *next < end);
        let target = breakpoint.unwrap_or(end);
        let remaining = motion.clock.time_until(target);
        self.check_window(motion, remaining)?;
        let values = held_inputs(inputs, now, self.inputs);
        let VisitedRegime {
            regime,
            step,
            cells,
            ..
        } = &mut self.regimes[motion.regime];
        motion.before.copy_from_slice(&motion.state);
        let flow = &mut self.flow;
        let length = remaining.min(regime.step_table.window);
        let start = motion.clock;
        let (found, by_jump) = dispatch_registers!(simd => {
            advance_in_regime(simd, flow, (regime, cells), motion, (values, length), step)
        });
        let reached = match found {
            SearchResult::Nothing if length < remaining => {
                motion.clock = start.advanced_by(length);
                false
            }
            SearchResult::Nothing => {
                motion.clock = Clock::new(target);
                motion.jumped = breakpoint.map(|_| JumpedFamilies::Any);
                breakpoint.is_none()
            }
            SearchResult::Limit { .. } => {
                motion.clock = start.advanced_by(flow.tau);
                false
            }
        };
        let diverged = motion.state.iter().position(|y| !y.is_finite());
        if diverged.is_some() {
            flow.return_to_finite_state(regime, &mut motion.state);
            motion.clock = start.advanced_by(flow.tau);
        }
        for (slot, phase) in motion.phases.iter_mut().zip(&self.phases) {
            *slot = motion.clock.phase(*phase);
        }
        let tau = flow.tau;
        let segment = Segment {
            regime,
            start,
            state: &motion.before,
            tau,
            is_held: cells.iter().any(|cell| matches!(cell, Cell::On(_))),
        };
        follow.observe_segment(&segment, flow);
        if let Some(state) = diverged {
            let t = motion.time();
            return Err(SolveError::NotFinite { t, state }.into());
        }
        if found == SearchResult::Nothing && breakpoint.is_some() {
            self.apply_inputs(motion, inputs)?;
        }
        if let SearchResult::Limit {
            event_function,
            upper,
        } = found
        {
            motion.at_once = if tau > 0.0 { 0 } else { motion.at_once + 1 };
            self.switch(motion, (event_function, upper, by_jump), inputs, follow)?;
        }
        Ok(reached)
    }

    /// Rejects a motion so fast, or a duration so long, that the simulation would not end.
    fn check_window(&self, motion: &Motion, remaining: f64) -> Result<(), SolveError> {
        let window = self.regimes[motion.regime].regime.step_table.window;
        if remaining <= MAX_STEPS * window {
            return Ok(());
        }
        Err(SolveError::Request {
            problem: format!(
                "at t = {:?} s the motion needs steps of at most {window:e} s for the remaining {remaining:e} s, \
                 which are too many; shorten the time, or choose parameters of a slower motion",
                motion.time()
            ),
        })
    }

    /// Applies a change of the inputs at the time reached.
    ///
    /// # Errors
    /// A regime that cannot be prepared.
    pub fn follow_input_jump(
        &mut self,
        motion: &mut Motion,
        inputs: &HeldInputs,
    ) -> Result<(), ExactError> {
        motion.jumped = Some(JumpedFamilies::Any);
        self.apply_inputs(motion, inputs)
    }

    /// Enters the regime after a change of inputs, if functions depend only on inputs or on the sides of other
    /// surfaces.
    fn apply_inputs(&mut self, motion: &mut Motion, inputs: &HeldInputs) -> Result<(), ExactError> {
        if !self.has_dependents() {
            return Ok(());
        }
        let mut cells = self.regimes[motion.regime].cells.clone();
        let before = self.outline(&cells);
        let point = StateAt {
            state: &motion.state,
            inputs: held_inputs(inputs, motion.time(), self.inputs),
            phases: &motion.phases,
        };
        self.determine_cells(&mut cells, DecisionCause::Jump(before), point);
        motion.regime = self.regime(&cells, motion.time())?;
        Ok(())
    }

    /// Enters the regime beyond a limit.
    fn switch(
        &mut self,
        motion: &mut Motion,
        (event_function, upper, by_jump): (usize, bool, bool),
        inputs: &HeldInputs,
        follow: &mut dyn Follow,
    ) -> Result<(), ExactError> {
        let before = motion.regime;
        let values = held_inputs(inputs, motion.time(), self.inputs);
        let point = StateAt {
            state: &motion.state,
            inputs: values,
            phases: &motion.phases,
        };
        let family = self.regimes[before].regime.event_functions[event_function]
            .limits
            .family;
        let limit = Limit {
            before,
            event_function,
            family,
            upper,
            by_jump,
            t: motion.time(),
        };
        let Transition {
            after,
            saltation,
            moves_others,
        } = self.transition(&limit, point)?;
        let rank = limit.rank(self.regimes[before].cells[family]);
        let phases = &motion.phases;
        let guard = self.families[family].ranks[rank][0];
        let function = &self.regimes[before].regime.event_functions[event_function].linear;
        follow.observe_switch(&Change {
            before: &self.regimes[before].regime,
            after: &self.regimes[after].regime,
            function,
            explicit_rate: self.explicit_rate(function, phases),
            saltation: saltation.map(|index| &self.saltations[index]),
            state: &motion.state,
            inputs: values,
            phases,
            t: motion.time(),
            families: &self.families,
            cells: (&self.regimes[before].cells, &self.regimes[after].cells),
        });
        motion.regime = after;
        self.release_surfaces(motion, before);
        if by_jump {
            // The jump may exceed more than one limit.
            motion.jumped = Some(JumpedFamilies::Any);
        } else if self.has_dependents() {
            // The cells of all other families have been determined.
            motion.jumped = Some(JumpedFamilies::Held);
        } else if moves_others {
            motion.jumped = Some(JumpedFamilies::AnyBut(family));
        }
        self.count_switch(motion, guard)
    }

    fn count_switch(&self, motion: &mut Motion, guard: usize) -> Result<(), ExactError> {
        motion.switches += 1;
        if motion.switches.is_multiple_of(SWITCHES_AVERAGED) {
            let (t, rate) = (motion.time(), self.max_switch_rate);
            if (t - motion.averaged_from) * rate < SWITCHES_AVERAGED as f64 {
                return Err(SolveError::TooManySwitches { t, guard, rate }.into());
            }
            motion.averaged_from = t;
        }
        Ok(())
    }
}

/// Advances the state within a regime to the first limit that it reaches, by at most `length` s. Returns this
/// limit, and true if a jump exceeded it.
#[inline(always)]
fn advance_in_regime<S: Simd>(
    simd: S,
    flow: &mut Flow,
    (regime, cells): (&Regime, &[Cell]),
    motion: &mut Motion,
    (inputs, length): (&[f64], f64),
    step: &mut usize,
) -> (SearchResult, bool) {
    flow.start(simd, regime, &motion.state, inputs, &motion.phases);
    // Functions have the same indices as their families.
    for departure in &motion.departing {
        match departure.errors {
            None => flow.start_departure(simd, regime, departure.family),
            Some(errors) => flow.continue_departure(departure.family, errors),
        }
    }
    if motion.at_once > MAX_SIMULTANEOUS_SWITCHES {
        // Only rounding errors separate the surfaces, so the motion is advanced first.
        if let Some(shortest) = regime.step_table.steps.last() {
            flow.step(simd, regime, shortest);
        }
        motion.at_once = 0;
    }
    let jump = match motion.jumped.take() {
        Some(jumped) => {
            find_jumped_function(simd, flow, regime, |family| jumped.includes(family, cells))
        }
        None => None,
    };
    let found = match jump {
        Some(found) => found,
        None => search(simd, flow, regime, length, step, &mut motion.effort),
    };
    if found == SearchResult::Nothing {
        flow.advance_to(simd, regime, length);
        flow.end_departures(simd, regime);
    }
    motion.departing.retain_mut(|departure| {
        departure.errors = flow.departure_errors(departure.family);
        departure.errors.is_some()
    });
    flow.state(simd, regime, &mut motion.state);
    (found, jump.is_some())
}

/// Returns the inputs of the model that apply from a time on.
fn held_inputs(inputs: &HeldInputs, t: f64, count: usize) -> &[f64] {
    let all = inputs.last_sample(t);
    &all[..count.min(all.len())]
}
