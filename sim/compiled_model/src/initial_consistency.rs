//! Consistent initial states, errors of constraints that cannot be satisfied, and the system whose steps are projected
//! onto the constraints.

use eomgen_model_spec::argument::Argument;
use std::borrow::Borrow;
use std::cell::RefCell;

use eomgen_codegen::independence::dependence::find_dependent_combinations;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;

use crate::contacts::Start;
use crate::displacements::generic_weight;
use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::labels::{ConstraintLabel, Labels};
use crate::motion_model::MotionModel;
use crate::projection::{
    InitialChange, LARGE_RATE_PER_S, MAX_INITIAL_CORRECTIONS, Projection, find_unmoved_sizes,
};
use crate::singular_positions::SingularityWatch;

/// Derivatives are dependent if less than this fraction of a row remains after elimination of the others.
const MIN_INDEPENDENT_FRACTION: f64 = 1e-9;

/// Largest residual of a dependent constraint that counts as rounding, relative to the terms of its rate.
const MAX_RELATIVE_RESIDUAL: f64 = 1e-9;

/// A rate below this fraction of the largest rate or of the typical size is rounding of the accelerations.
const MAX_ROUNDING_FRACTION: f64 = 1e-12;

/// Smallest coefficient of a constraint in a dependent combination, relative to the largest, for which an error names
/// the constraint.
const MIN_NAMED_COEFFICIENT: f64 = 1e-6;

/// Dependent constraints are contradictory if their combined residual exceeds this fraction of its largest term. A
/// smaller residual may come from curvature if the initial state does not satisfy the constraints.
const MIN_CONTRADICTION_FRACTION: f64 = 0.1;

impl dyn MotionModel + '_ {
    /// Returns the system of the model for solvers, at the relative `tolerance` of the states: with projection onto the
    /// constraints, impacts and sticking. The system keeps the state of contacts and sticking, so use it for one motion
    /// only.
    ///
    /// # Errors
    /// See [`MotionModel::evaluator`].
    pub(crate) fn driven_model<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>>(
        &self,
        evaluator: E,
        inputs: I,
        tolerance: f64,
    ) -> Result<DrivenModel<E, I>, Error> {
        let labels = self.labels();
        let impacts = labels.impacts.iter();
        let impacts = impacts.map(|impact| impact.name.clone()).collect();
        let driven = DrivenModel::new(evaluator, inputs)
            .with_typical_sizes(&labels.typical_sizes)
            .with_projection(self.projection()?);
        Ok(driven
            .with_impacts(impacts)
            .with_corners(self.corners()?)
            .with_sides(self.sided_model()?, tolerance))
    }

    /// Returns the projection onto the constraints; `None` without constraints.
    ///
    /// # Errors
    /// See [`MotionModel::evaluator`].
    fn projection(&self) -> Result<Option<Projection>, Error> {
        if self.labels().constraints.is_empty() {
            return Ok(None);
        }
        let at = |rate: f64| self.evaluator_at_stabilisation_rate(rate).map(RefCell::new);
        let constraints = self.labels().constraints.iter();
        let names = constraints
            .map(|constraint| constraint.name.clone())
            .collect();
        let Some(rows) = self.constraint_rows() else {
            return Ok(None);
        };
        let degrees = rows.degrees_of_freedom();
        Ok(Some(Projection {
            singularity_watch: Some(RefCell::new(SingularityWatch::new(
                rows,
                names,
                self.labels().constraint_excess,
            ))),
            unmoved_sizes: find_unmoved_sizes(&self.labels().typical_sizes, degrees),
            positive_rate_model: at(LARGE_RATE_PER_S)?,
            negative_rate_model: at(-LARGE_RATE_PER_S)?,
            stabilisation_rate: self.stabilisation_rate(),
        }))
    }

    /// Returns the consistent state nearest to `state` in the norm of the kinetic energy, for a motion over a time span
    /// (s), and the changed values. A negative distance of an impact within the rounding of this time span is set to
    /// zero.
    ///
    /// # Errors
    /// [`Error::Request`] if a constraint depends on others at the state, or if no state near it satisfies the
    /// constraints; the message names them.
    pub(crate) fn find_consistent_start(
        &self,
        state: &[f64],
        (t, until): (f64, f64),
        inputs: &HeldInputs,
    ) -> Result<(Vec<f64>, Vec<InitialChange>), Error> {
        let inputs = &inputs.evaluate(t);
        let projection = match self.projection() {
            Ok(Some(projection)) => projection,
            Ok(None) => {
                let mut found = state.to_vec();
                self.remove_rounding_overlap((t, until), &mut found, inputs)?;
                return Ok((found, Vec::new()));
            }
            // If constraints are dependent at every state, no pivot is positive.
            Err(error) => {
                let reason = self.describe_dependent_constraint(t, state, inputs)?;
                return Err(reason.map_or(error, Error::Request));
            }
        };
        let mut own = self.evaluator()?;
        let mut found = state.to_vec();
        let at = (t, &inputs[..]);
        if projection
            .correct(
                &mut own,
                at,
                &mut found,
                (MAX_INITIAL_CORRECTIONS, &mut |_| {}),
            )
            .is_none()
        {
            let error = match self.describe_dependent_constraint(t, state, inputs)? {
                Some(reason) => Error::Request(reason),
                None => self.unsatisfied_constraints_error(t, &found, inputs),
            };
            return Err(error);
        }
        // A correction may succeed by rounding although constraints are dependent.
        if let Some(reason) = self.describe_dependent_constraint(t, &found, inputs)? {
            return Err(Error::Request(reason));
        }
        self.check_redundancy(t, &found, inputs)?;
        let degrees = own.program().degrees_of_freedom();
        self.undo_rounding(state, &mut found, degrees);
        self.remove_rounding_overlap((t, until), &mut found, inputs)?;
        let Labels {
            state_names,
            state_units,
            ..
        } = self.labels();
        let largest = state
            .iter()
            .chain(&found)
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let labels = state_names.iter().zip(state_units);
        let entries = labels.zip(state.iter().zip(&found));
        let moved = entries
            .filter(|(_, (from, to))| (*from - *to).abs() > 1e-12 * largest)
            .map(|((name, unit), (from, to))| InitialChange {
                name: name.clone(),
                unit: unit.clone(),
                requested: *from,
                used: *to,
            });
        Ok((found.clone(), moved.collect()))
    }

    /// Restores rates of 0 that a correction changed by rounding only, so that a body at rest stays at rest.
    fn undo_rounding(&self, state: &[f64], found: &mut [f64], degrees: usize) {
        let rates = degrees..2 * degrees;
        let typical = self.labels().typical_sizes[rates.clone()].iter();
        let entries = typical.chain(&found[rates.clone()]);
        let largest = entries.fold(0.0_f64, |most, entry| most.max(entry.abs()));
        for (to, from) in found[rates.clone()].iter_mut().zip(&state[rates]) {
            if *from == 0.0 && to.abs() <= MAX_ROUNDING_FRACTION * largest {
                *to = 0.0;
            }
        }
    }

    /// Returns the states before each correction that moves a state at a time (s) onto the constraints.
    ///
    /// # Errors
    /// See [`MotionModel::evaluator`].
    pub(crate) fn list_corrected_states(
        &self,
        (t, state): (f64, &[f64]),
        inputs: &HeldInputs,
    ) -> Result<Vec<Vec<f64>>, Error> {
        let Some(projection) = self.projection()? else {
            return Ok(Vec::new());
        };
        let (mut states, mut moved) = (Vec::new(), state.to_vec());
        let mut keep = |state: &[f64]| states.push(state.to_vec());
        let (mut own, inputs) = (self.evaluator()?, inputs.evaluate(t));
        let most = (MAX_INITIAL_CORRECTIONS, &mut keep as &mut dyn FnMut(&[f64]));
        projection.correct(&mut own, (t, &inputs[..]), &mut moved, most);
        Ok(states)
    }

    /// Moves a state so that no distance of an impact is negative by rounding.
    ///
    /// # Errors
    /// [`Error::Request`] with the name of an impact whose distance is more negative.
    fn remove_rounding_overlap(
        &self,
        (t, until): (f64, f64),
        state: &mut [f64],
        inputs: &[f64],
    ) -> Result<(), Error> {
        let impacts = &self.labels().impacts;
        if impacts.is_empty() {
            return Ok(());
        }
        let lengths = impacts.iter().enumerate().map(|(place, impact)| {
            let coordinates = impact.coordinates.iter().map(|own| state[*own].abs());
            coordinates.fold(self.largest_length(place), f64::max)
        });
        let lengths: Vec<f64> = lengths.collect();
        let start = Start {
            t,
            end: until,
            inputs,
            lengths: &lengths,
        };
        let below = start.move_onto_contacts(&mut self.evaluator()?, state);
        below.map_err(|(place, distance)| {
            let impact = &impacts[place];
            Error::Request(format!(
                "the distance of the impact `{}` is negative at the initial state ({distance:.6e} {}): choose an \
                 initial state in which no bodies overlap",
                impact.name, impact.unit
            ))
        })
    }

    /// Returns an error text if a constraint has a zero, infinite or dependent derivative at a state. The text states
    /// whether the constraint contradicts the others.
    fn describe_dependent_constraint(
        &self,
        t: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Option<String>, Error> {
        let point = Point { t, state, inputs };
        let Some(mut rows) = self.constraint_rows() else {
            return Ok(None);
        };
        let (mut all, residuals) = (rows.rows(point), rows.residuals(point));
        let constraints = &self.labels().constraints;
        let lengths: Vec<f64> = all.iter().map(|row| norm(row)).collect();
        if let Some(place) = lengths.iter().position(|length| *length == 0.0) {
            return Ok(Some(format!(
                "the constraint `{}` has no effect at the initial state, because its derivative is zero; start \
                 at another state ({}), or write it with a simple zero, such as x instead of x^2",
                constraints[place].name,
                Argument::State
            )));
        }
        if let Some(place) = lengths.iter().position(|length| !length.is_finite()) {
            return Ok(Some(format!(
                "the derivative of the constraint `{}` is not finite at the initial state, as for \
                 sqrt(x) at x = 0; start at another state ({}), or rewrite the constraint",
                constraints[place].name,
                Argument::State
            )));
        }
        for (row, length) in all.iter_mut().zip(&lengths) {
            row.iter_mut().for_each(|entry| *entry /= length);
        }
        let mut combinations = find_dependent_combinations(&all, MIN_INDEPENDENT_FRACTION);
        let parts = match combinations.len() > self.labels().constraint_excess {
            true => combinations.pop(),
            false => None,
        };
        let Some(parts) = parts else {
            let sizes = self.labels().typical_sizes.iter().enumerate();
            let direction: Vec<f64> = sizes
                .map(|(place, size)| generic_weight(place) * size)
                .collect();
            let found = self.describe_singular_position(point, &direction);
            return Ok(found.map(|dependence| {
                format!(
                    "the initial state is a singular position: {dependence}; start at another state ({})",
                    Argument::State
                )
            }));
        };
        let last = parts.iter().rposition(|part| *part != 0.0).unwrap_or(0);
        let most = parts
            .iter()
            .fold(0.0_f64, |most, part| most.max(part.abs()));
        let others: Vec<usize> = (0..last)
            .filter(|place| parts[*place].abs() > MIN_NAMED_COEFFICIENT * most)
            .collect();
        let part = |place: usize| {
            parts[place] / lengths[place] * residuals[place] / (parts[last] / lengths[last])
        };
        let combined = others.iter().chain([&last]).map(|place| part(*place));
        let depends = DependentConstraint {
            constraint: &constraints[last],
            on: others.iter().map(|place| &constraints[*place]).collect(),
            combined_residual: combined.clone().sum(),
            scale: combined.map(f64::abs).fold(0.0, f64::max),
        };
        Ok(Some(depends.reason()))
    }

    /// Checks that dependent constraints do not contradict each other.
    ///
    /// # Errors
    /// [`Error::Request`] with the residuals at a state that satisfies as many constraints as possible.
    fn check_redundancy(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<(), Error> {
        let Labels {
            constraints,
            constraint_excess,
            typical_sizes,
            ..
        } = self.labels();
        let (true, Some(mut rows)) = (*constraint_excess > 0, self.constraint_rows()) else {
            return Ok(());
        };
        let point = Point { t, state, inputs };
        let degrees = rows.degrees_of_freedom();
        let entries = state.iter().zip(typical_sizes);
        let sizes: Vec<f64> = entries
            .map(|(entry, typical)| entry.abs().max(*typical))
            .collect();
        let [of_coordinates, of_rates] = [&sizes[..degrees], &sizes[degrees..]]
            .map(|own| rows.compute_weighted_lengths(point, own));
        let residuals = rows.residuals(point);
        let is_unsatisfied = |place: &usize| {
            let scale = match constraints[*place].is_nonholonomic {
                true => of_rates[*place],
                false => of_coordinates[*place],
            };
            residuals[*place].abs() > MAX_RELATIVE_RESIDUAL * scale
        };
        let left: Vec<String> = (0..constraints.len())
            .filter(is_unsatisfied)
            .map(|place| {
                let (residual, own) = (residuals[place], &constraints[place]);
                format!(
                    "the residual of `{}` stays at {residual:.3e} {}",
                    own.name, own.unit
                )
            })
            .collect();
        match left.is_empty() {
            true => Ok(()),
            false => Err(Error::Request(format!(
                "the constraints contradict each other at these parameters: {}; remove or correct one of them",
                left.join(", ")
            ))),
        }
    }

    fn unsatisfied_constraints_error(&self, t: f64, state: &[f64], inputs: &[f64]) -> Error {
        let constraints = &self.labels().constraints;
        let rows = self.constraint_rows();
        let residuals = rows.map(|mut rows| rows.residuals(Point { t, state, inputs }));
        let residuals = residuals.unwrap_or_default();
        let left: Vec<String> = constraints
            .iter()
            .zip(residuals)
            .filter(|(_, residual)| residual.abs() > f64::EPSILON)
            .map(|(constraint, residual)| {
                format!(
                    "the residual of `{}` stays at {residual:.3e} {}",
                    constraint.name, constraint.unit
                )
            })
            .collect();
        Error::Request(format!(
            "no state near the initial state satisfies the constraints: {}; a constraint may have no \
             solution or contradict another; check them, or start nearer to a solution ({})",
            left.join(", "),
            Argument::State
        ))
    }
}

/// Constraint whose derivative is a linear combination of the derivatives of others.
struct DependentConstraint<'a> {
    constraint: &'a ConstraintLabel,
    on: Vec<&'a ConstraintLabel>,
    /// Residual minus the linear combination of the other residuals.
    combined_residual: f64,
    /// Largest term of `combined_residual`.
    scale: f64,
}

impl DependentConstraint<'_> {
    /// Returns the error text. It reports a contradiction if the residuals do not satisfy the linear combination, and a
    /// singular position otherwise.
    fn reason(&self) -> String {
        let names: Vec<String> = self.on.iter().map(|on| format!("`{}`", on.name)).collect();
        let (name, others) = (&self.constraint.name, names.join(", "));
        let kind = self.constraint.is_nonholonomic;
        let of_one_kind = self.on.iter().all(|on| on.is_nonholonomic == kind);
        if of_one_kind && self.combined_residual.abs() > MIN_CONTRADICTION_FRACTION * self.scale {
            return format!(
                "the constraint `{name}` contradicts {others} at the initial state: they restrict the same motion, \
                 but a residual of {:.3e} {} remains; remove or correct one of them",
                self.combined_residual.abs(),
                self.constraint.unit
            );
        }
        format!(
            "the initial state is a singular position: the derivative of the constraint `{name}` is a linear \
             combination of the derivatives of {others}; start at another state ({}), or remove one of them if they \
             depend on each other everywhere",
            Argument::State
        )
    }
}
