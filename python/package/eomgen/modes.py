"""Natural modes of a model."""

from __future__ import annotations

from typing import NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import NDArray


class Mode(NamedTuple):
    """Natural mode: the motion exp(eigenvalue t) shape, or its real part.

    frequency: undamped natural frequency, Hz; 0 for a rigid motion. damping: damping ratio. eigenvalue: in 1/s; for a
    conjugate pair, the one with positive imaginary part. shape: complex amplitudes, SI, scaled so that the largest is
    1. names: names of the amplitudes: coordinates, then first-order states. frequency_limit: for a rigid motion, the
    largest frequency that rounding can hide, Hz; otherwise None.
    """

    frequency: float
    damping: float
    eigenvalue: complex
    shape: NDArray[np.complex128]
    names: Tuple[str, ...]
    frequency_limit: Optional[float]
