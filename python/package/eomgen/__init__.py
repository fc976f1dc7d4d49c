"""Equations of motion from a specification: derivation, compilation, simulation, comparison with records.

    >>> import eomgen
    >>> m = eomgen.load("pendulum.toml")
    >>> m.rates(0.0, [0.1, 0.0])
    >>> r = m.simulate(until=2, interval=1e-3)
    >>> r["theta"]

All numbers are in SI units, except parameters, which are in their declared units.
"""

from ._native import VERSION as __version__
from ._native import DiscoveryError, SimulationError, SpecificationError
from .certificate import Certificate
from .comparison import Comparison
from .discovery import Discovery, discover
from .equilibrium import Equilibrium
from .gradient import Gradient
from .linearisation import DiscreteLinearisation, Linearisation
from .model import Model, SpecificationWarning, load
from .modes import Mode
from .records import record_to_csv
from .simulation import Simulation
from .sweep import Sweep
from .trajectory import Event, Trajectory

__all__ = [
    "Certificate",
    "Comparison",
    "Discovery",
    "DiscoveryError",
    "DiscreteLinearisation",
    "Equilibrium",
    "Event",
    "Gradient",
    "Linearisation",
    "Mode",
    "Model",
    "Simulation",
    "SimulationError",
    "SpecificationError",
    "SpecificationWarning",
    "Sweep",
    "Trajectory",
    "__version__",
    "discover",
    "load",
    "record_to_csv",
]
