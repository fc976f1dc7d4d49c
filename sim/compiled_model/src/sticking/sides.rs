//! Sides at a point of the motion, and corrections of states onto surfaces that hold it.

use crate::contacts::HeldDirection;

use super::discs::{Disc, DiscState};
use super::sided_model::CORRECTION_COUNT;
use super::surface_state::SurfaceState;
use super::surface_states::{
    KnownSides, MAX_DRIFT_FRACTION, MAX_FORCE_DRIFT_FRACTION, SurfaceStates,
};

impl SurfaceStates {
    /// Returns the sides of all surfaces at a point: 0.5 for surfaces and 0 for disc components that hold the motion.
    /// Functions are evaluated only if needed.
    pub(super) fn find_current_sides(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<f64> {
        let kept = self.kept.clone().unwrap_or_default();
        let mut functions = Vec::new();
        let mut sides = Vec::with_capacity(self.places.len());
        for (surface, place) in self.places.iter().enumerate() {
            let kept = kept.get(surface).filter(|side| **side != 0.0);
            let moved = match (*place, kept) {
                (SurfaceState::Holding { .. } | SurfaceState::Unloaded { .. }, _) => {
                    sides.push(0.5);
                    continue;
                }
                (SurfaceState::Bearing { side, .. }, _)
                | (SurfaceState::Leaving { side, .. }, Some(_)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (SurfaceState::Free, Some(side)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (SurfaceState::Free | SurfaceState::Leaving { .. }, None) => place.displacement(),
            };
            if functions.is_empty() {
                functions = self.sided.evaluate_functions(at, inputs);
            }
            sides.push(
                self.sided
                    .side_at_value(surface, functions[surface] + moved),
            );
        }
        self.append_disc_sides(at, inputs, &mut sides);
        sides
    }

    /// Appends the sides of the components of discs at a point.
    pub(super) fn append_disc_sides(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
        sides: &mut Vec<f64>,
    ) {
        let functions = match self.discs.iter().all(Disc::is_holding) {
            true => Vec::new(),
            false => self.sided.evaluate_functions(at, inputs),
        };
        for disc in &self.discs {
            disc.write_sides(&functions, self.kept.is_some(), sides);
        }
    }

    /// Returns the surfaces that hold the motion, followed by the rows of the discs that do.
    pub(super) fn list_holding_rows(&self) -> Vec<usize> {
        let holds = |surface: &usize| matches!(self.places[*surface], SurfaceState::Holding { .. });
        let discs = self.discs.iter().filter(|disc| disc.is_holding());
        let surfaces = (0..self.places.len()).filter(holds);
        surfaces
            .chain(discs.flat_map(|disc| disc.rows.clone()))
            .collect()
    }

    /// Returns the directions in which surfaces hold the motion, from the last evaluation.
    pub fn list_held_directions(&self) -> Vec<HeldDirection> {
        let degrees = self.sided.degrees_of_freedom();
        let rows = self.list_holding_rows().into_iter();
        let direction = |row: usize| {
            let by_force = self.sided.own_force_rate(row);
            let values = self.sided.at.get(row).filter(|_| by_force > 0.0)?;
            Some(HeldDirection {
                column: values.column[..degrees].to_vec(),
                since: self.held_since(row)?,
                roundings: [
                    MAX_DRIFT_FRACTION * self.sizes[row] / by_force,
                    MAX_FORCE_DRIFT_FRACTION,
                ],
            })
        };
        rows.filter_map(direction).collect()
    }

    /// Returns the time (s) at which the surface or disc of a row began to hold the motion.
    fn held_since(&self, row: usize) -> Option<f64> {
        if let Some(place) = self.places.get(row) {
            return match place {
                SurfaceState::Holding { since, .. } => Some(*since),
                _ => None,
            };
        }
        let disc = self.discs.iter().find(|disc| disc.rows.contains(&row))?;
        match disc.state {
            DiscState::Holding { since } => Some(since),
            _ => None,
        }
    }

    /// Computes the sides that hold the motion at a point.
    pub(super) fn find_holding_sides(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        match &self.known {
            KnownSides::Everywhere => {
                self.sided.set_model_inputs(inputs);
                return;
            }
            KnownSides::At(known, at) if *known == t && at == state => return,
            KnownSides::At(..) | KnownSides::Nothing => {}
        }
        let (sides, held) = (
            self.find_current_sides((t, state), inputs),
            self.list_holding_rows(),
        );
        self.sided
            .find_holding_sides((t, state), inputs, &sides, &held);
        if self.are_sides_fixed() {
            self.known = KnownSides::Everywhere;
            return;
        }
        match &mut self.known {
            KnownSides::At(known, at) => {
                *known = t;
                at.copy_from_slice(state);
            }
            known => *known = KnownSides::At(t, state.to_vec()),
        }
    }

    /// Returns true if no side depends on the state.
    fn are_sides_fixed(&self) -> bool {
        let is_fixed = |side: &f64| *side != 0.0;
        let kept = self.kept.as_ref();
        self.discs.is_empty()
            && self.places.iter().all(|place| *place == SurfaceState::Free)
            && kept.is_some_and(|kept| kept.iter().all(is_fixed))
            && self.sided.are_other_sides_fixed()
    }

    /// Corrects a state onto the surfaces that hold it, if it has drifted or if `always` is true.
    pub(super) fn correct_onto_surfaces(
        &mut self,
        (t, state): (f64, &mut [f64]),
        inputs: &[f64],
        always: bool,
    ) -> u64 {
        let held = self.list_holding_rows();
        if held.is_empty() {
            return 0;
        }
        let values = self.sided.evaluate_functions((t, state), inputs);
        let has_strayed = |surface: &usize| {
            let Some(since) = self.held_since(*surface) else {
                return false;
            };
            let by_force = self.sided.own_force_rate(*surface) * (t - since).abs();
            let allowed =
                MAX_DRIFT_FRACTION * self.sizes[*surface] + MAX_FORCE_DRIFT_FRACTION * by_force;
            values[*surface].abs() > allowed
        };
        if !always && !held.iter().any(has_strayed) {
            return 0;
        }
        self.find_holding_sides((t, state), inputs);
        self.known = KnownSides::Nothing;
        for _ in 0..CORRECTION_COUNT {
            let values = self.sided.evaluate_functions((t, state), inputs);
            self.sided.move_onto_surfaces(t, state, (&held, &values));
        }
        CORRECTION_COUNT as u64
    }
}
