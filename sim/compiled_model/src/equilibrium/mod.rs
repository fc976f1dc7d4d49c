//! Equilibria: states that stay as they are, at rest or turning and travelling steadily.
//!
//! At an equilibrium all accelerations and all rates of states of first order are 0. Rates of coordinates
//! are 0 too, but along [cyclic directions](Instance::cyclic_directions), where a constant speed changes
//! nothing. The search keeps the speeds that the start has; if there is no equilibrium with them, it looks
//! for the speeds as well. How it finds one is the business of `search` and `linear`.

mod linear;
mod search;
mod stability;
#[cfg(test)]
mod tests;

use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};

use self::search::{Search, Unknown};

pub use self::stability::Stability;

/// A state is no equilibrium if a rate is this large beside the terms it is the sum of.
const NOT_ZERO: f64 = 1e-6;

/// Speeds agree with a cyclic direction if they differ by no more than this part of the largest of their kind.
const SAME_SPEED: f64 = 1e-9;

/// A state that stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Where it is.
    pub at: OperatingPoint,
    /// The accelerations, and then the rates of states of first order, that are left of rounding,
    /// SI, in the order of the coordinates and of the states.
    pub residual: Vec<f64>,
    /// The names of the rates that are not 0: where it runs steadily.
    pub running: Vec<String>,
    /// The names of the coordinates, rates, inputs and states of first order that were looked for.
    pub free: Vec<String>,
    /// Whether forces depend on the time there: then it is one at that instant alone.
    pub depends_on_time: bool,
}

/// Changes of a state that is no equilibrium, by name; empty at an equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Departure {
    /// Rates that are not 0, except constant speeds along cyclic directions.
    pub moving: Vec<String>,
    /// Rates whose accelerations are not 0 compared with their terms.
    pub accelerating: Vec<String>,
    /// States of first order whose rates are not 0 compared with their terms.
    pub changing: Vec<String>,
}

impl Departure {
    /// Returns true at an equilibrium.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Where the search begins and what it leaves alone, SI.
#[derive(Clone, Copy, Debug, Default)]
pub struct EquilibriumRequest<'r> {
    /// Values in place of those of the initial state, where the search begins.
    pub start: &'r [(&'r str, f64)],
    /// Values that stay.
    pub fixed: &'r [(&'r str, f64)],
}

impl Instance<'_> {
    /// The equilibrium nearest to the start. Coordinates and states of first order are free but for those
    /// that are fixed. Inputs are 0 or as given; if coordinates, speeds or such states are fixed, the inputs
    /// that are not are free: they hold the machine there.
    ///
    /// # Errors
    /// An unknown name; a rate other than 0 of a coordinate whose value matters; a start outside a declared
    /// range; and [`Error::Stopped`] where no equilibrium is found.
    pub fn equilibrium(&self, request: EquilibriumRequest<'_>) -> Result<Equilibrium, Error> {
        let given = [request.start, request.fixed].concat();
        let mut at = self.operating_point(&given)?;
        self.check_ranges(&at)?;
        // With residuals among the accelerations, where these are zero the constraints hold.
        let holding = self.stabilised(1.0);
        let directions = match self.is_at_rest(&at) {
            true => Vec::new(),
            false => holding.cyclic_directions(&at)?,
        };
        self.check_speeds(&at, &given, &directions)?;
        self.move_along(&mut at, &directions);
        let mut search = Search::new(&holding, &directions, self.free(&at, request.fixed)?)?;
        let start = at.clone();
        let first = search.run(&mut at);
        let residual = match first {
            Ok(residual) => residual,
            Err(error) => {
                // No machine with these speeds: it may have others.
                let directions = holding.cyclic_directions(&start)?;
                let speeds = self.free_speeds(&directions, request.fixed)?;
                if speeds.is_empty() {
                    return Err(error);
                }
                at = start;
                let mut free = self.free(&at, request.fixed)?;
                free.retain(|unknown| !is_cyclic(unknown, &directions));
                free.extend(speeds);
                search = Search::new(&holding, &directions, free)?;
                search.run(&mut at).map_err(|_| error)?
            }
        };
        let depends_on_time = search.depends_on_time(&at);
        Ok(Equilibrium {
            running: self.running(&at),
            residual,
            free: search.names(),
            depends_on_time,
            at,
        })
    }

    /// Returns true if a state stays as it is, as [`Instance::departure`] tells.
    ///
    /// # Errors
    /// As [`Instance::jacobian_evaluator`].
    pub fn is_equilibrium(&self, at: &OperatingPoint) -> Result<bool, Error> {
        Ok(self.departure(at)?.is_none())
    }

    /// Returns the rates, accelerations and states of first order that keep a state from being an equilibrium.
    ///
    /// # Errors
    /// As [`Instance::jacobian_evaluator`].
    pub fn departure(&self, at: &OperatingPoint) -> Result<Departure, Error> {
        let holding = self.stabilised(1.0);
        let mut found = Departure::default();
        if !self.is_at_rest(at) {
            let directions = holding.cyclic_directions(at)?;
            let mut along = at.clone();
            self.move_along(&mut along, &directions);
            found.moving = self.other_speeds(at, &along);
        }
        let mut search = Search::new(&holding, &[], self.free(at, &[])?)?;
        let names = self.model().state_names();
        for row in search.linearised(at)?.rows_above(NOT_ZERO) {
            let name = names[self.degrees() + row].clone();
            match row < self.degrees() {
                true => found.accelerating.push(name),
                false => found.changing.push(name),
            }
        }
        Ok(found)
    }

    /// The names of the rates that are not 0.
    fn running(&self, at: &OperatingPoint) -> Vec<String> {
        let rates = self.degrees()..2 * self.degrees();
        let names = self.model().state_names();
        let moving = rates.filter(|place| at.state[*place] != 0.0);
        moving.map(|place| names[place].clone()).collect()
    }

    fn degrees(&self) -> usize {
        self.model().program().degrees_of_freedom()
    }

    fn is_at_rest(&self, at: &OperatingPoint) -> bool {
        let degrees = self.degrees();
        at.state[degrees..2 * degrees]
            .iter()
            .all(|rate| *rate == 0.0)
    }

    /// What is looked for if speeds are given: all coordinates and states of first order that are not fixed,
    /// and inputs that hold those that are.
    fn free(&self, at: &OperatingPoint, fixed: &[(&str, f64)]) -> Result<Vec<Unknown>, Error> {
        let fixed = fixed.iter().map(|(name, _)| self.model().setting(name));
        let fixed = fixed.collect::<Result<Vec<Setting>, Error>>()?;
        let degrees = self.degrees();
        let is_held = fixed
            .iter()
            .any(|setting| matches!(setting, Setting::State(_)));
        let states = (0..degrees)
            .chain(2 * degrees..at.state.len())
            .map(Setting::State);
        let inputs = (0..at.inputs.len()).filter(|_| is_held).map(Setting::Input);
        let free = states
            .chain(inputs)
            .filter(|setting| !fixed.contains(setting));
        Ok(free.map(Unknown::Setting).collect())
    }

    /// The speeds along cyclic directions that nothing fixes.
    fn free_speeds(
        &self,
        directions: &[Vec<f64>],
        fixed: &[(&str, f64)],
    ) -> Result<Vec<Unknown>, Error> {
        let degrees = self.degrees();
        let mut is_fixed = vec![false; degrees];
        for (name, _) in fixed {
            if let Setting::State(place) = self.model().setting(name)?
                && (degrees..2 * degrees).contains(&place)
            {
                is_fixed[place - degrees] = true;
            }
        }
        let moves_fixed = |direction: &Vec<f64>| {
            let mut pairs = direction.iter().zip(&is_fixed);
            pairs.any(|(speed, is_fixed)| *speed != 0.0 && *is_fixed)
        };
        let free = (0..directions.len()).filter(|place| !moves_fixed(&directions[*place]));
        Ok(free.map(Unknown::Speed).collect())
    }

    /// Replaces the rates by those of the nearest motion along cyclic directions.
    fn move_along(&self, at: &mut OperatingPoint, directions: &[Vec<f64>]) {
        let degrees = self.degrees();
        let given = at.state[degrees..2 * degrees].to_vec();
        let rates = &mut at.state[degrees..2 * degrees];
        rates.fill(0.0);
        for direction in directions {
            // Of the coordinates that move along it, those that were given a speed decide.
            let moving = || {
                direction
                    .iter()
                    .zip(&given)
                    .filter(|(part, rate)| **part * **rate != 0.0)
            };
            let count = moving().count().max(1) as f64;
            let speed = moving().map(|(part, rate)| rate / part).sum::<f64>() / count;
            for (rate, part) in rates.iter_mut().zip(direction) {
                *rate += speed * part;
            }
        }
    }

    /// Returns the names of the rates that differ between two states, compared with the largest of their kind.
    fn other_speeds(&self, one: &OperatingPoint, other: &OperatingPoint) -> Vec<String> {
        let model = self.model();
        let (units, names) = (
            model.model().state_units(model.orders()),
            model.state_names(),
        );
        let rates = || self.degrees()..2 * self.degrees();
        let differs = |place: &usize| {
            let alike = rates().filter(|other| units[*other].dimension == units[*place].dimension);
            let largest = alike.fold(0.0, |most: f64, other| most.max(one.state[other].abs()));
            let difference = (one.state[*place] - other.state[*place]).abs();
            difference.is_nan() || difference > SAME_SPEED * largest
        };
        let differing = rates().filter(differs);
        differing.map(|place| names[place].clone()).collect()
    }

    /// Refuses a given rate other than 0 of a coordinate that may not move steadily.
    fn check_speeds(
        &self,
        at: &OperatingPoint,
        given: &[(&str, f64)],
        directions: &[Vec<f64>],
    ) -> Result<(), Error> {
        let degrees = self.degrees();
        for (name, value) in given {
            let Setting::State(place) = self.model().setting(name)? else {
                continue;
            };
            let coordinate = place.wrapping_sub(degrees);
            let moves = |direction: &Vec<f64>| direction[coordinate] != 0.0;
            if (degrees..2 * degrees).contains(&place)
                && at.state[place] != 0.0
                && !directions.iter().any(moves)
            {
                let coordinate = &self.model().state_names()[coordinate];
                return Err(Error::Request(format!(
                    "{name} = {value}: in an equilibrium all rates are 0 but those of coordinates on whose \
                     value nothing depends; forces depend on `{coordinate}`"
                )));
            }
        }
        Ok(())
    }

    /// Refuses coordinates and inputs outside the ranges that the specification declares.
    fn check_ranges(&self, at: &OperatingPoint) -> Result<(), Error> {
        let model = self.model().model();
        let refused = |error| Error::model(model, error);
        let coordinates = model.coordinate_ranges().map_err(refused)?;
        let inputs = model.input_ranges().map_err(refused)?;
        let names = model.coordinates.iter().map(|known| &known.name);
        let names = names.chain(model.inputs.iter().map(|known| &known.name));
        let count = model.coordinates.len();
        let values = at.state[..count].iter().chain(&at.inputs);
        for ((name, range), value) in names.zip(coordinates.iter().chain(&inputs)).zip(values) {
            if let Some((low, high)) = range
                && !(*low..=*high).contains(value)
            {
                return Err(Error::Request(format!(
                    "{name} = {value} is outside its range {low} to {high} (SI): begin inside, or declare a \
                     wider range"
                )));
            }
        }
        Ok(())
    }
}

/// Whether an unknown is a coordinate that a cyclic direction alone moves: it stays where it is.
fn is_cyclic(unknown: &Unknown, directions: &[Vec<f64>]) -> bool {
    let Unknown::Setting(Setting::State(place)) = unknown else {
        return false;
    };
    directions.iter().any(|direction| {
        let mut moving = direction
            .iter()
            .enumerate()
            .filter(|(_, speed)| **speed != 0.0);
        moving.all(|(coordinate, _)| coordinate == *place)
    })
}
