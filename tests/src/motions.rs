//! Generated models and their simulation with the exact solver and with the general solvers. The two kinds of solvers
//! share only the derived equations.

use std::cell::RefCell;
use std::fmt::Write;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::{
    CompiledModel, DrivenModel, Motion, Orders, Request, SidedModel, Solver,
};
use eomgen_model_spec::check;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, Settings, SolveError, Trajectory, simulate};
use eomgen_sim::piecewise_linear::{ExactError, PiecewiseLinear, Propagator};

use crate::models::variant;

/// Builder of a specification, in SI units.
#[derive(Clone, Debug, Default)]
pub struct Spec {
    sections: [String; 7],
    count: usize,
}

const SECTIONS: [&str; 7] = [
    "parameters",
    "coordinates",
    "inputs",
    "kinetic",
    "potential",
    "forces",
    "states",
];

impl Spec {
    /// Adds a parameter with value and unit.
    pub fn parameter(self, name: &str, value: f64, unit: &str) -> Self {
        self.entry(
            0,
            &format!("{name} = {{ value = {value:e}, unit = \"{unit}\" }}"),
        )
    }

    /// Adds a coordinate in m with its initial position, m, and rate, m/s.
    pub fn coordinate(self, name: &str, [place, rate]: [f64; 2]) -> Self {
        let initial = format!("initial = {place:e}, initial_rate = {rate:e}");
        self.entry(1, &format!("{name} = {{ unit = \"m\", {initial} }}"))
    }

    /// Adds an input.
    pub fn input(self, name: &str, unit: &str) -> Self {
        self.entry(2, &format!("{name} = {{ unit = \"{unit}\" }}"))
    }

    /// Adds a kinetic energy.
    pub fn kinetic(mut self, energy: &str) -> Self {
        self.count += 1;
        let name = self.count;
        self.entry(3, &format!("T_{name} = \"{energy}\""))
    }

    /// Adds a potential energy.
    pub fn potential(mut self, energy: &str) -> Self {
        self.count += 1;
        let name = self.count;
        self.entry(4, &format!("V_{name} = \"{energy}\""))
    }

    /// Adds a force on a coordinate.
    pub fn force(mut self, on: &str, force: &str) -> Self {
        self.count += 1;
        let name = self.count;
        self.entry(
            5,
            &format!("Q_{name} = {{ on = \"{on}\", value = \"{force}\" }}"),
        )
    }

    /// Adds a first-order state in m.
    pub fn state(self, name: &str, rate: &str) -> Self {
        self.entry(
            6,
            &format!("{name} = {{ unit = \"m\", rate = \"{rate}\" }}"),
        )
    }

    fn entry(mut self, section: usize, line: &str) -> Self {
        self.sections[section].push_str(line);
        self.sections[section].push('\n');
        self
    }

    /// Returns the specification as text.
    pub fn text(&self) -> String {
        let mut text = "[model]\nname = \"made\"\ntitle = \"Made for a test\"\n".to_owned();
        for (name, lines) in SECTIONS.iter().zip(&self.sections) {
            if !lines.is_empty() {
                write!(text, "[{name}]\n{lines}").expect("text can be written");
            }
        }
        text
    }

    /// Returns the model.
    pub fn model(&self) -> Model {
        let text = self.text();
        match check(Source::new("made.toml", text.as_str())) {
            Ok(checked) => checked.model,
            Err(found) => panic!("{text}\n{}", found.render(false)),
        }
    }
}

/// Model of one order with its initial state and inputs.
pub struct TestMotion {
    /// Model.
    pub model: Model,
    /// Order of every field.
    pub order: usize,
    /// Initial state.
    pub initial: Vec<f64>,
    /// Inputs held between samples.
    pub inputs: HeldInputs,
}

impl TestMotion {
    /// Starts the model from its declared initial state, with zero inputs.
    pub fn new(model: Model, order: usize) -> Self {
        let orders = vec![order; model.fields.len()];
        let initial = model.initial_state(&orders).expect("an initial state");
        let inputs = HeldInputs::zero(model.inputs.len());
        Self {
            model,
            order,
            initial,
            inputs,
        }
    }

    /// Replaces the initial state.
    pub fn with_initial_state(mut self, initial: &[f64]) -> Self {
        self.initial = initial.to_vec();
        self
    }

    /// Returns the exact propagator, or the reason why there is none.
    pub fn propagator(&self) -> Result<Propagator, ExactError> {
        let orders = vec![self.order; self.model.fields.len()];
        PiecewiseLinear::derive(&self.model, &orders)?.propagator_for_model(&self.model)
    }

    /// Simulates a time span, s, with the exact solver.
    pub fn try_simulate_exactly(
        &self,
        span: (f64, f64),
        times: &[f64],
    ) -> Result<Trajectory, ExactError> {
        let mut propagator = self.propagator()?;
        propagator.simulate(&self.initial, span, times, &self.inputs, &mut |_| {})
    }

    /// Simulates like [`try_simulate_exactly`](Self::try_simulate_exactly); asserts success and a row for every time.
    pub fn simulate_exactly(&self, span: (f64, f64), times: &[f64]) -> Trajectory {
        let trajectory = self
            .try_simulate_exactly(span, times)
            .expect("an exact motion");
        assert_eq!(trajectory.times, times, "every sample is there");
        trajectory
    }

    /// Returns the model with its inputs for the general solvers.
    pub fn driven(&self) -> DrivenModel<RefCell<Evaluator>, &HeldInputs> {
        let evaluator = variant(&self.model, self.order).evaluator;
        assert!(evaluator.pivots_are_positive());
        let tolerance = Settings::default().tolerance;
        DrivenModel::new(RefCell::new(evaluator), &self.inputs)
            .with_sides(self.sided_model(), tolerance)
    }

    /// Returns the model with prescribed sides of its switching surfaces, at the declared parameters.
    fn sided_model(&self) -> Option<SidedModel> {
        let orders = Orders::Uniform(self.order);
        let compiled = CompiledModel::derive(self.model.clone(), orders).expect("the equations");
        let values = self.model.parameter_values().expect("values");
        let place = |name: &String| self.model.parameters.iter().position(|p| p.name == *name);
        let names = compiled.parameter_names();
        let values: Vec<f64> = names
            .iter()
            .map(|name| values[place(name).expect("a parameter")])
            .collect();
        compiled.sided_model(&values).expect("sides")
    }

    /// Simulates with the Runge-Kutta method of the general solvers.
    pub fn simulate_generally(
        &self,
        span: (f64, f64),
        times: &[f64],
        tolerance: f64,
    ) -> Result<Trajectory, SolveError> {
        self.simulate_by_method(Method::DormandPrince853, span, times, tolerance)
    }

    /// Simulates with the given method of the general solvers.
    pub fn simulate_by_method(
        &self,
        method: Method,
        span: (f64, f64),
        times: &[f64],
        tolerance: f64,
    ) -> Result<Trajectory, SolveError> {
        let settings = Settings {
            method,
            max_steps: 20_000,
            ..Settings::with_tolerance(tolerance)
        };
        let driven = self.driven();
        simulate(&driven, &self.initial, span, times, &settings, &mut |_| {})
    }

    /// Returns the energies at these times and states, in J.
    pub fn energies(&self, times: &[f64], states: &[Vec<f64>]) -> Vec<f64> {
        let mut evaluator = variant(&self.model, self.order).evaluator;
        let mut values = vec![0.0; evaluator.program().observables.len()];
        let pairs = times.iter().zip(states);
        let energy = |(&t, state): (&f64, &Vec<f64>)| {
            let inputs = &self.inputs.evaluate(t);
            evaluator.observables(Point { t, state, inputs }, &mut values);
            values[values.len() - 2]
        };
        pairs.map(energy).collect()
    }
}

/// Simulates a machine with declared initial state, inputs and parameters. `settings` are the relative tolerance and
/// the longest step (s). The solver may stop early.
pub fn simulate_declared(
    text: &str,
    times: &[f64],
    solver: Solver,
    (tolerance, max_step): (f64, f64),
) -> Motion {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let run = model.with_declared_parameters().expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times,
        inputs: &run.default_inputs(),
        solver,
        tolerance,
        max_step,
        audit: false,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    motion.unwrap_or_else(|error| panic!("{solver}: {error}\n{text}"))
}

/// Simulates like [`simulate_declared`]; asserts that the solver reaches the last time.
pub fn simulate_to_end(text: &str, times: &[f64], solver: Solver, settings: (f64, f64)) -> Motion {
    let motion = simulate_declared(text, times, solver, settings).into_complete();
    motion.unwrap_or_else(|error| panic!("{solver}: {error}\n{text}"))
}

/// Returns the ends of `count` equal steps from 0 to `until`, both included.
pub fn grid(until: f64, count: usize) -> Vec<f64> {
    (0..=count)
        .map(|k| until * k as f64 / count as f64)
        .collect()
}

/// Returns the largest difference of two motions at their samples. The difference of a state is relative to its largest
/// magnitude in the second motion, or to `smallest` if this is larger.
pub fn difference(a: &[Vec<f64>], b: &[Vec<f64>], smallest: f64) -> f64 {
    assert_eq!(a.len(), b.len(), "samples");
    let states = b.first().map_or(0, Vec::len);
    let worst = (0..states).map(|state| {
        let size = b.iter().fold(smallest, |size, y| size.max(y[state].abs()));
        let deviations = a.iter().zip(b).map(|(a, b)| (a[state] - b[state]).abs());
        // A NaN counts as an infinite difference.
        deviations.fold(0.0, |worst: f64, d| if d <= worst { worst } else { d }) / size
    });
    worst.fold(0.0, |a: f64, b| if b <= a { a } else { b })
}
