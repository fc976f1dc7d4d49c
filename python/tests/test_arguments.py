"""Tests of arguments of wrong types or out of range: every message names the argument, the given value and the valid values."""

import re
import warnings

import numpy as np
import pytest

import eomgen
import eomgen.dask

MASS = """
[model]
name = "mass"
[parameters]
m = { value = 2, unit = "kg", min = 0, uncertainty = { relative = 0.02 } }
k = { value = 8, unit = "N/m" }
omega = { value = 3, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = 0.1 }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "u*cos(omega*t)" }
"""

# Values of all types. A call may accept some of them.
VALUES = [
    None,
    0,
    -1,
    5,
    2.5,
    True,
    "",
    "abc",
    b"abc",
    float("nan"),
    float("inf"),
    [],
    [1.0],
    ["abc"],
    [1.0, "a"],
    {},
    {"abc": 1.0},
    {"x": None},
    {"x": "abc"},
    {3: 1.0},
    np.zeros(0),
    np.zeros((2, 2)),
    np.array([np.nan, 1.0]),
    np.array(["a"]),
    1j,
    object(),
    lambda *given: 0.0,
]

# Texts of exceptions that Python and PyO3 raise for values of a wrong type.
BARE = re.compile(
    r"not iterable|must be real|argument '|unsupported operand|unhashable|has no attribute|not callable|has no len|"
    r"cannot be converted|expected str|not subscriptable|cannot convert|could not convert|ambiguous|required positional"
)


@pytest.fixture(scope="module")
def mass():
    return eomgen.load(MASS)


@pytest.fixture(scope="module")
def calls(mass, tmp_path_factory):
    """Returns public functions by name, with valid arguments."""
    out = tmp_path_factory.mktemp("out")
    np.savez(out / "a.npz", t=np.arange(5.0), q=np.arange(5.0))
    r = mass.simulate(until=0.1, interval=0.05, inputs={"u": 1.0}, gradients=True)
    state = [0.1, 0.0]
    control = lambda t, x, y: 0.0
    point = {"t": 0.0, "x": state, "u": [1.0]}
    return {
        "load": (eomgen.load, {"path_or_text": MASS, "order": 1}),
        "rates": (mass.rates, point),
        "observables": (mass.observables, point),
        "energy": (mass.energy, point),
        "mass_matrix": (mass.mass_matrix, point),
        "jacobian": (mass.jacobian, {**point, "by": "state"}),
        "with_parameters": (mass.with_parameters, {"m": 2.0, "k": 3.0}),
        "derive": (mass.derive, {"format": "text"}),
        "linearise": (mass.linearise, point),
        "discretise": (mass.linearise(u=[0.0]).discretise, {"period": 1e-3}),
        "modes": (mass.modes, point),
        "trim": (mass.trim, {"x": state, "u": [0.0], "fixed": {"x": 0.0}, "t": 0.0}),
        "state": (mass.state, {"values": state}),
        "simulate": (
            mass.simulate,
            {
                "until": 0.1,
                "interval": 0.05,
                "solver": "rk",
                "state": state,
                "inputs": {"u": 1.0},
                "tolerance": 1e-6,
                "progress": None,
                "start": 0.0,
                "max_step": 0.1,
                "breaks": [0.05],
                "gradients": False,
            },
        ),
        "simulate with a controller": (
            mass.simulate,
            {
                "until": 0.1,
                "interval": 0.05,
                "controller": control,
                "period": 0.05,
                "offset": 0.0,
                "delay": 0.0,
                "controls": ["u"],
            },
        ),
        "simulation": (
            mass.simulation,
            {"start": 0.0, "state": state, "inputs": [0.0], "solver": "rk", "tolerance": 1e-6, "max_step": 0.1},
        ),
        "advance": (lambda until: mass.simulation(solver="rk").advance(until), {"until": 0.1}),
        "set_inputs": (mass.simulation().set_inputs, {"inputs": {"u": 1.0}}),
        "set_state": (mass.simulation().set_state, {"state": {"x": 1.0}}),
        "gradient": (r.gradient, {"weights": {"x": np.ones(3)}}),
        "validate": (mass.validate, {"extras": ["jacobians"]}),
        "generate": (mass.generate, {"out": out / "code", "target": "c99", "extras": ["jacobians"]}),
        "sweep": (
            mass.sweep,
            {
                "vary": {"k": (1, 2, 2)},
                "measure": "max:x",
                "seed": 1,
                "frequency": "omega",
                "transient": 1,
                "periods": 2,
                "state": {"x": 0.1},
                "inputs": {"u": 1.0},
                "threads": 1,
                "progress": lambda part: None,
            },
        ),
        "sweep of samples": (mass.sweep, {"samples": 2, "measure": ["max:x"], "until": 0.1, "out": out / "sweep"}),
        "sweep of a record": (mass.sweep, {"vary": {"k": (1, 2, 2)}, "measure": "final:x", "record": "abc.toml"}),
        "sweep of a section": (
            mass.sweep,
            {"vary": {"k": (8, 9, 2)}, "measure": "poincare:x", "section": "x=0", "until": 9.0, "transient": 0, "periods": 2},
        ),
        "compare": (mass.compare, {"dataset": "abc.toml", "out": out / "compared", "seed": 1, "progress": None}),
        "discover": (
            eomgen.discover,
            {"model": mass, "dataset": "abc.toml", "out": out / "found", "seed": 1, "progress": None},
        ),
        "record_to_csv": (
            eomgen.record_to_csv,
            {"source": out / "a.npz", "out": out / "a.csv", "columns": ["t", "q"]},
        ),
        "dask.sweep": (
            eomgen.dask.sweep,
            {"client": None, "arguments": ["--out", "map"], "shards": 2, "program": "eomgen", "progress": None},
        ),
    }


# Other words for an argument in messages.
ALIASES = {
    "path_or_text": ("SPECIFICATION", "abc", "specification"),
    "values": ("state",),
    "x": ("state", "initial state"),
    "u": ("input",),
    "fixed": ("state or input", "rate"),
    "state": ("initial state",),
    "inputs": ("input",),
    "controls": ("input", "controller"),
    "breaks": ("time",),
    "dataset": ("abc",),
    "record": ("abc",),
    "vary": ("parameter", "varied", "samples"),
    "samples": ("vary",),
    "measure": ("plan",),
    "frequency": ("parameter",),
    "extras": ("abc", "output", "function"),
    "columns": ("array",),
    "source": ("npz",),
    "arguments": ("--out",),
    "weights": ("weight", "state or observable"),
    "m": ("mass", "parameter"),
    "controller": ("function",),
    "period": ("controller",),
    "interval": ("samples",),
    "until": ("reached", "simulat", "contains a different sweep"),
    "max_step": ("step",),
    "tolerance": ("step", "tolerance"),
    "order": ("field",),
    "out": ("contains a different sweep",),
}

NAMES = [
    "load", "rates", "observables", "energy", "mass_matrix", "jacobian", "with_parameters", "derive", "linearise",
    "discretise", "modes", "trim", "state", "simulate", "simulate with a controller", "simulation", "advance",
    "set_inputs", "set_state", "gradient", "validate", "generate", "sweep", "sweep of samples", "sweep of a record",
    "sweep of a section", "compare", "discover", "record_to_csv", "dask.sweep",
]  # fmt: skip


def message_of(function, arguments):
    """Returns the exception of a call, or None."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            function(**arguments)
        except (TypeError, ValueError, eomgen.SimulationError, eomgen.DiscoveryError) as error:
            return error
        except OSError as error:
            # A file that cannot be read or written; the message has its path.
            assert error.filename is not None
        return None


@pytest.mark.parametrize("name", NAMES)
def test_messages_name_the_argument(calls, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    function, valid = calls[name]
    for argument in valid:
        for value in VALUES:
            error = message_of(function, {**valid, argument: value})
            if error is None:
                continue
            text = str(error)
            assert not BARE.search(text), f"{name}({argument}={value!r}): {text}"
            # The message may be about another argument, which is invalid or does not match this value.
            others = (f"{other} = " for other in valid)
            words = (argument, *ALIASES.get(argument, ()), *others, "abc.toml")
            assert any(word in text for word in words), f"{name}({argument}={value!r}): {text}"


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda m: m.simulate(1, controller=len, period=0.1, controls=1), "controls = 1: expected names of inputs"),
        (lambda m: m.simulate(1, controller=5, period=0.1), "controller = 5: expected a function of"),
        (lambda m: m.simulate(1, controller=len, period="a"), "period = 'a': expected a time in s"),
        (lambda m: m.simulate(1, inputs={"u": None}), "the input u = None: expected a number, an array"),
        (lambda m: m.simulate(1, gradients="no"), "gradients = 'no': expected True or False"),
        (lambda m: m.simulate(1, progress=3), "progress = 3: expected a function"),
        (lambda m: m.simulate(None), "until = None: expected a time in s"),
        (lambda m: m.derive(5), "format = 5: expected \"text\", \"latex\" or \"json\""),
        (lambda m: m.jacobian(0, [0, 0], by=[1]), "by = [1]: expected \"state\""),
        (lambda m: m.sweep({"k": (1, 2, 2)}, 0), "measure = 0: expected names of measures"),
        (lambda m: m.sweep({"k": 5}, "max:x"), "vary['k'] = 5: expected (from, to, count)"),
        (lambda m: m.sweep({"k": (1, 2, 2, "lin")}, "max:x"), "expected (from, to, count) or (from, to, count, \"log\")"),
        (lambda m: m.sweep({"k": (1, 2, 2.5)}, "max:x"), "vary['k'][2] = 2.5: expected a whole number"),
        (lambda m: m.sweep(5, "max:x"), "vary = 5: expected a mapping"),
        (lambda m: m.trim(fixed="x"), "fixed = 'x': expected an array of numbers, or a mapping"),
        (lambda m: m.trim(x="a"), "x = 'a': expected an array of numbers"),
        (lambda m: m.generate(5), "out = 5: expected the path of a folder"),
        (lambda m: m.generate("out", target=None), "target = None: expected the name of a target"),
        (lambda m: m.validate(3), "extras = 3: expected names of functions"),
        (lambda m: m.compare(None), "dataset = None: expected the path of a dataset file"),
        (lambda m: m.with_parameters(k="2"), "k = '2': expected one number"),
        (lambda m: m.simulation(max_step="a"), "max_step = 'a': expected a time in s above 0"),
        (lambda m: m.simulation().set_state(None), "state = None: expected an array"),
        (lambda m: m.simulation().set_inputs(None), "inputs = None: expected an array"),
        (lambda m: eomgen.load(5), "path_or_text = 5: expected a path"),
        (lambda m: eomgen.discover(5, "a.toml"), "model = 5: expected a model"),
        (lambda m: eomgen.record_to_csv("a.npz", "a.csv", columns=5), "columns = 5: expected names of arrays"),
        (lambda m: m.rates(0, np.array(["a", "b"])), "x = an array of <U1 with the shape (2,): expected real numbers"),
    ],
)
def test_values_of_a_wrong_type_are_type_errors(mass, call, said):
    with pytest.raises(TypeError) as raised:
        call(mass)
    assert said in str(raised.value)


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda m: m.simulation(tolerance=2), "tolerance = 2.0: expected a number between 0 and 1"),
        (lambda m: m.simulation(max_step=0), "max_step = 0.0: expected a time in s above 0"),
        (lambda m: m.simulation(state=[np.nan, 0]), "the state x = nan: expected a finite number"),
        (lambda m: m.simulation(inputs=[np.nan]), "the input u = nan: expected a finite number"),
        (lambda m: m.linearise(x=[np.nan, 0]), "the state x = nan: expected a finite number"),
        (lambda m: m.modes(u=[np.inf]), "the input u = inf: expected a finite number"),
        (lambda m: m.simulate(1, inputs={"u": 0}, breaks=[np.nan]), "breaks = nan: expected finite times in s"),
        (lambda m: m.sweep(samples=0, measure="max:x", until=1), "samples=0: expected a number from 1"),
        (lambda m: m.trim(fixed=0), "fixed has the shape (): expected (3,), for x, x_dot, u"),
        (lambda m: m.generate(""), "out = '': expected the path of a folder"),
    ],
)
def test_values_out_of_range_are_value_errors(mass, call, said):
    with pytest.raises(ValueError) as raised:
        call(mass)
    assert said in str(raised.value)


LINKED = """
[model]
name = "linked"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { unit = "m", initial = 0.42 }
y = { unit = "m", initial = -0.56 }
[kinetic]
mass = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"""


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda m: m.simulate(1, solver="fixed", inputs={"u": 0}), "max_step=1e-4 (s)"),
        (lambda m: eomgen.load(LINKED).simulate(1, solver="exact"), "(solver=\"rk\")"),
        (lambda m: eomgen.load(LINKED).simulate(1, solver="adams"), "use solver=\"rk\" or radau"),
        (lambda m: eomgen.load(LINKED).simulate(1, state=[0, 0, 0, 0]), "(state or x)"),
        (lambda m: m.sweep({"q": (1, 2, 2)}, "max:x", until=1), "no parameter `q`"),
        (lambda m: m.sweep({"k": (1, 2, 2)}, "max:q", until=1), "measure=\"max:q\": the model `mass` has no"),
        (lambda m: m.sweep({"k": (1, 2, 2)}, "max:x", until=-1), "until=-1.0: expected a time in s greater than 0"),
        (lambda m: m.sweep({"k": (1, 2, 2)}, "max:x", frequency="k"), "frequency=\"k\": its unit is N/m"),
        (lambda m: m.sweep({"k": (1, 2, 2)}, "poincare", section="x=0"), "section=\"x=0\": until is missing"),
        (lambda m: m.sweep({"k": (1, 2, 2)}, "poincare", periods=1), "expected at least 2 periods, and transient and periods"),
        (lambda m: m.with_parameters(k=3).sweep({"k": (1, 2, 2)}, "max:x"), "only one of with_parameters and vary"),
        (lambda m: m.generate("out", "rust", ["hessians"]), "extras=\"hessians\" needs target casadi or acados"),
    ],
)
def test_messages_name_arguments_of_python(mass, call, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((ValueError, eomgen.SimulationError)) as raised:
        call(mass)
    text = str(raised.value)
    assert said in text and not re.search(r"--[a-z]", text), text


def test_warnings_name_arguments_of_python(mass):
    with pytest.warns(UserWarning, match=re.escape("set it with inputs={\"u\": ...}")):
        mass.sweep({"k": (1, 2, 2)}, "max:x", until=0.1)


def test_sections_with_few_crossings_are_named(mass):
    arguments = {"measure": "poincare:x", "section": "x=0", "until": 9.0, "inputs": {"u": 0.0}}
    with pytest.warns(UserWarning, match=r"1 of 2 points has no number.*: 1 of 5 at k = 2\. .*\(until\), fewer"):
        s = mass.sweep({"k": (2, 40, 2)}, transient=2, periods=3, **arguments)
    assert np.isnan(s["poincare:x_mean"]).tolist() == [True, False]
    assert s["poincare:x_crossings"].tolist() == [1.0, 5.0] and s["poincare:x_status"].tolist() == [6.0, 0.0]
    with pytest.raises(ValueError, match="2 of 2 points have no number.*of 120 at k = 2"):
        mass.sweep({"k": (2, 40, 2)}, **arguments)
