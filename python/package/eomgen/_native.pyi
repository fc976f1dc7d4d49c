"""Compiled part of the package. Arguments are contiguous float64 arrays in SI units and are not converted."""

from typing import Callable, List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]

MAX_ORDER: int
VERSION: str

class SpecificationError(ValueError): ...

class SimulationError(RuntimeError):
    trajectory: object

class DiscoveryError(RuntimeError): ...
class RefusedValue(Exception): ...
class RefusedType(Exception): ...

class Simulation:
    def __init__(
        self,
        model: Model,
        start: float,
        state: _Array,
        inputs: _Array,
        settings: Tuple[str, float, float],
    ) -> None: ...
    def advance(self, until: float) -> None: ...
    def set_inputs(self, inputs: _Array) -> None: ...
    def set_state(self, state: _Array) -> None: ...
    @property
    def t(self) -> float: ...
    @property
    def state(self) -> _Array: ...
    @property
    def inputs(self) -> _Array: ...
    @property
    def solver(self) -> str: ...
    @property
    def controller_state_names(self) -> List[str]: ...
    @property
    def controller_states(self) -> _Array: ...
    def observables(self) -> _Array: ...
    def take_events(self) -> List[Tuple[float, str, str, str, str, List[float]]]: ...

class RecordedMotion:
    def gradient(
        self, model: Model, states: _Array, observables: _Array
    ) -> Tuple[Optional[_Array], List[Tuple[str, float]], _Array]: ...

class Model:
    @staticmethod
    def of_text(name: str, text: str, order: Optional[int]) -> Model: ...
    @staticmethod
    def of_file(path: str, order: Optional[int]) -> Model: ...
    def with_parameters(self, settings: List[Tuple[str, float]]) -> Model: ...
    def with_inputs(self, given: List[Tuple[str, str]]) -> Model: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def order(self) -> Optional[int]: ...
    @property
    def orders(self) -> List[int]: ...
    @property
    def warnings(self) -> Optional[str]: ...
    @property
    def text(self) -> str: ...
    @property
    def states(self) -> List[Tuple[str, str]]: ...
    @property
    def controlled_inputs(self) -> List[str]: ...
    @property
    def controller_states(self) -> List[Tuple[str, str]]: ...
    @property
    def first_order_states(self) -> int: ...
    @property
    def inputs(self) -> List[Tuple[str, str]]: ...
    @property
    def observables(self) -> List[Tuple[str, str]]: ...
    @property
    def parameters(self) -> List[Tuple[str, float, str]]: ...
    @property
    def independent_parameters(self) -> List[str]: ...
    @property
    def initial(self) -> List[float]: ...

def nearest(wrong: str, known: List[str]) -> Optional[str]: ...
def rates(model: Model, t: _Array, x: _Array, u: _Array, out: _Array) -> None: ...
def observables(model: Model, t: _Array, x: _Array, u: _Array, out: _Array) -> None: ...
def jacobian(model: Model, name: str, t: _Array, x: _Array, u: _Array, out: _Array) -> None: ...
def mass_matrix(model: Model, t: _Array, x: _Array, u: _Array, out: _Array) -> None: ...
def derive(model: Model, format: str) -> str: ...
def validate(model: Model, extras: List[str]) -> str: ...
def generate(
    model: Model, target: str, extras: List[str]
) -> Tuple[List[Tuple[str, Sequence[int]]], List[str]]: ...
def compare(
    model: Model, dataset: str, seed: int, progress: Callable[[str], object]
) -> Tuple[str, str]: ...
def modes(
    model: Model, t: float, x: _Array, u: _Array
) -> Tuple[
    List[Tuple[str, str]],
    List[
        Tuple[
            float,
            float,
            Tuple[float, float],
            List[Tuple[float, float]],
            Optional[float],
        ]
    ],
]: ...
def sweep(
    model: Model,
    vary: List[str],
    samples: Optional[int],
    seed: int,
    measures: List[str],
    frequency: str,
    span: Tuple[int, int],
    until: Optional[float],
    section: Optional[str],
    inputs: List[str],
    record: Optional[Tuple[str, str]],
    state: List[str],
    out: str,
    threads: int,
    progress: Callable[[int, int], object],
) -> Tuple[List[Tuple[str, str]], List[List[float]], List[str]]: ...
def linearise(
    model: Model, t: float, x: _Array, u: _Array
) -> Tuple[List[float], List[float], List[float], List[float], List[float], List[float]]: ...
def move_onto_constraints(model: Model, t: float, x: _Array, u: _Array) -> Tuple[List[float], Optional[str]]: ...
def discretise(model: Model, a: _Array, b: _Array, period: float) -> Tuple[List[float], List[float]]: ...
def trim(
    model: Model, start: List[Tuple[str, float]], fixed: List[Tuple[str, float]]
) -> Tuple[
    float, List[float], List[float], List[float], List[str], List[str], str, bool
]: ...
def simulate(
    model: Model,
    initial: _Array,
    times: _Array,
    input_times: _Array,
    input_values: _Array,
    functions: List[Tuple[str, int, Callable[[float], object]]],
    expressions: List[Tuple[str, str]],
    breaks: List[float],
    solver: str,
    tolerance: float,
    max_step: float,
    controller: Optional[
        Tuple[Callable[..., object], List[int], Tuple[float, float, float]]
    ],
    gradients: bool,
    progress: Optional[Callable[[float], object]],
) -> Tuple[
    str,
    Optional[str],
    Optional[Tuple[Optional[float], str]],
    _Array,
    _Array,
    _Array,
    List[Tuple[float, str, str, str, str, List[float]]],
    List[str],
    List[str],
    _Array,
    Optional[RecordedMotion],
    Optional[BaseException],
]: ...
def discover(
    model: Model, dataset: str, seed: int, progress: Callable[[str], object]
) -> Tuple[str, str, str, List[Tuple[str, str]]]: ...
def equations(model: Model) -> str: ...
