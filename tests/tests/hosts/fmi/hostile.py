"""Calls a unit in invalid ways: every call must return a status, and none may crash.

Arguments: the unit, and `fmu2` or `fmu3`.
"""

import ctypes
import os
import pathlib
import re
import sys
import tempfile
import threading
import zipfile
from ctypes import POINTER, byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

OK, DISCARD, ERROR = 0, 2, 3
unit, version = sys.argv[1:3]
is_two = version == "fmu2"
prefix = "fmi2" if is_two else "fmi3"
folder = pathlib.Path(tempfile.mkdtemp())
with zipfile.ZipFile(unit) as archive:
    archive.extractall(folder)
(library,) = [file for file in folder.glob("binaries/*/*") if file.is_file()]
description = (folder / "modelDescription.xml").read_text()
resources = (folder / "resources").as_uri() if is_two else str(folder / "resources") + os.sep
token = re.search(r'(?:guid|instantiationToken)="([^"]*)"', description)[1].encode()
references = {
    causality: [int(n) for n in re.findall(rf'valueReference="(\d+)"[^>]*causality="{causality}"', description)]
    for causality in ("parameter", "input", "output", "local")
}
variables = len(re.findall("valueReference=", description.split("<ModelStructure>")[0]))
states = len(re.findall(r'derivative="', description))
messages = []
c = ctypes.CDLL(str(library))


def call(name, *arguments):
    function = getattr(c, prefix + name)
    function.restype = c_int
    return function(*arguments)


def doubles(*numbers):
    return (c_double * max(len(numbers), 1))(*numbers)


def vr(*numbers):
    return (c_uint * max(len(numbers), 1))(*numbers)


Logger2 = ctypes.CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_char_p)
Logger3 = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)
logger2 = Logger2(lambda e, n, s, k, f, text: messages.append(text))
logger3 = Logger3(lambda e, s, k, text: messages.append(text))


class Callbacks(ctypes.Structure):
    _fields_ = [("logger", Logger2), *[(name, c_void_p) for name in ("make", "free", "finished", "environment")]]


callbacks = Callbacks(logger2, None, None, None, None)


def instantiate(exchange, name=b"one", key=token, place=resources.encode()):
    if is_two:
        function = c.fmi2Instantiate
        arguments = (name, 0 if exchange else 1, key, place, byref(callbacks), 0, 0)
    elif exchange:
        function = c.fmi3InstantiateModelExchange
        arguments = (name, key, place, c_bool(0), c_bool(0), None, logger3)
    else:
        function = c.fmi3InstantiateCoSimulation
        none = c_bool(0)
        arguments = (name, key, place, none, none, none, none, None, c_size_t(0), None, logger3, None)
    function.restype = c_void_p
    made = function(*arguments)
    return made and c_void_p(made)


def get(one, which, count=None):
    values = doubles(*[0.0] * len(which))
    n = c_size_t(len(which) if count is None else count)
    status = call("GetReal", one, vr(*which), n, values) if is_two else call("GetFloat64", one, vr(*which), n, values, n)
    return status, list(values)[: len(which)]


def put(one, which, numbers):
    n = c_size_t(len(which))
    if is_two:
        return call("SetReal", one, vr(*which), n, doubles(*numbers))
    return call("SetFloat64", one, vr(*which), n, doubles(*numbers), n)


def initialise(one, tolerance=1e-8, start=0.0):
    if is_two:
        status = call("SetupExperiment", one, 1, c_double(tolerance), c_double(start), 0, c_double(0))
        status = status or call("EnterInitializationMode", one)
    else:
        flags = (c_bool(1), c_double(tolerance), c_double(start), c_bool(0), c_double(0))
        status = call("EnterInitializationMode", one, *flags)
    return status or call("ExitInitializationMode", one)


def step(one, t, h):
    if is_two:
        return call("DoStep", one, c_double(t), c_double(h), 1)
    flags = [c_bool() for _ in range(3)]
    last = c_double()
    return call("DoStep", one, c_double(t), c_double(h), c_bool(1), *map(byref, flags), byref(last))


# A wrong token, no token, no name, no instance.
assert not instantiate(True, key=b"wrong") and not instantiate(False, key=None)
assert not instantiate(True, name=b"") and not instantiate(True, name=None)
assert any(b"token" in text for text in messages), messages
# No resources, an unknown folder, a damaged specification, none, and two.
(specification,) = (folder / "resources").glob("*.toml")
text = specification.read_bytes()
for change, reason in [
    (lambda: None, b"resource location"),
    (lambda: specification.write_bytes(text[: len(text) // 2] + b"["), b"is damaged"),
    (lambda: specification.write_bytes(text + b"# changed\n"), b"token"),
    (lambda: specification.with_name("b.toml").write_bytes(text), b"more than one"),
    (lambda: [file.unlink() for file in (folder / "resources").glob("*.toml")], b"no specification"),
]:
    change()
    messages.clear()
    assert not instantiate(False, place=None if reason.startswith(b"resource") else resources.encode())
    assert reason in messages[0], (reason, messages)
assert not instantiate(False, place=b"/no/such/folder") and b"/no/such/folder" in messages[1], messages
specification.write_bytes(text)
c[prefix + "FreeInstance"](None)
assert get(None, [1])[0] == ERROR and step(None, 0.0, 1.0) == ERROR
assert call("Reset", None) == ERROR and call("GetFMUstate" if is_two else "GetFMUState", None, None) == ERROR

one = instantiate(False)
# Wrong state, backward step, wrong start time, infinite time.
assert step(one, 0.0, 0.1) == ERROR
assert call("ExitInitializationMode", one) == ERROR
assert call("EnterContinuousTimeMode", one) == ERROR
assert initialise(one, tolerance=float("nan")) == ERROR
assert initialise(one, start=float("inf")) == ERROR
assert initialise(one) == OK
for t, h in [(0.0, -0.1), (0.0, 0.0), (0.0, float("nan")), (0.0, float("inf")), (5.0, 0.1), (float("nan"), 0.1)]:
    assert step(one, t, h) == ERROR, (t, h)
# Unknown variables, non-finite numbers, null pointers.
assert get(one, [variables])[0] == ERROR and get(one, [2**32 - 1])[0] == ERROR
assert get(one, list(range(variables)))[0] == OK
assert call("GetReal", one, None, c_size_t(0), None) == OK if is_two else True
n = c_size_t(0)
assert is_two or call("GetFloat64", one, None, n, None, n) == OK
n = c_size_t(1)
assert (call("GetReal", one, None, n, None) if is_two else call("GetFloat64", one, None, n, None, n)) == ERROR
assert is_two or call("GetFloat64", one, vr(1), n, doubles(0.0, 0.0), c_size_t(2)) == ERROR
for number in (float("nan"), float("inf")):
    for which in references["input"][:1] + references["parameter"][:1]:
        assert put(one, [which], [number]) == ERROR
assert put(one, references["local"][:1], [0.0]) == ERROR
assert put(one, references["output"][:1], [0.0]) == ERROR
# An invalid variable in a list leaves all unchanged.
first = references["parameter"][0]
_, (value,) = get(one, [first])
assert put(one, [first, variables], [value * 2, 0.0]) == ERROR and get(one, [first]) == (OK, [value])
# Values outside the bounds of the description.
for reference, bound in re.findall(r'valueReference="(\d+)"[^<]*(?:<Real )?[^<>]*min="([^"]*)"', description):
    messages.clear()
    assert put(one, [int(reference)], [float(bound) - 1.0]) == ERROR and b"admissible" in messages[0], messages
# There are no variables of other types.
assert call("GetBoolean", one, vr(1), n, None, *([] if is_two else [n])) == ERROR
assert call("SetString", one, vr(1), n, None, *([] if is_two else [n])) == ERROR

# Saved states give the same motion, also as bytes; truncated or altered bytes are rejected.
state = "state" if is_two else "State"
deserialise = "DeSerializeFMUstate" if is_two else "DeserializeFMUState"
saved, again = c_void_p(), c_void_p()
assert call("GetFMU" + state, one, byref(saved)) == OK
assert step(one, 0.0, 0.01) == OK
_, there = get(one, references["output"])
size = c_size_t()
assert call("SerializedFMU" + state + "Size", one, saved, byref(size)) == OK
bytes_ = (ctypes.c_ubyte * size.value)()
assert call("SerializeFMU" + state, one, saved, bytes_, c_size_t(size.value - 1)) == ERROR
assert call("SerializeFMU" + state, one, saved, bytes_, size) == OK
for cut in (0, 7, 100, size.value - 1):
    assert call(deserialise, one, bytes_, c_size_t(cut), byref(again)) == ERROR
for place in (0, 20, size.value // 2, size.value - 1):
    bytes_[place] ^= 1
    assert call(deserialise, one, bytes_, size, byref(again)) == ERROR
    bytes_[place] ^= 1
assert call(deserialise, one, bytes_, size, byref(again)) == OK
for copy in (saved, again):
    assert call("SetFMU" + state, one, copy) == OK and step(one, 0.0, 0.01) == OK
    assert get(one, references["output"]) == (OK, there)
exchange = instantiate(True, name=b"two")
assert call("SetFMU" + state, exchange, saved) == ERROR
for copy in (saved, again, saved):
    assert call("FreeFMU" + state, one, byref(copy)) == OK and not copy.value
assert call("SetFMU" + state, one, None) == ERROR

# Model exchange: steps exist in co-simulation only, and the number of states must match.
assert step(exchange, 0.0, 0.1) == ERROR
assert call("SetContinuousStates", exchange, doubles(*[0.0] * states), c_size_t(states)) == ERROR
assert initialise(exchange) == OK
assert call("EnterContinuousTimeMode", exchange) == OK
rates = "GetDerivatives" if is_two else "GetContinuousStateDerivatives"
for count in (0, states - 1, states + 1):
    assert call(rates, exchange, doubles(*[0.0] * (states + 1)), c_size_t(count)) == ERROR
assert call("SetContinuousStates", exchange, doubles(*[float("nan")] * states), c_size_t(states)) == DISCARD
assert call("SetTime", exchange, c_double(float("nan"))) == ERROR
huge = doubles(*[1e300] * states)
assert call("SetContinuousStates", exchange, huge, c_size_t(states)) == OK
assert call(rates, exchange, doubles(*[0.0] * states), c_size_t(states)) in (OK, DISCARD)

# Derivatives of variables without derivatives.
unknown, known, seed, result = vr(states + 1), vr(variables + 5), doubles(1.0), doubles(0.0)
counts = [] if is_two else [n]
for pair in ((unknown, known), (known, unknown), (unknown, vr(0)), (None, None)):
    arguments = (one, pair[0], n, pair[1], n, seed, *counts, result, *counts)
    assert call("GetDirectionalDerivative", *arguments) == ERROR, pair
assert call("NewDiscreteStates" if is_two else "EnterStepMode", one, None) == ERROR

# Reset restores the initial state; instances in threads are independent.
assert call("Terminate", one) == OK and step(one, 0.01, 0.01) == ERROR
assert call("Reset", one) == OK and initialise(one) == OK and step(one, 0.0, 0.01) == OK
assert get(one, references["output"]) == (OK, there)
results = []


def run(number):
    own = instantiate(False, name=b"thread")
    good = initialise(own) == OK
    for k in range(10):
        good = good and step(own, k * 1e-3, 1e-3) == OK
    results.append((good, get(own, references["output"])))
    c[prefix + "FreeInstance"](own)


threads = [threading.Thread(target=run, args=(number,)) for number in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert len(results) == 4 and all(result == results[0] and result[0] for result in results), results
c[prefix + "FreeInstance"](one)
c[prefix + "FreeInstance"](exchange)
sys.stdout.flush()
os._exit(0)
