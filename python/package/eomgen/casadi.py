"""Models as CasADi functions; needs the package `casadi`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Sequence, Tuple

import casadi
import numpy as np

if TYPE_CHECKING:
    from .model import Model


class Rates(casadi.Callback):
    """Function rates(t, x, u): (states, 1) with its Jacobian, created by `Model.to_casadi`. Keep a reference to
    it while expressions use it.
    """

    def __init__(self, model: "Model", name: str):
        casadi.Callback.__init__(self)
        self._model = model
        self._jacobian: Any = None
        self.construct(name, {})

    def get_n_in(self) -> int:
        return 3

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, place: int) -> str:
        return ("t", "x", "u")[place]

    def get_name_out(self, place: int) -> str:
        return "rates"

    def get_sparsity_in(self, place: int) -> Any:
        return casadi.Sparsity.dense(self._sizes()[place], 1)

    def get_sparsity_out(self, place: int) -> Any:
        return casadi.Sparsity.dense(self._sizes()[1], 1)

    def eval(self, arguments: Sequence[Any]) -> List[Any]:
        return [self._model.rates(*point(arguments))]

    def has_jacobian(self) -> bool:
        return True

    def get_jacobian(self, name: str, names_in: Any, names_out: Any, options: Any) -> Any:
        # CasADi keeps no reference to the Jacobian.
        self._jacobian = _Jacobian(self._model, name, self._sizes(), names_in, names_out)
        return self._jacobian

    def _sizes(self) -> Tuple[int, int, int]:
        return 1, len(self._model.states), len(self._model.inputs)


class _Jacobian(casadi.Callback):
    """Jacobian blocks of the rates with respect to t, x and u, as a function of t, x, u and the rates."""

    def __init__(
        self,
        model: "Model",
        name: str,
        sizes: Tuple[int, int, int],
        names_in: List[str],
        names_out: List[str],
    ):
        casadi.Callback.__init__(self)
        self._model, self._sizes = model, sizes
        self._names_in, self._names_out = names_in, names_out
        self.construct(name, {})

    def get_n_in(self) -> int:
        return 4

    def get_n_out(self) -> int:
        return 3

    def get_name_in(self, place: int) -> str:
        return self._names_in[place]

    def get_name_out(self, place: int) -> str:
        return self._names_out[place]

    def get_sparsity_in(self, place: int) -> Any:
        return casadi.Sparsity.dense((*self._sizes, self._sizes[1])[place], 1)

    def get_sparsity_out(self, place: int) -> Any:
        return casadi.Sparsity.dense(self._sizes[1], self._sizes[place])

    def eval(self, arguments: Sequence[Any]) -> List[Any]:
        t, x, u = point(arguments)
        return [self._model.jacobian(t, x, u, by=by) for by in ("time", "state", "inputs")]


def point(arguments: Sequence[Any]) -> Tuple[float, Any, Any]:
    """Converts CasADi arguments to time, state and inputs of the model."""
    t, x, u = (np.array(casadi.densify(given)).reshape(-1) for given in arguments[:3])
    return float(t[0]), x, u
