"""Conversion of NumPy and MATLAB files to CSV records."""

from __future__ import annotations

import os
import pathlib
import tempfile
import warnings
from typing import Dict, Iterable, List, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _arguments

Path = Union[str, "os.PathLike[str]"]

# First bytes of a MATLAB 7.3 file. The format is HDF5, which SciPy does not read.
_MATLAB_7_3 = b"MATLAB 7.3"


def record_to_csv(source: Path, out: Path, columns: Optional[Iterable[str]] = None) -> List[str]:
    """Writes arrays of a `.npz` or `.mat` file as columns of a CSV file. Returns the names of the columns.

    source: a file written by `numpy.savez` or by MATLAB up to version 7 (read with SciPy). out: the CSV file, which
    is replaced if it exists. columns: arrays to write, in this order. Default: all real arrays that are as
    long as the longest one. A matrix `x` of n columns becomes x_1 to x_n. Numbers keep all digits.

    Raises ValueError for a file of another kind, a file without arrays, and columns of different lengths or
    of unsuitable types. Raises ImportError if SciPy is needed and missing.
    """
    source = _arguments.path("source", source, "the path of a .npz or .mat file")
    out = _arguments.path("out", out, "the path of a CSV file")
    named = None if columns is None else _arguments.texts("columns", columns, "names of arrays")
    arrays = _arrays(pathlib.Path(source))
    wanted = list(arrays) if named is None else named
    for name in wanted:
        if name not in arrays:
            raise ValueError(f"{source} has no array {name!r}; it has {', '.join(arrays)}")
    rows: Dict[str, NDArray[np.float64]] = {}
    unreadable: List[str] = []
    for name in wanted:
        column = _samples(arrays[name])
        if column is not None:
            rows[name] = column
        elif columns is not None:
            array = arrays[name]
            raise ValueError(
                f"{source}: {name!r} holds {array.dtype} of shape {array.shape}; expected real samples"
            )
        elif arrays[name].size > 1:
            unreadable.append(f"{name} ({arrays[name].dtype})")
    if unreadable:
        warnings.warn(f"{source}: skipped, because they hold no real samples: {', '.join(unreadable)}", stacklevel=2)
    longest = max((len(column) for column in rows.values()), default=0)
    if longest < 2:
        raise ValueError(f"{source} holds no arrays of samples; it has {', '.join(arrays) or 'none'}")
    others = [name for name, column in rows.items() if len(column) != longest]
    if others and columns is not None:
        raise ValueError(
            f"{source}: {', '.join(others)} must have {longest} samples, as the other columns"
        )
    if others:
        warnings.warn(
            f"{source}: skipped, because shorter than the others: {', '.join(others)}",
            stacklevel=2,
        )
    table = {name: column for name, column in rows.items() if len(column) == longest}
    names = [
        name if column.shape[1] == 1 else f"{name}_{place}"
        for name, column in table.items()
        for place in range(1, column.shape[1] + 1)
    ]
    _write(pathlib.Path(out), names, np.column_stack(list(table.values())))
    return names


def _arrays(source: pathlib.Path) -> Dict[str, NDArray]:
    """Reads all arrays of a file, by name."""
    kind = source.suffix.lower()
    if kind == ".npz":
        with np.load(source, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    if kind != ".mat":
        raise ValueError(f"{source}: expected a file that ends in .npz or .mat")
    with open(source, "rb") as file:
        if file.read(len(_MATLAB_7_3)) == _MATLAB_7_3:
            raise ValueError(f"{source} is a MATLAB 7.3 file, which SciPy does not read; save it with save(..., '-v7')")
    try:
        from scipy.io import loadmat
    except ImportError as error:
        raise ImportError("reading MATLAB files needs SciPy: pip install scipy") from error
    loaded = loadmat(source, squeeze_me=True)
    return {name: np.asarray(array) for name, array in loaded.items() if not name.startswith("__")}


def _samples(array: NDArray) -> Optional[NDArray[np.float64]]:
    """Returns the array with one row per sample. Returns None unless it is real and has one or two dimensions."""
    if array.dtype.kind not in "fiub" or array.ndim not in (1, 2):
        return None
    column = np.asarray(array, dtype=np.float64)
    return column[:, np.newaxis] if column.ndim == 1 else column


def _write(out: pathlib.Path, names: List[str], table: NDArray[np.float64]) -> None:
    """Writes the table to a temporary file, which then replaces `out`."""
    quoted = ['"' + name.replace('"', '""') + '"' for name in names]
    lines = [",".join(quoted)]
    lines += [",".join("" if x != x else repr(x) for x in row) for row in table.tolist()]
    out.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=out.parent, suffix=".csv")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write("\n".join(lines) + "\n")
        os.chmod(temporary, 0o644)
        os.replace(temporary, out)
    except BaseException:
        os.unlink(temporary)
        raise
