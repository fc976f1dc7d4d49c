//! The solvers' [`System`] for a compiled model: the evaluator of its program and the inputs that
//! drive it.

use std::borrow::Borrow;
use std::cell::{RefCell, RefMut};

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, Point, Stretch};
use eomgen_codegen::program::{Op, ValueId};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{
    ObservedStep, Surface, SurfaceKind, SurfaceMode, System, jacobian_by_differences,
};

use crate::audit::{Auditor, Energies, EnergyAndPower, EnergyRoundings};
use crate::contacts::Contacts;
use crate::corners::{CornerEnergy, Corners, TouchingContact};
use crate::jacobians::{Jacobian, JacobianEvaluator};
use crate::motion::FrictionChoice;
use crate::observers::{Observers, Results};
use crate::projection::Projection;
use crate::statistics::{Meters, Observables};
use crate::sticking::{SidedModel, SurfaceStates};

/// Maximum number of alternating decisions of surfaces and contacts at an event.
const MAX_REVISIONS: usize = 20;

/// Compiled model with its inputs, as the system of a solver; it owns or borrows both. The mass matrix must be positive
/// definite at the evaluator's parameters.
pub struct DrivenModel<E, I> {
    evaluator: E,
    inputs: I,
    jacobians: Option<RefCell<JacobianEvaluator>>,
    projection: Option<Projection>,
    contacts: Option<RefCell<Contacts>>,
    corners: Option<RefCell<Corners>>,
    sliding: Option<RefCell<SurfaceStates>>,
    auditor: Option<RefCell<Auditor>>,
    energy_roundings: EnergyRoundings,
    meters: RefCell<Meters>,
    /// Typical sizes of the states; empty if all are 1.
    typical_sizes: Vec<f64>,
}

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> DrivenModel<E, I> {
    /// Combines an evaluator, prepared at its parameters, with inputs.
    pub fn new(evaluator: E, inputs: I) -> Self {
        Self {
            evaluator,
            inputs,
            jacobians: None,
            projection: None,
            contacts: None,
            corners: None,
            sliding: None,
            auditor: None,
            energy_roundings: EnergyRoundings::default(),
            meters: RefCell::default(),
            typical_sizes: Vec::new(),
        }
    }

    /// Sets the typical sizes of the states; see [`crate::CompiledModel::typical_sizes`].
    pub fn with_typical_sizes(mut self, sizes: &[f64]) -> Self {
        self.typical_sizes = sizes.to_vec();
        self
    }

    /// Sets the observers of the motion and returns the previous ones.
    pub(crate) fn replace_observers(&mut self, observers: Observers) -> Observers {
        let auditor = observers.auditor.map(RefCell::new);
        let before = std::mem::replace(&mut self.auditor, auditor);
        Observers {
            auditor: before.map(RefCell::into_inner),
            meters: self.meters.replace(observers.meters),
        }
    }

    /// Returns the results of the observers so far.
    pub(crate) fn results(&self) -> Results {
        let auditor = self.auditor.as_ref();
        Results {
            audit: auditor.map(|auditor| auditor.borrow().audit()),
            measured: self.meters.borrow().results(),
        }
    }

    /// Writes the observables at a time (s) and a state, with the forces during sticking.
    pub fn write_observables(&self, (t, state): (f64, &[f64]), out: &mut [f64]) {
        match self.surface_states() {
            Some(sliding) => {
                let inputs = &self.inputs.borrow().evaluate(t);
                sliding
                    .borrow_mut()
                    .write_observables((t, state), inputs, out);
            }
            None => self.evaluate_at(t, state, |evaluator, point| {
                evaluator.observables(point, out)
            }),
        }
    }

    /// Projects the state onto the constraints after every step.
    pub fn with_projection(mut self, projection: Option<Projection>) -> Self {
        self.projection = projection;
        self
    }

    /// Enables the impacts of the program; `names` are their names, in its order.
    pub(crate) fn with_impacts(mut self, names: Vec<String>) -> Self {
        let contacts = (!names.is_empty()).then(|| {
            let evaluator = self.evaluator();
            let impacts = evaluator.program().impacts.iter().enumerate();
            let has_friction = impacts.filter(|(_, impact)| impact.friction.is_some());
            let degrees = evaluator.program().degrees_of_freedom();
            let sizes = self.typical_sizes();
            let (values, others) = sizes.split_at(degrees);
            Contacts::new(names, [values, &others[..degrees]])
                .with_friction(has_friction.map(|(place, _)| place))
        });
        self.contacts = contacts.map(RefCell::new);
        self
    }

    /// Enables the corner conditions at surfaces where the energies jump.
    pub(crate) fn with_corners(mut self, corners: Option<Corners>) -> Self {
        self.corners = corners.map(RefCell::new);
        self
    }

    /// Sets the model with the sides of switching surfaces, at the same parameters. Its rates are smooth across
    /// surfaces, and surfaces can hold the motion, as dry friction does. `tolerance` is the relative tolerance of the
    /// states. The system keeps the state of the surfaces, so use it for one motion only.
    pub fn with_sides(mut self, sided: Option<SidedModel>, tolerance: f64) -> Self {
        let contact_guards = self.contacts.as_ref();
        let contact_guards = contact_guards.map_or(0, |contacts| contacts.borrow().guard_count());
        self.sliding = sided.map(|sided| {
            let mut states = SurfaceStates::new(sided, tolerance);
            states.skip_contact_guards(contact_guards);
            RefCell::new(states)
        });
        self
    }

    /// Lets the motion cross the surfaces that could otherwise hold it.
    pub fn without_holding(mut self) -> Self {
        if let Some(sliding) = &mut self.sliding {
            sliding.get_mut().disable_holding();
        }
        self
    }

    /// Returns the model with sides and the projection onto the constraints, for use with another motion.
    pub fn into_parts(self) -> (Option<SidedModel>, Option<Projection>) {
        let sided = self
            .sliding
            .map(|sliding| sliding.into_inner().into_sided_model());
        (sided, self.projection)
    }

    /// Returns time (s) and reason if the motion ended at a singular position of its constraints. The solver
    /// stopped at the time `t` (s) and `state`.
    pub(crate) fn find_singular_position(
        &self,
        (t, state): (f64, &[f64]),
    ) -> Option<(f64, String)> {
        let projection = self.projection.as_ref()?;
        let mut rates = vec![0.0; state.len()];
        self.evaluate_at(t, state, |evaluator, point| {
            evaluator.rates(point, &mut rates)
        });
        let mut watch = projection.singularity_watch.as_ref()?.borrow_mut();
        watch.find_end((t, state), &rates, self.inputs.borrow())
    }

    /// Returns the message for an input whose function jumps near a time (s) at which no step is accurate.
    pub(crate) fn jump_message(&self, t: f64) -> Option<String> {
        let place = self.inputs.borrow().find_unknown_jump(t)?;
        let name = self.evaluator().program().inputs.get(place)?.name.clone();
        Some(format!(
            "the function of the input `{name}` jumps near t = {t:?} s: give its jumps (`breaks` in Python), so that steps \
             end there, or write a step as above(t - t0)"
        ))
    }

    /// Returns cause and remedy if the motion stopped because bodies overlap at an impact.
    pub(crate) fn overlap_message(&self) -> Option<String> {
        self.contacts.as_ref()?.borrow().failure_message()
    }

    /// Returns the times at which contact friction admits several motions.
    pub fn friction_choices(&self) -> Vec<FrictionChoice> {
        let contacts = self.contacts.as_ref();
        contacts.map_or_else(Vec::new, |contacts| contacts.borrow().choices().to_vec())
    }

    /// Returns cause and remedy if the motion stopped at a corner.
    pub(crate) fn corner_message(&self) -> Option<String> {
        let corners = self.corners.as_ref()?.borrow();
        corners.failure().map(str::to_owned)
    }

    /// Returns the inputs just before a time (s) and at it.
    fn evaluate_inputs_around(&self, t: f64) -> [Vec<f64>; 2] {
        let given = self.inputs.borrow();
        [t.next_down(), t].map(|t| given.evaluate(t).into_owned())
    }

    /// Returns true if the motion crosses a surface at which the energies jump.
    fn crosses_corner(&self, before: (f64, &[f64]), at: (f64, &[f64])) -> bool {
        let Some(corners) = &self.corners else {
            return false;
        };
        let given = self.inputs.borrow();
        let inputs = [before.0, at.0].map(|t| given.evaluate(t));
        corners
            .borrow_mut()
            .crosses(before, at, [&inputs[0], &inputs[1]])
    }

    /// Applies the corner conditions between a state on the near side of a surface and a state just beyond it. Returns
    /// true if the state changed.
    fn apply_corner(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        let Some(corners) = &self.corners else {
            return false;
        };
        let (given, arrived) = (self.inputs.borrow(), y.to_vec());
        let inputs = [before.0, t].map(|t| given.evaluate(t).into_owned());
        let inputs = [&inputs[0][..], &inputs[1][..]];
        let touching = self.find_touching_contacts((t, y));
        let mut corners = corners.borrow_mut();
        let Some(energy) = corners.apply(before, (t, y), inputs, &touching) else {
            return false;
        };
        drop(corners);
        if let Some(auditor) = &self.auditor {
            let energies = &mut DrivenEnergies(self);
            let CornerEnergy { before, work } = energy;
            auditor
                .borrow_mut()
                .audit_corner((t, y), (before, work), energies);
        }
        arrived != y
    }

    /// Returns the contacts at which bodies touch at rest; they act when the rates jump.
    fn find_touching_contacts(&self, (t, state): (f64, &[f64])) -> Vec<TouchingContact> {
        let Some(contacts) = &self.contacts else {
            return Vec::new();
        };
        self.with_contacts(contacts, (t, state), |contacts, own, inputs| {
            contacts.find_touching_contacts(own, Point { t, state, inputs })
        })
    }

    /// Releases surfaces and determines the modes of contacts after a jump of the rates at which energies or inputs
    /// jump.
    fn decide_contacts_after_jump(&self, (t, state): (f64, &[f64])) {
        if let Some(sliding) = &self.sliding {
            let inputs = &self.inputs.borrow().evaluate(t);
            sliding
                .borrow_mut()
                .release_left_surfaces((t, state), inputs);
        }
        if let Some(contacts) = &self.contacts {
            self.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.decide_after_jump(own, Point { t, state, inputs });
            });
        }
    }

    /// Returns cause and remedy if the motion stopped because bodies overlap, or at a corner.
    pub fn stop_message(&self) -> Option<String> {
        self.overlap_message().or_else(|| self.corner_message())
    }

    /// Returns true if neither surfaces nor closed contacts hold the motion, so that the model's own Jacobians apply.
    pub fn is_free(&self) -> bool {
        let sliding = self.sliding.as_ref();
        sliding.is_none_or(|sliding| sliding.borrow().is_free()) && !self.has_closed_contacts()
    }

    fn has_closed_contacts(&self) -> bool {
        let contacts = self.contacts.as_ref();
        contacts.is_some_and(|contacts| !contacts.borrow().closed().is_empty())
    }

    /// Passes the closed contacts to the surfaces. Returns true if the closed contacts changed.
    fn update_closed_contacts(&self) -> bool {
        let (Some(sliding), Some(contacts)) = (&self.sliding, &self.contacts) else {
            return false;
        };
        let (contacts, mut sliding) = (contacts.borrow(), sliding.borrow_mut());
        let closed = contacts.closed_modes();
        sliding.set_closed_contacts(&closed)
    }

    /// Determines the effect of the surfaces if the closed contacts or their modes changed, then revises the modes of
    /// the contacts. Repeats both until they agree.
    fn settle_modes(&self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        let (Some(sliding), Some(contacts)) = (&self.sliding, &self.contacts) else {
            return;
        };
        self.close_released((t, state), inputs);
        for _ in 0..MAX_REVISIONS {
            if self.update_closed_contacts() {
                sliding.borrow_mut().decide_again((t, state), inputs);
            }
            if !sliding.borrow_mut().take_decided() {
                return;
            }
            self.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.revise_modes(own, Point { t, state, inputs });
            });
        }
        contacts.borrow_mut().stop_at_contradiction();
    }

    /// Closes the open contacts at bodies that the surfaces no longer hold, if they then push. The bodies touch at
    /// rest, so there is no impact. If a closed contact stops a surface, the contact takes over its force.
    fn close_released(&self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        let (Some(sliding), Some(contacts)) = (&self.sliding, &self.contacts) else {
            return;
        };
        if !sliding.borrow().has_decided() {
            return;
        }
        let mut released = contacts.borrow().at_held_bodies();
        released.retain(|place| !sliding.borrow_mut().keeps_distance(*place));
        while !released.is_empty() {
            let saved = sliding.borrow().save();
            let state = &self.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.close_at_rest(own, Point { t, state, inputs }, &released)
            });
            self.update_closed_contacts();
            sliding.borrow_mut().decide_again((t, state), inputs);
            let pushing = self.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.find_pushing(own, Point { t, state, inputs }, &released)
            });
            if pushing.len() == released.len() {
                return;
            }
            contacts.borrow_mut().reopen(&released);
            self.update_closed_contacts();
            sliding.borrow_mut().restore(saved);
            released = pushing;
        }
    }

    /// Records the directions in which surfaces hold bodies that touch open contacts.
    fn note_drifts(&self, at: (f64, &[f64])) {
        let (Some(sliding), Some(contacts)) = (&self.sliding, &self.contacts) else {
            return;
        };
        let held = sliding.borrow().list_held_directions();
        self.with_contacts(contacts, at, |contacts, own, inputs| {
            let (t, state) = at;
            contacts.note_drifts(own, Point { t, state, inputs }, &held);
        });
    }

    /// Calls `act` with the contacts, the evaluator that determines the rates at a time and a state, and the inputs of
    /// this evaluator.
    fn with_contacts<T>(
        &self,
        contacts: &RefCell<Contacts>,
        (t, state): (f64, &[f64]),
        act: impl FnOnce(&mut Contacts, &mut Evaluator, &[f64]) -> T,
    ) -> T {
        let inputs = &self.inputs.borrow().evaluate(t);
        self.with_contacts_under(contacts, (t, state), inputs, act)
    }

    /// Calls `act` like [`DrivenModel::with_contacts`], with the given inputs of the model.
    fn with_contacts_under<T>(
        &self,
        contacts: &RefCell<Contacts>,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        act: impl FnOnce(&mut Contacts, &mut Evaluator, &[f64]) -> T,
    ) -> T {
        let sliding = self.surface_states();
        let contacts = &mut contacts.borrow_mut();
        let Some(sliding) = sliding else {
            return act(contacts, &mut self.evaluator(), inputs);
        };
        let mut sliding = sliding.borrow_mut();
        let (evaluator, inputs) = sliding.evaluator_with_sides((t, state), inputs);
        act(contacts, evaluator, inputs)
    }

    /// Returns the states of the surfaces if they determine rates and observables: while sides are fixed or surfaces hold
    /// the motion.
    fn surface_states(&self) -> Option<&RefCell<SurfaceStates>> {
        self.sliding.as_ref().filter(|_| self.is_sticking_active())
    }

    /// Returns true if sides are fixed or surfaces hold the motion, so that the signs of the switching functions do not
    /// determine the rates.
    fn is_sticking_active(&self) -> bool {
        let sliding = self.sliding.as_ref();
        sliding.is_some_and(|sliding| sliding.borrow().is_active())
    }

    /// Sets the model's Jacobian for implicit solvers, at the same parameters.
    pub fn with_jacobian(mut self, jacobians: JacobianEvaluator) -> Self {
        self.jacobians = Some(RefCell::new(jacobians));
        self
    }

    fn degrees_of_freedom(&self) -> usize {
        self.evaluator().program().degrees_of_freedom()
    }

    fn evaluator(&self) -> RefMut<'_, Evaluator> {
        self.evaluator.borrow().borrow_mut()
    }

    /// Calls `of` with the evaluator and the point of a time and a state; the inputs are those at this time.
    fn evaluate_at<T>(
        &self,
        t: f64,
        state: &[f64],
        of: impl FnOnce(&mut Evaluator, Point<'_>) -> T,
    ) -> T {
        let inputs = &self.inputs.borrow().evaluate(t);
        of(&mut self.evaluator(), Point { t, state, inputs })
    }

    /// Returns the switching functions; a function over modes gives one per mode. A function counts as a speed if it
    /// depends on rates and is constant at zero rates.
    pub fn surfaces(&self) -> Vec<Surface> {
        let (here, there) = (
            self.evaluate_guards_at_rest(0.11),
            self.evaluate_guards_at_rest(0.17),
        );
        let evaluator = self.evaluator();
        let program = evaluator.program();
        let is_rate =
            |id: &ValueId| matches!(program.value(*id).op, Op::Rate(_) | Op::ModeRates(_));
        let all = program.guards.iter().flat_map(|guard| {
            let moves = program.reachable(&[guard.value]).iter().any(is_rate);
            let count = program.value(guard.value).extent.length();
            std::iter::repeat_n((&guard.formula, moves), count)
        });
        let states = self.sliding.as_ref().map(RefCell::borrow);
        let states = states.filter(|states| states.can_hold_motion());
        let held_kind = match states.is_some() {
            true => SurfaceKind::HeldSpeed,
            false => SurfaceKind::Speed,
        };
        let holding = states.map(|states| states.holding_guards());
        let holding = holding.unwrap_or_default();
        let own = all.zip(here.iter().zip(&there)).enumerate();
        let own = own.map(|(guard, ((formula, moves), (here, there)))| Surface {
            formula: formula.clone(),
            kind: match moves && here == there {
                true if holding.contains(&guard) => held_kind,
                true => SurfaceKind::Speed,
                false => SurfaceKind::Function,
            },
        });
        let contacts = self.contacts.iter();
        let impacts = contacts.flat_map(|contacts| contacts.borrow().surfaces());
        let sliding = self.sliding.iter();
        let discs = sliding.flat_map(|sliding| sliding.borrow().disc_formulas());
        let discs = discs.map(|formula| Surface {
            formula,
            kind: held_kind,
        });
        own.chain(impacts).chain(discs).collect()
    }

    /// Evaluates the switching functions at zero rates, with coordinates of the given size.
    fn evaluate_guards_at_rest(&self, size: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.evaluator().guard_count()];
        let mut state = vec![0.0; self.state_count()];
        let degrees = self.evaluator().program().degrees_of_freedom();
        for (place, coordinate) in state[..degrees].iter_mut().enumerate() {
            *coordinate = size / (place + 2) as f64;
        }
        self.evaluate_at(0.0, &state, |evaluator, point| {
            evaluator.guards(point, &mut values);
        });
        values
    }
}

impl<E> DrivenModel<E, HeldInputs> {
    /// Replaces the inputs.
    pub fn set_inputs(&mut self, inputs: HeldInputs) {
        self.inputs = inputs;
    }
}

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> System for DrivenModel<E, I> {
    fn state_count(&self) -> usize {
        self.evaluator().program().states()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let inputs = &self.inputs.borrow().evaluate(t);
        let point = Point {
            t,
            state: y,
            inputs,
        };
        match self.surface_states() {
            Some(sliding) => sliding.borrow_mut().write_rates((t, y), inputs, out),
            None => self.evaluator().rates(point, out),
        }
        if let Some(contacts) = &self.contacts {
            self.with_contacts(contacts, (t, y), |contacts, own, inputs| {
                let point = Point {
                    t,
                    state: y,
                    inputs,
                };
                contacts.add_to_rates(own, point, out);
            });
        }
    }

    fn typical_sizes(&self) -> Vec<f64> {
        match self.typical_sizes.is_empty() {
            true => vec![1.0; self.state_count()],
            false => self.typical_sizes.clone(),
        }
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let inputs = &self.inputs.borrow().evaluate(t);
        let mut has_own_sides = true;
        if let Some(sliding) = &self.sliding {
            let mut sliding = sliding.borrow_mut();
            has_own_sides = sliding.has_own_sides((t, y), inputs);
            let is_turning = sliding.disc_count() > 0 && !has_own_sides;
            if (!sliding.is_free() || is_turning) && !self.has_closed_contacts() {
                let given = (&inputs[..], &self.typical_sizes()[..]);
                return sliding.write_jacobian((t, y), given, out);
            }
        }
        match &self.jacobians {
            Some(jacobians) if has_own_sides && !self.has_closed_contacts() => {
                let point = Point {
                    t,
                    state: y,
                    inputs,
                };
                jacobians
                    .borrow_mut()
                    .evaluate(Jacobian::RatesByState, point, out);
            }
            _ => jacobian_by_differences(self, t, y, out),
        }
    }

    fn guard_count(&self) -> usize {
        let contacts = self.contacts.as_ref();
        let contacts = contacts.map_or(0, |contacts| contacts.borrow().guard_count());
        let sliding = self.sliding.as_ref();
        let discs = sliding.map_or(0, |sliding| sliding.borrow().disc_count());
        self.evaluator().guard_count() + contacts + discs
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let own = self.evaluator().guard_count();
        self.evaluate_at(t, y, |evaluator, point| {
            evaluator.guards(point, &mut out[..own]);
        });
        if let Some(contacts) = &self.contacts {
            self.with_contacts(contacts, (t, y), |contacts, evaluator, inputs| {
                let point = Point {
                    t,
                    state: y,
                    inputs,
                };
                contacts.write_guards(evaluator, point, &mut out[own..]);
            });
            self.update_closed_contacts();
        }
        if let Some(sliding) = &self.sliding {
            let inputs = &self.inputs.borrow().evaluate(t);
            sliding.borrow_mut().write_guards((t, y), inputs, out);
            if self.contacts.is_some() && sliding.borrow().has_decided() {
                // The surfaces can only hold the motion after its first evaluation.
                self.settle_modes((t, y), inputs);
                self.note_drifts((t, y));
                self.guards(t, y, out);
            }
        }
    }

    fn bound_guards(&self, (begin, end): (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) {
        let stretch = Stretch {
            t: Enclosure::time(begin, end),
            state,
            inputs: &self.inputs.borrow().bound(begin, end),
        };
        let mut evaluator = self.evaluator();
        let (own, more) = out.split_at_mut(evaluator.guard_count());
        evaluator.bound_guards(&stretch, own);
        if let Some(contacts) = &self.contacts {
            contacts
                .borrow()
                .bound_guards(&mut evaluator, &stretch, more);
        }
        if let Some(sliding) = &self.sliding {
            sliding.borrow().bound_guards(out);
        }
    }

    fn is_singular(&self, guard: usize) -> bool {
        let sliding = self.sliding.as_ref().map(RefCell::borrow);
        sliding.is_some_and(|sliding| sliding.is_singular(guard))
    }

    fn is_distance(&self, guard: usize) -> bool {
        let contact = guard.checked_sub(self.evaluator().guard_count());
        let contacts = self.contacts.as_ref().map(RefCell::borrow);
        contact.is_some_and(|contact| contacts.is_some_and(|known| contact < known.names.len()))
    }

    fn has_energy_jump(&self, guard: usize) -> bool {
        let corners = self.corners.as_ref().map(RefCell::borrow);
        corners.is_some_and(|corners| corners.contains(guard))
    }

    fn find_indefinite_coordinate(&self, t: f64, y: &[f64]) -> Option<usize> {
        let mut evaluator = self.evaluator();
        let size = evaluator.program().degrees_of_freedom();
        let mut mass = vec![0.0; size * size];
        let inputs = &self.inputs.borrow().evaluate(t);
        evaluator.mass_matrix(
            Point {
                t,
                state: y,
                inputs,
            },
            &mut mass,
        );
        first_indefinite_row(&mut mass, size)
    }

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        let holds =
            self.projection.is_some() || self.contacts.is_some() || self.is_sticking_active();
        if !holds {
            return 0;
        }
        let inputs = &self.inputs.borrow().evaluate(t);
        let mut evaluations = 0;
        if let Some(projection) = &self.projection {
            let given = self.inputs.borrow();
            evaluations += projection.correct_after_step(&mut self.evaluator(), t, given, y);
        }
        if let Some(contacts) = &self.contacts {
            let arrived = y.to_vec();
            evaluations += self.with_contacts(contacts, (t, &arrived), |contacts, own, inputs| {
                contacts.correct_state(own, (t, inputs), y)
            });
            self.settle_modes((t, y), inputs);
        }
        if let Some(sliding) = &self.sliding {
            evaluations += sliding.borrow_mut().correct_state(t, inputs, y);
        }
        evaluations
    }

    fn mark_corrected(&self, is_corrected: &mut [bool]) {
        if let Some(contacts) = &self.contacts {
            let (coordinates, rates) = is_corrected.split_at_mut(self.degrees_of_freedom());
            contacts.borrow().mark_corrected(coordinates, rates);
        }
    }

    fn forget_projection(&self) {
        if let Some(contacts) = &self.contacts {
            contacts.borrow_mut().forget_correction();
        }
    }

    fn apply_event(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        let mut jumps = false;
        let has_corner = self.crosses_corner(before, (t, y));
        if let Some(contacts) = &self.contacts {
            let arrived = y.to_vec();
            let given = self.inputs.borrow();
            let inputs_before = &given.evaluate(before.0);
            // The contact forces and the forces that hold the motion are evaluated at the point of the impact, before
            // inputs jump. Other inputs are evaluated at the time of the impact, as are the distances that stop a step.
            let reached = (before.0.max(t.next_down()), &arrived[..]);
            let inputs = &given.evaluate_before(t, given.last_sample(reached.0));
            let is_hit =
                self.with_contacts_under(contacts, reached, inputs, |contacts, own, inputs| {
                    let mut near = inputs.to_vec();
                    near[..inputs_before.len()].copy_from_slice(inputs_before);
                    let before = Point {
                        t: before.0,
                        state: before.1,
                        inputs: &near,
                    };
                    contacts.apply_impact(own, before, (t, inputs), y, has_corner)
                });
            let work = contacts.borrow().impact_work();
            jumps = arrived != y;
            if is_hit && self.projection.is_some() {
                contacts.borrow_mut().offset_for_projection((t, y));
            }
            if let Some(auditor) = self.auditor.as_ref().filter(|_| jumps) {
                let energies = &mut EnergiesBeforeCorner(DrivenEnergies(self));
                let states = (&arrived[..], &*y);
                auditor.borrow_mut().audit_impact(t, states, work, energies);
            }
        }
        jumps |= has_corner && self.apply_corner(before, t, y);
        let sliding = self.sliding.as_ref();
        let others = sliding.map(|sliding| sliding.borrow_mut().release_other_sides());
        if has_corner {
            self.decide_contacts_after_jump((t, y));
        }
        let has_changed = self.update_closed_contacts();
        if let Some((sliding, others)) = sliding.zip(others) {
            let inputs = &self.inputs.borrow().evaluate(t);
            let mut states = sliding.borrow_mut();
            // If the rates jump over a surface, the motion does not reach the surface.
            if !jumps {
                states.apply_crossing(inputs, before, t, y);
            }
            if jumps || has_changed && !states.has_decided() {
                states.decide_again((t, y), inputs);
            }
            drop(states);
            self.settle_modes((t, y), inputs);
            sliding.borrow_mut().restore_other_sides(others);
        }
        jumps
    }

    fn apply_breakpoint(&self, t: f64, y: &mut [f64]) -> bool {
        let Some(corners) = &self.corners else {
            return false;
        };
        let inputs = self.evaluate_inputs_around(t);
        let around = [&inputs[0][..], &inputs[1][..]];
        let touching = self.find_touching_contacts((t, y));
        let mut corners = corners.borrow_mut();
        let Some(energy) = corners.apply_input_jump((t, y), around, &touching) else {
            return false;
        };
        drop(corners);
        if let Some(auditor) = &self.auditor {
            let energies = &mut DrivenEnergies(self);
            let CornerEnergy { before, work } = energy;
            auditor
                .borrow_mut()
                .audit_corner_between_steps((t, y), (before, work), energies);
        }
        self.decide_contacts_after_jump((t, y));
        true
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        if let Some(sliding) = &self.sliding {
            sliding.borrow_mut().fix_sides(sides);
        }
    }

    fn assume_modes(&self, modes: &[SurfaceMode]) {
        if modes.is_empty() {
            return;
        }
        let own = self.evaluator().guard_count();
        if let Some(contacts) = &self.contacts {
            contacts.borrow_mut().assume_modes(&modes[own..]);
        }
        if let Some(sliding) = &self.sliding {
            sliding.borrow_mut().assume_modes(modes);
        }
    }

    fn update_modes(&self, t: f64, y: &[f64]) {
        let given = self.inputs.borrow();
        if let Some(corners) = &self.corners {
            corners.borrow_mut().update((t, y), &given.evaluate(t));
        }
        if let Some(sliding) = &self.sliding {
            // The caller fixes the sides again in the new regime.
            sliding.borrow_mut().release_other_sides();
        }
        if let Some(contacts) = &self.contacts {
            self.with_contacts(contacts, (t, y), |contacts, evaluator, inputs| {
                let point = Point {
                    t,
                    state: y,
                    inputs,
                };
                contacts.update_modes(evaluator, point);
            });
            self.settle_modes((t, y), &given.evaluate(t));
        }
        if let Some(sliding) = &self.sliding {
            let (earlier, inputs) = (given.evaluate(t.next_down()), given.evaluate(t));
            let inputs = inputs.as_ref();
            sliding
                .borrow_mut()
                .update((t, y), (earlier.as_ref(), inputs));
            self.settle_modes((t, y), inputs);
            self.note_drifts((t, y));
        }
    }

    fn write_modes(&self, modes: &mut [SurfaceMode]) {
        let own = self.evaluator().guard_count();
        if let Some(contacts) = &self.contacts {
            contacts.borrow().write_modes(&mut modes[own..]);
        }
        if let Some(sliding) = &self.sliding {
            sliding.borrow().write_modes(modes);
        }
    }

    fn add_rate_roundings(&self, length: f64, out: &mut [f64]) {
        let degrees = self.degrees_of_freedom();
        if let Some(contacts) = &self.contacts {
            contacts.borrow().add_rate_roundings(&mut out[degrees..]);
        }
        if let Some(sliding) = &self.sliding {
            sliding.borrow().add_rate_roundings(out);
        }
        let (speeds, accelerations) = out.split_at_mut(degrees);
        for (speed, acceleration) in speeds.iter_mut().zip(accelerations) {
            *speed += length * *acceleration;
        }
    }

    fn is_observing(&self) -> bool {
        self.auditor.is_some() || !self.meters.borrow().is_empty()
    }

    fn observe_step(&self, step: &mut ObservedStep<'_>) {
        self.measure_step(step);
        self.audit_step(step);
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.inputs.borrow().next_change(t)
    }
}

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> DrivenModel<E, I> {
    fn measure_step(&self, step: &mut ObservedStep<'_>) {
        let mut meters = self.meters.borrow_mut();
        if !meters.is_empty() {
            meters.observe_step(step, &mut DrivenObservables(self));
        }
    }

    fn audit_step(&self, step: &mut ObservedStep<'_>) {
        let Some(auditor) = &self.auditor else {
            return;
        };
        let mut auditor = auditor.borrow_mut();
        let sliding = self.sliding.as_ref();
        let is_held = sliding.is_some_and(|sliding| !sliding.borrow().is_free());
        if is_held || self.has_closed_contacts() {
            let mut rates = vec![0.0; step.end.1.len()];
            let length = step.end.0 - step.start.0;
            self.add_rate_roundings(length, &mut rates);
            auditor.raise_to_roundings(&rates, length);
        }
        let energies = &mut DrivenEnergies(self);
        if let Some(length) = auditor.suspected_crossing() {
            let errors = self.find_errors_of_crossing(length, step.start);
            auditor.judge_crossing(&errors, energies);
        }
        match auditor.driven_contacts().map(str::to_owned) {
            Some(reason) if self.has_closed_contacts() => {
                auditor.exclude_step(step, energies, &reason)
            }
            _ => auditor.audit_step(step, energies),
        }
    }

    /// Returns the errors of a step of `length` s across a surface to the given time (s) and state. The step
    /// extrapolates the rates of the near side.
    fn find_errors_of_crossing(&self, length: f64, (t, state): (f64, &[f64])) -> Vec<f64> {
        let mut errors = vec![0.0; state.len()];
        self.rates(t, state, &mut errors);
        for error in &mut errors {
            *error = error.abs() * length;
        }
        errors
    }
}

/// Pivots below this fraction of their diagonal entry count as rounding.
const PIVOT_ROUNDING: f64 = 1e-14;

/// Returns the first row of a symmetric matrix with finite entries whose pivot is not positive.
fn first_indefinite_row(matrix: &mut [f64], size: usize) -> Option<usize> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    for row in 0..size {
        let diagonal = matrix[row * size + row];
        // Cholesky factorisation L L^T = matrix, written to the lower triangle.
        for column in 0..=row {
            let products = (0..column)
                .map(|k| matrix[row * size + k] * matrix[column * size + k])
                .sum::<f64>();
            let rest = matrix[row * size + column] - products;
            if column == row && rest <= PIVOT_ROUNDING * diagonal.abs() {
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

/// Energy and power of a motion of the model, with the forces of sticking surfaces and of contacts at rest.
struct DrivenEnergies<'m, E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>>(
    &'m DrivenModel<E, I>,
);

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> Energies for DrivenEnergies<'_, E, I> {
    fn evaluate(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        let model = self.0;
        let mut observables = vec![0.0; model.evaluator().program().observables.len()];
        model.write_observables((t, state), &mut observables);
        let mut found = EnergyAndPower::from_observables(&observables);
        if let Some(contacts) = &model.contacts {
            found.power += model.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.power(own, Point { t, state, inputs })
            });
        }
        found
    }

    fn bound_roundings(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        let model = self.0;
        let inputs = &model.inputs.borrow().evaluate(t);
        let point = Point { t, state, inputs };
        let mut bounds = model.energy_roundings.bound(&model.evaluator(), point);
        if let Some(contacts) = &model.contacts {
            bounds.power += model.with_contacts(contacts, (t, state), |contacts, own, inputs| {
                contacts.power_rounding(own, Point { t, state, inputs })
            });
        }
        bounds
    }
}

/// Energies of a motion of the model, from just before the energies jump if they jump at the same instant.
struct EnergiesBeforeCorner<'m, E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>>(
    DrivenEnergies<'m, E, I>,
);

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> Energies
    for EnergiesBeforeCorner<'_, E, I>
{
    fn evaluate(&mut self, at: (f64, &[f64])) -> EnergyAndPower {
        let model = self.0.0;
        let mut found = self.0.evaluate(at);
        if let Some(corners) = &model.corners {
            let inputs = &model.inputs.borrow().evaluate(at.0);
            let energy = corners.borrow_mut().energy(at, inputs);
            found.energy = energy.unwrap_or(found.energy);
        }
        found
    }

    fn bound_roundings(&mut self, at: (f64, &[f64])) -> EnergyAndPower {
        self.0.bound_roundings(at)
    }
}

/// Observables of a motion of the model.
struct DrivenObservables<'m, E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>>(
    &'m DrivenModel<E, I>,
);

impl<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>> Observables
    for DrivenObservables<'_, E, I>
{
    fn write(&mut self, at: (f64, &[f64]), out: &mut [f64]) {
        self.0.write_observables(at, out);
    }

    fn bound(
        &mut self,
        (begin, end): (f64, f64),
        state: &[Enclosure],
        out: &mut [Enclosure],
    ) -> bool {
        if !self.0.is_free() {
            return false;
        }
        let stretch = Stretch {
            t: Enclosure::time(begin, end),
            state,
            inputs: &self.0.inputs.borrow().bound(begin, end),
        };
        self.0.evaluator().bound_observables(&stretch, out);
        true
    }

    fn degrees_of_freedom(&self) -> usize {
        self.0.degrees_of_freedom()
    }
}
