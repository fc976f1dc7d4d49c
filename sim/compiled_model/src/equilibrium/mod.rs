//! Equilibria: states at rest or in steady motion.
//!
//! At an equilibrium all accelerations and all rates of first-order states are 0. Rates of coordinates are 0 too,
//! except along [cyclic directions](Instance::find_cyclic_directions), along which any constant speed is possible. The
//! search keeps the given speeds. If no equilibrium with these speeds is found, the speeds become unknowns as well.

mod accuracy;
mod constraints;
mod linear;
mod search;
mod stability;
#[cfg(test)]
mod tests;
mod unknown;

use std::cell::RefCell;

use eomgen_model_spec::ids::InputId;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ROUNDING_FACTOR, System};

use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};

use self::search::Search;
use self::unknown::Unknown;

pub use self::stability::Stability;

/// Smallest rate that counts as nonzero, relative to its largest term.
const MAX_ZERO_RATE_FRACTION: f64 = 1e-6;

/// Largest difference of speeds that count as equal, relative to the largest speed of the same unit.
const MAX_SPEED_DIFFERENCE_FRACTION: f64 = 1e-9;

/// Relative tolerance of a state at which friction holds a machine.
const HELD_TOLERANCE: f64 = 1e-9;

/// An equilibrium of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// State, time and inputs of the equilibrium.
    pub point: OperatingPoint,
    /// Remaining accelerations of the coordinates, then rates of the first-order states, SI.
    pub residual: Vec<f64>,
    /// Names of the nonzero rates, which stay constant.
    pub nonzero_rates: Vec<String>,
    /// Names of the coordinates, rates, inputs and first-order states that were unknowns of the search.
    pub unknowns: Vec<String>,
    /// True if the rates depend on time or on prescribed motion that moves. If so, the point is an equilibrium at this
    /// instant only.
    pub depends_on_time: bool,
}

/// Quantities that keep a state from being an equilibrium, by name; empty at an equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Departure {
    /// Nonzero rates, except constant speeds along cyclic directions.
    pub moving_rates: Vec<String>,
    /// Rates whose accelerations are nonzero, relative to their terms.
    pub accelerating_rates: Vec<String>,
    /// First-order states whose rates are nonzero, relative to their terms.
    pub changing_states: Vec<String>,
    /// Nonzero rates of prescribed motion whose positions act on the machine.
    pub moving_inputs: Vec<String>,
}

impl Departure {
    /// Returns true at an equilibrium.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Start and fixed values of a search for an equilibrium, SI.
#[derive(Clone, Copy, Debug, Default)]
pub struct EquilibriumRequest<'r> {
    /// Values that replace those of the initial state at the start of the search.
    pub start_values: &'r [(&'r str, f64)],
    /// Values that stay fixed.
    pub fixed_values: &'r [(&'r str, f64)],
}

impl Instance<'_> {
    /// Finds the equilibrium nearest to the start. Coordinates and first-order states are unknowns unless fixed. A
    /// first-order state whose rate is 0 at rest for any value, such as the state of a hysteresis, keeps its value if
    /// an equilibrium has it. Inputs have their default or given values. If coordinates, speeds or first-order states
    /// are fixed, the inputs that are not fixed are unknowns too and hold the machine there.
    ///
    /// If friction holds the machine at the start, and forces balance at no state near it, the start is the
    /// equilibrium.
    ///
    /// # Errors
    /// An unknown name, a nonzero rate of a coordinate that is not cyclic, a start outside a declared range, and
    /// [`Error::Stopped`] if no equilibrium is found.
    pub fn find_equilibrium(&self, request: EquilibriumRequest<'_>) -> Result<Equilibrium, Error> {
        let given = [request.start_values, request.fixed_values].concat();
        let mut at = self.operating_point(&given)?;
        self.check_ranges(&at)?;
        // At a nonzero stabilisation rate, violated constraints cause accelerations.
        let holding = self.with_stabilisation_rate(1.0);
        let directions = match self.is_at_rest(&at) {
            true => Vec::new(),
            false => holding.find_cyclic_directions(&at)?,
        };
        self.check_speeds(&at, &given, &directions)?;
        let [fixed, given] = [request.fixed_values, &given].map(|values| self.find_rates(values));
        self.project_rates(&mut at, &directions, &[fixed?, given?]);
        self.check_fixed_rates(&at, request.fixed_values)?;
        let mut unknowns = self.find_unknowns(&at, request.fixed_values)?;
        let mut search = Search::new(&holding, &directions, unknowns.clone())?;
        let start = at.clone();
        let lasting = search.find_lasting_states(&at);
        let mut without_lasting = None;
        if !lasting.is_empty() {
            unknowns.retain(|unknown| !lasting.contains(unknown));
            let mut others = Search::new(&holding, &directions, unknowns)?;
            match others.run(&mut at) {
                Ok(residual) => {
                    search = others;
                    without_lasting = Some(residual);
                }
                Err(_) => at = start.clone(),
            }
        }
        let first = match without_lasting {
            Some(residual) => Ok(residual),
            None => search.run(&mut at),
        };
        let held = match &first {
            Err(_) if request.fixed_values.is_empty() => holding.find_held_rates(&start)?,
            _ => None,
        };
        let residual = match (first, held) {
            (Ok(residual), _) => residual,
            (Err(_), Some(rates)) => {
                at = start;
                rates
            }
            (Err(error), None) => {
                // No equilibrium has these speeds, so the search includes the speeds.
                let directions = holding.find_cyclic_directions(&start)?;
                let speeds = self.find_unknown_speeds(&directions, request.fixed_values)?;
                if speeds.is_empty() {
                    return Err(error);
                }
                at = start;
                let mut free = self.find_unknowns(&at, request.fixed_values)?;
                free.retain(|unknown| !is_cyclic_coordinate(unknown, &directions));
                free.extend(speeds);
                search = Search::new(&holding, &directions, free)?;
                search.run(&mut at).map_err(|_| error)?
            }
        };
        let depends_on_time =
            search.depends_on_time(&at) || !holding.find_moving_inputs(&at)?.is_empty();
        Ok(Equilibrium {
            nonzero_rates: self.list_nonzero_rates(&at),
            residual,
            unknowns: search.names(),
            depends_on_time,
            point: at,
        })
    }

    /// Returns true if a state is an equilibrium; see [`Instance::find_departure`].
    ///
    /// # Errors
    /// See [`Instance::jacobian_evaluator`].
    pub fn is_equilibrium(&self, at: &OperatingPoint) -> Result<bool, Error> {
        Ok(self.find_departure(at)?.is_none())
    }

    /// Returns the rates, accelerations and first-order states that keep a state from being an equilibrium.
    ///
    /// # Errors
    /// See [`Instance::jacobian_evaluator`].
    pub fn find_departure(&self, at: &OperatingPoint) -> Result<Departure, Error> {
        let holding = self.with_stabilisation_rate(1.0);
        let mut found = Departure {
            moving_inputs: holding.find_moving_inputs(at)?,
            ..Departure::default()
        };
        if !self.is_at_rest(at) {
            let directions = holding.find_cyclic_directions(at)?;
            let mut along = at.clone();
            self.project_rates(&mut along, &directions, &[]);
            found.moving_rates = self.list_differing_rates(at, &along);
        }
        if holding.find_held_rates(at)?.is_some() {
            return Ok(found);
        }
        let mut search = Search::new(&holding, &[], self.find_unknowns(at, &[])?)?;
        let names = self.model().state_names();
        for row in search
            .linearise(at)?
            .find_rows_above(MAX_ZERO_RATE_FRACTION)
        {
            let name = names[self.degrees() + row].clone();
            match row < self.degrees() {
                true => found.accelerating_rates.push(name),
                false => found.changing_states.push(name),
            }
        }
        Ok(found)
    }

    /// Returns the nonzero rates of prescribed motion whose positions change the rate of a state.
    fn find_moving_inputs(&self, at: &OperatingPoint) -> Result<Vec<String>, Error> {
        let inputs = &self.model().model().inputs;
        let moving = inputs.iter().enumerate().filter_map(|(place, input)| {
            let rate = input.rate.filter(|rate| at.inputs[rate.index()] != 0.0)?;
            Some((place, rate))
        });
        let moving: Vec<(usize, InputId)> = moving.collect();
        if moving.is_empty() {
            return Ok(Vec::new());
        }
        let by_inputs = self.state_space_evaluator()?.evaluate(at.point())?.b;
        let acts = |place: &usize| {
            let mut rows = by_inputs.chunks_exact(inputs.len());
            rows.any(|row| row[*place] != 0.0)
        };
        let acting = moving.into_iter().filter(|(place, _)| acts(place));
        Ok(acting.map(|(_, rate)| inputs[rate].name.clone()).collect())
    }

    /// Returns the accelerations and the rates of first-order states if friction holds the machine at rest and no state
    /// changes. All are then 0 up to rounding.
    fn find_held_rates(&self, at: &OperatingPoint) -> Result<Option<Vec<f64>>, Error> {
        if !self.is_at_rest(at) || self.holding_model()?.is_none() {
            return Ok(None);
        }
        let evaluator = RefCell::new(self.interpreter()?);
        let inputs = HeldInputs::constant(at.inputs.clone());
        let system = self.driven_model(&evaluator, inputs, HELD_TOLERANCE)?;
        let mut guards = vec![0.0; system.guard_count()];
        // The first evaluation decides which surfaces hold the motion.
        system.guards(at.t, &at.state, &mut guards);
        let (mut rates, mut roundings) = (vec![0.0; at.state.len()], vec![0.0; at.state.len()]);
        system.rates(at.t, &at.state, &mut rates);
        system.add_rate_roundings(0.0, &mut roundings);
        let mut pairs = rates.iter().zip(roundings);
        let is_held = pairs.all(|(rate, rounding)| rate.abs() <= ROUNDING_FACTOR * rounding);
        Ok(is_held.then(|| rates.split_off(self.degrees())))
    }

    fn list_nonzero_rates(&self, at: &OperatingPoint) -> Vec<String> {
        let rates = self.degrees()..2 * self.degrees();
        let names = self.model().state_names();
        let moving = rates.filter(|place| at.state[*place] != 0.0);
        moving.map(|place| names[place].clone()).collect()
    }

    pub(super) fn degrees(&self) -> usize {
        self.model().program().degrees_of_freedom()
    }

    fn is_at_rest(&self, at: &OperatingPoint) -> bool {
        let degrees = self.degrees();
        at.state[degrees..2 * degrees]
            .iter()
            .all(|rate| *rate == 0.0)
    }

    /// Returns the unknowns at given speeds: all coordinates and first-order states that are not fixed, and, if a state
    /// is fixed, the inputs that are not fixed. Rates of prescribed motion are given: a machine on an accelerated base
    /// is not at rest.
    fn find_unknowns(
        &self,
        at: &OperatingPoint,
        fixed: &[(&str, f64)],
    ) -> Result<Vec<Unknown>, Error> {
        let fixed = fixed
            .iter()
            .map(|(name, _)| self.model().find_setting(name));
        let fixed = fixed.collect::<Result<Vec<Setting>, Error>>()?;
        let degrees = self.degrees();
        let is_held = fixed
            .iter()
            .any(|setting| matches!(setting, Setting::State(_)));
        let states = (0..degrees)
            .chain(2 * degrees..at.state.len())
            .map(Setting::State);
        let inputs = self.model().model().inputs.iter().enumerate();
        let inputs = inputs.filter(|(_, input)| is_held && input.rate_of.is_none());
        let inputs = inputs.map(|(place, _)| Setting::Input(place));
        let free = states
            .chain(inputs)
            .filter(|setting| !fixed.contains(setting));
        Ok(free.map(Unknown::Setting).collect())
    }

    /// Returns the speeds along cyclic directions that no fixed value determines.
    fn find_unknown_speeds(
        &self,
        directions: &[Vec<f64>],
        fixed: &[(&str, f64)],
    ) -> Result<Vec<Unknown>, Error> {
        let fixed = self.find_rates(fixed)?;
        let moves_fixed = |direction: &Vec<f64>| fixed.iter().any(|place| direction[*place] != 0.0);
        let free = (0..directions.len()).filter(|place| !moves_fixed(&directions[*place]));
        Ok(free.map(Unknown::Speed).collect())
    }

    /// Returns the coordinates whose rates are among the given values.
    fn find_rates(&self, values: &[(&str, f64)]) -> Result<Vec<usize>, Error> {
        let degrees = self.degrees();
        let mut found = Vec::new();
        for (name, _) in values {
            if let Setting::State(place) = self.model().find_setting(name)?
                && (degrees..2 * degrees).contains(&place)
            {
                found.push(place - degrees);
            }
        }
        Ok(found)
    }

    /// Replaces the rates by those of a motion along cyclic directions. The speed along a direction is the mean of the
    /// speeds that the first group of coordinates along it gives, or else that all nonzero rates give.
    fn project_rates(
        &self,
        at: &mut OperatingPoint,
        directions: &[Vec<f64>],
        groups: &[Vec<usize>],
    ) {
        let degrees = self.degrees();
        let given = at.state[degrees..2 * degrees].to_vec();
        let rates = &mut at.state[degrees..2 * degrees];
        rates.fill(0.0);
        let nonzero: Vec<usize> = (0..degrees).filter(|place| given[*place] != 0.0).collect();
        for direction in directions {
            let speeds = |group: &Vec<usize>| -> Vec<f64> {
                let moving = group.iter().filter(|place| direction[**place] != 0.0);
                moving
                    .map(|place| given[*place] / direction[*place])
                    .collect()
            };
            let mut groups = groups.iter().chain([&nonzero]).map(speeds);
            let speeds = groups.find(|speeds| !speeds.is_empty()).unwrap_or_default();
            let speed = speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
            for (rate, part) in rates.iter_mut().zip(direction) {
                *rate += speed * part;
            }
        }
    }

    /// Rejects fixed rates that are impossible in any steady motion.
    fn check_fixed_rates(&self, at: &OperatingPoint, fixed: &[(&str, f64)]) -> Result<(), Error> {
        let degrees = self.degrees();
        for (name, value) in fixed {
            let Setting::State(place) = self.model().find_setting(name)? else {
                continue;
            };
            let difference = (at.state[place] - value).abs();
            if (degrees..2 * degrees).contains(&place)
                && difference > MAX_SPEED_DIFFERENCE_FRACTION * value.abs()
            {
                return Err(Error::Request(format!(
                    "{name} = {value}: no steady motion has this rate together with the other fixed rates; the \
                     nearest steady motion has {name} = {:?}. Fix only one rate of each steady motion",
                    at.state[place]
                )));
            }
        }
        Ok(())
    }

    /// Returns the names of the rates that differ between two states, relative to the largest rate
    /// of the same unit.
    fn list_differing_rates(&self, one: &OperatingPoint, other: &OperatingPoint) -> Vec<String> {
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
            difference.is_nan() || difference > MAX_SPEED_DIFFERENCE_FRACTION * largest
        };
        let differing = rates().filter(differs);
        differing.map(|place| names[place].clone()).collect()
    }

    /// Rejects a nonzero rate of a coordinate that is not cyclic.
    fn check_speeds(
        &self,
        at: &OperatingPoint,
        given: &[(&str, f64)],
        directions: &[Vec<f64>],
    ) -> Result<(), Error> {
        let degrees = self.degrees();
        for (name, value) in given {
            let Setting::State(place) = self.model().find_setting(name)? else {
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
                    "{name} = {value}: at an equilibrium, a rate is nonzero only if no force depends on its \
                     coordinate; forces depend on `{coordinate}`. Set {name} to 0"
                )));
            }
        }
        Ok(())
    }

    fn check_ranges(&self, at: &OperatingPoint) -> Result<(), Error> {
        let model = self.model().model();
        let refused = |error| Error::from_model_error(model, error);
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
                    "{name} = {value} is outside its range {low} to {high} (SI): start inside it, or declare a \
                     wider range"
                )));
            }
        }
        Ok(())
    }
}

/// Returns true if an unknown is the only coordinate of a cyclic direction. Such an unknown keeps its value.
fn is_cyclic_coordinate(unknown: &Unknown, directions: &[Vec<f64>]) -> bool {
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
