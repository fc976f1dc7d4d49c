"""Validates a unit by FMPy, simulates both of its kinds, and compares all states and observables with
a table that `simulate` wrote.

Arguments: the unit, the table, the tolerance of model exchange, and the largest differences of model exchange and of
co-simulation, relative to the largest value of a column.
"""

import csv
import sys

import fmpy
import numpy
from fmpy.validation import validate_fmu

unit, table = sys.argv[1:3]
tolerance, *limits = map(float, sys.argv[3:6])
problems = validate_fmu(unit)
assert not problems, problems

with open(table, newline="") as file:
    rows = list(csv.reader(file))
names = rows[0]
expected = numpy.array([[float(number) for number in row] for row in rows[1:]])
times = expected[:, 0]

description = fmpy.read_model_description(unit)
outputs = [v.name for v in description.modelVariables if v.causality == "output"]
assert set(outputs) == set(names[1:]), (outputs, names)
platforms = fmpy.supported_platforms(unit)
assert fmpy.platform in platforms or fmpy.platform_tuple in platforms, platforms

for kind, limit in zip(("ModelExchange", "CoSimulation"), limits):
    found = fmpy.simulate_fmu(
        unit,
        fmi_type=kind,
        stop_time=times[-1],
        output_interval=times[1] - times[0],
        relative_tolerance=tolerance if kind == "ModelExchange" else 1e-10,
        solver="CVode",
        output=outputs,
        record_events=False,
    )
    assert len(found) == len(times), (kind, len(found), len(times))
    for column, name in enumerate(names[1:], 1):
        # Residuals of constraints are rounding.
        right = expected[:, column]
        size = numpy.abs(right).max()
        worst = numpy.abs(found[name] - right).max()
        assert worst <= limit * (size if size > 1e-12 else 1.0), (kind, name, worst, size)
