//! Slopes of a step of the method in `tableau`, its error estimate and its dense output.

use super::magnitudes::Magnitudes;
use super::point::Point;
use super::system::System;
use super::tableau::{
    END_SLOPE, ERROR_3, ERROR_5, EXTENSION, INCREMENTS, NODES, SLOPES, STAGES, Terms,
};
use super::watch::WatchedSystem;

/// Weight of the error estimate of order 3 in the error estimate of the step.
const WEIGHT_OF_ORDER_3: f64 = 0.1;

/// Number of entries that are summed at once in registers.
const LANES: usize = 4;

/// Rates of [`LANES`] states at the nodes of a step.
type Group = [[f64; LANES]; SLOPES];

/// Rates of a step at its nodes, with reused memory.
pub struct Slopes {
    groups: Vec<Group>,
    /// Last evaluated rates.
    rates: Vec<f64>,
    trial: Vec<f64>,
    sums: [Vec<f64>; 2],
    interior: Interior,
}

impl Slopes {
    /// Allocates memory for this number of states.
    pub fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        Self {
            groups: vec![[[0.0; LANES]; SLOPES]; states.div_ceil(LANES)],
            rates: zeros(),
            trial: zeros(),
            sums: [zeros(), zeros()],
            interior: Interior {
                coefficients: std::array::from_fn(|_| zeros()),
            },
        }
    }

    /// Evaluates the slope at the start of a step.
    pub fn begin<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>, start: &Point) {
        watched.rates(start.t, &start.y, &mut self.rates);
        self.store(0);
    }

    /// Uses the slope at the end of the last step as the slope at the start of the next.
    pub fn follow(&mut self) {
        for group in &mut self.groups {
            group[0] = group[END_SLOPE];
        }
    }

    /// Makes a step of `length` s from `start`, where the slope is known, and writes its end state to `end`.
    /// Returns false if a state or a rate is not finite.
    pub fn make_step<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
        end: &mut Vec<f64>,
    ) -> bool {
        for stage in 1..STAGES {
            if !self.evaluate(watched, start, length, stage) {
                return false;
            }
        }
        self.write_state(start, length, END_SLOPE);
        end.clone_from(&self.trial);
        is_finite(end)
    }

    /// Returns the end state of a step of `length` s from `start`; `None` if a state or a rate is not finite.
    pub fn step_from<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
    ) -> Option<Vec<f64>> {
        self.begin(watched, start);
        let mut end = Vec::new();
        self.make_step(watched, start, length, &mut end)
            .then_some(end)
    }

    /// Evaluates the slope at the end of a step, and returns it.
    pub fn end<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        end: &Point,
    ) -> &[f64] {
        watched.rates(end.t, &end.y, &mut self.rates);
        self.store(END_SLOPE);
        &self.rates
    }

    /// Stores the last evaluated rates as the slope at a node.
    fn store(&mut self, slope: usize) {
        let parts = self.rates.chunks(LANES);
        for (group, part) in self.groups.iter_mut().zip(parts) {
            match part.try_into() {
                Ok(whole) => group[slope] = whole,
                Err(_) => group[slope][..part.len()].copy_from_slice(part),
            }
        }
    }

    /// Returns the estimated error of a step of `length` s to the state `end`, as a multiple of the tolerance.
    pub fn error(&mut self, magnitudes: &Magnitudes, length: f64, end: &[f64]) -> f64 {
        let [order_5, order_3] = &mut self.sums;
        combine(&self.groups, ERROR_5, order_5);
        combine(&self.groups, ERROR_3, order_3);
        let fifth = magnitudes.max_norm(order_5, end);
        let third = WEIGHT_OF_ORDER_3 * magnitudes.max_norm(order_3, end);
        let size = fifth.hypot(third);
        match size > 0.0 {
            true => length * fifth * (fifth / size),
            false => size,
        }
    }

    /// Computes the dense output of the last step, of `length` s from `start` to `end`. The slope at the end
    /// must be known.
    pub fn compute_dense_output<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
        (start, end): (&Point, &Point),
    ) {
        for stage in END_SLOPE + 1..SLOPES {
            self.evaluate(watched, start, length, stage);
        }
        let coefficients = &mut self.interior.coefficients;
        for index in 0..start.y.len() {
            let moved = end.y[index] - start.y[index];
            let group = &self.groups[index / LANES];
            let [first, last] = [0, END_SLOPE].map(|slope| length * group[slope][index % LANES]);
            coefficients[0][index] = moved;
            coefficients[1][index] = first - moved;
            coefficients[2][index] = 2.0 * moved - (first + last);
        }
        for (terms, out) in EXTENSION.into_iter().zip(&mut coefficients[3..]) {
            combine(&self.groups, terms, out);
            out.iter_mut().for_each(|entry| *entry *= length);
        }
    }

    /// Returns the last computed dense output.
    pub fn interior(&self) -> &Interior {
        &self.interior
    }

    /// Evaluates the slope at a node. Returns true if it is finite.
    fn evaluate<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
        stage: usize,
    ) -> bool {
        self.write_state(start, length, stage);
        let t = start.t + NODES[stage] * length;
        let is_finite = watched.rates(t, &self.trial, &mut self.rates);
        self.store(stage);
        is_finite
    }

    /// Writes the state at a node to `trial`.
    fn write_state(&mut self, start: &Point, length: f64, stage: usize) {
        combine(&self.groups, INCREMENTS[stage], &mut self.trial);
        for (entry, start) in self.trial.iter_mut().zip(&start.y) {
            *entry = start + length * *entry;
        }
    }
}

/// Dense output of a step: coefficients of its polynomial.
#[derive(Clone)]
pub struct Interior {
    coefficients: [Vec<f64>; 7],
}

impl Interior {
    /// Returns the coefficients of the nested form, relative to the start.
    pub fn coefficients(&self) -> &[Vec<f64>; 7] {
        &self.coefficients
    }

    /// Returns the largest contribution of the last coefficient to each state.
    pub fn last_term(&self) -> Vec<f64> {
        // The maximum of s^4 (1 - s)^3 is at s = 4/7.
        let largest = (4.0_f64 / 7.0).powi(4) * (3.0_f64 / 7.0).powi(3);
        self.coefficients[6].iter().map(|c| largest * c).collect()
    }

    /// Returns the state at a fraction `part` of the step from `start`.
    pub fn interpolate(&self, part: f64, start: &[f64]) -> Vec<f64> {
        let rest = 1.0 - part;
        let entry = |(index, start): (usize, &f64)| {
            let mut value = 0.0;
            for (power, coefficients) in self.coefficients.iter().enumerate().rev() {
                let factor = if power % 2 == 0 { part } else { rest };
                value = factor * (value + coefficients[index]);
            }
            start + value
        };
        start.iter().enumerate().map(entry).collect()
    }
}

/// Writes a linear combination of slopes to `out`.
fn combine(groups: &[Group], terms: Terms, out: &mut [f64]) {
    for (slots, group) in out.chunks_mut(LANES).zip(groups) {
        let mut sums = [0.0; LANES];
        for (slope, coefficient) in terms {
            for (sum, rate) in sums.iter_mut().zip(&group[*slope % SLOPES]) {
                *sum += coefficient * rate;
            }
        }
        match slots.len() {
            LANES => slots.copy_from_slice(&sums),
            part => slots.copy_from_slice(&sums[..part]),
        }
    }
}

fn is_finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}
