"""Conversion of arguments to contiguous float64 arrays of the model's sizes."""

from __future__ import annotations

import math
import operator
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

Array = NDArray[np.float64]

FLOAT = np.dtype(np.float64)


def numbers(what: str, given: ArrayLike) -> Array:
    """Converts to a contiguous float64 array. Raises TypeError unless all entries are real numbers."""
    if type(given) is np.ndarray and given.dtype is FLOAT and given.flags.c_contiguous:
        return given
    if isinstance(given, np.ma.MaskedArray):
        raise TypeError(f"{what}: a masked array; fill it, or remove the masked rows")
    try:
        array = np.asarray(given)
    except ValueError as error:
        raise TypeError(f"{what}: expected an array of numbers: {error}") from None
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what}: expected real numbers, not {array.dtype}")
    return np.asarray(array, dtype=np.float64, order="C")


def real(what: str, given: Any) -> float:
    """Converts to one finite number."""
    array = numbers(what, given)
    if array.size != 1:
        raise TypeError(f"{what}: expected one number, not an array of shape {array.shape}")
    value = float(array.reshape(()))
    if not math.isfinite(value):
        raise ValueError(f"{what} = {value}: expected a finite number")
    return value


def whole(what: str, given: Any, most: int = 2**63 - 1) -> int:
    """Converts to a whole number from 0 to `most`."""
    expected = f"expected a whole number from 0 to {most}"
    if isinstance(given, (bool, np.bool_)):
        raise TypeError(f"{what} = {given}: {expected}")
    try:
        value = operator.index(given)
    except TypeError:
        raise TypeError(f"{what} = {given!r}: {expected}") from None
    if not 0 <= value <= most:
        raise ValueError(f"{what} = {value}: {expected}")
    return value


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
    """Times, states and inputs of one call, a row for each state.

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
