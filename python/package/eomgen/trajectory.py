"""Simulated motions: samples by name, tables, plots."""

from __future__ import annotations

import warnings
from decimal import Decimal
from typing import TYPE_CHECKING, Any, Callable, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native
from ._progress import Fraction
from .gradient import Gradient

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]

# Maximum number of decimals of times; further decimals are rounding errors.
MAX_DECIMALS = 15

# Largest number of values in one motion, rows times columns: a few GB of memory.
MAX_VALUES = 10**8

# Number of output intervals if `interval` is not given.
DEFAULT_INTERVALS = 1000


class Event(NamedTuple):
    """Event of a motion.

    t: time, s. surface: name of the contact, or formula whose sign changes; empty if the rates jump because of a jump of an input.
    kind: crossing, stick, slip, impact, contact, separation, corner, reflection or input. before, after: modes of the
    surface. jump: jump of the rate of each coordinate, SI; empty without a jump. Simultaneous events share the jump.
    """

    t: float
    surface: str
    kind: str
    before: str
    after: str
    jump: Mapping[str, float]


class Trajectory:
    """Samples of a motion, in SI.

    t: times, (n,), s. states: (n, states). observables: (n, observables). `r["tip"]` is the column of an
    observable or of a state; observables take precedence. solver: name of the solver. reason: reason why "auto"
    chose this solver; None for a requested solver.
    switches: number of events at surfaces. controller_states: states of the controllers of the specification, after the
    samples at each time, (n, count); `r["e_i"]` is the column of one state.
    """

    def __init__(
        self,
        names: Tuple[Tuple[str, ...], Tuple[str, ...]],
        units: Mapping[str, str],
        found: Tuple[Any, ...],
    ):
        self.solver, self.reason, _, self.t, self.states, self.observables, events = found[:7]
        self.state_names, self.observable_names = names
        self.controller_state_names, self.controller_states = tuple(found[8]), found[9]
        self._recorded = found[10]
        self._events = events
        self.switches = sum(event[2] != "input" for event in events)
        self._units = units

    @property
    def events(self) -> List[Event]:
        """Events in order of time."""
        return [Event(*event[:5], dict(zip(self.state_names, event[5]))) for event in self._events]

    @property
    def names(self) -> Tuple[str, ...]:
        """Names of all columns: states, observables, states of controllers."""
        return self.state_names + self.observable_names + self.controller_state_names

    def __getitem__(self, name: str) -> Array:
        if name in self.observable_names:
            return self.observables[:, self.observable_names.index(name)]
        if name in self.state_names:
            return self.states[:, self.state_names.index(name)]
        if name in self.controller_state_names:
            return self.controller_states[:, self.controller_state_names.index(name)]
        if name == "t":
            return self.t
        raise KeyError(_arguments.unknown("state or observable", name, self.names))

    def __len__(self) -> int:
        return len(self.t)

    def gradient(self, weights: Mapping[str, Any]) -> Gradient:
        """Returns the gradient of a number L, which depends on the samples, with respect to initial state, parameters and
        inputs, through events. The motion must be simulated with `gradients=True`. One call takes as long as two to five
        simulations, for any number of parameters.

        weights: derivatives of L with respect to the samples of states and observables, (n,), by name, for example
        `{"tip": 2 * (r["tip"] - target)}`.

        Raises ValueError if the gradient does not exist: the motion touches a switching surface or crosses several at once.
        """
        if self._recorded is None:
            raise ValueError("this motion has no gradient: call simulate with gradients=True")
        return Gradient(self._recorded, (self.state_names, self.observable_names), len(self), weights)

    def to_pandas(self) -> Any:
        """Returns a pandas DataFrame with one column per name and the index t (s). Needs the package `pandas`."""
        import pandas

        index = pandas.Index(self.t, name="t")
        parts = [self.states, self.observables, self.controller_states]
        numbers = np.concatenate(parts, axis=1)
        return pandas.DataFrame(numbers, index=index, columns=list(self.names))

    def plot(self, *names: str, axes: Any = None) -> Any:
        """Plots columns over time, one above the other. Returns the matplotlib axes, one per column. Needs
        the package `matplotlib`.

        names: names of columns. Default: all coordinates and modes. axes: existing axes, one per name.
        """
        from matplotlib import pyplot

        names = names or self.state_names[: len(self.state_names) // 2]
        columns = [self[name] for name in names]
        if axes is None:
            size = (7.0, 1.0 + 1.6 * len(names))
            _, axes = pyplot.subplots(
                len(names), 1, sharex=True, squeeze=False, figsize=size, layout="constrained"
            )
        axes = np.atleast_1d(axes).ravel()
        for axis in axes:
            if not hasattr(axis, "plot"):
                raise TypeError(_arguments.rejected("axes", axis, "matplotlib axes"))
        if len(axes) != len(names):
            raise ValueError(f"{len(axes)} axes for {len(names)} columns")
        for axis, name, column in zip(axes, names, columns):
            unit = self._units.get(name)
            axis.plot(self.t, column)
            axis.set_ylabel(f"{name} ({unit})" if unit else name)
            axis.grid(alpha=0.3)
        axes[-1].set_xlabel("t (s)")
        return axes

    def __repr__(self) -> str:
        end = f"{self.t[0]:g} to {self.t[-1]:g} s" if len(self.t) else "no sample"
        return f"<eomgen.Trajectory: {len(self.t)} samples, {end}, solver {self.solver}>"


def simulate(
    model: "Model",
    span: Tuple[Any, Any, Any],
    settings: Tuple[Any, Any, Any],
    initial: Array,
    driven: Tuple[Any, Any],
    control: Tuple[Any, Any, Any, Any, Any],
    gradients: bool,
    progress: Optional[Callable[[float], object]],
) -> Trajectory:
    """Simulates a model over a span (start, until, interval) with settings (solver, tolerance, max_step),
    driven by (inputs, breaks) and by a controller with (function, period, offset, delay, inputs). `Model.simulate`
    describes the arguments."""
    solver, tolerance, longest = solver_settings(*settings)
    _arguments.require_finite("state", model.states, initial)
    times = sample_times(*span, len(model.states) + len(model.observable_names))
    given, breaks = driven
    # Controllers measure the inputs, and fixed steps hold them, so they must remain inputs of the model.
    keep = control[0] is not None or bool(model._native.controlled_inputs) or solver == "fixed"
    if gradients and control[0] is not None:
        raise ValueError("no gradient of the trajectory: a controller drives the motion")
    native, names, given, expressions = prescribe(model, given, keep)
    declared = (model._native.controlled_inputs, model._native.prescribed_inputs)
    entry = controller_entry(names, {**given, **dict(expressions)}, declared, control)
    driven_names = [names[place] for place in entry[1]] if entry is not None else []
    others = (*driven_names, *model._native.controlled_inputs)
    known = {**{name: 0.0 for name in others}, **given, **{name: 0.0 for name, _ in expressions}}
    input_times, input_values, functions = driving(names, known, times)
    with Fraction("simulating", (times[0], times[-1]), progress) as line:
        found = _native.simulate(
            native,
            initial,
            times,
            input_times,
            input_values,
            functions,
            expressions,
            break_times(breaks),
            solver,
            tolerance,
            longest,
            entry,
            gradients,
            line.tell,
        )
    for warning in found[7]:
        warnings.warn(warning, stacklevel=3)
    if gradients:
        columns = {name: np.size(given.get(name, 0.0)) for name in names if not callable(given.get(name))}
        found = (*found[:10], (found[10], native, names, columns), found[11])
    names = (model.states, model.observable_names)
    trajectory = Trajectory(names, model.units, found)
    stopped = found[2]
    if stopped is not None:
        error = _native.SimulationError(stopped[1]) if found[11] is None else found[11]
        error.trajectory = trajectory
        raise error
    return trajectory


def solver_settings(solver: Any, tolerance: Any, max_step: Any) -> Tuple[str, float, float]:
    """Returns the name of a solver, its relative tolerance and its longest step, s."""
    solver = _arguments.text("solver", solver, "the name of a solver, such as \"auto\"")
    expected = "a number between 0 and 1"
    tolerance = _arguments.real("tolerance", tolerance, expected)
    if not 0.0 < tolerance < 1.0:
        raise ValueError(_arguments.rejected("tolerance", tolerance, expected))
    if max_step is None:
        return solver, tolerance, np.inf
    expected = "a time in s above 0"
    longest = _arguments.number("max_step", max_step, expected)
    if not longest > 0.0:
        raise ValueError(_arguments.rejected("max_step", longest, expected))
    return solver, tolerance, longest


def controller_entry(
    names: Sequence[str],
    given: Mapping[str, Any],
    declared: Tuple[Sequence[str], Sequence[str]],
    control: Tuple[Any, Any, Any, Any, Any],
) -> Any:
    """Returns function, indices of the driven inputs and times of a controller, or None. declared: inputs that
    controllers of the specification drive, and prescribed motion."""
    controlled, prescribed = declared
    function, period, offset, delay, controls = control
    if function is None:
        if period is not None or controls is not None:
            raise TypeError("period and controls need controller, a function of (t, x, y)")
        return None
    _arguments.function("controller", function, "a function of (t, x, y)")
    if period is None:
        raise TypeError("controller needs period, the time between two samples in s")
    schedule = tuple(
        _arguments.real(what, time, "a time in s")
        for what, time in (("period", period), ("offset", offset), ("delay", delay))
    )
    if schedule[0] <= 0.0:
        raise ValueError(f"period = {schedule[0]}: expected a time in s above 0")
    for what, time in zip(("offset", "delay"), schedule[1:]):
        if time < 0.0:
            raise ValueError(f"{what} = {time}: expected a time in s of 0 or more")
    if controls is None:
        others = (*given, *controlled, *prescribed)
        driven = [name for name in names if name not in others]
    else:
        driven = _arguments.texts("controls", controls, "names of inputs")
        _arguments.check_names("input", driven, names)
    for name in driven:
        if name in prescribed:
            raise ValueError(f"the input {name} is prescribed motion, which moves between samples: give it in inputs")
        if name in given or name in controlled:
            other = "inputs" if name in given else "a controller of the specification"
            raise ValueError(f"the input {name} is driven by the controller and by {other}")

    def sampled(t: float, x: Array, y: Array) -> List[Any]:
        found = function(t, x, y)
        if isinstance(found, Mapping):
            for name in found:
                if name not in driven:
                    raise _native.RefusedValue(_arguments.unknown("controlled input", name, driven))
            missing = [name for name in driven if name not in found]
            if missing:
                raise _native.RefusedValue(f"it returned no value for {', '.join(missing)}")
            return [found[name] for name in driven]
        if found is None and driven:
            raise _native.RefusedType(f"it returned None, expected values for {', '.join(driven)}")
        values = list(np.atleast_1d(found))
        if len(values) != len(driven):
            raise _native.RefusedValue(
                f"it returned {len(values)} values, expected {len(driven)} for {', '.join(driven)}"
            )
        return values

    return sampled, [list(names).index(name) for name in driven], schedule


def sample_times(start: Any, until: Any, interval: Any, columns: int) -> Array:
    """Returns the times of the samples, s. The times are bit-identical to those on the command line."""
    begin, end = (_arguments.real(what, time, "a time in s") for what, time in (("start", start), ("until", until)))
    if end <= begin:
        raise ValueError(f"until = {end}: expected a time in s after {begin:g}")
    whole = end - begin
    expected = f"a time in s above 0 and at most {whole}"
    step = whole / DEFAULT_INTERVALS if interval is None else _arguments.real("interval", interval, expected)
    if not 0.0 < step <= whole:
        raise ValueError(_arguments.rejected("interval", step, expected))
    steps = np.floor(whole / step * (1.0 + 1e-12))
    if (steps + 1.0) * columns > MAX_VALUES:
        raise ValueError(
            f"interval = {step}: too many samples: the limit is {MAX_VALUES:.0e} values (rows times columns); "
            "give a longer interval"
        )
    times = begin + np.arange(int(steps) + 1) * step
    return _rounded(times, max(_decimals(begin), _decimals(step)), end)


def _decimals(number: float) -> int:
    """Returns the number of decimals of the shortest notation of a number."""
    exponent = Decimal(repr(number)).normalize().as_tuple().exponent
    return max(0, -int(exponent))


def _rounded(times: Array, decimals: int, end: float) -> Array:
    """Returns the floating-point numbers nearest to times with this number of decimals. 7 times 0.05 s is then 0.35 s."""
    if decimals <= MAX_DECIMALS:
        scale = 10.0**decimals
        whole = np.rint(times * scale)
        # Larger integers are not exact.
        times = np.where(np.abs(whole) < 2.0**53, whole / scale, times)
    rounded: Array = np.minimum(times, end)
    return rounded


def break_times(given: Any) -> List[float]:
    """Returns the times at which input functions jump, s."""
    if given is None:
        return []
    expected = "times in s"
    breaks = _arguments.numbers("breaks", given, expected).reshape(-1)
    if not np.isfinite(breaks).all():
        raise ValueError(_arguments.rejected("breaks", breaks[~np.isfinite(breaks)][0], f"finite {expected}"))
    return [float(time) for time in breaks]


def prescribe(
    model: "Model", given: Any, keep: bool
) -> Tuple[Any, Tuple[str, ...], Mapping[str, Any], List[Tuple[str, str]]]:
    """Replaces inputs that are given as expressions by definitions, unless `keep` is true. Returns the compiled model,
    the names of its inputs, the values of inputs without an expression, and the expressions that were kept."""
    names = model.inputs
    example = f"a mapping of names to values, such as {{{names[0]!r}: 0.0}}" if names else None
    expected = example or "nothing: the model has none"
    given = _arguments.mapping("inputs", given, expected)
    _arguments.check_names("input", given, names)
    check_no_rates(given, model._native.prescribed_inputs)
    expressions = [(name, value) for name, value in given.items() if isinstance(value, str)]
    if not expressions:
        return model._native, names, given, []
    others = {name: value for name, value in given.items() if not isinstance(value, str)}
    if keep:
        return model._native, names, others, expressions
    native = model._native.with_inputs(expressions)
    return native, tuple(name for name, _ in native.inputs), others, []


def check_no_rates(given: Iterable[str], prescribed: Sequence[str]) -> None:
    """Raises ValueError for a rate of prescribed motion, which is computed from the motion."""
    rates = {f"{name}_{order}": name for name in prescribed for order in ("dot", "ddot")}
    for name in given:
        if name in prescribed and name in rates:
            motion = rates[name]
            raise ValueError(
                f"the input {name} is a rate of the prescribed motion {motion}: remove it; a function of t for {motion} "
                f"may return ({motion}, {motion}', {motion}'')"
            )


def driving(names: Sequence[str], given: Mapping[str, Any], times: Array) -> Tuple[Array, Array, Any]:
    """Returns times (s), a row of inputs for each, and functions of time with the name and index of their
    input. A row is held until the next time."""
    functions = [(name, names.index(name), f) for name, f in given.items() if callable(f)]
    rates = {f"{name}_{order}" for name in given for order in ("dot", "ddot")}
    missing = [name for name in names if name not in given and name not in rates]
    if missing:
        warnings.warn(
            f"inputs not driven and taken as 0: {', '.join(missing)}; set them with inputs={{NAME: ...}}",
            stacklevel=4,
        )
    held = {name: value for name, value in given.items() if not callable(value)}
    columns = [_column(name, held.get(name, 0.0), times) for name in names]
    if all(len(column) == 1 for column in columns):
        rows = np.array([[column[0] for column in columns]]).reshape(1, len(names))
        return times[:1], rows, functions
    rows = np.stack([np.broadcast_to(column, times.shape) for column in columns], axis=-1)
    return times, np.ascontiguousarray(rows), functions


def _column(name: str, given: Any, times: Array) -> Array:
    expected = "a number, an array with a number for each sample, an expression or a function of t"
    column = _arguments.numbers(f"the input {name}", given, expected).reshape(-1)
    if np.ndim(given) > 1 or len(column) not in (1, len(times)):
        raise ValueError(
            f"the input {name} has the shape {np.shape(given)}: expected a number, or "
            f"{len(times)} numbers, one for each sample"
        )
    wrong = np.flatnonzero(~np.isfinite(column))
    if wrong.size:
        first = wrong[0]
        raise ValueError(f"the input {name} at t = {times[first]}: {column[first]}: expected a finite number")
    return column
