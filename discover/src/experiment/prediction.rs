//! Response of a fitted model to a proposed input, and check of its limits.

use std::path::PathBuf;

use eomgen_records::dataset::Initial;
use eomgen_records::record::Record;
use eomgen_sim::inputs::HeldInputs;

use crate::experiment::bounds::Bounds;
use crate::experiment::proposal::Proposal;
use crate::fit::fit_result::Fit;
use crate::fit::shooting::{SensorValues, Shooting};
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::simulation::{Motion, Simulation};
use crate::thresholds;

/// Predicted record of an experiment, without noise.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// State at each sample.
    pub states: Vec<Vec<f64>>,
    /// Sensor outputs, as a list with one record.
    pub records: Vec<Record>,
}

/// Reason why an experiment is not proposed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exclusion {
    /// The motion cannot be simulated.
    SimulationFailed,
    /// The named channel or coordinate would violate its limits.
    LeavesLimits(String),
}

/// Model with fixed parameters for the simulation of experiments.
pub struct Predictor<'a> {
    problem: &'a EstimationProblem<'a>,
    /// Model of a fit, with or without an additional effect.
    model: &'a EstimationModel,
    shooting: Shooting<'a>,
    sensors: SensorValues,
    simulation: Simulation<'a>,
    initial: Vec<f64>,
}

impl<'a> Predictor<'a> {
    /// Creates a predictor of a fitted model; `None` if the model cannot be simulated with its
    /// parameters.
    pub fn from_fit(problem: &'a EstimationProblem<'a>, fit: &'a Fit) -> Option<Self> {
        let theta = &fit.train.estimate.theta;
        let values = fit.training_shooting(problem).parameter_values(theta);
        Self::with_model(problem, (fit, theta), &fit.model, &values)
    }

    /// Creates a predictor of another model with given parameters, and with the sensors of a fit.
    pub fn with_model(
        problem: &'a EstimationProblem<'a>,
        (fit, theta): (&'a Fit, &[f64]),
        model: &'a EstimationModel,
        values: &[f64],
    ) -> Option<Self> {
        let initial = match problem.dataset.initial {
            // The recorded initial state may be impossible on the test rig.
            Initial::Estimate => model.initial_state(),
            Initial::Rest | Initial::Values(_) => {
                problem.estimate_first_state(model, &problem.dataset.train[0])
            }
        };
        let shooting = fit.training_shooting(problem);
        Some(Self {
            problem,
            model,
            sensors: shooting.sensor_values(theta),
            shooting,
            simulation: model.create_simulation(values).ok()?,
            initial,
        })
    }

    /// Simulates an experiment.
    ///
    /// # Errors
    ///
    /// The reason why the experiment is not proposed.
    pub fn predict(
        &mut self,
        bounds: &Bounds,
        times: &[f64],
        proposal: &Proposal,
    ) -> Result<Prediction, Exclusion> {
        let count = self.model.specification().inputs.len();
        let inputs = proposal.build_inputs(bounds, times, count);
        let output_times = self.problem.output_rate.times(times);
        (self.simulation).limit_steps(thresholds::MAX_EXPERIMENT_STEPS_PER_SAMPLE * times.len());
        let motion = (self.simulation).simulate_motion(&self.initial, &output_times.times, &inputs);
        let Motion { states, outputs } = motion.map_err(|_| Exclusion::SimulationFailed)?;
        self.check_limits(bounds, &states, &outputs)?;
        let seen = self
            .shooting
            .apply_sensors(&output_times, &self.sensors, &outputs);
        Ok(Prediction {
            records: vec![write_record(times, inputs, &seen, bounds.channels.len())],
            states: output_times.at_samples(states),
        })
    }

    /// Returns an error if a motion violates its limits.
    fn check_limits(
        &self,
        bounds: &Bounds,
        states: &[Vec<f64>],
        outputs: &[f64],
    ) -> Result<(), Exclusion> {
        let channels = &self.problem.dataset.channels;
        for row in outputs.chunks_exact(channels.len()) {
            for ((value, limits), channel) in row.iter().zip(&bounds.channels).zip(channels) {
                if !value.is_finite() {
                    return Err(Exclusion::SimulationFailed);
                }
                if !(limits.low..=limits.high).contains(value) {
                    return Err(Exclusion::LeavesLimits(channel.name.clone()));
                }
            }
        }
        match states.iter().all(|state| self.model.is_admissible(state)) {
            true => Ok(()),
            false => Err(Exclusion::LeavesLimits("a coordinate".to_owned())),
        }
    }
}

/// Creates a record from predicted columns.
fn write_record(times: &[f64], inputs: HeldInputs, seen: &[f64], channels: usize) -> Record {
    let column = |channel: usize| seen.iter().skip(channel).step_by(channels).copied();
    Record {
        is_continued: false,
        name: "experiment".to_owned(),
        path: PathBuf::new(),
        times: times.to_vec(),
        origin: 0.0,
        inputs,
        input_columns: Vec::new(),
        channels: (0..channels)
            .map(|channel| column(channel).collect())
            .collect(),
    }
}
