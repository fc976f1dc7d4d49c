"""Simulated records of a linear stage, for `eomgen compare` and `eomgen discover`.

    python3 examples/measured/make.py examples/measured

A motor drives a carriage of 4 kg on a screw. The viscous friction is 12 N s/m. The dry friction, which stage.toml lacks,
is 2.5 N. The midpoint rule integrates Newton's law in steps of 25 us. The files have the format of many logging
programs: lines about the test bench, a line of names, a line of units, semicolons and decimal commas. The script does
not use eomgen.
"""

import argparse
import math
import pathlib
import random

MASS, VISCOUS, DRY = 4.0, 12.0, 2.5  # kg, N s/m, N
STEP, PARTS, SAMPLES = 5e-3, 200, 800  # sample time (s), steps per sample, number of samples
NOISE = 20e-6  # m


def force(t, turn):
    """Returns the force of the motor in N."""
    return 9.0 * math.cos(2.9 * t + turn) + 6.0 * math.sin(7.3 * t * (1.0 + 0.2 * turn))


def acceleration(pushed, v):
    """Returns the acceleration in m/s^2. Dry friction changes its sign over 0.1 mm/s."""
    return (pushed - VISCOUS * v - DRY * math.tanh(v / 1e-4)) / MASS


def record(name, turn):
    """Returns the text of a record."""
    noise = random.Random(name)
    lines = ["Bench 2, linear stage", f"File: {name}", "Time;Force;Position", "s;N;mm"]
    x = v = 0.0
    h = STEP / PARTS
    for sample in range(SAMPLES):
        pushed = round(force(STEP * sample, turn), 3)  # held until the next sample
        shown = 1e3 * (x + noise.gauss(0.0, NOISE))
        lines.append(f"{STEP * sample:.3f};{pushed:.3f};{shown:.4f}".replace(".", ","))
        for _ in range(PARTS):
            middle = v + 0.5 * h * acceleration(pushed, v)
            v += h * acceleration(pushed, middle)
            x += h * middle
    return "\n".join(lines) + "\n"


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", type=pathlib.Path, help="folder for the two records")
folder = parser.parse_args().folder
for name, turn in [("first.csv", 0.0), ("second.csv", 1.0)]:
    (folder / name).write_text(record(name, turn), encoding="utf-8")
