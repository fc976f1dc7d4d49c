//! What forces of given shapes do to the windows' outputs, to first order: neighbouring motions
//! that they drive. Where the model is marched these come along with the march; otherwise a
//! motion with a small force is integrated beside the one without. What is made of them is
//! decided elsewhere.

use codegen::program::evaluator::Point;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::fit::full::Fit;
use crate::fit::sensitivity::Crew;
use crate::fit::shooting::{Shooting, samples_in};
use crate::model::problem::Setting;
use crate::residual_force::equations::{Asked, Equations, Standing};
use crate::residual_force::finite_difference_response::Stepped;
use crate::search::response::At;
use sim::exponential::Drives;

/// Weights of shapes in the equations: where each equation stands, and a weight per column.
pub type Weights<'w> = dyn Fn(&[Standing], &[f64], &mut [f64]) + Sync + 'w;

/// Columns: the equation that each works in, and how their weights are found from where the
/// equations stand and from the inputs.
pub struct Columns<'w> {
    /// The equation of each.
    pub equations: Vec<usize>,
    /// Fills a weight per column.
    pub weights: &'w Weights<'w>,
}

/// Forces of these shapes as drives of neighbouring motions.
struct Pushes<'c> {
    asked: Asked,
    columns: &'c Columns<'c>,
    begin: f64,
    standings: Vec<Standing>,
    accelerations: Vec<f64>,
    weights: Vec<f64>,
}

impl<'c> Pushes<'c> {
    fn new(equations: &Equations, columns: &'c Columns<'c>, begin: f64) -> Self {
        Self {
            asked: equations.asked(),
            weights: vec![0.0; columns.equations.len()],
            columns,
            begin,
            standings: Vec::new(),
            accelerations: Vec::new(),
        }
    }
}

impl Drives for Pushes<'_> {
    fn at(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]) {
        let point = Point { t, state, inputs };
        self.asked.standings(point, &mut self.standings);
        self.asked.accelerations(point, &mut self.accelerations);
        for standing in &mut self.standings {
            standing.time = t - self.begin;
        }
        (self.columns.weights)(&self.standings, inputs, &mut self.weights);
        let half = state.len() / 2;
        let slots = out.chunks_exact_mut(half.max(1));
        for (slots, (equation, weight)) in
            slots.zip(self.columns.equations.iter().zip(&self.weights))
        {
            let own = &self.accelerations[equation * half..(equation + 1) * half];
            let pairs = slots.iter_mut().zip(own);
            pairs.for_each(|(slot, acceleration)| *slot = weight * acceleration);
        }
    }
}

/// For each window that is looked at a column per shape, in noises per unit of force; no columns
/// where the fit has no motion. None if neighbouring motions cannot be followed at all.
pub fn pushed(
    (at, setting, fit): (&At, &Setting<'_>, &Fit),
    equations: &Equations,
    columns: &Columns<'_>,
) -> Option<Vec<DMatrix<f64>>> {
    let whole = setting.shooting(&fit.plant, &setting.train, &fit.unknowns, &fit.ranges);
    let shooting = Shooting {
        part: at.part,
        ..whole
    };
    let theta = &at.estimate.theta;
    let is_marched = fit.plant.at(&shooting.values(theta)).ok()?.is_marched();
    if !is_marched && fit.plant.steps.is_none() {
        return None;
    }
    let count = columns.equations.len();
    let size = at
        .places
        .len()
        .div_ceil(rayon::current_num_threads().max(1));
    let parts: Vec<Vec<DMatrix<f64>>> = (0..at.places.len())
        .collect::<Vec<_>>()
        .par_chunks(size.max(1))
        .map(|part| {
            let mut crew = Crew::frozen(&shooting, theta, 1.0);
            let mut pushes = Pushes::new(equations, columns, 0.0);
            let mut one = |window: usize| {
                at.base[window].as_ref()?;
                let place = at.places[window];
                let start = &at.estimate.starts[place];
                pushes.begin = setting.train.list[place].times[0];
                match is_marched {
                    true => crew.as_mut()?.driven(place, start, (count, &mut pushes)),
                    false => Stepped::new(&shooting, theta, place)?.columns(
                        start,
                        (count, &mut pushes),
                        at.level,
                    ),
                }
            };
            let none = || DMatrix::zeros(0, 0);
            part.iter()
                .map(|window| one(*window).unwrap_or_else(none))
                .collect()
        })
        .collect();
    Some(parts.into_iter().flatten().collect())
}

/// Where the equations stand along the windows' motions, at every sample.
pub fn stood(
    (at, setting, fit): (&At, &Setting<'_>, &Fit),
    equations: &Equations,
) -> Vec<Vec<Vec<Standing>>> {
    let shooting = setting.shooting(&fit.plant, &setting.train, &fit.unknowns, &fit.ranges);
    let Ok(mut runner) = fit.plant.at(&shooting.values(&at.estimate.theta)) else {
        return Vec::new();
    };
    let mut asked = equations.asked();
    let windows = at.places.iter().map(|place| {
        let window = &setting.train.list[*place];
        let times = &window.times[..samples_in(window, at.part)];
        let inputs = setting.train.inputs(window);
        let states = runner.states(&at.estimate.starts[*place], times, inputs);
        let samples = times.iter().zip(states.unwrap_or_default());
        let samples = samples.map(|(t, state)| {
            let mut standings = Vec::new();
            let point = Point {
                t: *t,
                state: &state,
                inputs: inputs.at(*t),
            };
            asked.standings(point, &mut standings);
            for standing in &mut standings {
                standing.time = t - times[0];
            }
            standings
        });
        samples.collect()
    });
    windows.collect()
}
