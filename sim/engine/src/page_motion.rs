//! A motion whose numbers scripts can read and write.

use eomgen_compiled_model::{
    Error, ExportedCode, ExportedModel, ExportedMotion, InitialChange, SolverOptions,
};
use eomgen_sim::inputs::HeldInputs;

use crate::signals::{SIGNAL_LENGTH, Signal, inputs};

/// Outcome of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Status {
    /// The motion continues.
    Continues = 0,
    /// The motion continues, and the state was projected onto the constraints.
    Moved = 1,
    /// The motion ended or cannot start; see [`PageMotion::reason`].
    Stopped = 2,
}

/// A motion whose numbers scripts can read and write. Scripts write parameters, inputs, signals and the initial
/// state, and then call a function that uses them. State and observables are those at the time reached.
pub struct PageMotion {
    motion: ExportedMotion,
    /// Independent parameters, SI.
    pub parameters: Vec<f64>,
    /// Inputs, SI.
    pub inputs: Vec<f64>,
    /// Numbers that describe the signals, [`SIGNAL_LENGTH`] for each.
    pub signals: Vec<f64>,
    /// State, SI.
    pub state: Vec<f64>,
    /// Observables, SI.
    pub observables: Vec<f64>,
    /// Number of signals that drive the motion; 0 if the inputs are held.
    signal_count: usize,
    reason: Option<String>,
}

impl PageMotion {
    /// Creates a motion of the exported model in `bytes`, with a relative tolerance; `None` if the bytes are damaged.
    pub fn new(bytes: &[u8], tolerance: f64) -> Option<Self> {
        let model = ExportedModel::from_bytes(bytes)?;
        let program = model.program();
        let inputs = program.inputs.len();
        let options = SolverOptions {
            tolerance,
            ..SolverOptions::default()
        };
        Some(Self {
            parameters: program.default_parameters(),
            inputs: vec![0.0; inputs],
            signals: vec![0.0; inputs * SIGNAL_LENGTH],
            state: vec![0.0; program.states()],
            observables: vec![f64::NAN; program.observables.len()],
            signal_count: 0,
            reason: None,
            motion: ExportedMotion::new(model, options),
        })
    }

    /// Returns the model.
    pub fn model(&self) -> &ExportedModel {
        self.motion.model()
    }

    /// Sets the machine code of the model's programs.
    pub fn set_code(&mut self, code: ExportedCode) {
        self.motion.set_code(code);
    }

    /// Starts at a time (s) and the state, with the signals of the last [`PageMotion::drive`] or the inputs.
    pub fn start(&mut self, t: f64) -> Status {
        let given = match self.signal_count {
            0 => HeldInputs::constant(self.inputs.clone()),
            _ => {
                let first = inputs(&self.driving_signals(), (t, &self.inputs));
                let before = first.evaluate(t).into_owned();
                inputs(&self.driving_signals(), (t, &before))
            }
        };
        let started = self.motion.start((t, &self.state), given);
        self.settle(started)
    }

    /// Applies the parameters from the time reached on.
    pub fn set_parameters(&mut self) -> Status {
        let set = self.motion.set_parameters(&self.parameters);
        self.settle(set)
    }

    /// Holds the inputs from the time reached on.
    pub fn hold(&mut self) -> Status {
        let t = self.motion.time();
        let before = self.motion.inputs().evaluate(t).into_owned();
        let inputs = HeldInputs::constant(before.clone());
        let inputs = inputs.with_held_step(t, &before, &self.inputs);
        self.signal_count = 0;
        self.follow(|motion| motion.set_inputs(inputs))
    }

    /// Drives the inputs by the first `count` signals from the time reached on.
    pub fn drive(&mut self, count: usize) -> Status {
        self.signal_count = count;
        let t = self.motion.time();
        let before = self.motion.inputs().evaluate(t).into_owned();
        let inputs = inputs(&self.driving_signals(), (t, &before));
        // The start has the values before the first output of a controller.
        for (index, value) in inputs.evaluate(t).iter().enumerate() {
            if !self.motion.drives(index) {
                self.inputs[index] = *value;
            }
        }
        self.follow(|motion| motion.set_inputs(inputs))
    }

    fn driving_signals(&self) -> Vec<Signal> {
        let rows = self.signals.as_chunks::<SIGNAL_LENGTH>().0;
        let rows = rows.iter().take(self.signal_count);
        rows.map(Signal::from_numbers).collect()
    }

    /// Continues to a time, s.
    pub fn advance(&mut self, until: f64) -> Status {
        self.follow(|motion| motion.advance(until))
    }

    /// Returns the time reached, s.
    pub fn time(&self) -> f64 {
        self.motion.time()
    }

    /// Returns the number of events since the start.
    pub fn event_count(&self) -> usize {
        self.motion.event_count()
    }

    /// Returns the reason why the motion ended or cannot start; empty if it continues.
    pub fn reason(&self) -> &str {
        self.reason.as_deref().unwrap_or_default()
    }

    /// Applies `act` to the motion, unless it has ended.
    fn follow(&mut self, act: impl FnOnce(&mut ExportedMotion) -> Result<(), Error>) -> Status {
        let followed = act(&mut self.motion);
        if self.reason.is_some() {
            return Status::Stopped;
        }
        self.settle(followed.map(|()| Vec::new()))
    }

    fn settle(&mut self, outcome: Result<Vec<InitialChange>, Error>) -> Status {
        self.state.copy_from_slice(self.motion.state());
        self.motion.write_observables(&mut self.observables);
        self.reason = outcome.as_ref().err().map(Error::to_string);
        match outcome {
            Ok(changes) if changes.is_empty() => Status::Continues,
            Ok(_) => Status::Moved,
            Err(_) => Status::Stopped,
        }
    }
}
