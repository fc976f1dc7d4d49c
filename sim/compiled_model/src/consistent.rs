//! A model on its constraints: initial states moved there, what is said of constraints that cannot
//! hold, and the model as solvers see it, whose steps are kept there. How a state is corrected is the
//! business of `projection`.

use std::cell::RefCell;

use eomgen_analysis::qr_iteration;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::model::{Constraint, RESIDUAL, STABILISATION_RATE};
use eomgen_sim::inputs::HeldInputs;
use nalgebra::DMatrix;

use crate::contacts::first_overlap;
use crate::driven::Driven;
use crate::error::Error;
use crate::instance::Instance;
use crate::jacobians::Jacobian;
use crate::projection::{LARGE_RATE, Moved, Projection};

/// Corrections of an initial state before the search is given up.
const MOST_AT_THE_START: usize = 100;

/// A derivative is a combination of others if this part of it is left beside them.
const INDEPENDENT: f64 = 1e-9;

/// A combination of constraints' derivatives that is this small beside them is on its way to none.
const SINGULAR: f64 = 1e-3;

/// A constraint is named with others if its part in their combination is no less beside the largest.
const TAKES_PART: f64 = 0.1;

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
        let driven = Driven::new(evaluator, inputs).with_projection(self.projection()?);
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
        Ok(Some(Projection {
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
        let inputs = &inputs.at(t);
        let projection = match self.projection() {
            Ok(Some(projection)) => projection,
            Ok(None) => {
                self.above_zero(t, state, inputs)?;
                return Ok((state.to_vec(), Vec::new()));
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
                None => self.not_kept(t, &found, inputs)?,
            };
            return Err(error);
        }
        // Rounding may have let a correction succeed that rests on a constraint which follows from others.
        if let Some(reason) = self.dependent(t, &found, inputs)? {
            return Err(Error::Request(reason));
        }
        self.above_zero(t, &found, inputs)?;
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

    /// Whether no distance of an impact is below zero.
    fn above_zero(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<(), Error> {
        let impacts = &self.model().model().impacts;
        if impacts.is_empty() {
            return Ok(());
        }
        let below = first_overlap(&mut self.evaluator()?, Point { t, state, inputs });
        let Some((place, distance)) = below else {
            return Ok(());
        };
        let impact = &impacts[place];
        Err(Error::Request(format!(
            "the impact `{}` begins at {distance:.6e} {}, below zero: give an initial state in which \
             nothing overlaps",
            impact.name, impact.unit
        )))
    }

    /// Which constraint has no derivative of its own, if one has none, and whether it contradicts
    /// those that it follows.
    fn dependent(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Option<String>, Error> {
        let gradients = self.gradients(t, state, inputs)?;
        let residuals = self.residuals(t, state, inputs)?;
        let constraints = &self.model().model().constraints;
        let mut independent: Vec<Independent> = Vec::new();
        for (place, gradient) in gradients.into_iter().enumerate() {
            let constraint = &constraints[place];
            let size = norm(&gradient);
            if size == 0.0 {
                return Ok(Some(format!(
                    "the constraint `{}` holds nothing at the initial state: its derivatives are all 0 \
                     there; start elsewhere (--initial), or write it so that it changes its sign",
                    constraint.name
                )));
            }
            let mut rest = Independent {
                place,
                direction: gradient,
                residual: residuals[place],
            };
            let mut held = Vec::new();
            for other in &independent {
                if rest.take_away(other).abs() > INDEPENDENT * size {
                    held.push(other.place);
                }
            }
            let left = norm(&rest.direction);
            if left.is_nan() || left <= INDEPENDENT * size {
                let follows = Follows {
                    constraint,
                    of: held.iter().map(|other| &constraints[*other]).collect(),
                    apart: rest.residual,
                    scale: held.iter().fold(residuals[place].abs(), |most, other| {
                        most.max(residuals[*other].abs())
                    }),
                };
                return Ok(Some(follows.reason()));
            }
            rest.direction.iter_mut().for_each(|entry| *entry /= left);
            rest.residual /= left;
            independent.push(rest);
        }
        Ok(None)
    }

    /// What is to be said of constraints that are no longer independent of each other at a state to which a motion
    /// from `initial` has come; nothing where they are.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    pub(crate) fn singular_position(
        &self,
        (start, initial): (f64, &[f64]),
        (t, state): (f64, &[f64]),
        inputs: &HeldInputs,
    ) -> Result<Option<String>, Error> {
        let constraints = &self.model().model().constraints;
        if constraints.is_empty() || state.iter().any(|entry| !entry.is_finite()) {
            return Ok(None);
        }
        let before = self.gradients(start, initial, &inputs.at(start))?;
        let here = self.gradients(t, state, &inputs.at(t))?;
        // In parts of the largest that each derivative was or is, as one may vanish by itself.
        let sizes = before.iter().zip(&here).map(|(a, b)| norm(a).max(norm(b)));
        let sizes: Vec<f64> = sizes.collect();
        let degrees = here.first().map_or(0, Vec::len);
        let parts = DMatrix::from_fn(here.len(), degrees, |row, column| {
            here[row][column] / sizes[row]
        });
        let Some(held) = qr_iteration::symmetric_eigen(&(&parts * parts.transpose())) else {
            return Ok(None);
        };
        let (least, value) = held.eigenvalues.argmin();
        if value.max(0.0).sqrt() > SINGULAR {
            return Ok(None);
        }
        let combined = held.eigenvectors.column(least);
        let takes_part =
            |(_, part): &(&Constraint, &f64)| part.abs() > TAKES_PART * combined.amax();
        let names = constraints.iter().zip(combined.iter()).filter(takes_part);
        let names: Vec<String> = names
            .map(|(constraint, _)| format!("`{}`", constraint.name))
            .collect();
        let what = match &names[..] {
            [one] => {
                format!("the constraint {one} holds nothing any more, as its derivatives are all 0")
            }
            several => format!(
                "the constraints {} are no longer independent, as the derivative of one is made of those of the others",
                several.join(", ")
            ),
        };
        Ok(Some(format!(
            "at t = {t:?} s the motion comes to a singular position: {what} there, and no accelerations follow; \
             shorten the time, or keep the motion away from there (a stop, another start by --initial)"
        )))
    }

    /// What every constraint is away from zero, in SI.
    fn residuals(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<f64>, Error> {
        let mut own = self.unchecked();
        let mut observables = vec![0.0; own.program().observables.len()];
        own.observables(Point { t, state, inputs }, &mut observables);
        let model = self.model().model();
        let residual = |constraint: &Constraint| {
            let name = format!("{RESIDUAL}{}", constraint.name);
            let mut known = model.observables.iter();
            let place = known.position(|observable| observable.name == name);
            place.map_or(f64::NAN, |place| observables[place])
        };
        Ok(model.constraints.iter().map(residual).collect())
    }

    /// The derivative of every constraint by the coordinates, or by the rates of a nonholonomic one,
    /// each coordinate measured by its own inertia.
    fn gradients(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let mut jacobians = self.interpreted_jacobians()?;
        let (rows, columns) = jacobians.shape(Jacobian::ObservablesByState);
        let mut matrix = vec![0.0; rows * columns];
        let point = Point { t, state, inputs };
        jacobians.evaluate(Jacobian::ObservablesByState, point, &mut matrix);
        let mut own = self.unchecked();
        let degrees = own.program().degrees_of_freedom();
        let mut mass = vec![0.0; degrees * degrees];
        own.mass_matrix(point, &mut mass);
        let names = self.model().observable_names();
        let constraints = &self.model().model().constraints;
        let gradient = |constraint: &Constraint| {
            let residual = format!("{RESIDUAL}{}", constraint.name);
            let row = names.iter().position(|name| *name == residual).unwrap_or(0);
            let first = if constraint.is_nonholonomic {
                degrees
            } else {
                0
            };
            let entries = &matrix[row * columns + first..][..degrees];
            let entries = entries.iter().enumerate();
            entries
                .map(|(place, entry)| entry / mass[place * degrees + place].sqrt())
                .collect()
        };
        Ok(constraints.iter().map(gradient).collect())
    }

    /// Which constraints are not kept.
    fn not_kept(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Error, Error> {
        let constraints = &self.model().model().constraints;
        let residuals = self.residuals(t, state, inputs)?;
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
        Ok(Error::Request(format!(
            "no state near the initial one keeps the constraints: {}; one of them may never be zero, or \
             contradict another; check them, or start nearer (--initial)",
            left.join(", ")
        )))
    }
}

/// A direction that a constraint holds and none before it.
struct Independent {
    /// Which constraint.
    place: usize,
    /// Its derivative, without what those before it hold.
    direction: Vec<f64>,
    /// The constraint's residual, combined as the direction is.
    residual: f64,
}

impl Independent {
    /// Takes away what of this the other holds, and says how much that was.
    fn take_away(&mut self, other: &Self) -> f64 {
        let pairs = self.direction.iter().zip(&other.direction);
        let along: f64 = pairs.map(|(a, b)| a * b).sum();
        for (entry, part) in self.direction.iter_mut().zip(&other.direction) {
            *entry -= along * part;
        }
        self.residual -= along * other.residual;
        along
    }
}

/// A constraint whose derivative is a combination of the derivatives of others, or not finite.
struct Follows<'a> {
    constraint: &'a Constraint,
    of: Vec<&'a Constraint>,
    /// Its residual less the same combination of theirs.
    apart: f64,
    /// The largest residual of them all.
    scale: f64,
}

impl Follows<'_> {
    /// Redundant where its residual is made of theirs as its derivative is, else it asks for
    /// something else in a direction that is held already.
    fn reason(&self) -> String {
        let names: Vec<String> = self.of.iter().map(|of| format!("`{}`", of.name)).collect();
        let (name, others) = (&self.constraint.name, names.join(", "));
        if self.of.is_empty() {
            return format!(
                "the derivative of the constraint `{name}` is not finite at the initial state, as that of \
                 sqrt(x) at x = 0; start elsewhere (--initial), or write the constraint without it"
            );
        }
        let kind = self.constraint.is_nonholonomic;
        let of_one_kind = self.of.iter().all(|of| of.is_nonholonomic == kind);
        if of_one_kind && self.apart.abs() > CONTRADICTION * self.scale {
            return format!(
                "the constraint `{name}` contradicts {others} at the initial state: it holds what they \
                 hold, and asks for {:.3e} {} more; leave one of them out, or correct it",
                self.apart.abs(),
                self.constraint.unit
            );
        }
        format!(
            "the constraint `{name}` is redundant at the initial state: its derivative is a combination of the \
             derivatives of {others}; leave one of them out"
        )
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}
