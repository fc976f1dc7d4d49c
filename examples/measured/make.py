"""Records of a linear stage as a bench would write them, to compare and to discover with.

    python3 examples/measured/make.py examples/measured

A carriage of 4 kg on a screw is pushed by a motor. Viscous friction takes 12 N s/m, and dry
friction, which stage.toml does not know, 2.5 N. Newton's law is integrated in steps of 25 us by the
midpoint rule. The files are what many logging programs leave: lines about the bench, a line of names,
one of units, semicolons and decimal commas. Nothing of eomgen is used.
"""

import math
import pathlib
import random
import sys

MASS, VISCOUS, DRY = 4.0, 12.0, 2.5  # kg, N s/m, N
STEP, PARTS, SAMPLES = 5e-3, 200, 800  # s from sample to sample, steps between them, samples
NOISE = 20e-6  # m


def force(t, turn):
    """What the motor does, N."""
    return 9.0 * math.cos(2.9 * t + turn) + 6.0 * math.sin(7.3 * t * (1.0 + 0.2 * turn))


def acceleration(pushed, v):
    """Dry friction turns within 0.1 mm/s."""
    return (pushed - VISCOUS * v - DRY * math.tanh(v / 1e-4)) / MASS


def record(name, turn):
    """The text of a record."""
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


folder = pathlib.Path(sys.argv[1])
for name, turn in [("first.csv", 0.0), ("second.csv", 1.0)]:
    (folder / name).write_text(record(name, turn), encoding="utf-8")
