"""Tests of the conversion of NumPy and MATLAB records to CSV, and of rejected files."""

import csv

import numpy as np
import pytest

import eomgen

T = np.linspace(0.0, 1.0, 101)
ARRAYS = {"t": T, "u": np.sin(3 * T) / 7, "enc": np.column_stack([T**2, -T / 3]), "rate": np.array(100.0)}


def columns(path):
    """Returns the names and the numbers of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array([[float(cell) if cell else np.nan for cell in row] for row in rows[1:]])


def test_numpy_arrays_keep_all_digits(tmp_path):
    np.savez(tmp_path / "run.npz", **ARRAYS)
    names = eomgen.record_to_csv(tmp_path / "run.npz", tmp_path / "run.csv")
    assert names == ["t", "u", "enc_1", "enc_2"]
    head, numbers = columns(tmp_path / "run.csv")
    assert head == names
    assert (numbers == np.column_stack([T, ARRAYS["u"], ARRAYS["enc"]])).all()
    assert eomgen.record_to_csv(tmp_path / "run.npz", tmp_path / "run.csv", ["u", "t"]) == ["u", "t"]


def test_matlab_files_are_converted(tmp_path):
    io = pytest.importorskip("scipy.io")
    io.savemat(tmp_path / "run.mat", {**ARRAYS, "note": "by hand", "short": T[:7]})
    with pytest.warns(UserWarning, match="skipped.*short"):
        names = eomgen.record_to_csv(tmp_path / "run.mat", tmp_path / "run.csv")
    assert names == ["t", "u", "enc_1", "enc_2"]
    _, numbers = columns(tmp_path / "run.csv")
    assert (numbers[:, 1] == ARRAYS["u"]).all()


def test_arrays_without_real_samples_are_named(tmp_path):
    np.savez(tmp_path / "run.npz", t=T, response=np.exp(1j * T), words=np.array(["a", "b"]))
    with pytest.warns(UserWarning, match=r"no real samples: response \(complex128\), words"):
        names = eomgen.record_to_csv(tmp_path / "run.npz", tmp_path / "run.csv")
    assert names == ["t"]


def test_invalid_records_are_rejected_without_output(tmp_path):
    np.savez(tmp_path / "run.npz", t=T, short=T[:7], words=np.array(["a", "b"]))
    np.savez(tmp_path / "none.npz", rate=np.array(100.0))
    (tmp_path / "new.mat").write_bytes(b"MATLAB 7.3 MAT-file, and so on")
    for name, wanted, part in [
        ("run.npz", ["v"], "has no array 'v'; it has t, short, words"),
        ("run.npz", ["t", "short"], "short must have 101 samples"),
        ("run.npz", ["words"], "expected real samples"),
        ("none.npz", None, "holds no arrays of samples"),
        ("new.mat", None, "-v7"),
        ("run.csv", None, "ends in .npz or .mat"),
    ]:
        with pytest.raises(ValueError, match=part):
            eomgen.record_to_csv(tmp_path / name, tmp_path / "out.csv", wanted)
        assert not (tmp_path / "out.csv").exists()
