"""Calls the functions of model exchange of a bouncing ball with two sampled controllers: announced times, values before an
event, coincidence with an impact and with changes of inputs and parameters, saved states, reset, and late events.

Argument: the unit of `sampled_ball.toml`.
"""

import ctypes
import sys

import numpy
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model
from fmpy.fmi3 import FMU3Model

unit = sys.argv[1]
description = read_model_description(unit)
is_two = description.fmiVersion == "2.0"
reference = {variable.name: variable.valueReference for variable in description.modelVariables}
one = (FMU2Model if is_two else FMU3Model)(
    guid=description.guid if is_two else description.instantiationToken,
    unzipDirectory=extract(unit),
    modelIdentifier=description.modelExchange.modelIdentifier,
    instanceName="one",
)
PERIOD, DELAY, OFFSET, SLOW = 0.1, 0.025, 0.05, 0.3


def get(*names):
    references = [reference[name] for name in names]
    values = list(one.getReal(references) if is_two else one.getFloat64(references))
    return values[0] if len(values) == 1 else values


def put(name, value):
    (one.setReal if is_two else one.setFloat64)([reference[name]], [value])


def start(t=0.0, **given):
    if is_two:
        one.setupExperiment(startTime=t)
        one.enterInitializationMode()
    else:
        one.enterInitializationMode(startTime=t)
    for name, value in given.items():
        put(name, value)
    one.exitInitializationMode()
    return update()


def update():
    """Returns whether the state changed, and the next time."""
    again, terminate, _, changed, is_defined, t = one.newDiscreteStates() if is_two else one.updateDiscreteStates()
    assert not again and not terminate and is_defined
    return bool(changed), t


def event(t, state=None, **given):
    one.enterContinuousTimeMode()
    one.setTime(t)
    if state is not None:
        one.setContinuousStates(numpy.array(state).ctypes.data_as(ctypes.POINTER(ctypes.c_double)), 2)
    one.enterEventMode()
    for name, value in given.items():
        put(name, value)
    return update()


def instants(end):
    """Returns the exact times of samples and outputs before a time."""
    samples = [k * PERIOD for k in range(round(end / PERIOD) + 1)]
    slow = [OFFSET + k * SLOW for k in range(round(end / SLOW) + 1)]
    times = sorted([*samples, *(sample + DELAY for sample in samples), *slow])
    # Times that differ by rounding are one instant.
    kept = [t for last, t in zip([-1.0, *times], times) if t - last > 1e-9]
    return [t for t in kept if t < end - 1e-9]


one.instantiate()
# The first sample is taken at the start, with the values of the initialisation.
changed, t = start(r=7.0)
assert not changed and t == DELAY
assert get("count", "read_rate", "read_r", "read_force", "u") == [1.0, 0.0, 7.0, 7.0, 0.0]
# No accumulated rounding after a thousand periods.
expected = instants(100.0)[1:]
found = []
while t < 100.0 - 1e-9:
    found.append(t)
    changed, t = event(t)
    assert not changed
assert found == expected, next(pair for pair in zip(found, expected) if pair[0] != pair[1])
assert get("count") == 1000.0
one.reset()

# A start between two samples.
assert start(0.12) == (False, 0.2) and get("count") == 0.0
one.reset()

# A controller reads the inputs and parameters before the event; the outputs act after their delay.
start(r=1.0)
event(DELAY)
acceleration = get("der(y_dot)")
assert abs(acceleration - (-10.0 + 0.5)) <= 1e-12, acceleration
assert event(OFFSET)[1] == PERIOD
v = get("v")
assert abs(v + 2.4) <= 1e-12, v
rate = -1.0
changed, t = event(PERIOD, (0.75, rate), r=5.0, k=4.0)
assert not changed and t == PERIOD + DELAY, t
assert get("read_rate", "read_r") == [rate, 1.0] and abs(get("read_force") - (1.0 + v)) <= 1e-12
assert get("u") == 0.0
# The output of the sample uses the earlier gain.
changed, t = event(t)
assert get("u") == -3.0 * rate and t == 2 * PERIOD
assert abs(get("der(y_dot)") - (-10.0 + (5.0 + 3.0 + v) / 2)) <= 1e-12
# A saved state, also in bytes, continues with the delayed output.
changed, t = event(t, (0.6, -2.0))


def follow(t):
    rows = []
    for k in range(12):
        _, t = event(t, (0.6 - 0.01 * k, -2.0 + 0.1 * k))
        rows.append((t, *get("u", "v", "count", "read_rate", "read_force", "der(y_dot)")))
    return rows


saved = one.getFMUstate() if is_two else one.getFMUState()
bytes_ = one.serializeFMUstate(saved) if is_two else one.serializeFMUState(saved)
rows = follow(t)
assert len({row[1] for row in rows}) > 3
again = one.deSerializeFMUstate(bytes_) if is_two else one.deserializeFMUState(bytes_)
for state in (saved, again):
    (one.setFMUstate if is_two else one.setFMUState)(state)
    assert follow(t) == rows
# Another period, set at a sample: this sample is taken, and the next one is a multiple of the new period.
(one.setFMUstate if is_two else one.setFMUState)(saved)
count = get("count")
_, t = event(t)
assert t == 3 * PERIOD
_, t = event(t, T=0.07)
assert get("count") == count + 1
times = []
while t < 0.5:
    times.append(t)
    _, t = event(t)
# The output of the sample at 0.3 s keeps its time; the slow controller is sampled at 0.35 s, too.
both = OFFSET + SLOW
assert times == [3 * PERIOD + DELAY, both, both + 0.07 / 4, 6 * 0.07, 6 * 0.07 + 0.07 / 4, 7 * 0.07], times
one.reset()

# An impact at the time of a sample precedes it: the controller reads the rate after the impact.
start(k=0.0)
for t in instants(0.4)[1:]:
    event(t)
changed, t = event(0.4, (-1e-12, -4.0))
assert changed and abs(get("read_rate") - 2.0) <= 1e-9 and get("count") == 5.0, get("read_rate", "count")
# A time event without event mode.
for delay in (1e-12, 1e-3):
    try:
        event(t + delay)
        assert delay == 1e-12
        t = 0.5
    except FMICallException:
        assert delay == 1e-3
one.terminate()
one.freeInstance()
