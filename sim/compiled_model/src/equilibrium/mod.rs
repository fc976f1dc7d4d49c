//! Equilibria: states that stay as they are, at rest or turning and travelling steadily.
//!
//! At an equilibrium all accelerations and all rates of states of first order are 0. Rates of coordinates
//! are 0 too, but along [cyclic directions](Instance::cyclic_directions), where a constant speed changes
//! nothing. The search keeps the speeds that the start has; if there is no equilibrium with them, it looks
//! for the speeds as well. How it finds one is the business of `search` and `linear`.

mod linear;
mod search;
mod stability;

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

    /// Whether a state stays as it is: whether all accelerations and rates of states of first order are 0
    /// beside the terms they are made of, and speeds along cyclic directions.
    ///
    /// # Errors
    /// As [`Instance::jacobian_evaluator`].
    pub fn is_equilibrium(&self, at: &OperatingPoint) -> Result<bool, Error> {
        let holding = self.stabilised(1.0);
        if !self.is_at_rest(at) {
            let directions = holding.cyclic_directions(at)?;
            let mut along = at.clone();
            self.move_along(&mut along, &directions);
            if !self.has_speeds_of(at, &along) {
                return Ok(false);
            }
        }
        let mut search = Search::new(&holding, &[], self.free(at, &[])?)?;
        Ok(search.linearised(at)?.is_below(NOT_ZERO))
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

    /// Whether the rates of two states are the same, beside the largest of their kind.
    fn has_speeds_of(&self, one: &OperatingPoint, other: &OperatingPoint) -> bool {
        let model = self.model();
        let units = model.model().state_units(model.orders());
        let rates = || self.degrees()..2 * self.degrees();
        rates().all(|place| {
            let alike = rates().filter(|other| units[*other].dimension == units[place].dimension);
            let largest = alike.fold(0.0, |most: f64, other| most.max(one.state[other].abs()));
            (one.state[place] - other.state[place]).abs() <= SAME_SPEED * largest
        })
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

#[cfg(test)]
mod tests {
    use crate::{CompiledModel, EquilibriumRequest, Error, Instance, Orders};

    use super::Equilibrium;

    /// A pendulum with a motor, its angle from below.
    const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad", initial = 2.8 }
[inputs]
u = { unit = "N m" }
[kinetic]
mass = "1/2*m*l^2*dot(theta)^2"
[potential]
weight = "-m*g*l*cos(theta)"
[forces]
motor = { on = "theta", value = "u" }
"#;

    fn fixed(run: &Instance<'_>, fixed: &[(&str, f64)]) -> Result<Equilibrium, Error> {
        run.equilibrium(EquilibriumRequest { start: &[], fixed })
    }

    fn from(run: &Instance<'_>, start: &[(&str, f64)]) -> Result<Equilibrium, Error> {
        run.equilibrium(EquilibriumRequest { start, fixed: &[] })
    }

    fn compiled(text: &str) -> CompiledModel {
        CompiledModel::of_text("model.toml", text, Orders::Declared).expect("a model")
    }

    fn model() -> CompiledModel {
        CompiledModel::of_text("pendulum.toml", PENDULUM, Orders::Declared).expect("a model")
    }

    #[test]
    fn the_nearest_equilibrium_is_found() {
        let model = model();
        let run = model.at_declared().expect("an instance");
        let found = fixed(&run, &[]).expect("an equilibrium");
        assert!(
            (found.at.state[0] - std::f64::consts::PI).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.at.inputs, [0.0]);
        let held = fixed(&run, &[("theta", 0.3)]).expect("a torque");
        let right = 2.0 * 9.81 * 0.5 * 0.3_f64.sin();
        assert!(
            (held.at.inputs[0] - right).abs() < 1e-12 * right,
            "{held:?}"
        );
        let loaded = fixed(&run, &[("u", 5.0)]).expect("an angle");
        assert!(
            (loaded.at.state[0].sin() * 9.81 - 5.0).abs() < 1e-11,
            "{loaded:?}"
        );
    }

    #[test]
    fn where_there_is_none_it_is_said() {
        let model = model();
        let run = model.at_declared().expect("an instance");
        for given in [&[("u", 20.0)][..], &[("theta", 0.3), ("u", 0.0)]] {
            let found = fixed(&run, given);
            assert!(
                matches!(found, Err(Error::Stopped { .. })),
                "{given:?}: {found:?}"
            );
        }
        for given in [("theta_dot", 1.0), ("thta", 0.0), ("u", f64::NAN)] {
            let refused = fixed(&run, &[given]);
            assert!(
                matches!(refused, Err(Error::Request(_))),
                "{given:?}: {refused:?}"
            );
        }
    }

    #[test]
    fn a_pendulum_goes_to_the_nearer_equilibrium() {
        use std::f64::consts::{FRAC_PI_2, PI};
        let model = model();
        let run = model.at_declared().expect("an instance");
        for (start, right) in [
            (1.5, 0.0),
            (1.57, 0.0),
            (1.58, PI),
            (1.7, PI),
            (4.5, PI),
            (4.8, 2.0 * PI),
        ] {
            let found = from(&run, &[("theta", start)]).expect("an equilibrium");
            assert!(
                (found.at.state[0] - right).abs() < 1e-9,
                "{start}: {found:?}"
            );
        }
        let found = from(&run, &[("theta", FRAC_PI_2)])
            .expect("an equilibrium")
            .at
            .state[0];
        assert!(found.abs() < 1e-9 || (found - PI).abs() < 1e-9, "{found}");
        // The slope of the force is exactly 0 where a level pendulum's angle is measured from level.
        let level = PENDULUM.replace("-m*g*l*cos(theta)", "m*g*l*sin(theta)");
        let model = compiled(&level.replace("2.8", "0"));
        let run = model.at_declared().expect("an instance");
        let found = from(&run, &[]).expect("an equilibrium").at.state[0];
        assert!((found + FRAC_PI_2).abs() < 1e-9, "it falls: {found}");
    }

    #[test]
    fn a_search_stays_within_the_declared_range() {
        let within = PENDULUM.replace("initial = 2.8", "range = [0.4, 4], initial = 1.2");
        let model = compiled(&within);
        let run = model.at_declared().expect("an instance");
        let found = from(&run, &[]);
        assert!(
            matches!(found, Err(Error::Stopped { .. })),
            "0 is outside: {found:?}"
        );
        let found = from(&run, &[("theta", 2.0)])
            .expect("an equilibrium")
            .at
            .state[0];
        assert!((found - std::f64::consts::PI).abs() < 1e-9, "{found}");
        assert!(matches!(
            from(&run, &[("theta", 5.0)]),
            Err(Error::Request(_))
        ));
    }

    #[test]
    fn a_spring_of_two_rates_is_in_equilibrium_beyond_its_kink() {
        let text = PENDULUM
            .replace("-m*g*l*cos(theta)", "1/2*c*(min(theta, 0)^2 + 100*max(theta, 0)^2) - p*theta")
            .replace("[coordinates]", "c = { value = 2, unit = \"N m\" }\np = { value = 3, unit = \"N m\" }\n[coordinates]")
            .replace("2.8", "-1");
        let model = compiled(&text);
        let run = model.at_declared().expect("an instance");
        let found = from(&run, &[]).expect("an equilibrium").at.state[0];
        assert!((found - 0.015).abs() < 1e-12, "{found}");
    }

    /// A disc on a shaft with friction, its motor, and a bob that swings out as it turns.
    const GOVERNOR: &str = r#"
[model]
name = "governor"
[parameters]
J = { value = 2, unit = "kg m^2" }
m = { value = 0.5, unit = "kg" }
l = { value = 0.4, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.1, unit = "N m s" }
T = { value = 0.8, unit = "N m" }
[coordinates]
phi = { unit = "rad" }
theta = { unit = "rad", initial = 0.5 }
[inputs]
u = { unit = "N m" }
[kinetic]
all = "1/2*J*dot(phi)^2 + 1/2*m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)"
[potential]
weight = "-m*g*l*cos(theta)"
[dissipation]
bearing = "1/2*c*dot(phi)^2"
[forces]
motor = { on = "phi", value = "T + u" }
"#;

    #[test]
    fn steady_running_is_an_equilibrium() {
        let model = compiled(GOVERNOR);
        let run = model.at_declared().expect("an instance");
        // T = c omega at 8 rad/s; the bob stands out by cos(theta) = g/(l omega^2).
        let right = (9.81 / (0.4 * 64.0_f64)).acos();
        let found = from(&run, &[("theta", 1.0)]).expect("steady running");
        assert!((found.at.state[2] - 8.0).abs() < 1e-8, "{found:?}");
        assert!((found.at.state[1] - right).abs() < 1e-8, "{found:?}");
        assert!(found.free.contains(&"phi_dot".to_owned()), "{found:?}");
        assert!(run.is_equilibrium(&found.at).expect("an answer"));
        // At a speed that is fixed the motor holds it.
        let found = run.equilibrium(EquilibriumRequest {
            start: &[("theta", 1.0)],
            fixed: &[("phi_dot", 10.0)],
        });
        let found = found.expect("steady running");
        assert_eq!(found.at.state[2], 10.0);
        assert!((found.at.inputs[0] - 0.2).abs() < 1e-9, "{found:?}");
        let mut slipping = found.at.clone();
        slipping.state[3] = 0.1;
        assert!(!run.is_equilibrium(&slipping).expect("an answer"));
    }
}
