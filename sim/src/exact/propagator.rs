//! From switch to switch. Which regimes there are is in `entered`, what lies beyond a limit in
//! `beyond`.

use std::collections::HashMap;

use codegen::affine::system::AffineEvaluator;
use fearless_simd::{Level, Simd, dispatch};
use nalgebra::{Complex, DVector};

use super::clock::Clock;
use super::entered::Entered;
use super::error::ExactError;
use super::flow::Flow;
use super::functional::Linear;
use super::groups::{Group, Place, groups};
use super::regime::Regime;
use super::search::{Effort, Found, passed, search};
use super::switching::switched_rate;
use crate::record::HeldInputs;
use crate::solve::{SolveError, Switch};

/// Switches in one instant before the motion is moved on by the shortest step.
const AT_ONCE: u32 = 16;

/// Decays that are slower than what switches by this factor are carried as polynomials: as
/// modes they would hold large amplitudes that cancel.
const SLOW: f64 = 1e-2;

/// A motion that would need more steps than this, hours of them, is not begun.
const MOST_STEPS: f64 = 1e8;

/// Over this many switches their rate is averaged.
const SWITCHES_AVERAGED: u64 = 1024;

/// Exact motion at fixed parameters.
pub struct Propagator {
    pub(super) evaluator: AffineEvaluator,
    pub(super) groups: Vec<Group>,
    pub(super) regimes: Vec<Entered>,
    pub(super) known: HashMap<Vec<Place>, usize>,
    flow: Flow,
    inputs: usize,
    pub(super) states: usize,
    pub(super) phases: Vec<[f64; 2]>,
    pub(super) saltations: Vec<DVector<f64>>,
    /// Decays up to this rate are slow beside what happens between switches, 1/s.
    pub(super) slow: f64,
    /// Give up when switches come faster than this on average, 1/s.
    pub max_switch_rate: f64,
}

/// Where a motion stands.
#[derive(Clone, Debug)]
pub struct Motion {
    pub(super) clock: Clock,
    pub(super) state: Vec<f64>,
    pub(super) regime: usize,
    at_once: u32,
    /// Whether a function may have jumped beyond its limit, and of which group it cannot.
    jumped: Option<Option<usize>>,
    /// Switches so far and the time at which the present average began.
    switches: u64,
    averaged_from: f64,
    /// The groups whose functions are leaving a surface that held the motion.
    pub(super) departing: Vec<usize>,
    /// What was done so far.
    pub(super) effort: Effort,
    /// The state at the start of the present segment.
    before: Vec<f64>,
    /// exp(i theta) of the phases now.
    phases: Vec<Complex<f64>>,
}

/// Who follows a motion.
pub(super) trait Follow {
    /// The motion went on in one regime; `flow` stands at the end and may be moved.
    fn flowed(&mut self, segment: &Segment<'_>, flow: &mut Flow);

    /// The motion changed from one regime to another at a switching surface.
    fn switched(&mut self, change: &Change<'_>);
}

/// A motion within one regime.
pub(super) struct Segment<'a> {
    pub regime: &'a Regime,
    pub places: &'a [Place],
    /// When it began.
    pub start: Clock,
    /// The state then.
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    /// How long it took, s.
    pub tau: f64,
}

/// A change of regime.
pub(super) struct Change<'a> {
    pub clock: Clock,
    /// Where the groups stood before.
    pub places: &'a [Place],
    /// The index of the function that reached its limit, and whether its upper one.
    pub limit: (usize, bool),
    pub before: &'a Regime,
    pub after: &'a Regime,
    /// The function that reached its limit, as the regime before has it.
    pub function: &'a Linear,
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    pub phases: &'a [Complex<f64>],
    /// The part of the function's rate that is not due to the state's, 1/s times its unit.
    pub explicit_rate: f64,
    /// u of the saltation matrix I + u grad g, if that is constant.
    pub saltation: Option<&'a DVector<f64>>,
    /// The first of the surfaces that were reached, and whether it is positive from here on.
    pub switch: Switch,
}

impl Motion {
    /// The time, s.
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// The state.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// How many switches there were.
    pub fn switches(&self) -> u64 {
        self.switches
    }
}

impl Propagator {
    pub(super) fn new(mut evaluator: AffineEvaluator) -> Result<Self, ExactError> {
        let sides = vec![0.0; evaluator.guard_count()];
        let system = evaluator.system(&sides);
        if !evaluator.half_widths_are_right() {
            return Err(ExactError::NegativeHalfWidth);
        }
        if !evaluator.pivots_are_positive() {
            return Err(ExactError::NotPositiveDefinite);
        }
        if system.guards.constant.iter().any(|c| !c.is_finite()) {
            return Err(ExactError::NotFinite);
        }
        Ok(Self {
            groups: groups(&evaluator, &system),
            regimes: Vec::new(),
            known: HashMap::new(),
            flow: Flow::default(),
            inputs: evaluator.inputs(),
            states: evaluator.states(),
            phases: system.phases.clone(),
            saltations: Vec::new(),
            slow: SLOW * switched_rate(&mut evaluator, &system),
            max_switch_rate: crate::solve::Settings::default().max_switch_rate,
            evaluator,
        })
    }

    /// Numbers in the state.
    pub fn states(&self) -> usize {
        self.states
    }

    /// How many regimes have been entered so far.
    pub fn regimes(&self) -> usize {
        self.regimes.len()
    }

    /// A motion from a state at a time, s.
    ///
    /// # Errors
    /// If a regime cannot be prepared.
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
        // The same motion from the same start, whatever was computed before.
        for entered in &mut self.regimes {
            entered.rung = 0;
        }
        let clock = Clock::at(t);
        let regime = self.regime_at(clock, state, held(inputs, t, self.inputs))?;
        Ok(Motion {
            clock,
            state: state.to_vec(),
            regime,
            at_once: 0,
            jumped: None,
            departing: Vec::new(),
            switches: 0,
            averaged_from: t,
            effort: Effort::default(),
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

    /// Goes on to a time, s, or to the next switch if that comes before; returns whether the
    /// time was reached.
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
        let remaining = motion.clock.until(target);
        self.check_window(motion, remaining)?;
        let values = held(inputs, now, self.inputs);
        let Entered {
            regime,
            rung,
            places,
            ..
        } = &mut self.regimes[motion.regime];
        motion.before.copy_from_slice(&motion.state);
        let flow = &mut self.flow;
        let length = remaining.min(regime.ladder.window);
        let start = motion.clock;
        let (found, leapt) = dispatch!(Level::new(), simd => {
            go_on(simd, flow, regime, motion, (values, length), rung)
        });
        let reached = match found {
            Found::Nothing if length < remaining => {
                motion.clock = start.plus(length);
                false
            }
            Found::Nothing => {
                motion.clock = Clock::at(target);
                motion.jumped = breakpoint.map(|_| None);
                breakpoint.is_none()
            }
            Found::Limit { .. } => {
                motion.clock = start.plus(flow.tau);
                false
            }
        };
        for (slot, phase) in motion.phases.iter_mut().zip(&self.phases) {
            *slot = motion.clock.phase(*phase);
        }
        if let Some(state) = motion.state.iter().position(|y| !y.is_finite()) {
            return Err(SolveError::NotFinite { t: now, state }.into());
        }
        let tau = flow.tau;
        let segment = Segment {
            regime,
            places,
            start,
            state: &motion.before,
            inputs: values,
            tau,
        };
        follow.flowed(&segment, flow);
        if let Found::Limit { functional, upper } = found {
            motion.at_once = if tau > 0.0 { 0 } else { motion.at_once + 1 };
            self.switch(motion, (functional, upper, leapt), inputs, follow)?;
        }
        Ok(reached)
    }

    /// Refuses a motion so fast, or a time so long, that there would be no end.
    fn check_window(&self, motion: &Motion, remaining: f64) -> Result<(), SolveError> {
        let window = self.regimes[motion.regime].regime.ladder.window;
        if remaining <= MOST_STEPS * window {
            return Ok(());
        }
        Err(SolveError::Request {
            problem: format!(
                "at t = {:?} s there are {remaining:e} s to go in steps of at most {window:e} s, \
                 with no end in sight; expected a shorter time, or parameters of a slower motion",
                motion.time()
            ),
        })
    }

    /// Enters the regime beyond a limit.
    fn switch(
        &mut self,
        motion: &mut Motion,
        (functional, upper, leapt): (usize, bool, bool),
        inputs: &HeldInputs,
        follow: &mut dyn Follow,
    ) -> Result<(), ExactError> {
        let before = motion.regime;
        let values = held(inputs, motion.time(), self.inputs);
        let phases = &motion.phases;
        let group = self.regimes[before].regime.functionals[functional]
            .limits
            .group;
        let beyond = match self.regimes[before].beyond[functional][usize::from(upper)] {
            Some(beyond) => beyond,
            None => self.find_beyond(before, functional, group, upper, motion.time())?,
        };
        let (mut after, mut saltation) = (beyond.regime, beyond.saltation);
        let (rank, to_positive) = crossed(self.regimes[before].places[group], upper);
        if beyond.jumps && !leapt {
            let rate = |propagator: &Self, index: usize| {
                propagator.rate(index, group, &motion.state, values, phases)
            };
            let (here, there) = (rate(self, before), rate(self, after));
            let outward = if upper { 1.0 } else { -1.0 };
            // A motion that has just left the surface, or hardly gets there, has no rate there
            // but rounding.
            let slack = self.rate_rounding(after, group, &motion.state);
            if there * outward < -slack && here * outward > -slack {
                let mut places = self.regimes[before].places.clone();
                places[group] = Place::On(rank);
                after = self.regime(&places, motion.time())?;
                saltation = None;
            }
        }
        let guard = self.groups[group].ranks[rank][0];
        let function = &self.regimes[before].regime.functionals[functional].linear;
        follow.switched(&Change {
            clock: motion.clock,
            places: &self.regimes[before].places,
            limit: (functional, upper),
            before: &self.regimes[before].regime,
            after: &self.regimes[after].regime,
            function,
            explicit_rate: self.explicit_rate(function, phases),
            saltation: saltation.map(|place| &self.saltations[place]),
            state: &motion.state,
            inputs: values,
            phases,
            switch: Switch {
                t: motion.time(),
                guard,
                to_positive,
            },
        });
        motion.regime = after;
        self.let_go(motion, before);
        if leapt {
            // A jump may have led over more than one limit.
            motion.jumped = Some(None);
        } else if beyond.moves_others || after != beyond.regime {
            motion.jumped = Some(Some(group));
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

/// Moves the state on within a regime, for `length` s at most, to the first limit that is
/// reached: which one it is, and whether a jump led over it.
#[inline(always)]
fn go_on<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    motion: &mut Motion,
    (inputs, length): (&[f64], f64),
    rung: &mut usize,
) -> (Found, bool) {
    flow.start(simd, regime, &motion.state, inputs, &motion.phases);
    // A group's function stands at the group's place among the functions.
    for group in &motion.departing {
        flow.depart(simd, regime, *group);
    }
    if motion.at_once > AT_ONCE {
        // Rounding alone decides between surfaces: the motion itself must.
        if let Some(shortest) = regime.ladder.rungs.last() {
            flow.step(simd, regime, shortest);
        }
        motion.at_once = 0;
    }
    let leap = match motion.jumped.take() {
        Some(except) => passed(simd, flow, regime, except),
        None => None,
    };
    let found = match leap {
        Some(found) => found,
        None => search(simd, flow, regime, length, rung, &mut motion.effort),
    };
    motion.departing.retain(|group| flow.is_departing(*group));
    if found == Found::Nothing {
        flow.go_to(simd, regime, length);
    }
    flow.state(simd, regime, &mut motion.state);
    (found, leap.is_some())
}

/// The inputs in force from a time on, as many as the model has.
fn held(inputs: &HeldInputs, t: f64, count: usize) -> &[f64] {
    let all = inputs.at(t);
    &all[..count.min(all.len())]
}

/// The rank of the threshold at a limit of a place, and whether its surfaces are positive
/// beyond.
fn crossed(place: Place, upper: bool) -> (usize, bool) {
    match (place, upper) {
        (Place::Between(above), true) => (above, true),
        (Place::Between(above), false) => (above - 1, false),
        (Place::On(rank), upper) => (rank, upper),
    }
}
