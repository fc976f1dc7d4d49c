//! Search for an equilibrium: Gauss-Newton steps with the emitted Jacobians.
//!
//! A step is shortened until the linearised equations are accurate along it (P. Deuflhard, *Newton
//! Methods for Nonlinear Problems*, 3.2). The search thus follows the path from its start and does
//! not jump to another equilibrium. No coordinate moves by more than a fraction of its natural
//! scale, or out of its declared range. Steps are tangential to the holonomic constraints, and each
//! point is moved onto them, so that the path is that of independent coordinates.

use eomgen_codegen::program::evaluator::Evaluator;
use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};
use crate::state_space::StateSpaceEvaluator;

use super::constraints::HolonomicConstraints;
use super::linear::LinearisedEquations;
use super::unknown::Unknown;

/// Maximum number of steps; near an equilibrium ten are enough.
const MAX_STEPS: usize = 300;

const MAX_HALVINGS: i32 = 40;

/// Number of halvings after which a step is accepted although the equations are not linear along
/// it, for example across a kink.
const MAX_STRAIGHT_HALVINGS: i32 = 12;

/// Maximum number of halvings of a step if all accelerations are zero already; the remaining gain
/// is rounding.
const MAX_FINAL_HALVINGS: i32 = 2;

/// Longest step, relative to a coordinate's natural scale.
const MAX_STEP_FRACTION: f64 = 0.25;

/// Displacement from a point at which no step helps, relative to a coordinate's natural scale or, without one, its
/// typical size.
const NUDGE_FRACTION: f64 = 1.0 / 1024.0;

const MAX_NUDGES: usize = 3;

/// Largest acceleration that counts as zero, relative to the largest term of its equation.
const MAX_ZERO_FRACTION: f64 = 1e-10;

pub(super) struct Search<'i, 'm> {
    instance: &'i Instance<'m>,
    evaluator: Evaluator,
    state_space: StateSpaceEvaluator<'i, 'm>,
    constraints: Option<HolonomicConstraints>,
    directions: Vec<Vec<f64>>,
    unknowns: Vec<Unknown>,
    /// Natural scales of the unknowns, if known.
    scales: Vec<Option<f64>>,
    /// Natural scales of the unknowns, or their typical sizes; 0 if neither is known.
    typical: Vec<f64>,
    /// Ranges of the unknowns, if declared.
    ranges: Vec<Option<(f64, f64)>>,
}

impl<'i, 'm> Search<'i, 'm> {
    pub fn new(
        instance: &'i Instance<'m>,
        directions: &[Vec<f64>],
        unknowns: Vec<Unknown>,
    ) -> Result<Self, Error> {
        let model = instance.model().model();
        let refused = |error| Error::from_model_error(model, error);
        let scales = instance.natural_scales()?;
        let coordinates = model.coordinate_ranges().map_err(refused)?;
        let inputs = model.input_ranges().map_err(refused)?;
        let range = |unknown: &Unknown| match unknown {
            Unknown::Setting(Setting::State(place)) => coordinates.get(*place).copied().flatten(),
            Unknown::Setting(Setting::Input(place)) => inputs.get(*place).copied().flatten(),
            _ => None,
        };
        let scale = |unknown: &Unknown| match unknown {
            Unknown::Setting(Setting::State(place)) => scales.get(*place).copied().flatten(),
            other => range(other).map(|(low, high)| high - low),
        };
        let sizes = instance.model().typical_sizes();
        let typical = |unknown: &Unknown| match (scale(unknown), unknown) {
            (Some(scale), _) => scale,
            (None, Unknown::Setting(Setting::State(place))) => sizes[*place],
            _ => 0.0,
        };
        Ok(Self {
            typical: unknowns.iter().map(typical).collect(),
            evaluator: instance.interpreter()?,
            state_space: instance.state_space_evaluator()?,
            constraints: HolonomicConstraints::new(instance, &unknowns),
            instance,
            directions: directions.to_vec(),
            scales: unknowns.iter().map(scale).collect(),
            ranges: unknowns.iter().map(range).collect(),
            unknowns,
        })
    }

    /// Moves `at` to an equilibrium and returns the remaining accelerations.
    pub fn run(&mut self, at: &mut OperatingPoint) -> Result<Vec<f64>, Error> {
        if !self.project(at) {
            return Err(unsatisfied_constraints_error());
        }
        let mut here = self.linearise(at)?;
        let mut nudges = 0;
        for _ in 0..MAX_STEPS {
            if here.is_below(f64::EPSILON) {
                break;
            }
            let step = here.solve_step(&self.scales);
            let moved = match self.advance(at, &here, &step) {
                // No step reduces the accelerations, which are zero up to rounding.
                None if here.is_below(MAX_ZERO_FRACTION) || nudges == MAX_NUDGES => break,
                None => {
                    nudges += 1;
                    self.nudge(at, &here)
                }
                moved => moved,
            };
            let Some((trial, mut there)) = moved else {
                break;
            };
            there.sizes = there.sizes.sup(&here.sizes);
            (*at, here) = (trial, there);
        }
        if here.is_below(MAX_ZERO_FRACTION) {
            return Ok(here.accelerations.iter().copied().collect());
        }
        Err(self.not_found_error(at, &here))
    }

    /// Returns the longest shortened step that reduces the accelerations and along which the
    /// equations are nearly linear. If there is none, returns the longest that reduces the
    /// accelerations.
    fn advance(
        &mut self,
        at: &OperatingPoint,
        here: &LinearisedEquations,
        step: &DVector<f64>,
    ) -> Option<(OperatingPoint, LinearisedEquations)> {
        let halvings = match here.is_below(MAX_ZERO_FRACTION) {
            true => MAX_FINAL_HALVINGS,
            false => MAX_HALVINGS,
        };
        let longest = self.step_fraction(step);
        let before = here.squared_norm(&here.accelerations);
        let mut bent = None;
        for halving in 0..halvings {
            if halving >= MAX_STRAIGHT_HALVINGS && bent.is_some() {
                break;
            }
            let change = step * (longest * 0.5_f64.powi(halving));
            let Some((trial, way)) = self.move_point(at, &change) else {
                continue;
            };
            let Some(there) = self.try_linearised(&trial) else {
                continue;
            };
            if here.squared_norm(&there.accelerations) >= before {
                continue;
            }
            if here.is_straight_to(&there, &way) {
                return Some((trial, there));
            }
            bent.get_or_insert((trial, there));
        }
        bent
    }

    /// Returns the fraction of a step that keeps every unknown within [`MAX_STEP_FRACTION`].
    fn step_fraction(&self, step: &DVector<f64>) -> f64 {
        let parts = step.iter().zip(&self.scales);
        let part = |(change, scale): (&f64, &Option<f64>)| match scale {
            Some(scale) if *change != 0.0 => MAX_STEP_FRACTION * scale / change.abs(),
            _ => f64::INFINITY,
        };
        parts.map(part).fold(1.0, f64::min)
    }

    /// Returns a point displaced in the direction of the accelerations. If no step helps, forces
    /// may have an extremum.
    fn nudge(
        &mut self,
        at: &OperatingPoint,
        here: &LinearisedEquations,
    ) -> Option<(OperatingPoint, LinearisedEquations)> {
        let change = DVector::from_fn(self.unknowns.len(), |place, _| match self.unknowns[place] {
            Unknown::Setting(Setting::State(state)) => {
                NUDGE_FRACTION * self.typical[place] * here.acceleration_sign(state)
            }
            _ => 0.0,
        });
        let (trial, way) = self.move_point(at, &change)?;
        let there = self.try_linearised(&trial)?;
        (way.amax() > 0.0).then_some((trial, there))
    }

    /// Returns the accelerations at a point and their derivatives with respect to the unknowns.
    pub fn linearise(&mut self, at: &OperatingPoint) -> Result<LinearisedEquations, Error> {
        let found = self.try_linearised(at);
        found.ok_or_else(|| self.instance.no_linearisation_error(at.point()))
    }

    /// Returns the same, or `None` if a number is not finite.
    fn try_linearised(&mut self, at: &OperatingPoint) -> Option<LinearisedEquations> {
        let degrees = self.instance.model().program().degrees_of_freedom();
        let states = at.state.len();
        let mut rates = vec![0.0; states];
        self.evaluator.rates(at.point(), &mut rates);
        let found = self.state_space.evaluate(at.point()).ok()?;
        let by_state = DMatrix::from_row_slice(states, states, &found.a);
        let by_inputs = DMatrix::from_row_slice(states, at.inputs.len(), &found.b);
        let rows = states - degrees;
        let matrix = DMatrix::from_fn(rows, self.unknowns.len(), |row, column| {
            let row = degrees + row;
            match self.unknowns[column] {
                Unknown::Setting(Setting::State(place)) => by_state[(row, place)],
                Unknown::Setting(Setting::Input(place)) => by_inputs[(row, place)],
                Unknown::Setting(Setting::Time) => 0.0,
                Unknown::Speed(direction) => {
                    let speeds = self.directions[direction].iter().enumerate();
                    speeds
                        .map(|(place, speed)| by_state[(row, degrees + place)] * speed)
                        .sum()
                }
            }
        });
        let accelerations = DVector::from_column_slice(&rates[degrees..]);
        if !accelerations
            .iter()
            .chain(matrix.iter())
            .all(|number| number.is_finite())
        {
            return None;
        }
        let sizes = DVector::from_fn(rows, |row, _| {
            let term = |(entry, value): (f64, &f64)| (entry * value).abs();
            let by_state = by_state.row(degrees + row);
            let by_inputs = by_inputs.row(degrees + row);
            let of_states = by_state.iter().copied().zip(&at.state).map(term);
            let of_inputs = by_inputs.iter().copied().zip(&at.inputs).map(term);
            let scaled = matrix.row(row);
            let of_sizes = scaled.iter().zip(&self.typical);
            let of_sizes = of_sizes.map(|(entry, size)| (entry * size).abs());
            let terms = of_states.chain(of_inputs).chain(of_sizes);
            terms.fold(accelerations[row].abs(), f64::max)
        });
        let constraints = match &mut self.constraints {
            Some(constraints) => Some(constraints.linearise(at)?),
            None => None,
        };
        Some(LinearisedEquations {
            accelerations,
            matrix,
            constraints,
            terms: sizes.clone(),
            sizes,
        })
    }

    /// Moves a point onto the constraints; returns false if that fails.
    fn project(&mut self, at: &mut OperatingPoint) -> bool {
        let constraints = self.constraints.as_mut();
        constraints.is_none_or(|constraints| constraints.project(at))
    }

    /// Returns a point moved by a change of the unknowns, inside their ranges and on the constraints, and the change of the
    /// unknowns. `None` if no such point is near.
    fn move_point(
        &mut self,
        at: &OperatingPoint,
        change: &DVector<f64>,
    ) -> Option<(OperatingPoint, DVector<f64>)> {
        let degrees = self.instance.model().program().degrees_of_freedom();
        let (mut moved, mut way) = (at.clone(), DVector::zeros(change.len()));
        for (place, unknown) in self.unknowns.iter().enumerate() {
            let within = |value: f64| match self.ranges[place] {
                Some((low, high)) => value.clamp(low, high),
                None => value,
            };
            let value = match *unknown {
                Unknown::Setting(Setting::State(state)) => &mut moved.state[state],
                Unknown::Setting(Setting::Input(input)) => &mut moved.inputs[input],
                Unknown::Setting(Setting::Time) => continue,
                Unknown::Speed(direction) => {
                    way[place] = change[place];
                    let rates = moved.state[degrees..].iter_mut();
                    for (rate, speed) in rates.zip(&self.directions[direction]) {
                        *rate += change[place] * speed;
                    }
                    continue;
                }
            };
            let there = within(*value + change[place]);
            way[place] = there - *value;
            *value = there;
        }
        if self.constraints.is_none() {
            return Some((moved, way));
        }
        if !self.project(&mut moved) {
            return None;
        }
        for (place, unknown) in self.unknowns.iter().enumerate() {
            if let Unknown::Setting(Setting::State(state)) = *unknown {
                let value = moved.state[state];
                if self.ranges[place].is_some_and(|(low, high)| !(low..=high).contains(&value)) {
                    return None;
                }
                way[place] = value - at.state[state];
            }
        }
        Some((moved, way))
    }

    /// Returns true if a rate depends on time at a point.
    pub fn depends_on_time(&mut self, at: &OperatingPoint) -> bool {
        self.state_space.depends_on_time(at.point())
    }

    /// Returns the names of the unknowns.
    pub fn names(&self) -> Vec<String> {
        let model = self.instance.model();
        let (states, degrees) = (model.state_names(), model.program().degrees_of_freedom());
        let name = |unknown: &Unknown| match *unknown {
            Unknown::Setting(Setting::Time) => "t".to_owned(),
            Unknown::Setting(Setting::State(place)) => states[place].clone(),
            Unknown::Setting(Setting::Input(place)) => model.model().inputs[place].name.clone(),
            Unknown::Speed(direction) => {
                let mut speeds = self.directions[direction].iter();
                let moving = speeds.position(|speed| *speed != 0.0).unwrap_or(0);
                states[degrees + moving].clone()
            }
        };
        self.unknowns.iter().map(name).collect()
    }

    fn not_found_error(&self, at: &OperatingPoint, here: &LinearisedEquations) -> Error {
        let degrees = self.instance.model().program().degrees_of_freedom();
        let states = self.instance.model().state_names();
        let (row, left) = here.largest_residual();
        let place = if row < degrees { row } else { row + degrees };
        let at_the_end = self
            .unknowns
            .iter()
            .zip(&self.ranges)
            .find(|(unknown, range)| {
                let Unknown::Setting(Setting::State(place)) = unknown else {
                    return false;
                };
                range.is_some_and(|(low, high)| [low, high].contains(&at.state[*place]))
            });
        let range = match at_the_end {
            Some((Unknown::Setting(Setting::State(place)), _)) => {
                format!(", {} is at the limit of its range", states[*place])
            }
            _ => String::new(),
        };
        let name = states.get(place).map_or("", String::as_str);
        let reason = format!(
            "no equilibrium was found near the initial state: the search ended at {name} = {:e}{range}, \
             with the acceleration or rate {left:e} (SI) of {name}; start nearer to an equilibrium (--state), or fix \
             a coordinate (--fix) so that inputs hold it",
            at.state.get(place).copied().unwrap_or(0.0)
        );
        Error::Stopped { t: None, reason }
    }
}

fn unsatisfied_constraints_error() -> Error {
    let reason = "no state near the start satisfies the constraints at the fixed values: start nearer to a solution \
                  (--state), or fix other values (--fix)";
    Error::Stopped {
        t: None,
        reason: reason.to_owned(),
    }
}
