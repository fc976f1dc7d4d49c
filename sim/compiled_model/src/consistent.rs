//! A model on its constraints: initial states moved there, what is said of constraints that cannot
//! hold, and the model as solvers see it, whose steps are kept there. How a state is corrected is the
//! business of `projection`.

use std::cell::RefCell;

use eomgen_codegen::independence::dependence::dependent_combination;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::{Constraint, STABILISATION_RATE};
use eomgen_sim::inputs::HeldInputs;

use crate::contacts::Start;
use crate::driven::Driven;
use crate::error::Error;
use crate::instance::Instance;
use crate::projection::{LARGE_RATE, Moved, Projection};
use crate::singular::SingularityWatch;

/// Corrections of an initial state before the search is given up.
const MOST_AT_THE_START: usize = 100;

/// A derivative is a combination of others if this part of it is left beside them.
const INDEPENDENT: f64 = 1e-9;

/// A constraint is named with others if its part in their combination is no less beside the largest.
const TAKES_PART: f64 = 1e-6;

/// A constraint that follows from others contradicts them if so much of the residuals is left when
/// theirs are taken away; less may be their curvature where a motion does not begin on them.
const CONTRADICTION: f64 = 0.1;

impl Instance<'_> {
    /// The model as the general solver sees it, with an evaluator of it: states stay on its
    /// constraints, bodies hit at its impacts, and surfaces such as those of dry friction hold it. A
    /// motion of its own, as contacts and what holds are remembered.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    pub fn driven<'d>(
        &self,
        evaluator: &'d RefCell<Evaluator>,
        inputs: &'d HeldInputs,
    ) -> Result<Driven<&'d RefCell<Evaluator>, &'d HeldInputs>, Error> {
        let impacts = self.model().model().impacts.iter();
        let impacts = impacts.map(|impact| impact.name.clone()).collect();
        let driven = Driven::new(evaluator, inputs)
            .with_typical_sizes(self.model().typical_sizes())
            .with_projection(self.projection()?);
        Ok(driven.with_impacts(impacts).with_sliding(self.sided()?))
    }

    /// What keeps states on the constraints, if there are any.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    fn projection(&self) -> Result<Option<Projection>, Error> {
        if self.model().model().constraints.is_empty() {
            return Ok(None);
        }
        let at = |rate: f64| self.stabilised(rate).evaluator().map(RefCell::new);
        let constraints = self.model().model().constraints.iter();
        let names = constraints
            .map(|constraint| constraint.name.clone())
            .collect();
        let Some(rows) = self.constraint_rows() else {
            return Ok(None);
        };
        Ok(Some(Projection {
            watch: RefCell::new(SingularityWatch::new(rows, names)),
            plus: at(LARGE_RATE)?,
            minus: at(-LARGE_RATE)?,
            own_rate: self.value(STABILISATION_RATE).unwrap_or(0.0),
        }))
    }

    /// The state nearest to this one, by the kinetic energy, in which the constraints hold, and what
    /// that moved.
    ///
    /// # Errors
    /// [`Error::Request`] that names a constraint that follows from others there, or those that no
    /// state near this one keeps.
    pub fn consistent(
        &self,
        state: &[f64],
        t: f64,
        inputs: &HeldInputs,
    ) -> Result<(Vec<f64>, Vec<Moved>), Error> {
        self.consistent_start(state, (t, t), inputs)
    }

    /// The same for a motion over a time span, s: a distance of an impact that is below zero by the
    /// rounding of what it covers then is brought to zero.
    ///
    /// # Errors
    /// As [`Instance::consistent`].
    pub(crate) fn consistent_start(
        &self,
        state: &[f64],
        (t, until): (f64, f64),
        inputs: &HeldInputs,
    ) -> Result<(Vec<f64>, Vec<Moved>), Error> {
        let inputs = &inputs.at(t);
        let projection = match self.projection() {
            Ok(Some(projection)) => projection,
            Ok(None) => {
                let mut found = state.to_vec();
                self.bring_above_zero((t, until), &mut found, inputs)?;
                return Ok((found, Vec::new()));
            }
            // Of constraints that follow from others wherever the machine is no pivot is positive.
            Err(error) => {
                let reason = self.dependent(t, state, inputs)?;
                return Err(reason.map_or(error, Error::Request));
            }
        };
        let mut own = self.evaluator()?;
        let mut found = state.to_vec();
        let at = (t, &inputs[..]);
        if projection
            .correct(&mut own, at, &mut found, MOST_AT_THE_START)
            .is_none()
        {
            let error = match self.dependent(t, state, inputs)? {
                Some(reason) => Error::Request(reason),
                None => self.not_kept(t, &found, inputs),
            };
            return Err(error);
        }
        // Rounding may have let a correction succeed that rests on a constraint which follows from others.
        if let Some(reason) = self.dependent(t, &found, inputs)? {
            return Err(Error::Request(reason));
        }
        self.bring_above_zero((t, until), &mut found, inputs)?;
        let names = self.model().state_names();
        let units = self.model().state_units();
        let largest = state
            .iter()
            .chain(&found)
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let entries = names.into_iter().zip(units).zip(state.iter().zip(&found));
        let moved = entries
            .filter(|(_, (from, to))| (*from - *to).abs() > 1e-12 * largest)
            .map(|((name, unit), (from, to))| Moved {
                name,
                unit,
                from: *from,
                to: *to,
            });
        Ok((found.clone(), moved.collect()))
    }

    /// Moves a state so that no distance of an impact is below zero by rounding.
    ///
    /// # Errors
    /// [`Error::Request`] that names an impact whose distance is below zero by more.
    fn bring_above_zero(
        &self,
        (t, until): (f64, f64),
        state: &mut [f64],
        inputs: &[f64],
    ) -> Result<(), Error> {
        let impacts = &self.model().model().impacts;
        if impacts.is_empty() {
            return Ok(());
        }
        let lengths: Vec<f64> = impacts
            .iter()
            .map(|impact| self.largest_in(impact.unit.dimension, state))
            .collect();
        let start = Start {
            t,
            until,
            inputs,
            lengths: &lengths,
        };
        let below = start.onto_contacts(&mut self.evaluator()?, state);
        below.map_err(|(place, distance)| {
            let impact = &impacts[place];
            Error::Request(format!(
                "the impact `{}` begins at {distance:.6e} {}, below zero: give an initial state in which \
                 nothing overlaps",
                impact.name, impact.unit
            ))
        })
    }

    /// The largest magnitude of the coordinates and parameters of a dimension, SI.
    fn largest_in(&self, dimension: Dimension, state: &[f64]) -> f64 {
        let model = self.model().model();
        let coordinates = model.coordinates.iter().zip(state);
        let coordinates = coordinates.filter(|(known, _)| known.unit.dimension == dimension);
        let parameters = model.parameters.iter();
        let parameters = parameters.filter(|known| known.unit.dimension == dimension);
        let parameters = parameters.filter_map(|known| self.value(&known.name));
        let all = coordinates.map(|(_, value)| *value).chain(parameters);
        all.fold(0.0, |most, value| value.abs().max(most))
    }

    /// Which constraint has no derivative of its own, if one has none, and whether it contradicts
    /// those that it follows.
    fn dependent(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Option<String>, Error> {
        let point = Point { t, state, inputs };
        let Some(mut rows) = self.constraint_rows() else {
            return Ok(None);
        };
        let (mut all, residuals) = (rows.rows(point), rows.residuals(point));
        let constraints = &self.model().model().constraints;
        let lengths: Vec<f64> = all.iter().map(|row| norm(row)).collect();
        if let Some(place) = lengths.iter().position(|length| *length == 0.0) {
            return Ok(Some(format!(
                "the constraint `{}` holds nothing at the initial state: its derivative is zero there; start \
                 elsewhere (--state), or write it so that it crosses zero, as x instead of x^2",
                constraints[place].name
            )));
        }
        if let Some(place) = lengths.iter().position(|length| !length.is_finite()) {
            return Ok(Some(format!(
                "the derivative of the constraint `{}` is not finite at the initial state, as that of \
                 sqrt(x) at x = 0; start elsewhere (--state), or write the constraint without it",
                constraints[place].name
            )));
        }
        for (row, length) in all.iter_mut().zip(&lengths) {
            row.iter_mut().for_each(|entry| *entry /= length);
        }
        let Some(parts) = dependent_combination(&all, INDEPENDENT) else {
            return Ok(None);
        };
        let last = parts.iter().rposition(|part| *part != 0.0).unwrap_or(0);
        let most = parts
            .iter()
            .fold(0.0_f64, |most, part| most.max(part.abs()));
        let others: Vec<usize> = (0..last)
            .filter(|place| parts[*place].abs() > TAKES_PART * most)
            .collect();
        let part = |place: usize| {
            parts[place] / lengths[place] * residuals[place] / (parts[last] / lengths[last])
        };
        let combined = others.iter().chain([&last]).map(|place| part(*place));
        let depends = Depends {
            constraint: &constraints[last],
            on: others.iter().map(|place| &constraints[*place]).collect(),
            apart: combined.clone().sum(),
            scale: combined.map(f64::abs).fold(0.0, f64::max),
        };
        Ok(Some(depends.reason()))
    }

    /// Which constraints are not kept.
    fn not_kept(&self, t: f64, state: &[f64], inputs: &[f64]) -> Error {
        let constraints = &self.model().model().constraints;
        let rows = self.constraint_rows();
        let residuals = rows.map(|mut rows| rows.residuals(Point { t, state, inputs }));
        let residuals = residuals.unwrap_or_default();
        let left: Vec<String> = constraints
            .iter()
            .zip(residuals)
            .filter(|(_, residual)| residual.abs() > f64::EPSILON)
            .map(|(constraint, residual)| {
                format!(
                    "`{}` stays at {residual:.3e} {}",
                    constraint.name, constraint.unit
                )
            })
            .collect();
        Error::Request(format!(
            "no state near the initial one keeps the constraints: {}; one of them may never be zero, or \
             contradict another; check them, or start nearer (--state)",
            left.join(", ")
        ))
    }
}

/// A constraint whose derivative is a combination of the derivatives of others.
struct Depends<'a> {
    constraint: &'a Constraint,
    on: Vec<&'a Constraint>,
    /// Its residual less the same combination of theirs.
    apart: f64,
    /// The largest residual of them all, as large as it is in the combination.
    scale: f64,
}

impl Depends<'_> {
    /// A contradiction if the residuals do not combine to nothing as the derivatives do.
    fn reason(&self) -> String {
        let names: Vec<String> = self.on.iter().map(|on| format!("`{}`", on.name)).collect();
        let (name, others) = (&self.constraint.name, names.join(", "));
        let kind = self.constraint.is_nonholonomic;
        let of_one_kind = self.on.iter().all(|on| on.is_nonholonomic == kind);
        if of_one_kind && self.apart.abs() > CONTRADICTION * self.scale {
            return format!(
                "the constraint `{name}` contradicts {others} at the initial state: it holds what they \
                 hold, and asks for {:.3e} {} more; leave one of them out, or correct it",
                self.apart.abs(),
                self.constraint.unit
            );
        }
        format!(
            "the initial state is a singular position: the derivative of the constraint `{name}` is a \
             combination of the derivatives of {others} there; start elsewhere (--state), or leave one of them out if they depend on \
             each other everywhere"
        )
    }
}
