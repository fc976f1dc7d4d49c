"""A simulated motion: its samples by name, as a table, as a plot."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native
from ._progress import Fraction

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]

# The most numbers of one motion, rows times columns: a few GB of memory.
MOST_NUMBERS = 10**8

# Samples where nothing is said about them, but for the first.
DEFAULT_SAMPLES = 1000


class Trajectory:
    """The samples of a motion.

    t: (n,), s. states: (n, states). observables: (n, observables). `r["tip"]` is the column of a
    state or of an observable; of a name that is both, the observable. solver: who computed it;
    reason: why "auto" took that one, None where it was asked for; switches: how many times it
    passed a switching surface.
    """

    def __init__(
        self,
        names: Tuple[Tuple[str, ...], Tuple[str, ...]],
        units: Mapping[str, str],
        found: Tuple[str, Optional[str], Any, Array, Array, Array, int],
    ):
        self.solver, self.reason, _, self.t, self.states, self.observables, self.switches = found
        self.state_names, self.observable_names = names
        self._units = units

    @property
    def names(self) -> Tuple[str, ...]:
        """The names of all columns: states, then observables."""
        return self.state_names + self.observable_names

    def __getitem__(self, name: str) -> Array:
        if name in self.observable_names:
            return self.observables[:, self.observable_names.index(name)]
        if name in self.state_names:
            return self.states[:, self.state_names.index(name)]
        if name == "t":
            return self.t
        raise KeyError(_arguments.unknown("state or observable", name, self.names))

    def __len__(self) -> int:
        return len(self.t)

    def to_pandas(self) -> Any:
        """A pandas DataFrame: a column for each name, the index t (s). Needs the package `pandas`."""
        import pandas

        index = pandas.Index(self.t, name="t")
        numbers = np.concatenate([self.states, self.observables], axis=1)
        return pandas.DataFrame(numbers, index=index, columns=list(self.names))

    def plot(self, *names: str, axes: Any = None) -> Any:
        """Draws columns over time, one above the other; the coordinates and modes if none is named.
        Returns the axes of matplotlib, one for each column. Needs the package `matplotlib`.

        axes: as many axes as there are names, to draw into; new ones if None.
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


def simulated(
    model: "Model",
    until: Any,
    sample: Any,
    solver: Any,
    initial: Array,
    inputs: Any,
    tolerance: Any,
    progress: Optional[Callable[[float], object]],
) -> Trajectory:
    """The motion of a model; `Model.simulate` says what the arguments are."""
    if not isinstance(solver, str):
        raise TypeError(f"solver = {solver!r}: expected the name of a solver")
    if not np.isfinite(initial).all():
        wrong = [name for name, x in zip(model.states, initial) if not np.isfinite(x)]
        raise ValueError(f"the initial state is not finite: {', '.join(wrong)}")
    tolerance = _arguments.real("tolerance", tolerance)
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance = {tolerance}: expected a number between 0 and 1")
    times = sample_times(until, sample, len(model.states) + len(model.observable_names))
    input_times, input_values = held_inputs(model.inputs, inputs, times)
    with Fraction("simulating", times[-1], progress) as line:
        found = _native.simulate(
            model._native,
            initial,
            times,
            input_times,
            input_values,
            solver,
            tolerance,
            line.tell,
        )
    names = (model.states, model.observable_names)
    trajectory = Trajectory(names, model.units, found)
    stopped = found[2]
    if stopped is not None:
        error = _native.SimulationError(stopped[1])
        error.trajectory = trajectory
        raise error
    return trajectory


def sample_times(until: Any, sample: Any, columns: int) -> Array:
    """The times of the samples, s, from 0 on; as the command line has them, to the bit."""
    end = _arguments.real("until", until)
    if end <= 0.0:
        raise ValueError(f"until = {end}: expected a time in s after 0")
    step = end / DEFAULT_SAMPLES if sample is None else _arguments.real("sample", sample)
    if not 0.0 < step <= end:
        raise ValueError(f"sample = {step}: expected a time in s above 0 and at most {end}")
    steps = np.floor(end / step * (1.0 + 1e-12))
    if (steps + 1.0) * columns > MOST_NUMBERS:
        raise ValueError(
            f"sample = {step}: too many samples: the limit is {MOST_NUMBERS:.0e} numbers; "
            "give a longer time"
        )
    times: Array = np.minimum(np.arange(int(steps) + 1) * step, end)
    return times


def held_inputs(names: Sequence[str], given: Any, times: Array) -> Tuple[Array, Array]:
    """Times (s) and a row of inputs for each, held until the next."""
    if given is None:
        given = {}
    if not isinstance(given, Mapping):
        raise TypeError(
            f"inputs: expected names to values, such as {{{names[0]!r}: 0.0}}"
            if names
            else "inputs: the model has none"
        )
    _arguments.check_names("input", given, names)
    missing = [name for name in names if name not in given]
    if missing:
        warnings.warn(
            f"not driven and taken as 0: {', '.join(missing)}; give inputs={{NAME: ...}}",
            stacklevel=4,
        )
    columns = [_column(name, given.get(name, 0.0), times) for name in names]
    if all(len(column) == 1 for column in columns):
        return times[:1], np.array([[column[0] for column in columns]]).reshape(1, len(names))
    rows = np.stack([np.broadcast_to(column, times.shape) for column in columns], axis=-1)
    return times, np.ascontiguousarray(rows)


def _column(name: str, given: Any, times: Array) -> Array:
    if callable(given):
        given = [_arguments.real(f"the input {name} at t = {t}", given(float(t))) for t in times]
    column = _arguments.numbers(f"the input {name}", given).reshape(-1)
    if np.ndim(given) > 1 or len(column) not in (1, len(times)):
        raise ValueError(
            f"the input {name} has the shape {np.shape(given)}: expected a number, or "
            f"{len(times)} numbers, one for each sample"
        )
    if not np.isfinite(column).all():
        raise ValueError(f"the input {name} is not finite at some sample")
    return column
