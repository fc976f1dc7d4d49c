"""Gradients of simulated motions against differences of motions."""

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


def test_invalid_requests_are_rejected(block):
    r = block.simulate(until=1, interval=0.1, inputs={"u": 9.0})
    with pytest.raises(ValueError, match="gradients=True"):
        r.gradient({"x": r["x"]})
    r = block.simulate(until=1, interval=0.1, inputs={"u": 9.0}, gradients=True)
    with pytest.raises(ValueError, match="no state or observable `y`"):
        r.gradient({"y": r["x"]})
    with pytest.raises(ValueError, match="expected .11,."):
        r.gradient({"x": 1.0})
    with pytest.raises(ValueError, match="not finite"):
        r.gradient({"x": np.full(11, np.nan)})
    with pytest.raises(TypeError, match="weights"):
        r.gradient([1.0])
    with pytest.raises(ValueError, match="solver rk"):
        block.simulate(until=1, solver="radau", inputs={"u": 9.0}, gradients=True)
    puck = eomgen.load(PROJECT / "tests" / "tests" / "hosts" / "fmi" / "units" / "puck.toml")
    with pytest.raises(ValueError, match="norm"):
        puck.simulate(until=1, gradients=True)
