"""Moves a unit with dry friction through rest: held by friction, released by an input, saved and restored in the middle
of a rest, with two instances at once, from a folder with a space and non-ASCII characters.

Arguments: the unit, the name of its coordinate, the name of its input, an input that moves it, and the time by which it
rests.
"""

import ctypes
import shutil
import sys
import tempfile

import numpy
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave

unit, name, drive = sys.argv[1:4]
strong, rest = float(sys.argv[4]), float(sys.argv[5])
folder = tempfile.mkdtemp(suffix=" with spaces and ü")
extract(unit, folder)
description = read_model_description(folder)
is_two = description.fmiVersion == "2.0"
reference = {variable.name: variable.valueReference for variable in description.modelVariables}


def make(exchange):
    kinds = ((FMU2Slave, FMU2Model), (FMU3Slave, FMU3Model))
    part = description.modelExchange if exchange else description.coSimulation
    guid = description.guid if is_two else description.instantiationToken
    made = kinds[not is_two][exchange](
        guid=guid, unzipDirectory=folder, modelIdentifier=part.modelIdentifier, instanceName="one"
    )
    made.instantiate()
    if is_two:
        made.setupExperiment(startTime=0.0)
        made.enterInitializationMode()
    else:
        made.enterInitializationMode(startTime=0.0)
    made.exitInitializationMode()
    return made


def get(one, *names):
    references = [reference[name] for name in names]
    return numpy.array(one.getReal(references) if is_two else one.getFloat64(references))


def put(one, name, value):
    (one.setReal if is_two else one.setFloat64)([reference[name]], [value])


def save(one):
    return one.getFMUstate() if is_two else one.getFMUState()


def restore(one, state):
    (one.setFMUstate if is_two else one.setFMUState)(state)


def step(one, t, h):
    one.doStep(currentCommunicationPoint=t, communicationStepSize=h)


# Co-simulation: the energy does not grow, and the friction holds the motion exactly.
one, other = make(False), make(False)
h = 0.01
steps = round(rest / h)
energies = []
for k in range(steps):
    step(one, k * h, h)
    if k % 2:
        # Another instance, at another pace.
        step(other, (k - 1) * h, 2 * h)
    energies.append(get(one, "energy")[0])
energies = numpy.array(energies)
size = numpy.ptp(energies)
assert (numpy.diff(energies) <= 1e-7 * size).all(), numpy.diff(energies).max() / size
speed = f"{name}_dot"
acceleration = f"der({speed})"
there = get(one, name, speed)
rates = get(one, f"der({name})")
assert abs(there[1]) <= 1e-11 and abs(there[0]) > 1e-3 and abs(rates[0]) <= 1e-11, (there, rates)
assert numpy.abs(get(other, name) - there[0]).max() <= 1e-7 * abs(there[0])
assert abs(get(one, acceleration)[0]) <= 1e-9, get(one, acceleration)

# A saved rest: the same again, and after other inputs.
saved = save(one)
bytes_ = one.serializeFMUstate(saved) if is_two else one.serializeFMUState(saved)
again = one.deSerializeFMUstate(bytes_) if is_two else one.deserializeFMUState(bytes_)
t = steps * h
ends = []
for state in (None, saved, again):
    if state:
        restore(one, state)
    for k in range(20):
        step(one, t + k * h, h)
    still = get(one, name)[0]
    assert abs(still - there[0]) <= 1e-11, (still, there)
    put(one, drive, strong)
    for k in range(20, 60):
        step(one, t + k * h, h)
    ends.append(get(one, name)[0])
    put(one, drive, 0.0)
assert abs(ends[0] - there[0]) > 1e-3, (ends, there)
assert numpy.ptp(ends) <= 1e-6 * abs(ends[0]), ends

# Model exchange, with the classical Runge-Kutta method and bisection: the same rest, also after it was saved.
model = make(True)


def handle_event():
    model.enterEventMode()
    flags = model.newDiscreteStates() if is_two else model.updateDiscreteStates()
    assert not flags[0]
    model.enterContinuousTimeMode()


def vector(call, count):
    out = numpy.zeros(count)
    call(out.ctypes.data_as(pointer), count)
    return out


pointer = ctypes.POINTER(ctypes.c_double)
rates_of = model.getDerivatives if is_two else model.getContinuousStateDerivatives
indicators = description.numberOfEventIndicators
handle_event()
state = vector(model.getContinuousStates, 2)


def rates_at(t, x):
    model.setTime(t)
    model.setContinuousStates(numpy.ascontiguousarray(x).ctypes.data_as(pointer), 2)
    return vector(rates_of, 2)


def advance(t, x, h):
    a = rates_at(t, x)
    b = rates_at(t + h / 2, x + h / 2 * a)
    c = rates_at(t + h / 2, x + h / 2 * b)
    d = rates_at(t + h, x + h * c)
    return x + h / 6 * (a + 2 * b + 2 * c + d)


def signs_at(t, x):
    rates_at(t, x)
    return numpy.sign(vector(model.getEventIndicators, indicators))


def simulate(t, state, until, h=1e-3):
    while t < until - 1e-9:
        before = signs_at(t, state)
        assert (before != 0).all()
        end, length = advance(t, state, h), h
        crossed = (signs_at(t + h, end) != before).any()
        if crossed:
            near = 0.0
            for _ in range(60):
                middle = (near + length) / 2
                if middle <= near or middle >= length:
                    break
                if (signs_at(t + middle, advance(t, state, middle)) != before).any():
                    length = middle
                else:
                    near = middle
            end = advance(t, state, length)
        t, state = t + length, end
        rates_at(t, state)
        needs_event = model.completedIntegratorStep()[0]
        if crossed or needs_event:
            handle_event()
            state = vector(model.getContinuousStates, 2)
    return t, state


t, state = simulate(0.0, state, rest)
assert abs(state[0] - there[0]) <= 1e-5 * abs(there[0]) and abs(state[1]) <= 1e-11, (state, there)
held = rates_at(t, state)
assert (numpy.abs(held) <= 1e-9).all(), held
# Within the rest the acceleration does not depend on the input.
knowns, seeds = [reference[drive]], [1.0]
derivative = model.getDirectionalDerivative([reference[acceleration]], knowns, seeds)
assert abs(derivative[0]) <= 1e-6, derivative
saved = save(model)
t, state = simulate(t, state, t + 0.1)
restore(model, saved)
assert numpy.abs(vector(model.getContinuousStates, 2) - state).max() <= 1e-12 * abs(state[0])
assert (numpy.abs(rates_at(t, state)) <= 1e-9).all(), rates_at(t, state)
model.enterEventMode()
put(model, drive, strong)
(model.newDiscreteStates if is_two else model.updateDiscreteStates)()
model.enterContinuousTimeMode()
moved = rates_at(t, state)
assert abs(moved[1]) > 1e-2, moved
shutil.rmtree(folder, ignore_errors=True)
