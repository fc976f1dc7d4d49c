//! Checked controller of a library.

use std::path::{Path, PathBuf};

use eomgen_compiled_model::{CompiledModel, Sample, SampledController};
use eomgen_model_spec::control::Schedule;

use crate::VERSION;
use crate::interface::{Functions, MissingFunction, RequestedSchedule, open};

/// Reason why a library has no controller for a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct LibraryError {
    /// Path of the library.
    pub path: PathBuf,
    /// Cause and remedy.
    pub reason: String,
}

/// Controller in a shared library.
pub struct ControllerLibrary {
    functions: Functions,
    schedule: Schedule,
    driven: Vec<usize>,
    /// Names of the driven inputs.
    inputs: Vec<String>,
    path: PathBuf,
}

impl ControllerLibrary {
    /// Opens a library and starts its controller for a model.
    ///
    /// # Errors
    /// A file that is no library, a missing function, another version of the interface, a controller that rejects the
    /// model, and inadmissible times or driven inputs.
    pub fn open(path: &Path, model: &CompiledModel) -> Result<Self, LibraryError> {
        let refused = |reason: String| LibraryError {
            path: path.to_owned(),
            reason,
        };
        // For a name without a folder, the loader would search other folders.
        let file = path.canonicalize();
        let file =
            file.map_err(|error| refused(format!("the controller cannot be read: {error}")))?;
        let (functions, version) = open(&file).map_err(|MissingFunction(name, message)| {
            refused(match name {
                "" => format!("the controller is not a library for this platform: {message}"),
                name => format!("the controller has no function `{name}`; see eomgen_controller.h"),
            })
        })?;
        if version != VERSION {
            return Err(refused(format!(
                "the controller has version {version} of the interface, expected {VERSION}: compile it with the \
                 current eomgen_controller.h"
            )));
        }
        let inputs = model.model().inputs.iter();
        let inputs: Vec<String> = inputs.map(|input| input.name.clone()).collect();
        let (states, observables) = (model.state_names(), model.observable_names());
        let (status, requested) = functions.start([&states, &observables, &inputs]);
        if status != 0 {
            return Err(refused(format!(
                "the controller rejects the model `{}`: eomgen_controller_start returned {status}",
                model.model().name
            )));
        }
        let driven = check_driven(&requested, model, &inputs).map_err(refused)?;
        Ok(Self {
            functions,
            schedule: check_times(requested.times).map_err(refused)?,
            inputs: driven.iter().map(|place| inputs[*place].clone()).collect(),
            driven,
            path: path.to_owned(),
        })
    }

    /// Returns the names of the driven inputs.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }
}

fn check_times([period, offset, delay]: [f64; 3]) -> Result<Schedule, String> {
    if !(period.is_finite() && period > 0.0) {
        return Err(format!(
            "the period of the controller is {period} s: expected a time above 0"
        ));
    }
    for (what, time) in [("offset", offset), ("delay", delay)] {
        if !(time.is_finite() && time >= 0.0) {
            return Err(format!(
                "the {what} of the controller is {time} s: expected a time of 0 or more"
            ));
        }
    }
    Ok(Schedule {
        period,
        offset,
        delay,
    })
}

fn check_driven(
    requested: &RequestedSchedule,
    model: &CompiledModel,
    inputs: &[String],
) -> Result<Vec<usize>, String> {
    let count = inputs.len();
    if requested.outputs == 0 {
        return Err(
            "`outputs` of the controller is 0: the number of driven inputs must be set".to_owned(),
        );
    }
    let Some(driven) = requested.driven.get(..requested.outputs) else {
        return Err(format!(
            "the controller drives {} inputs, but the model has {count}",
            requested.outputs
        ));
    };
    let mut places = Vec::with_capacity(driven.len());
    for index in driven {
        let place = *index as usize;
        let Some(name) = inputs.get(place) else {
            return Err(format!(
                "the controller drives the input with index {index}, but the model has {count} inputs"
            ));
        };
        if places.contains(&place) {
            return Err(format!("the controller drives the input `{name}` twice"));
        }
        if model.model().inputs[place].rate.is_some()
            || model.model().inputs[place].rate_of.is_some()
        {
            return Err(format!(
                "the controller drives `{name}`, which is prescribed motion: outputs of controllers are held between \
                 samples: they jump and have no rates"
            ));
        }
        places.push(place);
    }
    Ok(places)
}

impl SampledController for ControllerLibrary {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn driven_inputs(&self) -> &[usize] {
        &self.driven
    }

    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String> {
        let own = self.path.display();
        outputs.fill(f64::NAN);
        let status = self
            .functions
            .sample(at.t, [at.state, at.observables, at.inputs], outputs);
        if status != 0 {
            return Err(format!("the controller {own} stopped with status {status}"));
        }
        let mut named = outputs.iter().zip(&self.inputs);
        match named.find(|(value, _)| !value.is_finite()) {
            None => Ok(()),
            Some((value, name)) => Err(format!(
                "the output `{name}` of the controller {own} is {value}"
            )),
        }
    }
}
