"""Simulations that continue over several calls."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, List, Mapping, Optional

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native
from .trajectory import Event, solver_settings

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]


class Simulation:
    """Simulation that continues over several calls, created by `Model.simulation`. Only one thread may use it.

    >>> s = m.simulation(state={"theta": 0.1})
    >>> while s.t < 2:
    ...     s.set_inputs({"torque": -0.5 * s["theta_dot"]})
    ...     s.advance(s.t + 1e-3)

    Inputs are held until `set_inputs` changes them. Without a change the solver keeps its steps, so many short calls give
    the same motion as one long call.

    Controllers of the specification run. The start and each `advance` include the samples at the current time, so
    inputs and states that are set at a sample act after it.
    """

    def __init__(
        self,
        model: "Model",
        start: float,
        state: Array,
        inputs: Any,
        solver: str,
        tolerance: float,
        max_step: Optional[float],
    ):
        self._model = model
        settings = solver_settings(solver, tolerance, max_step)
        start = _arguments.real("start", start, "a time in s")
        _arguments.require_finite("state", model.states, state)
        values = np.zeros(len(model.inputs))
        values = values if inputs is None else self._with(values, inputs)
        self._native = _native.Simulation(model._native, start, state, values, settings)
        self._warn_of_moved_state(4)

    def _warn_of_moved_state(self, level: int) -> None:
        moved = self._native.initial_changes
        if moved is not None:
            warnings.warn(moved, stacklevel=level)

    def _with(self, values: Array, inputs: Any) -> Array:
        names = self._model.inputs
        driven = self._model._native.controlled_inputs
        if isinstance(inputs, Mapping):
            _arguments.check_names("input", inputs, names)
            values = values.copy()
            for name, value in inputs.items():
                if name in driven:
                    raise ValueError(f"the input {name} is driven by a controller of the specification")
                values[names.index(name)] = _arguments.real(f"the input {name}", value)
            return values
        expected = "an array of numbers, or a mapping of names to numbers"
        given = _arguments.numbers("inputs", inputs, expected).reshape(-1)
        if len(given) != len(names):
            raise ValueError(
                f"inputs has {len(given)} numbers: expected {len(names)}, for {', '.join(names) or '(none)'}"
            )
        _arguments.require_finite("input", names, given)
        for name, before, value in zip(names, values, given):
            if name in driven and value != before:
                raise ValueError(f"the input {name} is driven by a controller of the specification")
        return given

    @property
    def t(self) -> float:
        """Current time, s."""
        return self._native.t

    @property
    def state(self) -> Array:
        """State at the current time, (states,)."""
        return self._native.state

    @property
    def inputs(self) -> Array:
        """Inputs from the current time on, (inputs,)."""
        return self._native.inputs

    @property
    def observables(self) -> Array:
        """Observables at the current time, (observables,)."""
        return self._native.observables()

    @property
    def controller_states(self) -> Array:
        """States of the controllers of the specification, after the samples at the current time."""
        return self._native.controller_states

    @property
    def solver(self) -> str:
        """Name of the solver in use."""
        return self._native.solver

    def __getitem__(self, name: str) -> float:
        if name in self._model.observable_names:
            return float(self.observables[self._model.observable_names.index(name)])
        if name in self._model.states:
            return float(self.state[self._model.states.index(name)])
        sampled = tuple(self._native.controller_state_names)
        if name in sampled:
            return float(self.controller_states[sampled.index(name)])
        names = self._model.states + self._model.observable_names + sampled
        raise KeyError(_arguments.unknown("state or observable", name, names))

    def advance(self, until: float) -> None:
        """Continues to the time `until`, s.

        Raises SimulationError if the solver stops early; `t` and `state` are then those of the stop. After Ctrl-C the
        simulation cannot continue.
        """
        self._native.advance(_arguments.number("until", until, "a time in s"))

    def set_inputs(self, inputs: Any) -> None:
        """Changes inputs from the current time on: (inputs,), or a mapping of names to numbers; other inputs keep their
        values. A controller of the specification keeps the inputs that it drives."""
        self._native.set_inputs(self._with(self.inputs, inputs))

    def set_state(self, state: Any) -> None:
        """Continues from another state: (states,), or a mapping of names to numbers; other states keep their values.
        Controllers keep their states. A state that violates the constraints is projected onto them, with a warning."""
        if isinstance(state, Mapping):
            names = self._model.states
            _arguments.check_names("state", state, names)
            values = self.state.copy()
            for name, value in state.items():
                values[names.index(name)] = _arguments.real(f"the state {name}", value)
            state = values
        if state is None:
            raise TypeError(_arguments.rejected("state", state, "an array, or a mapping of names to numbers"))
        given = self._model.state(state)
        _arguments.require_finite("state", self._model.states, given)
        self._native.set_state(given)
        self._warn_of_moved_state(3)

    def take_events(self) -> List[Event]:
        """Returns the events since the last call, in order of time."""
        names = self._model.states
        return [Event(*event[:5], dict(zip(names, event[5]))) for event in self._native.take_events()]

    def __repr__(self) -> str:
        return f"<eomgen.Simulation: {self._model.name} at t = {self.t:g} s, solver {self.solver}>"
