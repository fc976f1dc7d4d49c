//! Observers of the steps of the exact solver.

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, Point, Stretch};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ObservedStep, Trajectory};

use crate::audit::{Auditor, Energies, EnergyAndPower, EnergyRoundings};
use crate::error::Error;
use crate::instance::Instance;
use crate::observers::{Observers, Results};
use crate::statistics::{Meters, Observables};
use crate::sticking::ObservedMotion;

/// Reason for excluding steps during which the exact solver holds the motion on a surface.
const STICKING_EXCLUSION: &str = "during sticking, the power of the holding force is unknown";

/// Observers of an exact motion, with the sources of energies and observables.
pub(crate) struct ExactObservers {
    observers: Observers,
    /// Source of energies; `None` without audit.
    energies: Option<ExactEnergies>,
    /// Source of observables for the meters; `None` without meters.
    observed: Option<ObservedMotion>,
}

impl Instance<'_> {
    /// Returns observers of an exact motion from a time (s) and a state.
    ///
    /// # Errors
    /// A model whose evaluator cannot be prepared.
    pub(crate) fn exact_observers(
        &self,
        observers: Observers,
        (t, state): (f64, &[f64]),
        inputs: &HeldInputs,
    ) -> Result<ExactObservers, Error> {
        let observed = || {
            let start = Trajectory {
                times: vec![t],
                states: vec![state.to_vec()],
                ..Trajectory::default()
            };
            let (evaluator, holding) = (self.evaluator()?, self.holding_model()?);
            Ok::<_, Error>(ObservedMotion::new(evaluator, holding, &start, inputs))
        };
        let energies =
            (observers.auditor.as_ref()).map(|_| self.evaluator().map(ExactEnergies::new));
        let observed = (!observers.meters.is_empty()).then(observed);
        Ok(ExactObservers {
            energies: energies.transpose()?,
            observed: observed.transpose()?,
            observers,
        })
    }
}

impl ExactObservers {
    /// Observes a step with constant inputs. `is_held` is true if a surface holds the motion.
    pub fn observe_step(
        &mut self,
        step: &mut ObservedStep<'_>,
        is_held: bool,
        inputs: &HeldInputs,
    ) {
        let Self {
            observers,
            energies,
            observed,
        } = self;
        let inputs = &inputs
            .evaluate(0.5 * (step.start.0 + step.end.0))
            .into_owned();
        if let (Some(auditor), Some(energies)) = (&mut observers.auditor, energies) {
            energies.inputs.clone_from(inputs);
            audit_step(auditor, step, is_held, energies);
        }
        if let Some(observed) = observed {
            measure_step(&mut observers.meters, step, (observed, inputs, is_held));
        }
    }

    pub fn results(&self) -> Results {
        self.observers.results()
    }

    pub fn into_observers(self) -> Observers {
        self.observers
    }
}

fn audit_step(
    auditor: &mut Auditor,
    step: &mut ObservedStep<'_>,
    is_held: bool,
    energies: &mut ExactEnergies,
) {
    match is_held {
        true => auditor.exclude_step(step, energies, STICKING_EXCLUSION),
        false => auditor.audit_step(step, energies),
    }
}

/// Energy and power of an exact motion with constant inputs.
struct ExactEnergies {
    evaluator: Evaluator,
    inputs: Vec<f64>,
    observables: Vec<f64>,
    roundings: EnergyRoundings,
}

impl ExactEnergies {
    fn new(evaluator: Evaluator) -> Self {
        Self {
            observables: vec![0.0; evaluator.program().observables.len()],
            inputs: Vec::new(),
            roundings: EnergyRoundings::default(),
            evaluator,
        }
    }
}

impl Energies for ExactEnergies {
    fn evaluate(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.observables(point, &mut self.observables);
        EnergyAndPower::from_observables(&self.observables)
    }

    fn bound_roundings(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        let inputs = &self.inputs;
        self.roundings
            .bound(&self.evaluator, Point { t, state, inputs })
    }
}

fn measure_step(
    meters: &mut Meters,
    step: &mut ObservedStep<'_>,
    (observed, inputs, is_held): (&mut ObservedMotion, &[f64], bool),
) {
    for (t, state) in [step.start, step.end] {
        observed.extend(Point { t, state, inputs });
    }
    let mut observables = ExactObservables {
        observed,
        inputs,
        is_held,
    };
    meters.observe_step(step, &mut observables);
}

/// Observables of an exact motion with constant inputs.
struct ExactObservables<'o> {
    observed: &'o mut ObservedMotion,
    inputs: &'o [f64],
    is_held: bool,
}

impl Observables for ExactObservables<'_> {
    fn write(&mut self, (t, state): (f64, &[f64]), out: &mut [f64]) {
        let inputs = self.inputs;
        self.observed.observables(Point { t, state, inputs }, out);
    }

    fn bound(
        &mut self,
        (begin, end): (f64, f64),
        state: &[Enclosure],
        out: &mut [Enclosure],
    ) -> bool {
        if self.is_held {
            return false;
        }
        let constant = |input: &f64| Enclosure::constant(*input);
        let inputs: Vec<Enclosure> = self.inputs.iter().map(constant).collect();
        let stretch = Stretch {
            t: Enclosure::time(begin, end),
            state,
            inputs: &inputs,
        };
        self.observed.bound_observables(&stretch, out);
        true
    }

    fn degrees_of_freedom(&self) -> usize {
        self.observed.degrees_of_freedom()
    }
}
