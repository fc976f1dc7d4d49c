"""Linearisation of a model."""

from __future__ import annotations

from typing import Iterator, NamedTuple, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _native

Array = NDArray[np.float64]


class DiscreteLinearisation(NamedTuple):
    """Discrete-time linear model, dx[k+1] = A dx[k] + B du[k] and dy[k] = C dx[k] + D du[k], for inputs held over each
    period (s). dx, du and dy are differences from an equilibrium. It unpacks: `A, B, C, D, period = ...`.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    period: float


class Linearisation:
    """Linear model d(dx)/dt = rates + A dx + B du, dy = C dx + D du, where dx, du and dy are differences from
    the operating point. It unpacks: `A, B, C, D = m.linearise()`.

    A: (states, states). B: (states, inputs). C: (outputs, states). D: (outputs, inputs). The outputs are the
    observables. states, inputs, outputs: names. x: (states,) and u: (inputs,), the operating point. rates:
    (states,), 0 at an equilibrium. y: (outputs,), the observables at the operating point. All in SI.
    """

    def __init__(
        self,
        native: "_native.Model",
        states: Tuple[str, ...],
        inputs: Tuple[str, ...],
        outputs: Tuple[str, ...],
        x: Array,
        u: Array,
        a: Sequence[float],
        b: Sequence[float],
        c: Sequence[float],
        d: Sequence[float],
        rates: Sequence[float],
        observables: Sequence[float],
    ):
        self.states, self.inputs, self.outputs = states, inputs, outputs
        self._native = native
        self.x, self.u = x.copy(), u.copy()
        self.A = np.array(a).reshape(len(states), len(states))
        self.B = np.array(b).reshape(len(states), len(inputs))
        self.C = np.array(c).reshape(len(outputs), len(states))
        self.D = np.array(d).reshape(len(outputs), len(inputs))
        self.rates, self.y = np.array(rates), np.array(observables)

    def discretise(self, period: float) -> DiscreteLinearisation:
        """Returns the discrete-time linear model for inputs held over each period (s)."""
        seconds = _arguments.real("period", period)
        a, b = _native.discretise(self._native, self.A.ravel(), self.B.ravel(), seconds)
        a, b = np.array(a).reshape(self.A.shape), np.array(b).reshape(self.B.shape)
        return DiscreteLinearisation(a, b, self.C.copy(), self.D.copy(), seconds)

    def __iter__(self) -> Iterator[Array]:
        return iter((self.A, self.B, self.C, self.D))

    def __repr__(self) -> str:
        sizes = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<eomgen.Linearisation: {sizes}>"
