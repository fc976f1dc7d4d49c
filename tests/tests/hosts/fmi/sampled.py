"""Steps a unit with sampled controllers in co-simulation, and compares states, observables and states of controllers with a
table that `simulate` wrote. Saves, restores, resets and refuses.

Arguments: the unit, the table, and the largest difference relative to the largest value of a column.
"""

import csv
import sys

import fmpy
import numpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

unit, table, limit = sys.argv[1], sys.argv[2], float(sys.argv[3])
problems = validate_fmu(unit)
assert not problems, problems
with open(table, newline="") as file:
    rows = list(csv.reader(file))
names = rows[0][1:]
expected = numpy.array([[float(number) for number in row] for row in rows[1:]])
times, expected = expected[:, 0], expected[:, 1:]
sizes = numpy.maximum(numpy.abs(expected).max(axis=0), 1e-12)

description = fmpy.read_model_description(unit)
variables = {variable.name: variable for variable in description.modelVariables}
outputs = [name for name, variable in variables.items() if variable.causality == "output"]
assert set(outputs) == set(names), (outputs, names)
assert [name for name, variable in variables.items() if variable.causality == "input"] == ["r"]
is_two = description.fmiVersion == "2.0"
one = (FMU2Slave if is_two else FMU3Slave)(
    guid=description.guid if is_two else description.instantiationToken,
    unzipDirectory=fmpy.extract(unit),
    modelIdentifier=description.coSimulation.modelIdentifier,
    instanceName="one",
)
get_numbers = one.getReal if is_two else one.getFloat64
put_numbers = one.setReal if is_two else one.setFloat64
references = [variables[name].valueReference for name in names]


def start():
    if is_two:
        one.setupExperiment(startTime=0.0, tolerance=1e-11)
        one.enterInitializationMode()
    else:
        one.enterInitializationMode(startTime=0.0, tolerance=1e-11)
    put_numbers([variables["r"].valueReference], [0.2])
    one.exitInitializationMode()


def check(row):
    found = numpy.array(get_numbers(references))
    wrong = numpy.abs(found - expected[row]) > limit * sizes
    assert not wrong.any(), (times[row], names, found, expected[row])


def follow(first, last):
    for row in range(first, last):
        one.doStep(currentCommunicationPoint=times[row], communicationStepSize=times[row + 1] - times[row])
        check(row + 1)


def refused(name, value):
    before = get_numbers(references)
    try:
        put_numbers([variables[name].valueReference], [value])
    except FMICallException:
        assert get_numbers(references) == before
        return True
    return False


one.instantiate()
start()
check(0)
assert all(refused(name, 1.0) for name in ("u", "v", "e_i", "count"))
middle, end = len(times) // 2, len(times) - 1
follow(0, middle)
saved = one.getFMUstate() if is_two else one.getFMUState()
bytes_ = one.serializeFMUstate(saved) if is_two else one.serializeFMUState(saved)
follow(middle, end)
# Its own length: other outputs wait at other times.
again = one.deSerializeFMUstate(bytes_) if is_two else one.deserializeFMUState(bytes_)
for state in (saved, again):
    (one.setFMUstate if is_two else one.setFMUState)(state)
    check(middle)
    follow(middle, end)
# A tunable parameter changes between two samples, then returns: the controllers continue.
(one.setFMUstate if is_two else one.setFMUState)(saved)
mass = variables["m"]
put_numbers([mass.valueReference], [2 * float(mass.start)])
put_numbers([mass.valueReference], [float(mass.start)])
check(middle)
follow(middle, end)
one.reset()
start()
check(0)
follow(0, middle)
one.terminate()
one.freeInstance()
