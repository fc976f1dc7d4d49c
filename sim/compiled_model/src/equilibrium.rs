//! Equilibria: states at rest that stay there.
//!
//! The accelerations at rest are brought to zero by the method of Gauss and Newton with the emitted
//! Jacobians; each step is the smallest that the linearised equations allow (by the singular values,
//! so that a coordinate on which nothing depends stays where it is), and is halved until the
//! accelerations get smaller (Nocedal and Wright, *Numerical Optimization*, 10.3).

use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::instance::Instance;
use crate::jacobians::{Jacobian, JacobianEvaluator};
use crate::operating_point::{OperatingPoint, Setting};

/// Steps before the search is given up; from where it converges, ten are enough.
const MOST_STEPS: usize = 200;

/// Halvings of a step before it is given up.
const MOST_HALVINGS: usize = 40;

/// An acceleration is zero if it is this small beside the largest that the search has met in its
/// equation, or the terms that it is the sum of.
const ZERO: f64 = 1e-10;

/// A singular value is zero if it is this small beside the largest.
const RANK: f64 = 1e-12;

/// A state at rest that stays there.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Where it is; all rates are 0, those of states of first order too.
    pub at: OperatingPoint,
    /// The accelerations, and then the rates of states of first order, that are left of rounding,
    /// SI, in the order of the coordinates and of the states.
    pub residual: Vec<f64>,
    /// The names of the coordinates, inputs and states of first order that were looked for.
    pub free: Vec<String>,
    /// Whether forces depend on the time there: then it is one at that instant alone.
    pub depends_on_time: bool,
}

impl Instance<'_> {
    /// The equilibrium next to the initial state. Coordinates and states of first order are free but
    /// for those that are fixed; inputs are 0 or as fixed, but where coordinates or such states are
    /// fixed those that are not are free: they hold the machine there.
    ///
    /// # Errors
    /// An unknown name, a rate that is fixed to something else than 0, and
    /// [`Error::Stopped`] where no equilibrium is found.
    pub fn equilibrium(&self, fixed: &[(&str, f64)]) -> Result<Equilibrium, Error> {
        let mut at = self.operating_point(fixed)?;
        let degrees = self.model().program().degrees_of_freedom();
        let rates = degrees..2 * degrees;
        let mut settings = Vec::with_capacity(fixed.len());
        for (name, value) in fixed {
            let setting = self.model().setting(name)?;
            if matches!(setting, Setting::State(place) if rates.contains(&place)) && *value != 0.0 {
                return Err(Error::Request(format!(
                    "{name} = {value}: in an equilibrium all rates are 0"
                )));
            }
            settings.push(setting);
        }
        at.state[rates.clone()].fill(0.0);
        let is_fixed = |setting: &Setting| settings.contains(setting);
        let places = (0..at.state.len()).filter(|place| !rates.contains(place));
        let mut free: Vec<Setting> = places
            .map(Setting::State)
            .filter(|place| !is_fixed(place))
            .collect();
        if free.len() < at.state.len() - degrees {
            let inputs = (0..at.inputs.len()).map(Setting::Input);
            free.extend(inputs.filter(|place| !is_fixed(place)));
        }
        // With residuals among the accelerations, where these are zero the constraints hold.
        let holding = self.stabilised(1.0);
        let mut search = Search {
            jacobians: holding.jacobian_evaluator()?,
            instance: &holding,
            free,
        };
        let residual = search.run(&mut at)?;
        let depends_on_time = search.depends_on_time(&at);
        let states = self.model().state_names();
        let name = |setting: &Setting| match *setting {
            Setting::Time => "t".to_owned(),
            Setting::State(place) => states[place].clone(),
            Setting::Input(place) => self.model().model().inputs[place].name.clone(),
        };
        Ok(Equilibrium {
            at,
            residual,
            free: search.free.iter().map(name).collect(),
            depends_on_time,
        })
    }
}

struct Search<'i, 'm> {
    instance: &'i Instance<'m>,
    jacobians: JacobianEvaluator,
    free: Vec<Setting>,
}

/// The accelerations and the rates of states of first order at a point, and their derivatives by
/// what is free.
struct Linear {
    accelerations: DVector<f64>,
    matrix: DMatrix<f64>,
    /// How large each acceleration or a term of it has been so far.
    sizes: DVector<f64>,
}

impl Search<'_, '_> {
    /// Moves to an equilibrium, and gives the accelerations that are left there.
    fn run(&mut self, at: &mut OperatingPoint) -> Result<Vec<f64>, Error> {
        let mut here = self.linearised(at)?;
        for _ in 0..MOST_STEPS {
            let step = here.step();
            let moved = (0..MOST_HALVINGS).find_map(|halvings| {
                let part = 0.5_f64.powi(halvings as i32);
                let trial = self.moved(at, &step, part);
                let there = self.linearised(&trial).ok()?;
                (there.measured_by(&here.sizes) < here.measured_by(&here.sizes))
                    .then_some((trial, there))
            });
            // Where nothing gets smaller any more, rounding is all that is left, or no equilibrium.
            let Some((trial, mut there)) = moved else {
                break;
            };
            there.sizes = there.sizes.sup(&here.sizes);
            (*at, here) = (trial, there);
        }
        if here.is_zero() {
            return Ok(here.accelerations.iter().copied().collect());
        }
        Err(self.not_found(at, &here))
    }

    fn linearised(&mut self, at: &OperatingPoint) -> Result<Linear, Error> {
        let degrees = self.instance.model().program().degrees_of_freedom();
        let states = at.state.len();
        let mut rates = vec![0.0; states];
        self.instance.evaluator()?.rates(at.point(), &mut rates);
        let mut dense = |of: Jacobian| {
            let (rows, columns) = self.jacobians.shape(of);
            let mut matrix = vec![0.0; rows * columns];
            self.jacobians.evaluate(of, at.point(), &mut matrix);
            DMatrix::from_row_slice(rows, columns, &matrix)
        };
        let (by_state, by_inputs) = (
            dense(Jacobian::RatesByState),
            dense(Jacobian::RatesByInputs),
        );
        let matrix = DMatrix::from_fn(states - degrees, self.free.len(), |row, column| match self
            .free[column]
        {
            Setting::State(place) => by_state[(degrees + row, place)],
            Setting::Input(place) => by_inputs[(degrees + row, place)],
            Setting::Time => 0.0,
        });
        let accelerations = DVector::from_column_slice(&rates[degrees..]);
        let all = accelerations.iter().chain(matrix.iter());
        if !all.clone().all(|number| number.is_finite()) {
            return Err(Error::Request(
                "an acceleration is no finite number".to_owned(),
            ));
        }
        let sizes = DVector::from_fn(states - degrees, |row, _| {
            let by_state = (0..states).map(|k| (by_state[(degrees + row, k)] * at.state[k]).abs());
            let by_inputs =
                (0..at.inputs.len()).map(|k| (by_inputs[(degrees + row, k)] * at.inputs[k]).abs());
            by_state
                .chain(by_inputs)
                .fold(accelerations[row].abs(), f64::max)
        });
        Ok(Linear {
            accelerations,
            matrix,
            sizes,
        })
    }

    /// Part of a step from a point.
    fn moved(&self, at: &OperatingPoint, step: &DVector<f64>, part: f64) -> OperatingPoint {
        let mut moved = at.clone();
        for (setting, change) in self.free.iter().zip(step) {
            match *setting {
                Setting::State(place) => moved.state[place] += part * change,
                Setting::Input(place) => moved.inputs[place] += part * change,
                Setting::Time => {}
            }
        }
        moved
    }

    fn depends_on_time(&mut self, at: &OperatingPoint) -> bool {
        let mut by_time = vec![0.0; at.state.len()];
        self.jacobians
            .evaluate(Jacobian::RatesByTime, at.point(), &mut by_time);
        by_time.iter().any(|rate| *rate != 0.0)
    }

    fn not_found(&self, at: &OperatingPoint, here: &Linear) -> Error {
        let worst = here
            .relative()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let states = self.instance.model().state_names();
        let (name, left) = worst.map_or(("", 0.0), |(row, _)| {
            (&*states[row], here.accelerations[row])
        });
        let reason = format!(
            "no equilibrium was found near the initial state: where the search ended, at {name} = {:e}, {name} \
             is still accelerated by {left:e} (SI); begin nearer to one with --fix, or fix inputs that hold it",
            states
                .iter()
                .position(|known| known == name)
                .map_or(0.0, |place| at.state[place])
        );
        Error::Stopped { t: None, reason }
    }
}

impl Linear {
    /// The smallest change of what is free that makes the linearised accelerations least.
    fn step(&self) -> DVector<f64> {
        // Rows and columns of like sizes, so that units do not decide what is small.
        let rows = self.row_sizes();
        let equal = DMatrix::from_fn(self.matrix.nrows(), self.matrix.ncols(), |row, column| {
            self.matrix[(row, column)] / rows[row]
        });
        let wanted = -self.accelerations.component_div(&rows);
        if equal.is_empty() {
            return DVector::zeros(self.matrix.ncols());
        }
        let decomposed = equal.svd(true, true);
        let least = RANK * decomposed.singular_values.amax();
        let step = decomposed.solve(&wanted, least);
        step.unwrap_or_else(|_| DVector::zeros(self.matrix.ncols()))
    }

    fn row_sizes(&self) -> DVector<f64> {
        let sizes = self.matrix.row_iter().map(|row| row.amax());
        DVector::from_iterator(
            self.matrix.nrows(),
            sizes.map(|size| if size > 0.0 { size } else { 1.0 }),
        )
    }

    /// The sum of the squares of the accelerations, each in parts of its size.
    fn measured_by(&self, sizes: &DVector<f64>) -> f64 {
        let parts = self.accelerations.iter().zip(sizes);
        let square =
            |(value, size): (&f64, &f64)| (value / if *size > 0.0 { *size } else { 1.0 }).powi(2);
        parts.map(square).sum()
    }

    fn relative(&self) -> impl Iterator<Item = f64> {
        let parts = self.accelerations.iter().zip(&self.sizes);
        parts.map(|(value, size)| {
            if *value == 0.0 {
                0.0
            } else {
                value.abs() / size
            }
        })
    }

    fn is_zero(&self) -> bool {
        self.relative().all(|part| part <= ZERO)
    }
}

#[cfg(test)]
mod tests {
    use crate::{CompiledModel, Error, Orders};

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

    fn model() -> CompiledModel {
        CompiledModel::of_text("pendulum.toml", PENDULUM, Orders::Declared).expect("a model")
    }

    #[test]
    fn the_nearest_equilibrium_is_found() {
        let model = model();
        let run = model.at_declared().expect("an instance");
        let found = run.equilibrium(&[]).expect("an equilibrium");
        assert!(
            (found.at.state[0] - std::f64::consts::PI).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.at.inputs, [0.0]);
        let held = run.equilibrium(&[("theta", 0.3)]).expect("a torque");
        let right = 2.0 * 9.81 * 0.5 * 0.3_f64.sin();
        assert!(
            (held.at.inputs[0] - right).abs() < 1e-12 * right,
            "{held:?}"
        );
        let loaded = run.equilibrium(&[("u", 5.0)]).expect("an angle");
        assert!(
            (loaded.at.state[0].sin() * 9.81 - 5.0).abs() < 1e-11,
            "{loaded:?}"
        );
    }

    #[test]
    fn where_there_is_none_it_is_said() {
        let model = model();
        let run = model.at_declared().expect("an instance");
        for fixed in [&[("u", 20.0)][..], &[("theta", 0.3), ("u", 0.0)]] {
            let found = run.equilibrium(fixed);
            assert!(
                matches!(found, Err(Error::Stopped { .. })),
                "{fixed:?}: {found:?}"
            );
        }
        for fixed in [("theta_dot", 1.0), ("thta", 0.0), ("u", f64::NAN)] {
            let refused = run.equilibrium(&[fixed]);
            assert!(
                matches!(refused, Err(Error::Request(_))),
                "{fixed:?}: {refused:?}"
            );
        }
    }
}
