//! Value references: time, states, rates, inputs, parameters, observables, event indicators, states of controllers.

use std::ops::Range;

use eomgen_compiled_model::CompiledModel;

/// Variable of a unit, with its index within its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Independent variable.
    Time,
    /// State.
    State(usize),
    /// Derivative of the state with this index.
    Rate(usize),
    /// Input.
    Input(usize),
    /// Independent parameter.
    Parameter(usize),
    /// Observable.
    Observable(usize),
    /// Event indicator.
    Indicator(usize),
    /// State of a controller.
    ControllerState(usize),
}

/// Value references of an FMU's variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of states.
    pub states: usize,
    /// Number of inputs.
    pub inputs: usize,
    /// Number of independent parameters.
    pub parameters: usize,
    /// Number of observables.
    pub observables: usize,
    /// Number of event indicators.
    pub indicators: usize,
    /// Number of states of controllers.
    pub controller_states: usize,
}

/// Returns the variable of one kind with an index.
type VariableOfKind = fn(usize) -> Variable;

impl Layout {
    /// Returns the layout of a model with this number of switching surfaces.
    pub fn new(model: &CompiledModel, surfaces: usize) -> Self {
        let program = model.program();
        Self {
            states: program.states(),
            inputs: program.inputs.len(),
            parameters: program.parameters.len(),
            observables: program.observables.len(),
            indicators: surfaces,
            controller_states: model.model().controller_states().len(),
        }
    }

    /// Returns the number of variables.
    pub fn count(&self) -> usize {
        self.first_controller_state() + self.controller_states
    }

    fn first_input(&self) -> usize {
        1 + 2 * self.states
    }

    fn first_parameter(&self) -> usize {
        self.first_input() + self.inputs
    }

    fn first_observable(&self) -> usize {
        self.first_parameter() + self.parameters
    }

    fn first_indicator(&self) -> usize {
        self.first_observable() + self.observables
    }

    fn first_controller_state(&self) -> usize {
        self.first_indicator() + self.indicators
    }

    /// Returns the variable with a value reference; `None` if there is none.
    pub fn find(&self, reference: usize) -> Option<Variable> {
        let rates = 1 + self.states;
        let kinds: [(Range<usize>, VariableOfKind); 7] = [
            (1..rates, Variable::State),
            (rates..self.first_input(), Variable::Rate),
            (self.first_input()..self.first_parameter(), Variable::Input),
            (
                self.first_parameter()..self.first_observable(),
                Variable::Parameter,
            ),
            (
                self.first_observable()..self.first_indicator(),
                Variable::Observable,
            ),
            (
                self.first_indicator()..self.first_controller_state(),
                Variable::Indicator,
            ),
            (
                self.first_controller_state()..self.count(),
                Variable::ControllerState,
            ),
        ];
        if reference == 0 {
            return Some(Variable::Time);
        }
        let mut kinds = kinds.into_iter();
        let (range, variable) = kinds.find(|(range, _)| range.contains(&reference))?;
        Some(variable(reference - range.start))
    }
}
