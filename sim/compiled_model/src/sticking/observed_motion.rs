//! Observables and rates of a motion with sticking. During sticking they use the friction force that holds the motion,
//! not the force for sign(0) = 0.

use std::ops::Range;

use eomgen_codegen::independence::vectors::find_max_magnitude;
use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, Point, Stretch};
use eomgen_sim::friction_discs::DiscArrival;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;
use eomgen_sim::sliding_modes::Arrival;

use super::SidedModel;
use super::discs::{norm, unit_vector};

/// Largest distance of a state on a surface, relative to the largest value of the function in the motion.
const MAX_DISTANCE_FRACTION: f64 = 1e-10;

/// Additional distance, relative to the effect of the surface's own force over the time of the motion.
const MAX_FORCE_DISTANCE_FRACTION: f64 = 1e-11;

pub(crate) struct ObservedMotion {
    own: Evaluator,
    rest: Option<StickingMotion>,
}

impl ObservedMotion {
    /// Combines an evaluator with the model with sides, if surfaces can hold the motion.
    pub fn new(
        own: Evaluator,
        sided: Option<SidedModel>,
        trajectory: &Trajectory,
        inputs: &HeldInputs,
    ) -> Self {
        let motion = (&trajectory.times[..], &trajectory.states[..]);
        Self {
            own,
            rest: sided.map(|sided| StickingMotion::new(sided, motion, inputs)),
        }
    }

    /// Adds a point at the end of the motion.
    pub fn extend(&mut self, point: Point<'_>) {
        if let Some(rest) = &mut self.rest {
            rest.extend(point);
        }
    }

    /// Writes the observables at a point of the motion.
    pub fn observables(&mut self, point: Point<'_>, out: &mut [f64]) {
        let rest = self.rest.as_mut();
        if !rest.is_some_and(|rest| rest.write_observables(point, out)) {
            self.own.observables(point, out);
        }
    }

    /// Writes the bounds of the observables over a stretch of the motion during which no surface holds it.
    pub fn bound_observables(&mut self, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        self.own.bound_observables(stretch, out);
    }

    /// Returns the number of coordinates and modes.
    pub fn degrees_of_freedom(&self) -> usize {
        self.own.program().degrees_of_freedom()
    }

    /// Writes the rates at a point of the motion.
    pub fn rates(&mut self, point: Point<'_>, out: &mut [f64]) {
        let rest = self.rest.as_mut();
        if !rest.is_some_and(|rest| rest.write_rates(point, out)) {
            self.own.rates(point, out);
        }
    }
}

/// Forces and rates during sticking, along a motion.
pub struct StickingMotion {
    sided: SidedModel,
    /// Largest magnitude of each function, coordinate and rate.
    sizes: Vec<f64>,
    state_sizes: [f64; 2],
    /// First and last time, s.
    span: Option<(f64, f64)>,
}

impl StickingMotion {
    /// Prepares a motion with the given times (s) and states.
    pub fn new(
        sided: SidedModel,
        (times, states): (&[f64], &[Vec<f64>]),
        inputs: &HeldInputs,
    ) -> Self {
        let mut motion = Self {
            sizes: vec![0.0_f64; sided.side_count()],
            state_sizes: [0.0; 2],
            span: None,
            sided,
        };
        for (&t, state) in times.iter().zip(states) {
            let inputs = &inputs.evaluate(t);
            motion.extend(Point { t, state, inputs });
        }
        motion
    }

    /// Adds a point at the end of the motion.
    pub fn extend(&mut self, Point { t, state, inputs }: Point<'_>) {
        let functions = self.sided.evaluate_functions((t, state), inputs);
        for (size, value) in self.sizes.iter_mut().zip(functions) {
            *size = size.max(value.abs());
        }
        let degrees = self.sided.degrees_of_freedom();
        let (coordinates, rates) = state[..2 * degrees].split_at(degrees);
        for (size, entries) in self.state_sizes.iter_mut().zip([coordinates, rates]) {
            *size = size.max(find_max_magnitude(entries));
        }
        let (begin, _) = self.span.unwrap_or((t, t));
        self.span = Some((begin, t));
    }

    /// If surfaces hold the motion at a point, writes its rates and returns true.
    pub fn write_rates(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let is_held = self.find_holding_sides(point);
        if is_held {
            let Point { t, state, inputs } = point;
            self.sided.write_rates((t, state), inputs, out);
        }
        is_held
    }

    /// If surfaces hold the motion at a point, writes its observables and returns true.
    pub fn write_observables(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let is_held = self.find_holding_sides(point);
        if is_held {
            self.sided.write_observables((point.t, point.state), out);
        }
        is_held
    }

    /// Returns the model with sides, for use with another motion.
    pub fn into_sided_model(self) -> SidedModel {
        self.sided
    }

    fn find_holding_sides(&mut self, Point { t, state, inputs }: Point<'_>) -> bool {
        let reach: Vec<f64> = self
            .sizes
            .iter()
            .map(|size| MAX_DISTANCE_FRACTION * size)
            .collect();
        let roundings = self.state_sizes.map(|size| MAX_DISTANCE_FRACTION * size);
        self.sided.set_model_inputs(inputs);
        self.sided.close_resting_contacts((t, state), roundings);
        let duration = self.span.map_or(0.0, |(begin, end)| end - begin);
        set_holding_sides(&mut self.sided, (t, state), inputs, (&reach, duration))
    }
}

/// Computes the sides that hold a motion at a state. Returns false if the state is on no surface.
fn set_holding_sides(
    sided: &mut SidedModel,
    at: (f64, &[f64]),
    inputs: &[f64],
    (reach, duration): (&[f64], f64),
) -> bool {
    let functions = sided.evaluate_functions(at, inputs);
    let mut sides: Vec<f64> = (0..sided.surface_count())
        .map(|surface| sided.side_at_value(surface, functions[surface]))
        .collect();
    for rows in sided.discs() {
        sides.extend(unit_vector(&functions[rows.clone()], None));
    }
    sided.set_sides(at, inputs, &sides);
    let reach: Vec<f64> = (0..functions.len())
        .map(|row| {
            let by_force = MAX_FORCE_DISTANCE_FRACTION * sided.own_force_rate(row) * duration;
            reach[row] + by_force
        })
        .collect();
    let touching: Vec<usize> = (0..sided.surface_count())
        .filter(|surface| functions[*surface].abs() <= reach[*surface])
        .collect();
    let is_near =
        |rows: &&Range<usize>| norm(&functions[(*rows).clone()]) <= norm(&reach[(*rows).clone()]);
    let (stopped, touching): (Vec<usize>, Vec<usize>) =
        (touching.into_iter()).partition(|surface| sided.is_stopped_by_contacts(*surface));
    for surface in &stopped {
        sides[*surface] = 0.5;
    }
    let discs = sided.discs().iter().filter(is_near);
    let discs: Vec<DiscArrival> = discs
        .map(|rows| DiscArrival {
            rows: rows.clone(),
            along: unit_vector(&functions[rows.clone()], None),
            exceeds_limit: false,
        })
        .collect();
    if touching.is_empty() && discs.is_empty() {
        if !stopped.is_empty() {
            sided.find_holding_sides(at, inputs, &sides, &[]);
        }
        return !stopped.is_empty();
    }
    let arrival = |surface: &usize| Arrival {
        side: if functions[*surface] < 0.0 { -1.0 } else { 1.0 },
        exceeds_limit: false,
    };
    let arrivals: Vec<Arrival> = touching.iter().map(arrival).collect();
    let Some((verdicts, vectors)) =
        sided.decide(at, inputs, (&touching, &arrivals, &discs), &sides)
    else {
        return false;
    };
    for (surface, verdict) in touching.iter().zip(verdicts) {
        sides[*surface] = 0.5 + 0.5 * verdict.sign();
    }
    for (disc, verdict) in discs.iter().zip(vectors) {
        for (row, s) in disc.rows.clone().zip(verdict.vector()) {
            sides[row] = *s;
        }
    }
    sided.find_holding_sides(at, inputs, &sides, &[]);
    true
}
