"""Equilibrium of a model."""

from __future__ import annotations

from typing import Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _arguments

Array = NDArray[np.float64]


class Equilibrium:
    """Equilibrium of a model, at rest or in steady motion. All numbers are in SI.

    t: time, s. x: state, (states,). u: inputs at the equilibrium, (inputs,). residual: accelerations and rates
    of first-order states, zero up to rounding. states, inputs: names of x and u. steady_rates: names of
    the rates with a constant nonzero value. free: names of the unknowns of the search. stability:
    "asymptotically stable", "marginal" or "unstable". depends_on_time: True if forces depend on time; the
    state is then an equilibrium at t only.
    """

    def __init__(
        self,
        states: Tuple[str, ...],
        inputs: Tuple[str, ...],
        t: float,
        x: Sequence[float],
        u: Sequence[float],
        residual: Sequence[float],
        steady_rates: Sequence[str],
        free: Sequence[str],
        stability: str,
        depends_on_time: bool,
    ):
        self.states, self.inputs = states, inputs
        self.t, self.x, self.u = t, np.array(x), np.array(u)
        self.residual = np.array(residual)
        self.steady_rates, self.free = tuple(steady_rates), tuple(free)
        self.stability, self.depends_on_time = stability, depends_on_time

    @property
    def running(self) -> Tuple[str, ...]:
        """Earlier name of `steady_rates`."""
        return self.steady_rates

    def __getitem__(self, name: str) -> float:
        """Returns the value of a state or of an input."""
        for names, values in ((self.states, self.x), (self.inputs, self.u)):
            if name in names:
                return float(values[names.index(name)])
        raise KeyError(_arguments.unknown("state or input", name, self.states + self.inputs))

    def __repr__(self) -> str:
        motion = f"steady motion: {', '.join(self.steady_rates)}" if self.steady_rates else "at rest"
        return f"<eomgen.Equilibrium: {motion}, {self.stability}>"
