"""Compiled models: evaluation, simulation, linearisation, equilibria."""

from __future__ import annotations

import json
import os
import warnings
from pathlib import Path
from types import MappingProxyType
from typing import Any, Callable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments, _native
from ._arguments import Call
from ._files import FOLDER, write_all
from .certificate import Certificate
from .comparison import Comparison, compare
from .equilibrium import Equilibrium
from .linearisation import Linearisation
from .modes import Mode
from .simulation import Simulation
from .sweep import Sweep, sweep
from .trajectory import Trajectory, simulate

__all__ = ["Model", "SpecificationWarning", "load"]

Array = NDArray[np.float64]

# File name in messages about a specification given as text.
TEXT = "<text>"

# Values of arguments, in messages.
BY = '"state", "inputs", "parameters" or "time"'
FORMATS = '"text", "latex" or "json"'
EXTRAS = "names of functions to emit, such as [\"jacobians\"]"
DATASET = "the path of a dataset file"


class SpecificationWarning(UserWarning):
    """Warning about a specification that is valid but possibly not as intended."""


def load(path_or_text: Union[str, "os.PathLike[str]"], order: Optional[int] = None) -> "Model":
    """Reads and checks a specification, derives its equations and compiles them.

    path_or_text: path of a file, or the specification itself; a text with a line break is a specification.
    order: number of modes of every field. Default: the orders in the specification.

    Raises SpecificationError, which lists all errors with file, line and column.
    """
    if order is not None:
        order = _arguments.whole("order", order, _native.MAX_ORDER)
    given = _arguments.path_text("path_or_text", path_or_text, "a path, or the text of a specification")
    if "\n" in given or "\r" in given:
        native = _native.Model.of_text(TEXT, given, order)
    else:
        native = _native.Model.of_file(given, order)
    if native.warnings is not None:
        warnings.warn(native.warnings, SpecificationWarning, stacklevel=2)
    return Model(native)


class Model:
    """Compiled model at one set of parameter values, created by `load`. It is immutable; threads may share it.

    All numbers are in SI units, except `parameters`, which are in their declared units. The state consists of
    the coordinates, the modes, the rates of both, and first-order states, in the order of `states`.
    """

    def __init__(self, native: _native.Model):
        self._native = native
        self._states: Tuple[str, ...] = tuple(name for name, _ in native.states)
        self._inputs: Tuple[str, ...] = tuple(name for name, _ in native.inputs)
        self._observables: Tuple[str, ...] = tuple(name for name, _ in native.observables)

    @property
    def name(self) -> str:
        """Name of the model."""
        return self._native.name

    @property
    def states(self) -> Tuple[str, ...]:
        """Names of the states, in order."""
        return self._states

    @property
    def inputs(self) -> Tuple[str, ...]:
        """Names of the inputs, in order."""
        return self._inputs

    @property
    def observable_names(self) -> Tuple[str, ...]:
        """Names of the observables, in order; `energy` (J) and `power` (W) are last."""
        return self._observables

    @property
    def parameters(self) -> Mapping[str, float]:
        """Values of the parameters by name, in declared units. Set them with `with_parameters`."""
        return MappingProxyType({name: value for name, value, _ in self._native.parameters})

    @property
    def independent_parameters(self) -> Tuple[str, ...]:
        """Parameters with a number as value: the columns of `jacobian(..., by="parameters")`."""
        return tuple(self._native.independent_parameters)

    @property
    def units(self) -> Mapping[str, str]:
        """Units of parameters, states, inputs and observables, by name."""
        named = [(name, unit) for name, _, unit in self._native.parameters]
        native = self._native
        rest = native.inputs + native.observables + native.controller_states
        return MappingProxyType(dict(named + native.states + rest))

    @property
    def orders(self) -> Tuple[int, ...]:
        """Number of modes of each field."""
        return tuple(self._native.orders)

    @property
    def initial(self) -> Array:
        """Initial state of the specification, (states,)."""
        return np.array(self._native.initial)

    @property
    def text(self) -> str:
        """Text of the specification, including parameters that were set."""
        return self._native.text

    def with_parameters(self, /, **values: float) -> "Model":
        """Returns the model with new parameter values, in declared units. Expressions that depend on these values
        are recomputed. A number replaces the expression of a parameter.

        Raises SpecificationError for an unknown name or an inadmissible value.
        """
        units = self.units

        def expected(name: str) -> str:
            return f"one number in {units[name]}" if name in units else "one number"

        settings = [(name, _arguments.number(name, value, expected(name))) for name, value in values.items()]
        return Model(self._native.with_parameters(settings))

    def rates(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Array:
        """Computes the rates of the state.

        t: time in s, a number or (n,). x: state, (states,) or (n, states). u: inputs, (inputs,) or (n, inputs),
        or a mapping of names to numbers; missing inputs are 0. Returns an array of the shape of x.
        """
        call = self._call(t, x, u)
        rates = np.empty_like(call.x)
        _native.rates(self._native, call.t, call.x, call.u, rates)
        return rates[0] if call.single else rates

    def observables(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Array:
        """Computes the observables, in the order of `observable_names`: (observables,) or (n, observables).
        For the arguments see `rates`.
        """
        call = self._call(t, x, u)
        observables = np.empty((len(call.x), len(self._observables)))
        _native.observables(self._native, call.t, call.x, call.u, observables)
        return observables[0] if call.single else observables

    def energy(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Any:
        """Computes kinetic plus potential energy, in J: a number or (n,). For the arguments see `rates`."""
        return self.observables(t, x, u)[..., self._observables.index("energy")]

    def jacobian(
        self, t: ArrayLike, x: ArrayLike, u: Any = None, *, by: str = "state"
    ) -> Array:
        """Computes the Jacobian of the rates: (states, columns) or (n, states, columns). On a switching surface
        the derivatives are one-sided.

        by: "state", "inputs", "parameters" (the independent parameters, in SI) or "time". For the other arguments
        see `rates`.
        """
        columns = {
            "state": len(self._states),
            "inputs": len(self._inputs),
            "parameters": len(self._native.independent_parameters),
            "time": 1,
        }
        if _arguments.text("by", by, BY) not in columns:
            raise ValueError(_arguments.rejected("by", by, BY))
        call = self._call(t, x, u)
        shape = (len(call.x), len(self._states), columns[by])
        found = np.empty((shape[0], shape[1] * shape[2]))
        _native.jacobian(self._native, f"rates_by_{by}", call.t, call.x, call.u, found)
        found = found.reshape(shape)
        return found[0] if call.single else found

    def mass_matrix(self, t: ArrayLike, x: ArrayLike, u: Any = None) -> Array:
        """Computes the mass matrix: (coordinates, coordinates) or (n, coordinates, coordinates), where the coordinates
        include the modes. For the arguments see `rates`.
        """
        call = self._call(t, x, u)
        size = (len(self._states) - self._native.first_order_states) // 2
        found = np.empty((len(call.x), size * size))
        _native.mass_matrix(self._native, call.t, call.x, call.u, found)
        found = found.reshape(len(call.x), size, size)
        return found[0] if call.single else found

    def derive(self, format: str = "text") -> Any:
        """Returns the equations of motion with their coefficients: "text" and "latex" give a text, "json" the content
        of the document of `eomgen derive --format json`.
        """
        text = _native.derive(self._native, _arguments.text("format", format, FORMATS))
        return json.loads(text) if format == "json" else text

    def linearise(
        self, t: float = 0.0, x: Any = None, u: Any = None
    ) -> Linearisation:
        """Linearises the model at a state and returns A, B, C and D.

        t: time in s. x: state, (states,), or a mapping of names to numbers; missing states have the
        specification's initial values. u: inputs, (inputs,), or a mapping of names to numbers; missing inputs
        are 0. A state that violates the constraints is projected onto them, with a warning.
        """
        time, state, inputs = self._operating_point(t, x, u)
        found = _native.linearise(self._native, time, state, inputs)
        return Linearisation(self._native, self._states, self._inputs, self._observables, state, inputs, *found)

    def _operating_point(self, t: Any, x: Any, u: Any) -> Tuple[float, "np.ndarray", "np.ndarray"]:
        time = _arguments.real("t", t, "a time in s")
        call = self._call(time, self.state(x), u)
        _arguments.require_finite("state", self._states, call.x)
        _arguments.require_finite("input", self._inputs, call.u)
        state, moved = _native.move_onto_constraints(self._native, time, call.x[0], call.u[0])
        if moved is not None:
            warnings.warn(moved, stacklevel=3)
        return time, np.array(state), call.u[0]

    def modes(self, t: float = 0.0, x: Any = None, u: Any = None) -> List[Mode]:
        """Computes the natural modes of the model linearised at a state, lowest frequency first. For the arguments
        see `linearise`.
        """
        time, state, inputs = self._operating_point(t, x, u)
        amplitudes, found = _native.modes(self._native, time, state, inputs)
        names = tuple(name for name, _ in amplitudes)
        return [
            Mode(frequency, damping, complex(*eigenvalue), np.array([complex(*v) for v in shape]), names, limit)
            for frequency, damping, eigenvalue, shape, limit in found
        ]

    def validate(self, extras: Sequence[str] = ()) -> Certificate:
        """Checks the equations and the emitted Rust against an independent computation.

        extras: additional emitted functions, as in `generate`.
        """
        extras = _arguments.texts("extras", extras, EXTRAS)
        return Certificate(json.loads(_native.validate(self._native, extras)))

    def generate(
        self,
        out: Union[str, "os.PathLike[str]"],
        target: str = "rust",
        extras: Sequence[str] = (),
    ) -> List[Path]:
        """Writes the emitted source of the model to a folder and returns the paths of the files. The file with the
        equations is first.

        target: "rust", "c99", "cuda", "casadi" or "acados". extras: functions to emit in addition to the usual ones,
        such as "jacobians"; the names are those of `eomgen generate --with`.
        """
        folder = _arguments.path("out", out, FOLDER)
        target = _arguments.text("target", target, "the name of a target, such as \"rust\"")
        files, noted = _native.generate(self._native, target, _arguments.texts("extras", extras, EXTRAS))
        for warning in noted:
            warnings.warn(warning, stacklevel=2)
        return write_all(folder, {name: bytes(contents) for name, contents in files})

    def compare(
        self,
        dataset: Union[str, "os.PathLike[str]"],
        out: Union[str, "os.PathLike[str]", None] = None,
        *,
        seed: int = 1,
        progress: Optional[Callable[[str], object]] = None,
    ) -> Comparison:
        """Compares the model with measured records.

        dataset: path of the dataset file. out: folder for `comparison.json` and `report.html`; None writes no files.
        seed: seed of the noise in the simulated records that give the noise floor. progress: function that is called
        with each progress message.

        Raises SpecificationError for an invalid dataset file, ValueError for invalid records, and DiscoveryError if the
        model cannot be simulated over the records.
        """
        return compare(self._native, dataset, out, seed, progress)

    def sweep(
        self,
        vary: Any = None,
        measure: Union[str, Sequence[str]] = (),
        *,
        samples: Optional[int] = None,
        seed: int = 1,
        frequency: str = "omega",
        transient: int = 60,
        periods: int = 60,
        until: Optional[float] = None,
        section: Optional[str] = None,
        state: Any = None,
        inputs: Any = None,
        record: Any = None,
        out: Union[str, "os.PathLike[str]", None] = None,
        threads: Optional[int] = None,
        progress: Optional[Callable[[float], object]] = None,
    ) -> Sweep:
        """Computes measures over a grid or over random samples of parameters, like `eomgen sweep`.

        vary: mapping of a name, or of several names with commas, to (from, to, count) or (from, to, count, "log"), in
        declared units. samples: number of random samples of the uncertain parameters, instead of a grid; seed: their
        seed. measure: one or more of "lyapunov", "poincare", "poincare:NAME", "max:NAME", "rms:NAME", "final:NAME".

        frequency: parameter that is the angular frequency of the forcing. transient, periods: discarded and measured
        forcing periods. until: end of the simulation in s, instead of forcing periods. section: Poincare section,
        "NAME=VALUE", "NAME=VALUE:up" or "NAME=VALUE:down".

        state: mapping of names to numbers or expressions of parameters, or "trim" for the nearest equilibrium. inputs:
        mapping of names to numbers or expressions of t and parameters. record: dataset file whose first training record
        drives the inputs, or (file, name) for another record.

        out: folder of the sweep, in which an interrupted run is resumed; `eomgen merge` writes its tables and figures.
        None keeps no files. threads: number of threads, which does not affect the result. progress: function of the
        completed fraction, 0 to 1.

        Raises SpecificationError or ValueError for an invalid request. Ctrl-C interrupts the sweep
        when the current points are complete.
        """
        return sweep(
            self._native,
            (vary, samples, seed),
            measure,
            (frequency, transient, periods, until, section),
            (inputs, record, state),
            (out, threads),
            progress,
        )

    def trim(
        self,
        x: Any = None,
        u: Any = None,
        *,
        fixed: Optional[Mapping[str, float]] = None,
        t: float = 0.0,
    ) -> Equilibrium:
        """Finds the equilibrium nearest to a start, at rest or in steady motion.

        x: start, (states,), or a mapping of names to numbers; missing states have the specification's initial
        values. u: inputs, (inputs,), or a mapping of names to numbers; missing inputs are 0, and missing
        prescribed motion is in the middle of its range. fixed: states and inputs that keep their values, by
        name. If a state is fixed, the search also varies the inputs that are not fixed. t: time in s.

        Raises ValueError for an unknown name, a value that is not finite or outside its range, and a fixed rate
        that cannot be constant. Raises SimulationError if no equilibrium is found.
        """
        start = self._named("x", "state", self._states, x) + self._named("u", "input", self._inputs, u)
        start.append(("t", _arguments.real("t", t, "a time in s")))
        kept = self._named("fixed", "state or input", self._states + self._inputs, fixed)
        found = _native.trim(self._native, start, kept)
        return Equilibrium(self._states, self._inputs, *found)

    @staticmethod
    def _named(what: str, kind: str, names: Tuple[str, ...], given: Any) -> List[Tuple[str, float]]:
        if given is None:
            return []
        if not isinstance(given, Mapping):
            values = _arguments.numbers(what, given, "an array of numbers, or a mapping of names to numbers")
            if values.shape != (len(names),):
                raise ValueError(
                    f"{what} has the shape {values.shape}: expected ({len(names)},), "
                    f"for {', '.join(names) or '(none)'}"
                )
            given = dict(zip(names, values))
        _arguments.check_names(kind, given, names)
        return [(name, _arguments.real(f"{what}[{name!r}]", value)) for name, value in given.items()]

    def simulate(
        self,
        until: float,
        interval: Optional[float] = None,
        solver: str = "auto",
        state: Any = None,
        inputs: Any = None,
        *,
        tolerance: float = 1e-9,
        progress: Any = None,
        start: float = 0.0,
        max_step: Optional[float] = None,
        breaks: Any = None,
        controller: Optional[Callable[..., Any]] = None,
        period: Optional[float] = None,
        offset: float = 0.0,
        delay: float = 0.0,
        controls: Any = None,
        gradients: bool = False,
        sample: Optional[float] = None,
        initial: Any = None,
    ) -> Trajectory:
        """Simulates the motion from t = `start` to t = `until`.

        until: end time, s. interval: output interval, s. Default: a thousandth of the simulated time.
        solver: "auto", "exact" (for models that are linear between switches), "rk", "adams", "radau" (for
        stiff models) or "fixed" (classical Runge-Kutta method of order 4, as the emitted `step`; inputs are held during a
        step). tolerance: relative tolerance of all solvers except "exact" and "fixed". max_step: longest step of
        these solvers, s. Set it if inputs have short pulses that longer steps may miss. With "fixed", all steps have
        this length.

        state: initial state, (states,), or a mapping of names to numbers; missing states have the
        specification's initial values. A state that violates the constraints is projected onto them, with a warning.

        inputs: mapping of names to a number, to an array with a number per sample, to an expression such as
        "0.3*sin(50*t)" with t in s, or to a function of t (s). An array value is constant from its sample to
        the next one. With controllers an expression is evaluated like a function. Arrays for prescribed motion
        follow a cubic spline, which gives its rates. Functions are
        called at the times that the solver needs; `breaks` lists the times at which a function jumps. For prescribed
        motion a function returns (s, s', s''). Missing inputs are 0.

        controller: function of (t, x, y) that is called at the times offset + k period (s), with the time, the state and
        the observables before the sample. It returns the inputs `controls`, as a mapping of names to numbers, as a
        sequence or as one number. These inputs act `delay` (s) later and are held until the next values act. Default of
        `controls`: all inputs that nothing else drives, except prescribed motion. Controllers of the specification run too.

        gradients: True to keep the steps for `Trajectory.gradient`, with the solver "rk". Models with controllers
        have no gradients.

        progress: function of the completed fraction, 0 to 1, called about ten times a second. Default: a
        progress line in terminals and notebooks for simulations longer than two seconds.

        Warns if the initial state is projected onto the constraints, if the energy changes without work or if bodies overlap.

        Raises SimulationError if the solver stops early; its `trajectory` has the samples up to the stop. If an input
        function or the controller raised an exception, this exception is its cause. Ctrl-C interrupts the simulation.
        """
        # `sample` and `initial` are earlier names.
        interval = _arguments.renamed("interval", interval, "sample", sample)
        state = _arguments.renamed("state", state, "initial", initial)
        span = (start, until, interval)
        settings = (solver, tolerance, max_step)
        control = (controller, period, offset, delay, controls)
        driven = (inputs, breaks)
        gradients = _arguments.flag("gradients", gradients)
        return simulate(self, span, settings, self.state(state), driven, control, gradients, progress)

    def simulation(
        self,
        start: float = 0.0,
        state: Any = None,
        inputs: Any = None,
        *,
        solver: str = "auto",
        tolerance: float = 1e-9,
        max_step: Optional[float] = None,
    ) -> Simulation:
        """Starts a simulation that continues over several calls, for controllers and interactive programs.

        start: time, s. state: initial state, as for `simulate`. inputs: (inputs,), or a mapping of names to numbers;
        missing inputs are 0. For the other arguments see `simulate`. Controllers of the specification run.

        Raises SimulationError or ValueError for a state from which no motion can start.
        """
        return Simulation(self, start, self.state(state), inputs, solver, tolerance, max_step)

    def state(self, values: Any = None) -> Array:
        """Returns a state, (states,): the given array, or the initial state of the specification with values
        replaced by name.
        """
        if values is None:
            return self.initial
        if isinstance(values, Mapping):
            _arguments.check_names("state", values, self._states)
            state = self.initial
            for name, value in values.items():
                state[self._states.index(name)] = _arguments.real(f"the state {name}", value)
            return state
        expected = "an array of numbers, or a mapping of names to numbers"
        state = _arguments.numbers("the state", values, expected)
        if state.shape != (len(self._states),):
            raise ValueError(
                f"the state has the shape {state.shape}: expected ({len(self._states)},), "
                f"for {', '.join(self._states)}"
            )
        return state

    def to_casadi(self, name: Optional[str] = None) -> Any:
        """Returns the rates as a CasADi function rates(t, x, u) with its exact Jacobian. Keep a reference to the
        function while expressions use it, because CasADi calls the model. Needs the package `casadi`.
        """
        from .casadi import Rates

        chosen = self.name if name is None else _arguments.text("name", name, "the name of a function")
        return Rates(self, chosen)

    def _call(self, t: Any, x: Any, u: Any) -> Call:
        return Call(self._states, self._inputs, t, x, u)

    def __reduce__(self) -> Any:
        # Compiled code cannot be pickled; the other process compiles the text again.
        return load, (self.text, self._native.order)

    def __repr__(self) -> str:
        title = f": {self._native.title}" if self._native.title else ""
        order = f", order {', '.join(map(str, self.orders))}" if self.orders else ""
        counts = f"{len(self._states)} states, {len(self._inputs)} inputs"
        return f"<eomgen.Model {self.name}{title}; {counts}{order}>"

    def _repr_html_(self) -> str:
        return f"<div>{_native.equations(self._native)}</div>"
