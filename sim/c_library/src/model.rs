//! Models and motions behind the pointers of the interface.

use std::ffi::CString;
use std::sync::Arc;

use eomgen_compiled_model::{
    CompiledModel, Error, Instance, Orders, RecordedMotion, Request, SampleWeights, Solver,
};
use eomgen_sim::inputs::HeldInputs;

/// List of a model: names and the values of the specification, SI.
pub struct List {
    /// Names for C.
    pub names: Vec<CString>,
    /// Values, SI.
    pub values: Vec<f64>,
}

impl List {
    fn new(names: Vec<String>, values: Vec<f64>) -> Self {
        // Names of a specification are identifiers, without a zero.
        let names = names
            .into_iter()
            .map(|name| CString::new(name).unwrap_or_default());
        Self {
            names: names.collect(),
            values,
        }
    }
}

/// Derived specification with the names of its lists.
pub struct Model {
    compiled: Arc<CompiledModel>,
    /// States, parameters and inputs.
    pub lists: [List; 3],
}

/// Motion with its steps, for gradients.
pub struct Motion {
    recorded: RecordedMotion<'static>,
    samples: usize,
    states: usize,
}

/// Gradient of a number with respect to initial state, parameters and inputs, SI.
pub struct Gradient {
    /// Derivatives with respect to the entries of the three lists.
    pub by_list: [Vec<f64>; 3],
}

/// Values of a motion; `None` for those of the specification.
pub struct Values<'v> {
    /// Parameters, SI.
    pub parameters: Option<&'v [f64]>,
    /// Initial state, SI.
    pub initial: Option<&'v [f64]>,
    /// Constant inputs, SI.
    pub inputs: Option<&'v [f64]>,
}

impl Model {
    /// Reads, checks and derives a specification.
    ///
    /// # Errors
    /// Errors of [`CompiledModel::load`], and parameter values without equations.
    pub fn open(path: &str) -> Result<Self, Error> {
        let compiled = Arc::new(CompiledModel::load(path, Orders::Declared)?);
        let instance = compiled.with_parameters(&[])?;
        let names = compiled.parameter_names();
        let parameters = instance.parameters().to_vec();
        let initial = instance.initial_state().to_vec();
        let inputs = compiled.model().inputs.iter();
        let inputs = inputs.map(|input| input.name.clone()).collect();
        let lists = [
            List::new(compiled.state_names(), initial),
            List::new(names, parameters),
            List::new(inputs, compiled.default_inputs()),
        ];
        Ok(Self { compiled, lists })
    }

    /// Simulates with the Runge-Kutta method and records the steps.
    ///
    /// # Errors
    /// Invalid values, and a motion that stops before the last time.
    pub fn simulate(
        &self,
        values: &Values<'_>,
        times: &[f64],
        tolerance: f64,
    ) -> Result<Motion, Error> {
        let instance = self.instance(values.parameters)?;
        let inputs = match values.inputs {
            Some(inputs) => HeldInputs::constant(inputs.to_vec()),
            None => instance.default_inputs(),
        };
        let request = Request {
            initial: values.initial.unwrap_or(instance.initial_state()),
            times,
            inputs: &inputs,
            solver: Solver::Rk,
            tolerance,
            max_step: f64::INFINITY,
            audit: false,
        };
        let recorded = instance.record_motion(&request, &mut |_| {})?;
        if let Some(stop) = &recorded.motion().early_stop {
            return Err(stop.clone().into());
        }
        Ok(Motion {
            samples: times.len(),
            states: self.lists[0].values.len(),
            recorded,
        })
    }

    /// Returns an instance at parameter values in SI.
    fn instance(&self, parameters: Option<&[f64]>) -> Result<Instance<'static>, Error> {
        let names = self.compiled.parameter_names();
        let declared = &self.compiled.model().parameters;
        let pairs = names.iter().zip(parameters.unwrap_or_default());
        let settings = pairs.map(|(name, value)| {
            let known = declared.iter().find(|known| known.name == *name);
            let value = known.map_or(*value, |known| known.unit.from_si(*value));
            (name.as_str(), value)
        });
        self.compiled
            .share_with_parameters(&settings.collect::<Vec<_>>())
    }
}

impl Motion {
    /// Returns the number of samples and the number of states.
    pub fn shape(&self) -> (usize, usize) {
        (self.samples, self.states)
    }

    /// Returns the states at all samples, row by row.
    pub fn samples(&self) -> Vec<f64> {
        self.recorded.motion().trajectory.states.concat()
    }

    /// Returns the gradient of a number. `weights`: derivatives with respect to the states of all samples, row by row. The
    /// derivatives with respect to the initial state are NaN if friction holds the motion at the start.
    ///
    /// # Errors
    /// Errors of [`RecordedMotion::gradient`].
    pub fn gradient(&self, weights: &[f64]) -> Result<Gradient, Error> {
        let rows = weights.chunks(self.states.max(1)).map(<[f64]>::to_vec);
        let weights = SampleWeights {
            states: rows.collect(),
            observables: Vec::new(),
        };
        let found = self.recorded.gradient(&weights)?;
        let initial = found
            .initial_state
            .unwrap_or_else(|| vec![f64::NAN; self.states]);
        let inputs = found.inputs.into_iter().next().unwrap_or_default();
        Ok(Gradient {
            by_list: [initial, found.parameters, inputs],
        })
    }
}
