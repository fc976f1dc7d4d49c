"""Compares the time of a call with 100,000 states with the time of the machine code.

    python python/benches/many_states.py [SPECIFICATION ...]

The time of the machine code is measured by a Rust loop over the same states, in memory that is already allocated:
`sim/compiled_model/examples/rates_of_many_states.rs`, which cargo builds. Both programs run in turn, and the
shortest time of each counts. The rates must be bit-identical.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import eomgen

PROJECT = Path(__file__).resolve().parents[2]
SHIPPED = [
    PROJECT / "model-spec" / "models" / f"{name}.toml"
    for name in ("planetary_arm", "two_link_arm", "double_pendulum")
]
STATES = 100_000
TURNS, PASSES = 5, 20

BUILD = ["cargo", "build", "--release", "--package", "eomgen-compiled-model", "--example"]
EXAMPLE = "rates_of_many_states"


def example() -> str:
    """Returns the path of the loop in Rust."""
    run = subprocess.run(
        [*BUILD, EXAMPLE, "--message-format", "json-render-diagnostics"],
        cwd=PROJECT, check=True, stdout=subprocess.PIPE, text=True,
    )
    built = [json.loads(line) for line in run.stdout.splitlines()]
    return next(
        line["executable"]
        for line in built
        if line.get("reason") == "compiler-artifact" and line["target"]["name"] == EXAMPLE
    )


def measured(loop: str, path: Path) -> None:
    """Measures and prints both times for a specification."""
    m = eomgen.load(path)
    x = m.initial + 1e-4 * np.random.default_rng(1).standard_normal((STATES, len(m.states)))
    own, called = np.inf, np.inf
    with tempfile.TemporaryDirectory() as folder:
        states = Path(folder) / "states"
        x.tofile(states)
        for _ in range(TURNS):
            run = subprocess.run([loop, path, states, str(PASSES)], check=True, capture_output=True)
            own = min(own, float(run.stderr))
            for _ in range(PASSES):
                begin = time.perf_counter()
                rates = m.rates(0.0, x)
                called = min(called, 1e9 * (time.perf_counter() - begin) / STATES)
    assert rates.tobytes() == run.stdout, "other bits"
    state = x[0].copy()
    begin = time.perf_counter()
    for _ in range(10_000):
        m.rates(0.0, state)
    single = (time.perf_counter() - begin) / 10_000
    print(
        f"{m.name:20} machine code {own:7.1f} ns a state, from Python {called:7.1f}, "
        f"{called / own:.2f} times; one state a call {1e6 * single:.1f} us"
    )


if __name__ == "__main__":
    loop = example()
    for path in [Path(given) for given in sys.argv[1:]] or SHIPPED:
        measured(loop, path)
