"""Shared models and the shipped specifications."""

import _thread
import contextlib
import os
import shutil
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import eomgen

PROJECT = Path(__file__).resolve().parents[2]
SPECIFICATIONS = PROJECT / "model-spec" / "models"

# Stage with a specification that lacks the dry friction.
STAGE = SPECIFICATIONS / "emps.toml"

# Smooth friction of 12 N, which is added to the simulated stage.
HIDDEN = (
    '[parameters]\nlevel = { value = 12, unit = "N" }\nspeed = { value = 2e-4, unit = "m/s" }\n',
    '[forces]\nhidden = { on = "q", value = "-level*dot(q)/sqrt(dot(q)^2 + speed^2)" }\n',
)


@pytest.fixture(scope="session")
def arm():
    """Returns the planetary arm with four modes."""
    return eomgen.load(SPECIFICATIONS / "planetary_arm_rig.toml")


@pytest.fixture(scope="session")
def pendulum():
    return eomgen.load(SPECIFICATIONS / "pendulum.toml")


@pytest.fixture(scope="session")
def cart():
    """Returns a cart with two arms, driven by a force, a nonlinear model."""
    return eomgen.load(SPECIFICATIONS / "cart_two_arms.toml")


@pytest.fixture(scope="session")
def program():
    """Returns the path of the program `eomgen` of the same version."""
    found = os.environ.get("EOMGEN_PROGRAM") or shutil.which("eomgen")
    if found is None:
        pytest.skip("no program `eomgen`: EOMGEN_PROGRAM names it")
    return found


@pytest.fixture
def states():
    """Returns random states of a model, one per row."""

    def of(model, count, size=1e-3):
        return size * np.random.default_rng(1).standard_normal((count, len(model.states)))

    return of


@pytest.fixture
def interrupt():
    """Sends Ctrl-C during the block, which must end soon afterwards, even on a busy machine.

    A process that a shell started in the background ignores Ctrl-C, and so does Python; therefore the
    handler is set.
    """

    @contextlib.contextmanager
    def pressed(after):
        sent = []

        def press():
            sent.append(time.monotonic())
            _thread.interrupt_main(signal.SIGINT)

        timer = threading.Timer(after, press)
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            signal.signal(signal.SIGINT, before)
            lasted = time.monotonic() - sent[0] if sent else -1.0
            assert 0.0 <= lasted < 3.0, f"stopped {lasted:.2f} s after Ctrl-C"

    return pressed


def with_hidden_friction(text):
    """Returns the specification of the stage with the hidden friction."""
    parameters, forces = HIDDEN
    return text.replace("[parameters]\n", parameters).replace("[forces]\n", forces)


def write_record(path, turn, samples=750, step=0.002, noise=2e-6):
    """Simulates a record of the stage with its friction; `turn` selects the input."""
    truth = eomgen.load(with_hidden_friction(STAGE.read_text(encoding="utf-8")))
    t = np.arange(samples) * step
    force = 300 * np.cos(5 * t + turn) - 150 * np.sin(13 * t * (1 + 0.3 * turn))
    r = truth.simulate(until=t[-1], interval=step, solver="rk", inputs={"force": force})
    random = np.random.default_rng(int(turn) + 7)
    q = r["q"] + noise * random.standard_normal(samples)
    table = np.column_stack([r.t, force, q])
    np.savetxt(path, table, delimiter=",", header="t,force,q", comments="")


DESCRIPTION = """
title = "A simulated stage in which a friction is hidden"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[inputs.force]
column = "force"
unit = "N"
hold = "zero-order"
[channels.q]
column = "q"
unit = "m"
noise = 2e-6
[initial]
state = "rest"
[uncertain]
F_v = { relative = 0.05 }
[windows]
length = 0.25
"""


@pytest.fixture(scope="session")
def dataset(tmp_path_factory):
    """Writes a dataset with a hidden friction. Returns its path."""
    folder = tmp_path_factory.mktemp("records")
    write_record(folder / "train.csv", 0.0)
    write_record(folder / "test.csv", 1.0)
    (folder / "dataset.toml").write_text(DESCRIPTION, encoding="utf-8")
    return folder / "dataset.toml"
