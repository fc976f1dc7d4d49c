"""Sweeps over parameters."""

from __future__ import annotations

import os
import tempfile
import warnings
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native
from ._progress import Fraction

Array = NDArray[np.float64]

# Record of a dataset file that drives the inputs by default.
FIRST_RECORD = "train[0]"


class Sweep:
    """Result of a sweep: a column for each varied parameter, measured quantity and status.

    names: names of the columns. units: units by name. `s["max:x"]` is a column, (points,). A status is 0 if the
    quantity was measured; otherwise the numbers are NaN, and the status gives the reason
    (`statuses` in `job.json`).
    """

    def __init__(self, units: Sequence[Tuple[str, str]], columns: Sequence[Sequence[float]]):
        self.names = tuple(name for name, _ in units)
        self.units = dict(units)
        self._columns: Dict[str, Array] = {
            name: np.array(column) for name, column in zip(self.names, columns)
        }

    def __getitem__(self, name: str) -> Array:
        if name not in self._columns:
            raise KeyError(_arguments.unknown("column", name, self.names))
        return self._columns[name]

    def __len__(self) -> int:
        return len(next(iter(self._columns.values())))

    def to_pandas(self) -> Any:
        """Returns a pandas DataFrame. Needs the package `pandas`."""
        import pandas

        return pandas.DataFrame(self._columns)

    def __repr__(self) -> str:
        return f"<eomgen.Sweep: {len(self)} points; {', '.join(self.names)}>"


def sweep(
    native: _native.Model,
    points: Tuple[Any, Optional[int], int],
    measure: Union[str, Sequence[str]],
    window: Tuple[str, int, int, Optional[float], Optional[str]],
    conditions: Tuple[Any, Any, Any],
    run: Tuple[Any, Optional[int]],
    progress: Optional[Callable[[float], object]],
) -> Sweep:
    """Computes a sweep. See `Model.sweep`."""
    vary, samples, seed = points
    frequency, transient, periods, until, section = window
    inputs, record, state = conditions
    out, threads = run
    if (vary is None) == (samples is None):
        raise TypeError("expected either vary or samples")
    if record is not None and not isinstance(record, tuple):
        record = (record, FIRST_RECORD)
    request = (
        _axes(vary),
        None if samples is None else _arguments.whole("samples", samples),
        _arguments.whole("seed", seed),
        [measure] if isinstance(measure, str) else list(measure),
        frequency,
        (_arguments.whole("transient", transient), _arguments.whole("periods", periods)),
        None if until is None else _arguments.real("until", until),
        section,
        _assignments("inputs", inputs),
        None if record is None else (os.fspath(record[0]), record[1]),
        [state] if isinstance(state, str) else _assignments("state", state),
    )
    workers = 0 if threads is None else _arguments.whole("threads", threads, 1024)
    with Fraction("sweeping", 1.0, progress) as shown, tempfile.TemporaryDirectory() as unused:
        folder = os.path.join(unused, "sweep") if out is None else os.fspath(out)

        def tell(computed: int, whole: int) -> None:
            shown.tell(computed / whole)

        units, columns, noted = _native.sweep(native, *request, folder, workers, tell)
    for warning in noted:
        warnings.warn(warning, stacklevel=3)
    return Sweep(units, columns)


def _axes(vary: Any) -> List[str]:
    """Converts axes to texts `NAME[,NAME...]=FROM:TO:COUNT[:log]`."""
    if vary is None:
        return []
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        return list(vary)
    texts = []
    for name, axis in vary.items():
        expected = f"vary[{name!r}] = {axis!r}: expected (from, to, count) or (from, to, count, \"log\")"
        if isinstance(axis, str) or len(axis) not in (3, 4):
            raise TypeError(expected)
        first, last = (_arguments.real(name, end) for end in axis[:2])
        count = _arguments.whole(f"count of {name}", axis[2])
        texts.append(":".join([f"{name}={first!r}", repr(last), str(count), *axis[3:]]))
    return texts


def _assignments(kind: str, given: Any) -> List[str]:
    """Converts a mapping of names to numbers or expressions to texts `NAME=EXPR`."""
    if given is None:
        return []
    if not isinstance(given, Mapping):
        raise TypeError(f"{kind}: expected a mapping of names to numbers or expressions")
    texts = []
    for name, value in given.items():
        text = value if isinstance(value, str) else repr(_arguments.real(f"{kind}[{name!r}]", value))
        texts.append(f"{name}={text}")
    return texts
