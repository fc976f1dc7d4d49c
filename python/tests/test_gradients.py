"""Tests of gradients of simulated motions against finite differences."""

import warnings

import numpy as np
import pytest

import eomgen

from conftest import PROJECT

BLOCK = """
[model]
name = "block"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 0.03, unit = "N/mm" }
F_c = { value = 3, unit = "N" }
w = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = 0.1, initial_rate = 0.3 }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "u" }
friction = { on = "x", value = "-F_c*sign(dot(x))" }
"""


@pytest.fixture(scope="module")
def block():
    return eomgen.load(BLOCK)


def value(model, weights, **arguments):
    r = model.simulate(until=4, interval=0.1, solver="rk", tolerance=1e-12, **arguments)
    return sum(float(np.sum(w * r[name])) for name, w in weights.items())


def difference(value, size):
    def pair(step):
        return (value(step) - value(-step)) / (2 * step)

    small = 1e-4 * size
    return (4 * pair(small) - pair(2 * small)) / 3


def test_gradient_through_sticking_equals_differences(block):
    force = 8.0 * np.sin(2.0 * 0.1 * np.arange(41))
    r = block.simulate(until=4, interval=0.1, inputs={"u": force}, gradients=True, tolerance=1e-12)
    assert r.solver == "rk" and {"stick", "slip"} <= {event.kind for event in r.events}
    weights = {"x": np.cos(r.t), "energy": np.sin(r.t)}
    g = r.gradient(weights)
    for name in ("m", "k", "F_c"):
        parameter = block.parameters[name]
        found = difference(
            lambda by: value(block.with_parameters(**{name: parameter + by}), weights, inputs={"u": force}),
            parameter,
        )
        assert np.isclose(g.parameters[name], found, rtol=1e-6), name
    for place, name in enumerate(block.states):
        initial = block.initial
        found = difference(
            lambda by: value(block, weights, inputs={"u": force}, state={name: initial[place] + by}), 0.1
        )
        assert np.isclose(g.state[place], found, rtol=1e-6), name
    sample = 7

    def moved(by):
        changed = force.copy()
        changed[sample] += by
        return value(block, weights, inputs={"u": changed})

    assert g.inputs["u"].shape == r.t.shape
    assert np.isclose(g.inputs["u"][sample], difference(moved, 1.0), rtol=1e-6)


def test_gradient_by_constant_input_is_one_number(block):
    r = block.simulate(until=1, interval=0.1, inputs={"u": 9.0}, gradients=True)
    found = r.gradient({"x": np.ones(len(r))}).inputs["u"]
    expected = difference(
        lambda by: np.sum(block.simulate(until=1, interval=0.1, inputs={"u": 9.0 + by}, solver="rk")["x"]), 1.0
    )
    assert np.isclose(found, expected, rtol=1e-6)


def test_expressions_of_time_count_their_parameters(block):
    r = block.simulate(until=1, interval=0.1, inputs={"u": "9*F_c/3*cos(w*t)"}, gradients=True, tolerance=1e-12)
    g = r.gradient({"x": np.ones(len(r))})
    assert g.inputs == {}

    def moved(by):
        model = block.with_parameters(F_c=3 + by)
        given = {"u": "9*F_c/3*cos(w*t)"}
        return np.sum(model.simulate(until=1, interval=0.1, inputs=given, solver="rk", tolerance=1e-12)["x"])

    assert np.isclose(g.parameters["F_c"], difference(moved, 3.0), rtol=1e-6)


LINKED = """
[model]
name = "linked"
[parameters]
m = { value = 2, unit = "kg" }
M = { value = 3, unit = "kg" }
l = { value = 700, unit = "mm" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
s = { unit = "m" }
x = { unit = "m", initial = 0.42 }
y = { unit = "m", initial = -0.56 }
[kinetic]
masses = "1/2*M*dot(s)^2 + 1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "(x - s)^2 + y^2 - l^2" }
"""


@pytest.mark.parametrize(
    "start",
    [
        {"x": 0.5},
        {"x": 0.1, "y": -0.3},
        {"x": 0.42, "y": -0.56, "x_dot": 0.7},
        {"s": 0.2, "x": 0.5, "y": -0.7, "s_dot": -0.4, "x_dot": 0.3, "y_dot": 0.9},
    ],
)
def test_gradient_from_a_start_off_the_constraints_equals_differences(start):
    linked = eomgen.load(LINKED)
    initial = linked.state(start)
    arguments = {"until": 1, "interval": 0.1, "solver": "rk", "tolerance": 1e-12}
    with pytest.warns(UserWarning, match="the initial state was moved onto the constraints"):
        r = linked.simulate(state=initial, gradients=True, **arguments)
    g = r.gradient({"s": np.ones(len(r)), "x": np.cos(r.t)})

    def moved(model, state):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            r = model.simulate(state=state, **arguments)
        return float(np.sum(r["s"]) + np.sum(np.cos(r.t) * r["x"]))

    for place, name in enumerate(linked.states):
        unit = np.eye(len(linked.states))[place]
        found = difference(lambda by: moved(linked, initial + by * unit), 20.0)
        assert np.isclose(g.state[place], found, rtol=1e-6, atol=1e-7), name
    for name in ("m", "M", "l", "g"):
        own = linked.parameters[name]
        found = difference(lambda by: moved(linked.with_parameters(**{name: own + by}), initial), own)
        assert np.isclose(g.parameters[name], found, rtol=1e-6, atol=1e-7), name


def test_continued_simulation_warns_of_a_moved_state():
    linked = eomgen.load(LINKED)
    with pytest.warns(UserWarning, match="the state was moved onto the constraints: .*x from 0.5 to"):
        s = linked.simulation(state={"x": 0.5})
    assert (s["x"] - s["s"]) ** 2 + s["y"] ** 2 == pytest.approx(0.49)
    with pytest.warns(UserWarning, match="the state was moved onto the constraints"):
        s.set_state({"x": 0.7})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        linked.simulation()


def test_invalid_requests_are_rejected(block):
    r = block.simulate(until=1, interval=0.1, inputs={"u": 9.0})
    with pytest.raises(ValueError, match="gradients=True"):
        r.gradient({"x": r["x"]})
    r = block.simulate(until=1, interval=0.1, inputs={"u": 9.0}, gradients=True)
    with pytest.raises(ValueError, match="no state or observable `y`"):
        r.gradient({"y": r["x"]})
    with pytest.raises(ValueError, match="expected .11,."):
        r.gradient({"x": 1.0})
    with pytest.raises(ValueError, match="a weight of x is nan: expected finite numbers"):
        r.gradient({"x": np.full(11, np.nan)})
    with pytest.raises(TypeError, match="weights"):
        r.gradient([1.0])
    with pytest.raises(ValueError, match="solver rk"):
        block.simulate(until=1, solver="radau", inputs={"u": 9.0}, gradients=True)
    puck = eomgen.load(PROJECT / "tests" / "tests" / "hosts" / "fmi" / "units" / "puck.toml")
    with pytest.raises(ValueError, match="norm"):
        puck.simulate(until=1, gradients=True)
