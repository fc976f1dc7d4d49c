//! Backward pass over events, by transposed saltation matrices.

use std::ops::Range;

use eomgen_sim::ode::SurfaceMode;

use super::derivatives::Derivatives;
use super::pull_back::{BackwardPass, add, add_product, no_gradient};
use super::recorder::{Part, PartKind};
use crate::error::Error;

/// Largest relative difference of the event delays of two guards that count as the same surface.
const MAX_DELAY_DIFFERENCE_FRACTION: f64 = 1e-6;

/// Largest relative difference between the jump of a motion and the jump by a single impact.
const MAX_JUMP_DIFFERENCE_FRACTION: f64 = 1e-6;

impl BackwardPass<'_, '_> {
    /// Propagates the adjoint backwards over an event, by the transposed saltation matrix.
    pub fn propagate_over_event(&mut self, place: usize) -> Result<(), Error> {
        let recorded = self.recorded;
        let part = self.part(place);
        let after = recorded.recording.modes_after(place);
        let (near, beyond) = (&part.start, &part.end);
        let at = (near.0, &near.1[..]);
        let given = recorded.inputs().evaluate(self.clip(part, near.0));
        let (mut from, mut to) = (vec![0.0; near.1.len()], vec![0.0; near.1.len()]);
        self.evaluator.set_modes(after);
        self.evaluator
            .write_rates((beyond.0, &beyond.1), &given, &mut to)?;
        self.evaluator.set_modes(&part.modes);
        self.evaluator.write_rates(at, &given, &mut from)?;
        let impact = match part.kind {
            PartKind::Jump => Some(self.find_impact(part, &given)?),
            PartKind::Step | PartKind::Crossing => None,
        };
        if impact.is_none() && self.is_kink(&from, &to) {
            return Ok(());
        }
        let delay = match impact {
            Some(impact) => {
                let surface = self.evaluator.surface_of(impact);
                self.differentiate_delay(part, &given, surface)?
            }
            None => self.find_delay(part, after, &given)?,
        };
        // Change of L if the event is delayed by 1 s: the motion before the event continues, and the motion after it
        // loses this time.
        let mut by_delay = -scalar_product(&self.adjoint, &to);
        let row = recorded.inputs().last_sample_index(near.0);
        if let Some(impact) = impact {
            let degrees = self.rate_indices();
            let weights = self.adjoint[degrees.clone()].to_vec();
            let (jump, by_time) = self
                .evaluator
                .pull_back_jump(at, &given, (impact, &weights))?;
            add(&mut self.adjoint, &jump.state);
            add(&mut self.parameters, &jump.parameters);
            add(&mut self.inputs[row], &jump.inputs);
            by_delay += by_time;
        }
        by_delay += scalar_product(&self.adjoint, &from);
        for (sums, parts) in [
            (&mut self.adjoint, &delay.state),
            (&mut self.parameters, &delay.parameters),
            (&mut self.inputs[row], &delay.inputs),
        ] {
            add_product(sums, by_delay, parts);
        }
        Ok(())
    }

    /// Returns the indices of the rates of the degrees of freedom in the state.
    pub fn rate_indices(&self) -> Range<usize> {
        let degrees = self
            .recorded
            .instance
            .model()
            .program()
            .degrees_of_freedom();
        degrees..2 * degrees
    }

    /// Returns the index of the impact whose jump equals the jump of the rates.
    fn find_impact(&mut self, part: &Part, given: &[f64]) -> Result<usize, Error> {
        let degrees = self.rate_indices();
        let at = (part.start.0, &part.start.1[..]);
        let jumps = self.evaluator.compute_impact_jumps(at, given)?;
        let pairs = part.end.1[degrees.clone()]
            .iter()
            .zip(&part.start.1[degrees]);
        let change: Vec<f64> = pairs.map(|(after, before)| after - before).collect();
        let is_own = |jump: &Vec<f64>| {
            let largest = jump.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
            let allowed = MAX_JUMP_DIFFERENCE_FRACTION * largest;
            let mut pairs = jump.iter().zip(&change);
            pairs.all(|(jump, change)| (jump - change).abs() <= allowed)
        };
        let own = jumps.iter().position(is_own);
        own.ok_or_else(|| no_gradient(part.start.0, "several impacts act at once"))
    }

    /// Returns the derivatives of the time of an event without an impact.
    fn find_delay(
        &mut self,
        part: &Part,
        after: &[SurfaceMode],
        given: &[f64],
    ) -> Result<Derivatives, Error> {
        let t = part.start.0;
        let mut delay: Option<Derivatives> = None;
        let modes = part.modes.iter().zip(after).enumerate();
        for (surface, (mode, _)) in modes.filter(|(_, (mode, after))| mode != after) {
            if *mode == SurfaceMode::Held {
                let cause = format!(
                    "the rates jump at the breakaway from the surface `{}` = 0",
                    self.formula(surface)
                );
                return Err(no_gradient(t, &cause));
            }
            let own = self.differentiate_delay(part, given, surface)?;
            match &delay {
                None => delay = Some(own),
                Some(first) if are_equal(first, &own) => {}
                Some(_) => {
                    return Err(no_gradient(
                        t,
                        "the motion crosses several switching surfaces at once",
                    ));
                }
            }
        }
        delay.ok_or_else(|| {
            no_gradient(
                t,
                "the rates jump, but no switching surface changes its state",
            )
        })
    }

    /// Returns the derivatives of the time at which the motion reaches a surface.
    fn differentiate_delay(
        &mut self,
        part: &Part,
        given: &[f64],
        surface: usize,
    ) -> Result<Derivatives, Error> {
        let at = (part.start.0, &part.start.1[..]);
        let count = self.evaluator.surface_count();
        let (mut values, mut rates) = (vec![0.0; count], vec![0.0; count]);
        self.evaluator
            .write_surfaces(at, given, (&mut values, &mut rates))?;
        let (rate, fastest) = (rates[surface], self.surface_sizes[surface].1);
        if rate.abs() <= self.recorded.tolerance.sqrt() * fastest {
            return Err(self.touches(at.0, surface));
        }
        let mut delay = self.evaluator.differentiate_surface(at, given, surface)?;
        for part in [&mut delay.state, &mut delay.inputs, &mut delay.parameters] {
            part.iter_mut().for_each(|entry| *entry /= -rate);
        }
        Ok(delay)
    }
}

fn scalar_product(left: &[f64], right: &[f64]) -> f64 {
    left.iter()
        .zip(right)
        .map(|(left, right)| left * right)
        .sum()
}

fn are_equal(first: &Derivatives, second: &Derivatives) -> bool {
    let pairs = [
        (&first.state, &second.state),
        (&first.inputs, &second.inputs),
        (&first.parameters, &second.parameters),
    ];
    pairs.iter().all(|(first, second)| {
        first.iter().zip(*second).all(|(first, second)| {
            (first - second).abs() <= MAX_DELAY_DIFFERENCE_FRACTION * first.abs()
        })
    })
}
