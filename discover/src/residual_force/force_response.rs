//! First-order responses of the outputs to forces. They are computed with tangent vectors if the
//! exponential integrator is used, otherwise by simulations with a small force.

use crate::ids::EquationId;
use eomgen_codegen::program::evaluator::Point;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::fit::linearised_fit::Linearisation;
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::{Shooting, count_samples};
use crate::model::simulation::TangentDrives;
use crate::residual_force::equations::{EquationEvaluator, EquationSet, OperatingPoint};
use crate::residual_force::finite_difference_response::SteppedWindow;
use eomgen_sim::exponential::DrivingAccelerations;

/// Function that computes one weight per column from the operating points and the inputs.
pub type FillWeights<'w> = dyn Fn(&[OperatingPoint], &[f64], &mut [f64]) + Sync + 'w;

/// Equation and weights of each force column.
pub struct ForceColumns<'w> {
    /// Equation of each column.
    pub equations: Vec<EquationId>,
    /// Computes the weight of each column.
    pub fill_weights: &'w FillWeights<'w>,
}

/// Forces as drives of the linearised motion.
struct ForceDrives<'c> {
    evaluator: EquationEvaluator,
    columns: &'c ForceColumns<'c>,
    begin: f64,
    operating_points: Vec<OperatingPoint>,
    accelerations: Vec<f64>,
    weights: Vec<f64>,
}

impl<'c> ForceDrives<'c> {
    fn new(equations: &EquationSet, columns: &'c ForceColumns<'c>, begin: f64) -> Self {
        Self {
            evaluator: equations.create_evaluator(),
            weights: vec![0.0; columns.equations.len()],
            columns,
            begin,
            operating_points: Vec::new(),
            accelerations: Vec::new(),
        }
    }
}

impl DrivingAccelerations for ForceDrives<'_> {
    fn write_differences(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]) {
        let point = Point { t, state, inputs };
        self.evaluator
            .append_operating_points(point, &mut self.operating_points);
        self.evaluator
            .append_accelerations(point, &mut self.accelerations);
        for operating_point in &mut self.operating_points {
            operating_point.time = t - self.begin;
        }
        (self.columns.fill_weights)(&self.operating_points, inputs, &mut self.weights);
        let forced = out.len() / self.columns.equations.len().max(1);
        let slots = out.chunks_exact_mut(forced.max(1));
        for (slots, (equation, weight)) in
            slots.zip(self.columns.equations.iter().zip(&self.weights))
        {
            let own =
                &self.accelerations[equation.index() * forced..(equation.index() + 1) * forced];
            let pairs = slots.iter_mut().zip(own);
            pairs.for_each(|(slot, acceleration)| *slot = weight * acceleration);
        }
    }
}

/// Returns a matrix for each window with one column per force, in standard deviations per unit of
/// force. An element is `None` if the simulation of the window failed; the result is `None` if
/// neither method is available.
pub fn compute_force_responses(
    of: Linearisation<'_>,
    equations: &EquationSet,
    columns: &ForceColumns<'_>,
) -> Option<Vec<Option<DMatrix<f64>>>> {
    let Linearisation {
        point: at,
        problem,
        fit,
    } = of;
    let whole = fit.training_shooting(problem);
    let shooting = Shooting {
        fraction: at.fraction,
        ..whole
    };
    let theta = &at.estimate.theta;
    let carries_tangents = fit
        .model
        .create_simulation(&shooting.parameter_values(theta))
        .ok()?
        .has_tangents();
    if !carries_tangents && fit.model.longest_step.is_none() {
        return None;
    }
    let count = columns.equations.len();
    let size = at
        .windows
        .len()
        .div_ceil(rayon::current_num_threads().max(1));
    let parts: Vec<Vec<Option<DMatrix<f64>>>> = (0..at.windows.len())
        .collect::<Vec<_>>()
        .par_chunks(size.max(1))
        .map(|part| {
            let mut sensitivities =
                SensitivityEvaluator::with_fixed_unknowns(&shooting, theta, 1.0);
            let mut forces = ForceDrives::new(equations, columns, 0.0);
            let mut one = |number: usize| {
                at.projections[number].as_ref()?;
                let window = at.windows[number];
                let start = &at.estimate.initial_states[window];
                forces.begin = problem.train.windows[window].times[0];
                let driven = TangentDrives {
                    count,
                    drives: &mut forces,
                };
                match carries_tangents {
                    true => sensitivities
                        .as_mut()?
                        .compute_drive_response(window, start, driven),
                    false => SteppedWindow::new(&shooting, theta, window)?
                        .compute_responses(start, driven, at.level),
                }
            };
            part.iter().map(|number| one(*number)).collect()
        })
        .collect();
    Some(parts.into_iter().flatten().collect())
}

/// Returns the operating points of the equations at each sample of each window.
pub fn compute_operating_points(
    of: Linearisation<'_>,
    equations: &EquationSet,
) -> Vec<Vec<Vec<OperatingPoint>>> {
    let Linearisation {
        point: at,
        problem,
        fit,
    } = of;
    let shooting = fit.training_shooting(problem);
    let Ok(mut simulation) = fit
        .model
        .create_simulation(&shooting.parameter_values(&at.estimate.theta))
    else {
        return Vec::new();
    };
    let mut evaluator = equations.create_evaluator();
    let windows = at.windows.iter().map(|id| {
        let window = &problem.train.windows[*id];
        let times = &window.times[..count_samples(window, at.fraction)];
        let inputs = problem.train.inputs(window);
        let states = simulation.simulate_states(&at.estimate.initial_states[*id], times, inputs);
        let samples = times.iter().zip(states.unwrap_or_default());
        let samples = samples.map(|(t, state)| {
            let mut operating_points = Vec::new();
            let point = Point {
                t: *t,
                state: &state,
                inputs: &inputs.evaluate(*t),
            };
            evaluator.append_operating_points(point, &mut operating_points);
            for operating_point in &mut operating_points {
                operating_point.time = t - times[0];
            }
            operating_points
        });
        samples.collect()
    });
    windows.collect()
}
