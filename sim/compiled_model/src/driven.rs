//! A derived model seen by the solvers: the evaluator of its program and the inputs that drive
//! it behind their trait.

use std::borrow::Borrow;
use std::cell::{RefCell, RefMut};

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::{Op, ValueId};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ObservedStep, Surface, System, jacobian_by_differences};

use crate::audit::{Audit, Auditor, EnergyAt};
use crate::contacts::Contacts;
use crate::jacobians::{Jacobian, JacobianEvaluator};
use crate::projection::Projection;
use crate::sliding::{Sided, Sliding};

/// A derived model driven by inputs, as the solvers see it; it owns or borrows both. The mass
/// matrix has positive pivots at the evaluator's parameters.
pub struct Driven<E, I> {
    evaluator: E,
    inputs: I,
    jacobians: Option<RefCell<JacobianEvaluator>>,
    projection: Option<Projection>,
    contacts: Option<RefCell<Contacts>>,
    sliding: Option<RefCell<Sliding>>,
    auditor: Option<RefCell<Auditor>>,
    /// Typical sizes of the states; empty if all are 1.
    typical_sizes: Vec<f64>,
}

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> Driven<E, I> {
    /// Takes an evaluator, prepared with the parameters to be used, and its inputs.
    pub fn new(evaluator: E, inputs: I) -> Self {
        Self {
            evaluator,
            inputs,
            jacobians: None,
            projection: None,
            contacts: None,
            sliding: None,
            auditor: None,
            typical_sizes: Vec::new(),
        }
    }

    /// The same with the typical sizes of its states, as [`crate::CompiledModel::typical_sizes`] has them.
    pub fn with_typical_sizes(mut self, sizes: &[f64]) -> Self {
        self.typical_sizes = sizes.to_vec();
        self
    }

    /// The same with an auditor of its energy.
    pub(crate) fn with_auditor(mut self, auditor: Option<Auditor>) -> Self {
        self.auditor = auditor.map(RefCell::new);
        self
    }

    /// The energy balance of the motion so far, if it was audited.
    pub(crate) fn audit(&self) -> Option<Audit> {
        let auditor = self.auditor.as_ref()?;
        Some(auditor.borrow().audit().clone())
    }

    /// Energy and power, with the forces that hold the motion where surfaces do, and those of contacts at rest.
    fn energies(&self, t: f64, state: &[f64]) -> EnergyAt {
        let mut observables = vec![0.0; self.evaluator().program().observables.len()];
        match self.sliding.as_ref().filter(|_| self.slides()) {
            Some(sliding) => {
                let inputs = &self.inputs.borrow().at(t);
                let mut sliding = sliding.borrow_mut();
                sliding.observables((t, state), inputs, &mut observables);
            }
            None => self.at(t, state, |evaluator, point| {
                evaluator.observables(point, &mut observables);
            }),
        }
        let mut found = EnergyAt::of(&observables);
        if let Some(contacts) = &self.contacts {
            found.power += self.at(t, state, |evaluator, point| {
                contacts.borrow_mut().power(evaluator, point)
            });
        }
        found
    }

    /// The same that keeps states on the constraints, at the same parameters.
    pub(crate) fn with_projection(mut self, projection: Option<Projection>) -> Self {
        self.projection = projection;
        self
    }

    /// The same where bodies hit at the impacts of these names, if there are any: those of the
    /// program, in its order.
    pub(crate) fn with_impacts(mut self, names: Vec<String>) -> Self {
        self.contacts = (!names.is_empty()).then(|| RefCell::new(Contacts::new(names)));
        self
    }

    /// The same where surfaces may hold the motion, as dry friction does, at the same parameters. A motion
    /// of its own, as what holds is remembered.
    pub fn with_sliding(mut self, sided: Option<Sided>) -> Self {
        self.sliding = sided.map(|sided| RefCell::new(Sliding::new(sided)));
        self
    }

    /// What it was given for surfaces that may hold the motion, for another motion.
    pub fn into_sided(self) -> Option<Sided> {
        let sliding = self.sliding?;
        Some(sliding.into_inner().into_sided())
    }

    /// What keeps states on the constraints, if there are any.
    pub(crate) fn projection(&self) -> Option<&Projection> {
        self.projection.as_ref()
    }

    /// The impact at which bodies overlap, if the motion ended for that: why, and what to do.
    pub(crate) fn overlap(&self) -> Option<String> {
        self.contacts.as_ref()?.borrow().overlap()
    }

    /// Whether a contact is closed.
    fn rests(&self) -> bool {
        let contacts = self.contacts.as_ref();
        contacts.is_some_and(|contacts| contacts.borrow().rest())
    }

    /// Whether the rates are not those that the signs of the switching functions give.
    fn slides(&self) -> bool {
        let sliding = self.sliding.as_ref();
        sliding.is_some_and(|sliding| sliding.borrow().is_active())
    }

    /// The same with its own Jacobian, at the same parameters, for implicit methods.
    pub fn with_jacobian(mut self, jacobians: JacobianEvaluator) -> Self {
        self.jacobians = Some(RefCell::new(jacobians));
        self
    }

    fn evaluator(&self) -> RefMut<'_, Evaluator> {
        self.evaluator.borrow().borrow_mut()
    }

    /// What `of` makes of the model at a time and a state, with the inputs then.
    fn at<T>(&self, t: f64, state: &[f64], of: impl FnOnce(&mut Evaluator, Point<'_>) -> T) -> T {
        let inputs = &self.inputs.borrow().at(t);
        of(&mut self.evaluator(), Point { t, state, inputs })
    }

    /// The switching functions, those over modes one by one. A speed is one that depends on rates,
    /// and on no coordinate where nothing moves.
    pub fn surfaces(&self) -> Vec<Surface> {
        let (here, there) = (self.guards_at_rest(0.11), self.guards_at_rest(0.17));
        let evaluator = self.evaluator();
        let program = evaluator.program();
        let is_rate =
            |id: &ValueId| matches!(program.value(*id).op, Op::Rate(_) | Op::ModeRates(_));
        let all = program.guards.iter().flat_map(|guard| {
            let moves = program.reachable(&[guard.value]).iter().any(is_rate);
            let count = program.value(guard.value).extent.length();
            std::iter::repeat_n((&guard.formula, moves), count)
        });
        let own = all
            .zip(here.iter().zip(&there))
            .map(|((formula, moves), (here, there))| Surface {
                formula: formula.clone(),
                is_speed: moves && here == there,
            });
        let contacts = self.contacts.iter();
        let names = contacts.flat_map(|contacts| contacts.borrow().names.clone());
        let impacts = names.map(|formula| Surface {
            formula,
            is_speed: false,
        });
        own.chain(impacts).collect()
    }

    /// The switching functions where nothing moves, with coordinates of this size.
    fn guards_at_rest(&self, size: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.evaluator().guard_count()];
        let mut state = vec![0.0; self.states()];
        let degrees = self.evaluator().program().degrees_of_freedom();
        for (place, coordinate) in state[..degrees].iter_mut().enumerate() {
            *coordinate = size / (place + 2) as f64;
        }
        self.at(0.0, &state, |evaluator, point| {
            evaluator.guards(point, &mut values);
        });
        values
    }
}

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> System for Driven<E, I> {
    fn states(&self) -> usize {
        self.evaluator().program().states()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        if let Some(sliding) = self.sliding.as_ref().filter(|_| self.slides()) {
            let inputs = &self.inputs.borrow().at(t);
            return sliding.borrow_mut().rates((t, y), inputs, out);
        }
        self.at(t, y, |evaluator, point| {
            evaluator.rates(point, out);
            if let Some(contacts) = &self.contacts {
                contacts.borrow_mut().add_to_rates(evaluator, point, out);
            }
        });
    }

    fn typical_sizes(&self) -> Vec<f64> {
        match self.typical_sizes.is_empty() {
            true => vec![1.0; self.states()],
            false => self.typical_sizes.clone(),
        }
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let is_on = |sliding: &&RefCell<Sliding>| !RefCell::borrow(sliding).is_free();
        if let Some(sliding) = self.sliding.as_ref().filter(is_on) {
            let inputs = &self.inputs.borrow().at(t);
            let given = (&inputs[..], &self.typical_sizes()[..]);
            return sliding.borrow_mut().jacobian((t, y), given, out);
        }
        match &self.jacobians {
            Some(jacobians) if !self.rests() => {
                let mut jacobians = jacobians.borrow_mut();
                let inputs = &self.inputs.borrow().at(t);
                let point = Point {
                    t,
                    state: y,
                    inputs,
                };
                jacobians.evaluate(Jacobian::RatesByState, point, out);
            }
            _ => jacobian_by_differences(self, t, y, out),
        }
    }

    fn guard_count(&self) -> usize {
        let contacts = self.contacts.as_ref();
        let contacts = contacts.map_or(0, |contacts| contacts.borrow().names.len());
        self.evaluator().guard_count() + contacts
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.at(t, y, |evaluator, point| {
            let (own, more) = out.split_at_mut(evaluator.guard_count());
            evaluator.guards(point, own);
            if let Some(contacts) = &self.contacts {
                contacts.borrow_mut().guards(evaluator, point, more);
            }
        });
        if let Some(sliding) = &self.sliding {
            let inputs = &self.inputs.borrow().at(t);
            sliding.borrow_mut().guards((t, y), inputs, out);
        }
    }

    fn indefinite(&self, t: f64, y: &[f64]) -> Option<usize> {
        let mut evaluator = self.evaluator();
        let size = evaluator.program().degrees_of_freedom();
        let mut mass = vec![0.0; size * size];
        let inputs = &self.inputs.borrow().at(t);
        evaluator.mass_matrix(
            Point {
                t,
                state: y,
                inputs,
            },
            &mut mass,
        );
        first_not_positive(&mut mass, size)
    }

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        let holds = self.projection.is_some() || self.contacts.is_some() || self.slides();
        if !holds {
            return 0;
        }
        let inputs = &self.inputs.borrow().at(t);
        let (at, mut evaluations) = ((t, &inputs[..]), 0);
        if let Some(projection) = &self.projection {
            let given = self.inputs.borrow();
            evaluations += projection.after_a_step(&mut self.evaluator(), t, given, y);
        }
        if let Some(contacts) = &self.contacts {
            evaluations += contacts.borrow_mut().keep(&mut self.evaluator(), at, y);
        }
        if let Some(sliding) = &self.sliding {
            evaluations += sliding.borrow_mut().keep(t, inputs, y);
        }
        evaluations
    }

    fn cross(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) {
        if let Some(contacts) = &self.contacts {
            let arrived = self.auditor.as_ref().map(|_| y.to_vec());
            let inputs = &self.inputs.borrow().at(t);
            contacts
                .borrow_mut()
                .cross(&mut self.evaluator(), inputs, before, t, y);
            let work = contacts.borrow().impact_work();
            if let (Some(auditor), Some(arrived)) = (&self.auditor, arrived)
                && arrived != y
            {
                let energies = &mut |t: f64, y: &[f64]| self.energies(t, y);
                let states = (&arrived[..], &*y);
                auditor.borrow_mut().impact(t, states, work, energies);
            }
        }
        if let Some(sliding) = &self.sliding {
            let inputs = &self.inputs.borrow().at(t);
            sliding.borrow_mut().cross(inputs, before, t, y);
        }
    }

    fn keep_sides(&self, sides: Option<&[f64]>) {
        if let Some(sliding) = &self.sliding {
            sliding.borrow_mut().keep_sides(sides);
        }
    }

    fn caught_or_let_go(&self, t: f64, y: &[f64]) -> Vec<(usize, bool)> {
        let Some(sliding) = &self.sliding else {
            return Vec::new();
        };
        let given = self.inputs.borrow();
        let (earlier, inputs) = (given.at(t.next_down()), given.at(t));
        let mut sliding = sliding.borrow_mut();
        sliding.arrive((t, y), (earlier.as_ref(), inputs.as_ref()))
    }

    fn is_observing(&self) -> bool {
        self.auditor.is_some()
    }

    fn observe_step(&self, step: &mut ObservedStep<'_>) {
        let Some(auditor) = &self.auditor else {
            return;
        };
        let mut auditor = auditor.borrow_mut();
        let energies = &mut |t: f64, y: &[f64]| self.energies(t, y);
        match auditor.driven_contacts().map(str::to_owned) {
            Some(reason) if self.rests() => auditor.leave_out(step, energies, &reason),
            _ => auditor.step(step, energies),
        }
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.inputs.borrow().next_change(t)
    }
}

/// A pivot that is this small beside its diagonal entry is rounding.
const NOTHING_LEFT: f64 = 1e-14;

/// The first row of a symmetric matrix, of finite entries, whose pivot is not positive when the
/// rows before it are eliminated.
fn first_not_positive(matrix: &mut [f64], size: usize) -> Option<usize> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    for row in 0..size {
        let diagonal = matrix[row * size + row];
        // Row by row, L L^T = matrix, into its lower part.
        for column in 0..=row {
            let products = (0..column)
                .map(|k| matrix[row * size + k] * matrix[column * size + k])
                .sum::<f64>();
            let rest = matrix[row * size + column] - products;
            if column == row && rest <= NOTHING_LEFT * diagonal.abs() {
                return Some(row);
            }
            matrix[row * size + column] = if column == row {
                rest.sqrt()
            } else {
                rest / matrix[column * size + column]
            };
        }
    }
    None
}
