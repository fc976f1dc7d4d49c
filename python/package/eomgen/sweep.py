"""Sweeps over parameters."""

from __future__ import annotations

import os
import tempfile
import warnings
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native
from ._files import FOLDER
from ._progress import Fraction

Array = NDArray[np.float64]

# Record of a dataset file that drives the inputs by default.
FIRST_RECORD = "train[0]"


class Sweep:
    """Result of a sweep: one column per varied parameter, measured quantity and status.

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
        given = "neither is given" if vary is None else "both are given"
        raise TypeError(f"expected either vary or samples: {given}")
    request = (
        _axes(vary),
        None if samples is None else _arguments.whole("samples", samples),
        _arguments.whole("seed", seed),
        _arguments.texts("measure", measure, "names of measures, such as \"max:x\""),
        _arguments.text("frequency", frequency, "the name of a parameter"),
        (_arguments.whole("transient", transient), _arguments.whole("periods", periods)),
        None if until is None else _arguments.real("until", until, "a time in s"),
        None if section is None else _arguments.text("section", section, "a text such as \"x=0:up\""),
        _assignments("inputs", inputs),
        None if record is None else _record(record),
        [state] if isinstance(state, str) else _assignments("state", state),
    )
    workers = 0 if threads is None else _arguments.whole("threads", threads, 1024)
    with Fraction("sweeping", (0.0, 1.0), progress) as shown, tempfile.TemporaryDirectory() as unused:
        folder = os.path.join(unused, "sweep") if out is None else _arguments.path("out", out, FOLDER)

        def tell(computed: int, whole: int) -> None:
            shown.tell(computed / whole)

        units, columns, noted = _native.sweep(native, *request, folder, workers, tell)
    for warning in noted:
        warnings.warn(warning, stacklevel=3)
    return Sweep(units, columns)


def _record(given: Any) -> Tuple[str, str]:
    """Returns the dataset file and the name of a record."""
    expected = "the path of a dataset file, or (path, name of a record)"
    path, name = given if isinstance(given, tuple) and len(given) == 2 else (given, FIRST_RECORD)
    return _arguments.path("record", path, expected), _arguments.text("record", name, expected)


def _axes(vary: Any) -> List[str]:
    """Converts axes to texts `NAME[,NAME...]=FROM:TO:COUNT[:log]`."""
    if vary is None:
        return []
    if not isinstance(vary, Mapping):
        return _arguments.texts("vary", vary, "a mapping of names to (from, to, count) or (from, to, count, \"log\")")
    texts = []
    for name, axis in vary.items():
        _arguments.text("vary", name, "names of parameters")
        what, expected = f"vary[{name!r}]", "(from, to, count) or (from, to, count, \"log\")"
        is_axis = isinstance(axis, (Sequence, np.ndarray)) and not isinstance(axis, str)
        if not is_axis or len(axis) not in (3, 4) or len(axis) == 4 and axis[3] != "log":
            raise TypeError(_arguments.rejected(what, axis, expected))
        first, last = (_arguments.real(f"{what}[{place}]", axis[place]) for place in (0, 1))
        count = _arguments.whole(f"{what}[2]", axis[2])
        texts.append(":".join([f"{name}={first!r}", repr(last), str(count), *axis[3:]]))
    return texts


def _assignments(kind: str, given: Any) -> List[str]:
    """Converts a mapping of names to numbers or expressions to texts `NAME=EXPR`."""
    texts = []
    for name, value in _arguments.mapping(kind, given, "a mapping of names to numbers or expressions").items():
        _arguments.text(kind, name, "names as keys")
        text = value if isinstance(value, str) else repr(_arguments.real(f"{kind}[{name!r}]", value))
        texts.append(f"{name}={text}")
    return texts
