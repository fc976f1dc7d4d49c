//! Reference motion of a case, and comparison of the motions of hosts with the reference.

use eomgen_compiled_model::{
    CompiledModel, Orders, Request, Solver, split_assignments, with_prescribed_inputs,
};
use eomgen_validate::random::Random;

use super::cases::Case;
use super::host::{Answer, Host, HostRun};
use super::kind::Kind;
use crate::solvers::growth::{STARTS, difference, growth, magnitudes};

/// Tolerance of the hosts.
pub const TOLERANCE: f64 = 1e-9;

/// Relative tolerance of pages.
const PAGE_TOLERANCE: f64 = 1e-8;

/// Tolerance of the motions that measure the growth of small differences.
const GROWTH_TOLERANCE: f64 = 1e-11;

/// Accepted difference, in tolerances times the growth of small differences.
const ALLOWED_TOLERANCES: f64 = 100.0;

/// Accepted difference of model exchange, in units of the growth. It is larger because the importer integrates and
/// locates events by its own methods.
const ALLOWED_EXCHANGE: f64 = 1e-5;

/// Motion of a case, simulated by `rk` with a tight tolerance.
pub struct Reference {
    states: Vec<Vec<f64>>,
    sizes: Vec<f64>,
    growth: f64,
}

/// Result of the comparison of one host for one machine.
pub enum Verdict {
    /// Difference from the reference, relative to the accepted difference.
    Compared(f64),
    Rejected(String),
    Missing(String),
}

impl Verdict {
    /// Returns the worse of two verdicts. In increasing order of severity: rejection, larger difference, missing host.
    pub fn worse(self, other: Option<Self>) -> Self {
        let rank = |verdict: &Self| match verdict {
            Self::Compared(ratio) if *ratio <= 1.0 => 0,
            Self::Rejected(_) => 1,
            Self::Compared(_) => 2,
            Self::Missing(_) => 3,
        };
        match other {
            Some(other) if rank(&other) > rank(&self) => other,
            _ => self,
        }
    }
}

impl Reference {
    /// Simulates the case and neighbouring motions from disturbed states.
    ///
    /// # Errors
    /// A motion that stops early.
    pub fn new(case: &Case) -> Result<Self, String> {
        let times = case.times();
        let sines = case.inputs.iter().filter(|input| input.sine.is_some());
        let sines = sines.map(|input| format!("{}={}", input.name, case.expression(input)));
        let texts: Vec<String> = sines.collect();
        let given = split_assignments("--input", &texts).map_err(|e| e.to_string())?;
        let model = with_prescribed_inputs(case.model.model().clone(), &given)
            .map_err(|e| e.to_string())?;
        let model = CompiledModel::derive(model, Orders::PerField(case.model.orders()))
            .map_err(|error| error.to_string())?;
        let instance = model
            .with_declared_parameters()
            .map_err(|e| e.to_string())?;
        let inputs = match texts.is_empty() {
            true => case.held_inputs(),
            false => instance.default_inputs(),
        };
        let request = Request {
            initial: &case.initial,
            times: &times,
            inputs: &inputs,
            solver: Solver::Rk,
            tolerance: GROWTH_TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = instance
            .simulate_until_stop(&request, &mut |_| {})
            .and_then(|motion| motion.into_complete())
            .map_err(|error| format!("the reference: {error}"))?;
        let states = motion.trajectory.states;
        let sizes = magnitudes(&states, &model.state_units());
        // Disturbed states are not possible for bodies in contact, which would overlap, and for controllers, whose held
        // inputs would be lost.
        let starts = match case.kind {
            Kind::Impacts | Kind::ContactFriction | Kind::Controller => &STARTS[..1],
            _ => &STARTS[..],
        };
        let drawn = (starts, &mut Random::new(1));
        let growth = growth(&instance, &request, &states, &sizes, drawn)
            .map_err(|error| format!("a neighbour of the motion: {error}"))?;
        Ok(Self {
            states,
            sizes,
            growth,
        })
    }
}

/// Compares the motion of a host with the reference.
pub fn judge(reference: &Reference, run: HostRun) -> Verdict {
    match run.answer {
        Answer::Rejected(reason) => Verdict::Rejected(reason),
        Answer::Missing(reason) => Verdict::Missing(reason),
        Answer::Motion(states) => {
            let allowed = match run.host {
                Host::ModelExchange => ALLOWED_EXCHANGE,
                Host::Page => ALLOWED_TOLERANCES * PAGE_TOLERANCE,
                _ => ALLOWED_TOLERANCES * TOLERANCE,
            };
            let expected = match states.len() {
                1 => &reference.states[reference.states.len() - 1..],
                _ => &reference.states[..],
            };
            if states.len() != expected.len() {
                return Verdict::Compared(f64::INFINITY);
            }
            let found = difference(&states, expected, &reference.sizes);
            Verdict::Compared(found / (allowed * reference.growth))
        }
    }
}
