//! Rates, observables and switching functions in a given mode, and products of weights with their Jacobians.

use eomgen_codegen::program::evaluator::{Evaluator, ImpactValues, Point, SlidingValues};
use eomgen_sim::ode::SurfaceMode;
use nalgebra::{DMatrix, DVector};

use super::derivatives::Derivatives;
use crate::error::Error;
use crate::jacobians::JacobianLayout;
use crate::sticking::{MAX_SETTLED_CHANGE, MAX_SIDE_ITERATIONS, side_of};

/// Jacobians of rates or observables with respect to state, inputs and parameters.
struct RowJacobians {
    layouts: [JacobianLayout; 3],
    dense: [Vec<f64>; 3],
}

impl RowJacobians {
    fn find(evaluator: &Evaluator, names: [&str; 3]) -> Option<Self> {
        let program = evaluator.program();
        let [state, inputs, parameters] = names.map(|name| JacobianLayout::find(program, name));
        let layouts = [state?, inputs?, parameters?];
        let dense = [0, 1, 2].map(|by: usize| vec![0.0; layouts[by].rows * layouts[by].columns]);
        Some(Self { layouts, dense })
    }

    fn evaluate(&mut self, evaluator: &mut Evaluator, point: Point<'_>) {
        for (layout, dense) in self.layouts.iter_mut().zip(&mut self.dense) {
            layout.evaluate(evaluator, point, dense);
        }
    }

    /// Adds `factor` times a row to `sum`.
    fn add_row(&self, row: usize, factor: f64, sum: &mut Derivatives) {
        let sums = [&mut sum.state, &mut sum.inputs, &mut sum.parameters];
        for ((layout, dense), sum) in self.layouts.iter().zip(&self.dense).zip(sums) {
            let row = &dense[row * layout.columns..(row + 1) * layout.columns];
            for (slot, entry) in sum.iter_mut().zip(row) {
                *slot += factor * entry;
            }
        }
    }
}

/// Input of the program that is the side of a surface.
struct SideInput {
    guard: usize,
    is_odd: bool,
    /// Fixed value of the side; `None` if the side follows from the state or the surface holds the motion.
    fixed: Option<f64>,
}

/// Evaluator of a model in one mode of its surfaces.
pub(super) struct ModeEvaluator {
    evaluator: Evaluator,
    /// Inputs of the model, followed by the sides.
    inputs: Vec<f64>,
    model_inputs: usize,
    sides: Vec<SideInput>,
    /// Index of the first side of a surface that can hold the motion.
    first_sliding: usize,
    /// Surfaces that hold the motion, as indices among the surfaces that can.
    held: Vec<usize>,
    is_linear: bool,
    sliding: Vec<SlidingValues>,
    guards: Vec<f64>,
    observables: RowJacobians,
    guards_by: RowJacobians,
    guard_rates_by: RowJacobians,
    distances_by: RowJacobians,
    residuals_by: RowJacobians,
    residual_rates_by: RowJacobians,
    jumps_by: RowJacobians,
    jumps_by_time: JacobianLayout,
    impacts: Vec<ImpactValues>,
    parameters: usize,
}

impl ModeEvaluator {
    /// Wraps an evaluator of a program for gradients, prepared at its parameters.
    ///
    /// # Errors
    /// A program without the required outputs.
    pub fn new(evaluator: Evaluator) -> Result<Self, Error> {
        let missing = || Error::Request("the program has no gradients".to_owned());
        let find = |names| RowJacobians::find(&evaluator, names).ok_or_else(missing);
        let observables = find([
            "observables_by_state",
            "observables_by_inputs",
            "observables_by_parameters",
        ])?;
        let guards_by = find([
            "guards_by_state",
            "guards_by_inputs",
            "guards_by_parameters",
        ])?;
        let guard_rates_by = find([
            "guard_rates_by_state",
            "guard_rates_by_inputs",
            "guard_rates_by_parameters",
        ])?;
        let distances_by = find([
            "distances_by_state",
            "distances_by_inputs",
            "distances_by_parameters",
        ])?;
        let residuals_by = find([
            "residuals_by_state",
            "residuals_by_inputs",
            "residuals_by_parameters",
        ])?;
        let residual_rates_by = find([
            "residual_rates_by_state",
            "residual_rates_by_inputs",
            "residual_rates_by_parameters",
        ])?;
        let jumps_by = find(["jumps_by_state", "jumps_by_inputs", "jumps_by_parameters"])?;
        let program = evaluator.program();
        let jumps_by_time = JacobianLayout::find(program, "jumps_by_time").ok_or_else(missing)?;
        let outputs = &program.outputs;
        let others = outputs.sides.iter().map(|side| (side.guard, side.is_odd));
        let sliding = outputs.sliding.iter();
        let sides = others.chain(sliding.map(|surface| (surface.guard, surface.is_odd)));
        let sides = sides.map(|(guard, is_odd)| SideInput {
            guard,
            is_odd,
            fixed: None,
        });
        let sides: Vec<SideInput> = sides.collect();
        Ok(Self {
            inputs: vec![0.0; program.inputs.len()],
            model_inputs: program.inputs.len() - sides.len(),
            first_sliding: outputs.sides.len(),
            held: Vec::new(),
            is_linear: outputs.sliding.iter().all(|surface| surface.is_linear),
            sliding: Vec::new(),
            guards: vec![0.0; evaluator.guard_count()],
            parameters: program.parameters.len(),
            sides,
            observables,
            guards_by,
            guard_rates_by,
            distances_by,
            residuals_by,
            residual_rates_by,
            jumps_by,
            jumps_by_time,
            impacts: Vec::new(),
            evaluator,
        })
    }

    /// Returns zero derivatives with the sizes of the program.
    pub fn zeros(&self) -> Derivatives {
        let states = self.evaluator.program().states();
        Derivatives::zeros(states, self.inputs.len(), self.parameters)
    }

    /// Sets the modes of the surfaces, in the order of the guards.
    pub fn set_modes(&mut self, modes: &[SurfaceMode]) {
        self.held.clear();
        for (place, side) in self.sides.iter_mut().enumerate() {
            side.fixed = match modes.get(side.guard) {
                Some(SurfaceMode::Positive) => Some(1.0),
                Some(SurfaceMode::Negative) => Some(0.0),
                Some(SurfaceMode::Held) if place >= self.first_sliding => {
                    self.held.push(place - self.first_sliding);
                    Some(0.5)
                }
                _ => None,
            };
        }
    }

    /// Fixes the side of a surface, 0 or 1. Returns false if the rates do not depend on it.
    pub fn set_side(&mut self, guard: usize, value: f64) -> bool {
        let side = self.sides.iter_mut().find(|side| side.guard == guard);
        side.map(|side| side.fixed = Some(value)).is_some()
    }

    /// Sets the model inputs and the sides of the surfaces at a point.
    fn set_inputs(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) -> Result<(), Error> {
        self.inputs[..self.model_inputs].copy_from_slice(&inputs[..self.model_inputs]);
        if self.sides.iter().any(|side| side.fixed.is_none()) {
            let inputs = &self.inputs;
            self.evaluator
                .guards(Point { t, state, inputs }, &mut self.guards);
        }
        for (side, slot) in self.sides.iter().zip(&mut self.inputs[self.model_inputs..]) {
            let of_state = || side_of(self.guards[side.guard], side.is_odd);
            *slot = side.fixed.unwrap_or_else(of_state);
        }
        self.find_holding_sides((t, state))
    }

    fn find_holding_sides(&mut self, (t, state): (f64, &[f64])) -> Result<(), Error> {
        if self.held.is_empty() {
            return Ok(());
        }
        let first = self.model_inputs + self.first_sliding;
        for iteration in 0.. {
            let inputs = &self.inputs;
            self.evaluator
                .sliding(Point { t, state, inputs }, &mut self.sliding);
            if self.is_linear && iteration == 1 || iteration == MAX_SIDE_ITERATIONS {
                break;
            }
            let rates = self.held.iter().map(|row| -self.sliding[*row].rate);
            let rates = DVector::from_iterator(self.held.len(), rates);
            let change = self.differentiate_held_rates().lu().solve(&rates);
            let change = change.ok_or_else(|| {
                Error::Request(format!(
                    "no gradient of the trajectory: at t = {t:?} s, the surfaces that hold the motion are linearly \
                     dependent"
                ))
            })?;
            for (row, change) in self.held.iter().zip(&change) {
                self.inputs[first + row] += change;
            }
            if change.amax() <= MAX_SETTLED_CHANGE {
                break;
            }
        }
        Ok(())
    }

    /// Returns the derivatives of the rates of the held functions (rows) with respect to the sides of their surfaces.
    fn differentiate_held_rates(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.held.len(), self.held.len(), |row, column| {
            self.sliding[self.held[row]].by_sides[self.held[column]]
        })
    }

    pub fn write_rates(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        out: &mut [f64],
    ) -> Result<(), Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        self.evaluator.rates(Point { t, state, inputs }, out);
        Ok(())
    }

    /// Writes the products of weights with the Jacobians of the rates.
    pub fn pull_back_rates(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        weights: &[f64],
        out: &mut Derivatives,
    ) -> Result<(), Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        let sums = (
            &mut out.state[..],
            &mut out.inputs[..],
            &mut out.parameters[..],
        );
        self.evaluator.weighted_gradient(point, weights, sums);
        self.follow_holding_sides((t, state), out)
    }

    /// Adds the products of weights with the Jacobians of the observables.
    pub fn pull_back_observables(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        weights: &[f64],
    ) -> Result<Derivatives, Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        self.observables
            .evaluate(&mut self.evaluator, Point { t, state, inputs });
        let mut sum = self.zeros();
        for (row, weight) in weights.iter().enumerate() {
            if *weight != 0.0 {
                self.observables.add_row(row, *weight, &mut sum);
            }
        }
        self.follow_holding_sides((t, state), &mut sum)?;
        Ok(sum)
    }

    /// Replaces the derivatives with respect to the sides of held surfaces, by the condition that the rates of their
    /// switching functions are zero.
    fn follow_holding_sides(
        &mut self,
        (t, state): (f64, &[f64]),
        sum: &mut Derivatives,
    ) -> Result<(), Error> {
        if self.held.is_empty() {
            return Ok(());
        }
        let first = self.model_inputs + self.first_sliding;
        let by_sides = self.held.iter().map(|row| sum.inputs[first + row]);
        let by_sides = DVector::from_iterator(self.held.len(), by_sides);
        let multipliers = self
            .differentiate_held_rates()
            .transpose()
            .lu()
            .solve(&by_sides);
        let multipliers = multipliers.unwrap_or_else(|| DVector::repeat(self.held.len(), f64::NAN));
        let inputs = &self.inputs;
        self.guard_rates_by
            .evaluate(&mut self.evaluator, Point { t, state, inputs });
        for (row, multiplier) in self.held.iter().zip(&multipliers) {
            let guard = self.sides[self.first_sliding + row].guard;
            self.guard_rates_by.add_row(guard, -multiplier, sum);
        }
        Ok(())
    }

    /// Returns the number of surfaces: switching functions, then distances of impacts.
    pub fn surface_count(&self) -> usize {
        self.guards.len() + self.evaluator.program().impacts.len()
    }

    /// Returns the surface of an impact.
    pub fn surface_of(&self, impact: usize) -> usize {
        self.guards.len() + impact
    }

    /// Returns the index of the impact to which a surface belongs.
    pub fn impact_of(&self, surface: usize) -> Option<usize> {
        surface.checked_sub(self.guards.len())
    }

    /// Writes the surface functions and their rates.
    pub fn write_surfaces(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        (values, rates): (&mut [f64], &mut [f64]),
    ) -> Result<(), Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        let guards = self.guards.len();
        self.evaluator.guards(point, &mut values[..guards]);
        self.evaluator.guard_rates(point, &mut rates[..guards]);
        self.evaluator.impacts(point, &mut self.impacts);
        for (place, impact) in self.impacts.iter().enumerate() {
            (values[guards + place], rates[guards + place]) = (impact.distance, impact.rate);
        }
        Ok(())
    }

    /// Returns the derivatives of the function of a surface.
    pub fn differentiate_surface(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        surface: usize,
    ) -> Result<Derivatives, Error> {
        self.set_inputs((t, state), inputs)?;
        let (rows, row) = match self.impact_of(surface) {
            Some(impact) => (&mut self.distances_by, impact),
            None => (&mut self.guards_by, surface),
        };
        let inputs = &self.inputs;
        rows.evaluate(&mut self.evaluator, Point { t, state, inputs });
        let program = self.evaluator.program();
        let mut found = Derivatives::zeros(program.states(), self.inputs.len(), self.parameters);
        rows.add_row(row, 1.0, &mut found);
        Ok(found)
    }

    /// Returns, for each impact, the jump of the rates by this impact alone, one number per degree of freedom.
    pub fn compute_impact_jumps(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
    ) -> Result<Vec<Vec<f64>>, Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        self.evaluator
            .impacts(Point { t, state, inputs }, &mut self.impacts);
        let impacts = self.impacts.iter().enumerate();
        let jumps = impacts.map(|(place, impact)| {
            let impulse = -(1.0 + impact.restitution) * impact.rate / impact.delassus[place];
            impact.column.iter().map(|rate| rate * impulse).collect()
        });
        Ok(jumps.collect())
    }

    /// Returns the derivatives of the residuals of all constraints, and of the rates of these residuals.
    pub fn differentiate_constraints(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
    ) -> Result<[Vec<Derivatives>; 2], Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.residuals_by.evaluate(&mut self.evaluator, point);
        self.residual_rates_by.evaluate(&mut self.evaluator, point);
        let rows = |jacobians: &RowJacobians| -> Vec<Derivatives> {
            let rows = (0..jacobians.layouts[0].rows).map(|place| {
                let mut row = self.zeros();
                jacobians.add_row(place, 1.0, &mut row);
                row
            });
            rows.collect()
        };
        Ok([rows(&self.residuals_by), rows(&self.residual_rates_by)])
    }

    /// Returns the mass matrix of the degrees of freedom.
    pub fn mass_matrix(&mut self, (t, state): (f64, &[f64])) -> DMatrix<f64> {
        let degrees = self.evaluator.program().degrees_of_freedom();
        let mut mass = vec![0.0; degrees * degrees];
        let inputs = &self.inputs;
        self.evaluator
            .mass_matrix(Point { t, state, inputs }, &mut mass);
        DMatrix::from_row_slice(degrees, degrees, &mass)
    }

    /// Returns the products of weights with the derivatives of the jump by an impact, and with its time derivative.
    pub fn pull_back_jump(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        (impact, weights): (usize, &[f64]),
    ) -> Result<(Derivatives, f64), Error> {
        self.set_inputs((t, state), inputs)?;
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.jumps_by.evaluate(&mut self.evaluator, point);
        let mut by_time = vec![0.0; self.jumps_by_time.rows];
        self.jumps_by_time
            .evaluate(&mut self.evaluator, point, &mut by_time);
        let mut sum = self.zeros();
        let first = impact * weights.len();
        for (row, weight) in weights.iter().enumerate() {
            self.jumps_by.add_row(first + row, *weight, &mut sum);
        }
        let by_time = by_time[first..].iter().zip(weights);
        Ok((sum, by_time.map(|(entry, weight)| entry * weight).sum()))
    }
}
