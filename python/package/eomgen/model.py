"""A compiled model: calls on one state or on arrays of them, simulation, linearisation, equilibria."""

from __future__ import annotations

import os
import warnings
from types import MappingProxyType
from typing import Any, List, Mapping, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments, _native
from ._arguments import Call
from .equilibrium import Equilibrium
from .linearisation import Linearisation
from .trajectory import Trajectory, simulated

__all__ = ["Model", "SpecificationWarning", "load"]

Array = NDArray[np.float64]

# What stands for the file of a text in messages.
TEXT = "<text>"


class SpecificationWarning(UserWarning):
    """Something in a specification may not be as it was meant."""


def load(path_or_text: Union[str, "os.PathLike[str]"], order: Optional[int] = None) -> "Model":
    """Reads, checks, derives and compiles a specification.

    path_or_text: a file's path, or the text itself, which is what contains a line break.
    order: the number of modes of every field; None for what the specification says.

    Raises SpecificationError with all that is wrong, each at its place.
    """
    if order is not None:
        order = _arguments.whole("order", order, _native.MAX_ORDER)
    given = os.fspath(path_or_text)
    if not isinstance(given, str):
        raise TypeError(f"expected a path or a text, not {type(given).__name__}")
    if "\n" in given or "\r" in given:
        native = _native.Model.of_text(TEXT, given, order)
    else:
        native = _native.Model.of_file(given, order)
    if native.warnings is not None:
        warnings.warn(native.warnings, SpecificationWarning, stacklevel=2)
    return Model(native)


class Model:
    """A compiled model at one set of parameter values; made by `load`. It does not change, and
    threads may share it.

    All numbers are in SI units, but `parameters`, which are in their declared units. The state is
    the coordinates, the modes, then the rates of both, as `states` lists them.
    """

    def __init__(self, native: _native.Model):
        self._native = native
        self._states: Tuple[str, ...] = tuple(name for name, _ in native.states)
        self._inputs: Tuple[str, ...] = tuple(name for name, _ in native.inputs)
        self._observables: Tuple[str, ...] = tuple(name for name, _ in native.observables)

    @property
    def name(self) -> str:
        """The model's name."""
        return self._native.name

    @property
    def states(self) -> Tuple[str, ...]:
        """The names of the states, in their order."""
        return self._states

    @property
    def inputs(self) -> Tuple[str, ...]:
        """The names of the inputs, in their order."""
        return self._inputs

    @property
    def observable_names(self) -> Tuple[str, ...]:
        """The names of the observables, `energy` (J) and `power` (W) last."""
        return self._observables

    @property
    def parameters(self) -> Mapping[str, float]:
        """Names to values, in the units that the specification declares; `with_parameters` sets them."""
        return MappingProxyType({name: value for name, value, _ in self._native.parameters})

    @property
    def independent_parameters(self) -> Tuple[str, ...]:
        """The parameters that are given by a number: the columns of `jacobian(..., by="parameters")`."""
        return tuple(self._native.independent_parameters)

    @property
    def units(self) -> Mapping[str, str]:
        """The units of parameters, states, inputs and observables, by name."""
        named = [(name, unit) for name, _, unit in self._native.parameters]
        native = self._native
        return MappingProxyType(dict(named + native.states + native.inputs + native.observables))

    @property
    def orders(self) -> Tuple[int, ...]:
        """The number of modes of each field."""
        return tuple(self._native.orders)

    @property
    def initial(self) -> Array:
        """The initial state that the specification gives, (states,)."""
        return np.array(self._native.initial)

    @property
    def text(self) -> str:
        """The specification's text, with the parameters that were set."""
        return self._native.text

    def with_parameters(self, /, **values: float) -> "Model":
        """The model with some parameters set, each in its declared unit; what depends on them
        follows. A parameter that is given by an expression has the number in its place.

        Raises SpecificationError for an unknown name or a value that is not admissible.
        """
        settings = [(name, _number(name, value)) for name, value in values.items()]
        return Model(self._native.with_parameters(settings))

    def rates(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Array:
        """The rates of the state.

        t: s, one time or (n,). x: (states,) or (n, states). u: (inputs,) or (n, inputs), or names
        to numbers; 0 where not given. Returns an array of the shape of x.
        """
        call = self._call(t, x, u)
        rates = np.empty_like(call.x)
        _native.rates(self._native, call.t, call.x, call.u, rates)
        return rates[0] if call.single else rates

    def observables(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Array:
        """The observables, in the order of `observable_names`: (observables,) or (n, observables).
        Arguments as for `rates`.
        """
        call = self._call(t, x, u)
        observables = np.empty((len(call.x), len(self._observables)))
        _native.observables(self._native, call.t, call.x, call.u, observables)
        return observables[0] if call.single else observables

    def energy(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Any:
        """Kinetic and potential energy, J: a number or (n,). Arguments as for `rates`."""
        return self.observables(t, x, u)[..., self._observables.index("energy")]

    def jacobian(
        self, t: ArrayLike, x: ArrayLike, u: Any = None, *, by: str = "state"
    ) -> Array:
        """The derivatives of the rates by the state, the inputs, the independent parameters (these
        in SI) or the time: (states, columns) or (n, states, columns). On a switching surface they are
        one-sided.

        by: "state", "inputs", "parameters" or "time"; the others as for `rates`.
        """
        columns = {
            "state": len(self._states),
            "inputs": len(self._inputs),
            "parameters": len(self._native.independent_parameters),
            "time": 1,
        }
        if by not in columns:
            raise ValueError(f'by = {by!r}: expected "state", "inputs", "parameters" or "time"')
        call = self._call(t, x, u)
        shape = (len(call.x), len(self._states), columns[by])
        found = np.empty((shape[0], shape[1] * shape[2]))
        _native.jacobian(self._native, f"rates_by_{by}", call.t, call.x, call.u, found)
        found = found.reshape(shape)
        return found[0] if call.single else found

    def linearise(
        self, t: float = 0.0, x: Any = None, u: Any = None
    ) -> Linearisation:
        """A, B, C and D about a point.

        t: s. x: (states,), or names to numbers, the others as the specification's initial state,
        which is the default. u: (inputs,), or names to numbers; 0 where not given.
        """
        time = _arguments.real("t", t)
        call = self._call(time, self.state(x), u)
        state, inputs = call.x[0], call.u[0]
        found = _native.linearise(self._native, time, state, inputs)
        return Linearisation(self._states, self._inputs, self._observables, state, inputs, *found)

    def trim(
        self,
        x: Any = None,
        u: Any = None,
        *,
        fixed: Optional[Mapping[str, float]] = None,
        t: float = 0.0,
    ) -> Equilibrium:
        """The equilibrium nearest to a start, at rest or running steadily.

        x: (states,), or names to numbers, the others as the specification's initial state, which is the
        default. u: (inputs,), or names to numbers; 0 where not given, and prescribed motion in the middle of
        its range. fixed: names of states and inputs to the numbers that they keep; if it holds a state, the
        inputs that are not fixed are solved for: they hold the machine there. t: s.

        Raises ValueError for an unknown name, a number that is not finite or outside its range, and a rate
        that cannot be constant; SimulationError if no equilibrium is found.
        """
        start = self._named("state", self._states, x) + self._named("input", self._inputs, u)
        start.append(("t", _arguments.real("t", t)))
        kept = self._named("state or input", self._states + self._inputs, fixed or {})
        found = _native.trim(self._native, start, kept)
        return Equilibrium(self._states, self._inputs, *found)

    @staticmethod
    def _named(kind: str, names: Tuple[str, ...], given: Any) -> List[Tuple[str, float]]:
        # What is not given is left to the model.
        if given is None:
            return []
        if not isinstance(given, Mapping):
            values = _arguments.numbers(f"the {kind}", given)
            if values.shape != (len(names),):
                raise ValueError(
                    f"the {kind} has the shape {values.shape}: expected ({len(names)},), "
                    f"for {', '.join(names) or '(none)'}"
                )
            given = dict(zip(names, values))
        _arguments.check_names(kind, given, names)
        return [(name, _arguments.real(name, value)) for name, value in given.items()]

    def simulate(
        self,
        until: float,
        sample: Optional[float] = None,
        solver: str = "auto",
        initial: Any = None,
        inputs: Any = None,
        *,
        tolerance: float = 1e-9,
        progress: Any = None,
        start: float = 0.0,
        max_step: Optional[float] = None,
        breaks: Any = None,
    ) -> Trajectory:
        """The motion from t = `start`.

        until: its end, s. sample: the time from sample to sample, s; a thousandth of the whole if
        None. solver: "auto", "exact" (for models that are linear between their switches), "rk",
        "adams" or "radau" (for stiff models); tolerance: the relative one of all but "exact";
        max_step: the longest step of these, s, for inputs with pulses that longer steps may miss.

        initial: (states,), or names to numbers; the others as the specification says.

        inputs: names to a number, to an array with a number per sample, to an expression such as
        "0.3*sin(50*t)" with t in s, or to a function of t (s). Arrays are held from their sample
        to the next; arrays for prescribed motion follow a cubic spline, which gives its rates.
        Functions are called at the times that the solver needs; times at which one jumps are
        `breaks`. For prescribed motion a function returns (s, s', s''). Inputs that are not given
        are 0.

        progress: called with the part that is done, 0 to 1, about ten times a second; by default a
        line is shown in terminals and notebooks once it takes longer than two seconds.

        Warns if the energy changes without work or if bodies overlap.

        Raises SimulationError where the motion cannot be followed; its `trajectory` holds the
        samples until there. An exception of an input function is its cause. Ctrl-C stops it.
        """
        span = (start, until, sample)
        settings = (solver, tolerance, max_step)
        return simulated(self, span, settings, self.state(initial), (inputs, breaks), progress)

    def state(self, values: Any = None) -> Array:
        """A whole state, (states,): the initial one of the specification with some names set to
        other numbers, or the array that is given.
        """
        if values is None:
            return self.initial
        if isinstance(values, Mapping):
            _arguments.check_names("state", values, self._states)
            state = self.initial
            for name, value in values.items():
                state[self._states.index(name)] = _arguments.real(name, value)
            return state
        state = _arguments.numbers("the state", values)
        if state.shape != (len(self._states),):
            raise ValueError(
                f"the state has the shape {state.shape}: expected ({len(self._states)},), "
                f"for {', '.join(self._states)}"
            )
        return state

    def to_casadi(self, name: Optional[str] = None) -> Any:
        """The rates as a CasADi function rates(t, x, u), with its exact Jacobian. Keep it as long
        as expressions that use it: the model is called back from CasADi. Needs the package `casadi`.
        """
        from .casadi import Rates

        return Rates(self, name or self.name)

    def _call(self, t: Any, x: Any, u: Any) -> Call:
        return Call(self._states, self._inputs, t, x, u)

    def __reduce__(self) -> Any:
        # To other processes goes what it is made from.
        return load, (self.text, self._native.order)

    def __repr__(self) -> str:
        title = f": {self._native.title}" if self._native.title else ""
        order = f", order {', '.join(map(str, self.orders))}" if self.orders else ""
        counts = f"{len(self._states)} states, {len(self._inputs)} inputs"
        return f"<eomgen.Model {self.name}{title}; {counts}{order}>"

    def _repr_html_(self) -> str:
        return f"<div>{_native.equations(self._native)}</div>"


def _number(name: str, given: Any) -> float:
    # What is not finite is refused where the parameter is known, with its name and bounds.
    array = _arguments.numbers(name, given)
    if array.size != 1:
        raise TypeError(f"{name}: expected one number, not an array of shape {array.shape}")
    return float(array.reshape(()))
