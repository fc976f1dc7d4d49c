"""Gradients of simulated motions."""

from __future__ import annotations

from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _arguments

Array = NDArray[np.float64]


class Gradient:
    """Gradient of a number that depends on the samples of a motion.

    state: derivatives with respect to the initial state, (states,), SI; None if friction holds the motion at the start.
    parameters: derivatives with respect to the independent parameters by name, in declared units, at constant initial
    state. inputs: derivatives with respect to the inputs that are numbers or arrays, by name, SI; an array has one
    derivative per sample. There are no derivatives with respect to prescribed motion.
    """

    def __init__(
        self,
        recorded: Tuple[Any, Any, Sequence[str], Mapping[str, int]],
        names: Tuple[Sequence[str], Sequence[str]],
        samples: int,
        weights: Mapping[str, Any],
    ):
        native, model, inputs, columns = recorded
        expected = "a mapping of names of states and observables to arrays"
        if not isinstance(weights, Mapping):
            raise TypeError(_arguments.rejected("weights", weights, expected))
        tables = [np.zeros((samples, len(group))) for group in names]
        for name, given in weights.items():
            # Observables take precedence, as in a trajectory.
            group = 1 if name in names[1] else 0
            if name not in names[group]:
                known = (*names[0], *names[1])
                raise ValueError(_arguments.unknown("state or observable", name, known))
            column = _arguments.numbers(f"the weights of {name}", given)
            if column.shape != (samples,):
                raise ValueError(
                    f"the weights of {name} have the shape {column.shape}: expected ({samples},), one for each sample"
                )
            if not np.isfinite(column).all():
                raise ValueError(f"a weight of {name} is {column[~np.isfinite(column)][0]}: expected finite numbers")
            tables[group][:, names[group].index(name)] = column
        state, parameters, by_inputs = native.gradient(model, *tables)
        self.state: Optional[Array] = state
        self.parameters: Dict[str, float] = dict(parameters)
        self.inputs: Dict[str, Union[float, Array]] = {}
        for name, rows in columns.items():
            column = by_inputs[:, inputs.index(name)]
            # Prescribed motion is not held between its samples.
            if not np.isnan(column).any():
                self.inputs[name] = column if rows > 1 else float(column.sum())

    def __repr__(self) -> str:
        return f"<eomgen.Gradient: by {len(self.parameters)} parameters, {len(self.inputs)} inputs>"
