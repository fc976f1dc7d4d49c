"""Conversion of arguments to contiguous float64 arrays of the model's sizes."""

from __future__ import annotations

import math
import operator
import os
import reprlib
from typing import Any, Iterable, List, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

Array = NDArray[np.float64]

FLOAT = np.dtype(np.float64)


# Longest value in a message, in characters.
MAX_SHOWN = 60

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = MAX_SHOWN


def rejected(what: str, given: Any, expected: str) -> str:
    """Returns the message about a value that an argument does not accept."""
    if isinstance(given, np.ndarray) and given.ndim > 0:
        shown = f"an array of {given.dtype} with the shape {given.shape}"
    else:
        shown = repr(given.item()) if isinstance(given, np.generic) else _SHORT.repr(given)
    return f"{what} = {shown}: expected {expected}"


def numbers(what: str, given: ArrayLike, expected: str = "real numbers") -> Array:
    """Converts a value to a contiguous float64 array. Raises TypeError unless all entries are real numbers."""
    if type(given) is np.ndarray and given.dtype is FLOAT and given.flags.c_contiguous:
        return given
    if isinstance(given, np.ma.MaskedArray):
        raise TypeError(f"{what}: a masked array; fill it, or remove the masked rows")
    try:
        array = np.asarray(given)
    except ValueError as error:
        raise TypeError(f"{what}: expected an array of numbers: {error}") from None
    if array.dtype.kind not in "fiu":
        raise TypeError(rejected(what, given, expected))
    return np.asarray(array, dtype=np.float64, order="C")


def number(what: str, given: Any, expected: str = "one number") -> float:
    """Converts a value to one number, which may be infinite or NaN."""
    array = numbers(what, given, expected)
    if array.size != 1:
        raise TypeError(rejected(what, given, expected))
    return float(array.reshape(()))


def real(what: str, given: Any, expected: str = "a finite number") -> float:
    """Converts a value to one finite number."""
    value = number(what, given, expected)
    if not math.isfinite(value):
        raise ValueError(f"{what} = {value}: expected {expected}")
    return value


def whole(what: str, given: Any, most: int = 2**63 - 1, least: int = 0) -> int:
    """Converts a value to a whole number from `least` to `most`."""
    expected = f"a whole number from {least} to {most}"
    if isinstance(given, (bool, np.bool_)):
        raise TypeError(rejected(what, given, expected))
    try:
        value = operator.index(given)
    except TypeError:
        raise TypeError(rejected(what, given, expected)) from None
    if not least <= value <= most:
        raise ValueError(rejected(what, value, expected))
    return value


def flag(what: str, given: Any) -> bool:
    """Converts a value to True or False."""
    if not isinstance(given, (bool, np.bool_)):
        raise TypeError(rejected(what, given, "True or False"))
    return bool(given)


def text(what: str, given: Any, expected: str = "a text") -> str:
    """Returns a text that is not empty."""
    if not isinstance(given, str):
        raise TypeError(rejected(what, given, expected))
    if not given:
        raise ValueError(rejected(what, given, expected))
    return given


def texts(what: str, given: Any, expected: str) -> List[str]:
    """Converts one text or several texts to a list."""
    if isinstance(given, str):
        given = [given]
    if isinstance(given, (bytes, Mapping)) or not isinstance(given, Iterable):
        raise TypeError(rejected(what, given, expected))
    return [text(what, one, expected) for one in given]


def path_text(what: str, given: Any, expected: str) -> str:
    """Returns a path as text, which may be empty."""
    found = os.fspath(given) if isinstance(given, os.PathLike) else given
    if not isinstance(found, str):
        raise TypeError(rejected(what, given, expected))
    return found


def path(what: str, given: Any, expected: str) -> str:
    """Returns a path as text that is not empty."""
    return text(what, path_text(what, given, expected), expected)


def function(what: str, given: Any, expected: str) -> Any:
    """Returns a function, or None."""
    if given is not None and not callable(given):
        raise TypeError(rejected(what, given, f"{expected}, or None"))
    return given


def mapping(what: str, given: Any, expected: str) -> Mapping[Any, Any]:
    """Returns a mapping; None gives an empty mapping."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise TypeError(rejected(what, given, expected))
    return given


def require_finite(kind: str, names: Sequence[str], values: Array) -> None:
    """Raises ValueError for values that are not finite. A row of `values` has one value for each name."""
    for name, column in zip(names, values.reshape(-1, len(names)).T if len(names) else ()):
        wrong = column[~np.isfinite(column)]
        if wrong.size:
            raise ValueError(f"the {kind} {name} = {wrong[0]}: expected a finite number")


def renamed(name: str, given: Any, old: str, given_as_old: Any) -> Any:
    """Returns the value of an argument that may also be given under an earlier name."""
    if given_as_old is None:
        return given
    if given is not None:
        raise TypeError(f"both {name} and {old}, its earlier name, are given; give {name} only")
    return given_as_old


def unknown(kind: str, name: object, known: Sequence[str]) -> str:
    """Returns the message about a name that the model does not have."""
    meant = _native.nearest(name, list(known)) if isinstance(name, str) else None
    if meant is not None:
        hint = f"did you mean `{meant}`?"
    elif known:
        hint = f"it has {', '.join(known)}"
    else:
        hint = "it has none"
    return f"the model has no {kind} `{name}`; {hint}"


class Call:
    """Times, states and inputs of one call, one row per state.

    t: a number, or (n,). x: (states,) or (n, states). u: (inputs,) or (n, inputs), a mapping of names to
    numbers or to (n,), or None for 0.
    """

    __slots__ = ("t", "x", "u", "single")

    def __init__(self, states: Sequence[str], inputs: Sequence[str], t: Any, x: Any, u: Any):
        self.x = numbers("x", x)
        self.single = self.x.ndim == 1
        if self.x.ndim not in (1, 2) or self.x.shape[-1] != len(states):
            raise ValueError(
                f"x has the shape {self.x.shape}: expected ({len(states)},) or "
                f"(n, {len(states)}), for the states {', '.join(states)}"
            )
        if self.single:
            self.x = self.x.reshape(1, -1)
        rows = len(self.x)
        self.t = numbers("t", t)
        if self.t.ndim == 0:
            self.t = self.t.reshape(1)
        if self.t.ndim != 1 or len(self.t) not in (1, rows):
            raise ValueError(
                f"t has the shape {self.t.shape}: expected one time, or one for each of {rows} states"
            )
        self.u = self._inputs(inputs, u, rows)

    @staticmethod
    def _inputs(names: Sequence[str], u: Any, rows: int) -> Array:
        if u is None:
            return np.zeros((1, len(names)))
        if isinstance(u, Mapping):
            check_names("input", u, names)
            columns = [numbers(f"the input {name}", u.get(name, 0.0)) for name in names]
            try:
                u = np.stack(np.broadcast_arrays(*columns), axis=-1) if columns else np.zeros(0)
            except ValueError:
                shapes = ", ".join(str(column.shape) for column in columns)
                raise ValueError(f"the inputs have the shapes {shapes}") from None
        u = numbers("u", u)
        if u.ndim == 0 and len(names) == 1:
            u = u.reshape(1)
        width = len(names)
        if u.ndim not in (1, 2) or u.shape[-1] != width or (u.ndim == 2 and len(u) not in (1, rows)):
            raise ValueError(
                f"u has the shape {u.shape}: expected ({width},) or ({rows}, {width}), "
                f"for the inputs {', '.join(names) or '(none)'}"
            )
        return u.reshape(-1, width) if width else np.zeros((1, 0))


def check_names(kind: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Raises ValueError for the first unknown name, with the nearest known name."""
    for name in given:
        if name not in known:
            raise ValueError(unknown(kind, name, known))
