"""A state that stays as it is."""

from __future__ import annotations

from typing import Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Equilibrium:
    """An equilibrium of a model, at rest or running steadily.

    t: s. x: (states,). u: (inputs,), which hold the machine there. residual: (coordinates + states of
    first order,), the accelerations and rates that rounding leaves. states, inputs: names of x and u.
    running: names of the rates that are not 0. free: names of the unknowns that were solved for.
    stability: "asymptotically stable", "marginal" or "unstable". depends_on_time: whether forces depend
    on the time, so that it is an equilibrium at t alone. All SI.
    """

    def __init__(
        self,
        states: Tuple[str, ...],
        inputs: Tuple[str, ...],
        t: float,
        x: Sequence[float],
        u: Sequence[float],
        residual: Sequence[float],
        running: Sequence[str],
        free: Sequence[str],
        stability: str,
        depends_on_time: bool,
    ):
        self.states, self.inputs = states, inputs
        self.t, self.x, self.u = t, np.array(x), np.array(u)
        self.residual = np.array(residual)
        self.running, self.free = tuple(running), tuple(free)
        self.stability, self.depends_on_time = stability, depends_on_time

    def __getitem__(self, name: str) -> float:
        """The value of a state or of an input."""
        for names, values in ((self.states, self.x), (self.inputs, self.u)):
            if name in names:
                return float(values[names.index(name)])
        raise KeyError(name)

    def __repr__(self) -> str:
        motion = f"running: {', '.join(self.running)}" if self.running else "at rest"
        return f"<eomgen.Equilibrium: {motion}, {self.stability}>"
