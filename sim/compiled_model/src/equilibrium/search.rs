//! Equilibrium search by Gauss-Newton steps with the emitted Jacobians.
//!
//! A step is shortened until the linearised equations are accurate along it (P. Deuflhard, *Newton Methods for
//! Nonlinear Problems*, 3.2). The search thus follows the path from its start and does not jump to another equilibrium.
//! No coordinate moves by more than a fraction of its natural scale, or out of its declared range. Steps are tangential
//! to the holonomic constraints, and each point is projected onto them. The path is therefore the same as in
//! independent coordinates.

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_model_spec::argument::Argument;
use eomgen_sim::ode::ROUNDING_FACTOR;
use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};
use crate::state_space::StateSpaceEvaluator;

use super::accuracy::{Accuracy, Inaccuracy};
use super::constraints::HolonomicConstraints;
use super::linear::LinearisedEquations;
use super::unknown::Unknown;

/// Maximum number of steps; near an equilibrium ten suffice.
const MAX_STEPS: usize = 300;

const MAX_HALVINGS: i32 = 40;

/// Number of halvings after which a step is accepted although the equations are nonlinear along it, for example at a
/// kink.
const MAX_STRAIGHT_HALVINGS: i32 = 12;

/// Maximum number of halvings of a step if all accelerations are already zero to rounding; a further reduction is
/// rounding.
const MAX_FINAL_HALVINGS: i32 = 2;

/// Longest step, relative to a coordinate's natural scale.
const MAX_STEP_FRACTION: f64 = 0.25;

/// Displacement from a point at which no step reduces the accelerations, relative to a coordinate's natural scale or,
/// without one, its typical size.
const NUDGE_FRACTION: f64 = 1.0 / 1024.0;

const MAX_NUDGES: usize = 3;

/// Maximum number of displacements inside a region in which a coordinate changes no acceleration, such as a play. Each
/// displacement is twice the previous one; the longest is 64 natural scales.
const MAX_FLAT_NUDGES: i32 = 17;

/// Largest acceleration that counts as zero, relative to the largest term of its equation.
const MAX_ZERO_FRACTION: f64 = 1e-10;

/// An equilibrium within this distance of a switching surface may lie on it. The distance is relative to the size of an
/// unknown.
const SURFACE_FRACTION: f64 = 1e-6;

/// Maximum number of steps of the secant method to a switching surface.
const MAX_SURFACE_STEPS: usize = 5;

/// Singular values below this fraction of the largest count as 0.
const MIN_SINGULAR_VALUE_FRACTION: f64 = 1e-12;

/// Limit of singular values in a second search, which keeps the slopes of soft parts: the rounding error of the
/// entries.
const SOFT_SINGULAR_VALUE_FRACTION: f64 = 16.0 * f64::EPSILON;

/// Rounding error of an acceleration for which no bound is known, relative to the largest term of its equation.
const ROUNDING_FRACTION: f64 = ROUNDING_FACTOR * f64::EPSILON;

/// Reason why a search found no equilibrium.
enum Failure {
    /// No point with zero accelerations was found.
    NotFound(Error),
    /// The accelerations are zero to rounding, but the unknowns have large errors.
    Inaccurate(Error),
}

impl Failure {
    fn into_error(self) -> Error {
        match self {
            Self::NotFound(error) | Self::Inaccurate(error) => error,
        }
    }
}

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
        let scales = instance.compute_natural_scales()?;
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
            (None, Unknown::Speed(direction)) => {
                sizes[instance.degrees() + find_main_coordinate(&directions[*direction])]
            }
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
        let here = self.search_from(at)?;
        self.check_surfaces(at)?;
        Ok(here.accelerations.iter().copied().collect())
    }

    /// Moves `at` to an equilibrium. If the first attempt fails, makes further attempts from the same start.
    fn search_from(&mut self, at: &mut OperatingPoint) -> Result<LinearisedEquations, Error> {
        let start = at.clone();
        let first = match self.attempt(at, MIN_SINGULAR_VALUE_FRACTION)? {
            Ok(here) => return Ok(here),
            Err(first) => first,
        };
        // A slope that counts as 0 may belong to a soft part.
        *at = start.clone();
        let second = match self.attempt(at, SOFT_SINGULAR_VALUE_FRACTION)? {
            Ok(here) => return Ok(here),
            Err(second) => second,
        };
        *at = start;
        if let Some(here) = self.attempt_near_surface(at)? {
            return Ok(here);
        }
        Err(match (&first, &second) {
            (Failure::NotFound(_), Failure::Inaccurate(_)) => second.into_error(),
            _ => first.into_error(),
        })
    }

    /// Moves `at` to an equilibrium from a start on a switching surface, such as a wheel that touches the ground. The
    /// attempt starts on the side towards which the machine accelerates. Returns `None` if the start is not on a
    /// surface or no equilibrium is found.
    fn attempt_near_surface(
        &mut self,
        at: &mut OperatingPoint,
    ) -> Result<Option<LinearisedEquations>, Error> {
        if !self.evaluate_guards(at).contains(&0.0) {
            return Ok(None);
        }
        let here = self.linearise(at)?;
        let Some((near, _)) = self.displace_point(at, self.find_acceleration_signs(&here)) else {
            return Ok(None);
        };
        *at = near;
        Ok(self.attempt(at, MIN_SINGULAR_VALUE_FRACTION)?.ok())
    }

    /// Moves `at` to an equilibrium. Singular values below `least` times the largest count as 0.
    fn attempt(
        &mut self,
        at: &mut OperatingPoint,
        least: f64,
    ) -> Result<Result<LinearisedEquations, Failure>, Error> {
        let here = self.descend(at, least)?;
        if !here.is_below(MAX_ZERO_FRACTION) {
            return Ok(Err(Failure::NotFound(self.not_found_error(at, &here))));
        }
        Ok(match self.find_inaccuracy(at, &here, least) {
            None => Ok(here),
            Some(found) => Err(Failure::Inaccurate(self.inaccuracy_error(at, &here, found))),
        })
    }

    /// Rejects an equilibrium on a switching surface at which a derivative has no finite limit, such as that of
    /// `sign(p)*sqrt(abs(p))` at 0. Within the error of the search beside the surface, its derivatives are rounding.
    fn check_surfaces(&mut self, at: &OperatingPoint) -> Result<(), Error> {
        let guards = self.evaluate_guards(at);
        for place in 0..self.unknowns.len() {
            let size = self.typical[place];
            let mut change = DVector::zeros(self.unknowns.len());
            let mut displaced = |search: &Self, distance: f64| {
                change[place] = distance;
                search.move_unknowns(at, &change).0
            };
            let beside = displaced(self, SURFACE_FRACTION * size);
            let beside = self.evaluate_guards(&beside);
            for (guard, (here, there)) in guards.iter().zip(beside).enumerate() {
                let mut distance = -SURFACE_FRACTION * size * here / (there - here);
                if *here == 0.0 || distance.is_nan() || distance.abs() > SURFACE_FRACTION * size {
                    continue;
                }
                for _ in 0..MAX_SURFACE_STEPS {
                    let on = displaced(self, distance);
                    let value = self.evaluate_guards(&on)[guard];
                    if value == 0.0 {
                        if self.try_linearised(&on).is_none() {
                            return Err(self.instance.no_linearisation_error(on.point()));
                        }
                        break;
                    }
                    distance *= here / (here - value);
                }
            }
        }
        Ok(())
    }

    /// Evaluates the switching functions at a point.
    fn evaluate_guards(&mut self, at: &OperatingPoint) -> Vec<f64> {
        let mut guards = vec![0.0; self.evaluator.guard_count()];
        self.evaluator.guards(at.point(), &mut guards);
        guards
    }

    /// Moves `at` by steps that reduce the accelerations until no step does. Singular values below `least` times the
    /// largest count as 0.
    fn descend(
        &mut self,
        at: &mut OperatingPoint,
        least: f64,
    ) -> Result<LinearisedEquations, Error> {
        let mut here = self.linearise(at)?;
        let (mut nudges, mut flat_nudges) = (0, 0);
        for _ in 0..MAX_STEPS {
            if here.is_below(f64::EPSILON) {
                break;
            }
            let step = here.solve_step(&self.scales, least);
            let moved = match self.advance(at, &here, &step) {
                // No step reduces the accelerations, and they are zero up to rounding.
                None if here.is_below(MAX_ZERO_FRACTION) => break,
                None => {
                    let flat = self.find_flat_direction(&here, least);
                    let flat = flat.filter(|_| flat_nudges < MAX_FLAT_NUDGES);
                    if let Some(direction) = flat {
                        flat_nudges += 1;
                        self.displace_point(at, direction * 2.0_f64.powi(flat_nudges - 1))
                    } else if nudges < MAX_NUDGES {
                        nudges += 1;
                        let direction = self.find_acceleration_signs(&here);
                        self.displace_point(at, direction)
                    } else {
                        None
                    }
                }
                moved => moved,
            };
            let Some((trial, mut there)) = moved else {
                break;
            };
            there.sizes = there.sizes.sup(&here.sizes);
            there.largest = there.largest.sup(&here.largest);
            (*at, here) = (trial, there);
        }
        Ok(here)
    }

    /// Returns the reason why a point is not an equilibrium to six digits of its unknowns, if there is one.
    fn find_inaccuracy(
        &self,
        at: &OperatingPoint,
        here: &LinearisedEquations,
        least: f64,
    ) -> Option<Inaccuracy> {
        let system = here.scale(&self.scales)?;
        let magnitudes = DVector::from_fn(self.unknowns.len(), |place, _| {
            let value = match self.unknowns[place] {
                Unknown::Setting(Setting::State(state)) => at.state[state].abs(),
                Unknown::Setting(Setting::Input(input)) => {
                    // An input has no typical size; an input that balances nothing is rounding.
                    at.inputs[input]
                        .abs()
                        .max(here.compute_balancing_size(place))
                }
                _ => 0.0,
            };
            value.max(self.typical[place])
        });
        let accuracy = Accuracy::new(here, &system, least);
        let of_state = &here.state_terms * ROUNDING_FRACTION;
        let of_terms = &here.terms * ROUNDING_FRACTION;
        let mut found = accuracy.find_unbalanced(&of_state);
        let mut uncertain = accuracy.find_uncertain(&of_terms, &magnitudes);
        // Bounds on the rounding errors are sharper but take longer to compute.
        if (found.is_some() || uncertain.is_some())
            && let Some(bounds) = self.instance.bound_rate_roundings(at.point())
        {
            let bounds = DVector::from_vec(bounds);
            found = accuracy.find_unbalanced(&(&bounds + of_state));
            uncertain = accuracy.find_uncertain(&bounds, &magnitudes);
        }
        found.or(uncertain).or_else(|| {
            if !accuracy.has_free_motion() {
                return None;
            }
            let linear = self.instance.linearise(at.point()).ok()?;
            let lost = self.instance.find_lost_parameter(&linear, at.point());
            lost.map(Inaccuracy::Hidden)
        })
    }

    /// Returns the longest shortened step that reduces the accelerations and along which the equations are nearly
    /// linear. Without such a step, returns the longest one that reduces the accelerations.
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
        let longest = self.limit_step(step);
        let before = here.compute_squared_norm(&here.accelerations);
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
            if here.compute_squared_norm(&there.accelerations) >= before {
                continue;
            }
            if here.has_equal_slope_at(&there, &way) {
                return Some((trial, there));
            }
            bent.get_or_insert((trial, there));
        }
        bent
    }

    /// Returns the largest fraction of a step that keeps every unknown within [`MAX_STEP_FRACTION`].
    fn limit_step(&self, step: &DVector<f64>) -> f64 {
        let parts = step.iter().zip(&self.scales);
        let part = |(change, scale): (&f64, &Option<f64>)| match scale {
            Some(scale) if *change != 0.0 => MAX_STEP_FRACTION * scale / change.abs(),
            _ => f64::INFINITY,
        };
        parts.map(part).fold(1.0, f64::min)
    }

    /// Returns a change of the unknowns, relative to the typical sizes, that changes no acceleration and along which
    /// the machine accelerates. With constraints, a coordinate cannot move independently.
    fn find_flat_direction(&self, here: &LinearisedEquations, least: f64) -> Option<DVector<f64>> {
        if self.constraints.is_some() {
            return None;
        }
        let signs = self.find_acceleration_signs(here);
        let columns = here.matrix.column_iter().zip(signs.iter());
        if columns
            .into_iter()
            .any(|(column, sign)| column.amax() == 0.0 && *sign != 0.0)
        {
            return Some(signs);
        }
        let accelerations = DVector::from_fn(self.unknowns.len(), |place, _| {
            let coordinate = self.find_accelerated_coordinate(&self.unknowns[place]);
            let value = coordinate.and_then(|place| here.accelerations.get(place).copied());
            value.unwrap_or(0.0)
        });
        let change = here
            .scale(&self.scales)?
            .find_free_change(least, here, &accelerations)?;
        let relative = DVector::from_fn(change.len(), |place, _| match self.typical[place] {
            0.0 => 0.0,
            size => change[place] / size,
        });
        let largest = relative.amax();
        (largest > 0.0).then(|| relative / largest)
    }

    /// Returns the coordinate whose acceleration moves an unknown.
    fn find_accelerated_coordinate(&self, unknown: &Unknown) -> Option<usize> {
        match unknown {
            Unknown::Setting(Setting::State(state)) => {
                Some(*state).filter(|state| *state < self.instance.degrees())
            }
            Unknown::Speed(direction) => Some(find_main_coordinate(&self.directions[*direction])),
            Unknown::Setting(_) => None,
        }
    }

    /// Returns the signs of the accelerations of the unknowns; 0 for rounding, for first-order states and for inputs.
    fn find_acceleration_signs(&self, here: &LinearisedEquations) -> DVector<f64> {
        let signs = self.unknowns.iter().map(|unknown| {
            let coordinate = self.find_accelerated_coordinate(unknown);
            coordinate.map_or(0.0, |place| here.find_acceleration_sign(place))
        });
        DVector::from_iterator(self.unknowns.len(), signs)
    }

    /// Returns a point displaced in a direction relative to the typical sizes. The search uses it if no step helps,
    /// because forces may have an extremum or be constant.
    fn displace_point(
        &mut self,
        at: &OperatingPoint,
        direction: DVector<f64>,
    ) -> Option<(OperatingPoint, LinearisedEquations)> {
        let change = DVector::from_fn(direction.len(), |place, _| {
            NUDGE_FRACTION * self.typical[place] * direction[place]
        });
        let (trial, way) = self.move_point(at, &change)?;
        let there = self.try_linearised(&trial)?;
        (way.amax() > 0.0).then_some((trial, there))
    }

    /// Returns the first-order states among the unknowns whose rates are 0 for all values of the unknowns, to first
    /// order.
    pub fn find_lasting_states(&mut self, at: &OperatingPoint) -> Vec<Unknown> {
        let degrees = self.instance.degrees();
        let Some(here) = self.try_linearised(at) else {
            return Vec::new();
        };
        let lasts = |unknown: &&Unknown| match unknown {
            Unknown::Setting(Setting::State(place)) if *place >= 2 * degrees => {
                let row = place - degrees;
                here.accelerations[row] == 0.0 && here.matrix.row(row).amax() == 0.0
            }
            _ => false,
        };
        self.unknowns.iter().filter(lasts).copied().collect()
    }

    /// Linearises the accelerations at a point with respect to the unknowns.
    pub fn linearise(&mut self, at: &OperatingPoint) -> Result<LinearisedEquations, Error> {
        let found = self.try_linearised(at);
        found.ok_or_else(|| self.instance.no_linearisation_error(at.point()))
    }

    /// Linearises like [`Self::linearise`], but returns `None` if a number is not finite.
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
        let constraints = match &mut self.constraints {
            Some(constraints) => Some(constraints.linearise(at, &mut self.evaluator)?),
            None => None,
        };
        let of_constraints = |row: usize| {
            let constraints = constraints.as_ref()?;
            constraints.largest_accelerations.get(row).copied()
        };
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
            let terms = terms.chain(of_constraints(row));
            terms.fold(accelerations[row].abs(), f64::max)
        });
        let state = DVector::from_column_slice(&at.state);
        let of_states = by_state.rows(degrees, rows).abs() * state.abs();
        let forces = DVector::from_fn(rows, |row, _| of_constraints(row).unwrap_or(0.0));
        let state_terms = of_states + forces;
        let accelerations = match &constraints {
            Some(constraints) => constraints.project(&accelerations)?,
            None => accelerations,
        };
        let balances = |row: usize| {
            let mut unknowns = self.unknowns.iter().enumerate();
            unknowns.any(|(column, unknown)| {
                matches!(unknown, Unknown::Setting(Setting::Input(_)))
                    && matrix[(row, column)] != 0.0
            })
        };
        Some(LinearisedEquations {
            input_rows: (0..rows).map(balances).collect(),
            largest: accelerations.abs(),
            accelerations,
            matrix,
            constraints,
            terms: sizes.clone(),
            sizes,
            state_terms,
        })
    }

    /// Projects a point onto the constraints; returns false if the projection fails.
    fn project(&mut self, at: &mut OperatingPoint) -> bool {
        let constraints = self.constraints.as_mut();
        constraints.is_none_or(|constraints| constraints.project(at))
    }

    /// Returns a point moved by a change of the unknowns, inside their ranges and on the constraints, and the actual
    /// change. `None` if no such point is near.
    fn move_point(
        &mut self,
        at: &OperatingPoint,
        change: &DVector<f64>,
    ) -> Option<(OperatingPoint, DVector<f64>)> {
        let (mut moved, mut way) = self.move_unknowns(at, change);
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

    /// Returns a point moved by a change of the unknowns, limited to their ranges, and the actual change.
    fn move_unknowns(
        &self,
        at: &OperatingPoint,
        change: &DVector<f64>,
    ) -> (OperatingPoint, DVector<f64>) {
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
        (moved, way)
    }

    /// Returns true if a rate depends on time at a point.
    pub fn depends_on_time(&mut self, at: &OperatingPoint) -> bool {
        self.state_space.depends_on_time(at.point())
    }

    /// Returns the names of the unknowns.
    pub fn names(&self) -> Vec<String> {
        let model = self.instance.model();
        let (states, degrees) = (model.state_names(), model.program().degrees_of_freedom());
        let names = |unknown: &Unknown| match *unknown {
            Unknown::Setting(Setting::Time) => vec!["t".to_owned()],
            Unknown::Setting(Setting::State(place)) => vec![states[place].clone()],
            Unknown::Setting(Setting::Input(place)) => {
                vec![model.model().inputs[place].name.clone()]
            }
            Unknown::Speed(direction) => {
                let speeds = self.directions[direction].iter().enumerate();
                let moving = speeds.filter(|(_, speed)| **speed != 0.0);
                moving
                    .map(|(place, _)| states[degrees + place].clone())
                    .collect()
            }
        };
        self.unknowns.iter().flat_map(names).collect()
    }

    /// Returns the name and value of the coordinate or first-order state that belongs to a row of the equations.
    fn describe_row(&self, at: &OperatingPoint, row: usize) -> (String, f64) {
        let degrees = self.instance.model().program().degrees_of_freedom();
        let place = if row < degrees { row } else { row + degrees };
        let names = self.instance.model().state_names();
        let name = names.get(place).cloned().unwrap_or_default();
        (name, at.state.get(place).copied().unwrap_or(0.0))
    }

    fn not_found_error(&self, at: &OperatingPoint, here: &LinearisedEquations) -> Error {
        let states = self.instance.model().state_names();
        let (row, left) = here.find_largest_residual();
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
        let (name, value) = self.describe_row(at, row);
        let reason = format!(
            "no equilibrium was found near the initial state: the search ended at {name} = {value:e}{range}, \
             with the acceleration or rate {left:e} (SI) of {name}; start nearer to an equilibrium ({}), or fix \
             a coordinate ({}) so that inputs hold it",
            Argument::OperatingState,
            Argument::Fixed
        );
        Error::Stopped { t: None, reason }
    }

    /// Returns the error for a point that is not an equilibrium to six digits of its unknowns.
    fn inaccuracy_error(
        &self,
        at: &OperatingPoint,
        here: &LinearisedEquations,
        found: Inaccuracy,
    ) -> Error {
        let reason = match found {
            Inaccuracy::Unbalanced(row) => {
                let (name, value) = self.describe_row(at, row);
                let left = here.accelerations[row];
                format!(
                    "no equilibrium was found near the initial state: the search ended at {name} = {value:e}, with the \
                     acceleration or rate {left:e} (SI) of {name}, which is below the rounding error of a larger \
                     stiffness"
                )
            }
            Inaccuracy::Uncertain(unknown, error) => {
                let (name, value) = self.describe_unknown(at, self.unknowns[unknown]);
                format!(
                    "the equilibrium near {name} = {value:e} cannot be computed accurately: rounding of the largest \
                     forces changes {name} by up to {error:.1e} (SI)"
                )
            }
            Inaccuracy::Hidden(parameter) => format!(
                "the equilibrium cannot be computed: the term with `{parameter}` is below the rounding of a stiffness \
                 beside it"
            ),
        };
        let reason = format!("{reason}; make the stiff part rigid, or reduce its stiffness");
        Error::Stopped { t: None, reason }
    }

    /// Returns the name and value of an unknown.
    fn describe_unknown(&self, at: &OperatingPoint, unknown: Unknown) -> (String, f64) {
        let model = self.instance.model();
        let degrees = model.program().degrees_of_freedom();
        let state = |place: usize| (model.state_names()[place].clone(), at.state[place]);
        match unknown {
            Unknown::Setting(Setting::Time) => ("t".to_owned(), at.t),
            Unknown::Setting(Setting::State(place)) => state(place),
            Unknown::Setting(Setting::Input(place)) => {
                (model.model().inputs[place].name.clone(), at.inputs[place])
            }
            Unknown::Speed(direction) => {
                state(degrees + find_main_coordinate(&self.directions[direction]))
            }
        }
    }
}

/// Returns the coordinate that defines the speed along a cyclic direction.
fn find_main_coordinate(direction: &[f64]) -> usize {
    let place = direction.iter().position(|speed| *speed == 1.0);
    place.unwrap_or(0)
}

fn unsatisfied_constraints_error() -> Error {
    let reason = format!(
        "no state near the start satisfies the constraints at the fixed values: start nearer to a solution ({}), or \
         fix other values ({})",
        Argument::OperatingState,
        Argument::Fixed
    );
    Error::Stopped { t: None, reason }
}
