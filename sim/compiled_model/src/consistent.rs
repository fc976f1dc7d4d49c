//! A model on its constraints: initial states moved there, what is said of constraints that cannot
//! hold, and the model as solvers see it, whose steps are kept there. How a state is corrected is the
//! business of `projection`.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::model::{Constraint, RESIDUAL, STABILISATION_RATE};
use eomgen_sim::inputs::HeldInputs;

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
        let Some(projection) = self.projection()? else {
            self.above_zero(t, state, inputs)?;
            return Ok((state.to_vec(), Vec::new()));
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

    /// Which constraint has no derivative of its own, if one has none.
    fn dependent(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Option<String>, Error> {
        let gradients = self.gradients(t, state, inputs)?;
        let constraints = &self.model().model().constraints;
        let mut independent: Vec<(usize, Vec<f64>)> = Vec::new();
        for (place, gradient) in gradients.iter().enumerate() {
            let name = &constraints[place].name;
            let mut rest = gradient.clone();
            let mut held = Vec::new();
            for (other, direction) in &independent {
                let along: f64 = rest.iter().zip(direction).map(|(a, b)| a * b).sum();
                if along.abs() > INDEPENDENT * norm(gradient) {
                    held.push(constraints[*other].name.as_str());
                }
                for (entry, part) in rest.iter_mut().zip(direction) {
                    *entry -= along * part;
                }
            }
            let left = norm(&rest);
            if norm(gradient) == 0.0 {
                return Ok(Some(format!(
                    "the constraint `{name}` holds nothing at the initial state: its derivatives are \
                     all 0 there; start elsewhere (--initial), or write it so that it changes its sign"
                )));
            }
            if left.is_nan() || left <= INDEPENDENT * norm(gradient) {
                return Ok(Some(format!(
                    "the constraint `{name}` is redundant at the initial state: its derivative is made \
                     of that of {}; leave one of them out",
                    held.iter()
                        .map(|name| format!("`{name}`"))
                        .collect::<Vec<_>>()
                        .join(", ")
                )));
            }
            rest.iter_mut().for_each(|entry| *entry /= left);
            independent.push((place, rest));
        }
        Ok(None)
    }

    /// The derivative of every constraint by the coordinates, or by the rates of a nonholonomic one,
    /// each coordinate measured by its own inertia.
    fn gradients(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let mut jacobians = self.jacobian_evaluator()?;
        let (rows, columns) = jacobians.shape(Jacobian::ObservablesByState);
        let mut matrix = vec![0.0; rows * columns];
        let point = Point { t, state, inputs };
        jacobians.evaluate(Jacobian::ObservablesByState, point, &mut matrix);
        let mut own = self.evaluator()?;
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
        let mut own = self.evaluator()?;
        let mut observables = vec![0.0; own.program().observables.len()];
        own.observables(Point { t, state, inputs }, &mut observables);
        let model = self.model().model();
        let mut left = Vec::new();
        for constraint in &model.constraints {
            let residual = format!("{RESIDUAL}{}", constraint.name);
            let place = model
                .observables
                .iter()
                .position(|known| known.name == residual);
            let value = place.map_or(f64::NAN, |place| observables[place]);
            if value.abs() > f64::EPSILON {
                left.push(format!(
                    "`{}` stays at {value:.3e} {}",
                    constraint.name, constraint.unit
                ));
            }
        }
        Ok(Error::Request(format!(
            "no state near the initial one keeps the constraints: {}; one of them may never be zero, or \
             contradict another; check them, or start nearer (--initial)",
            left.join(", ")
        )))
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}
