"""Tests of controllers of a specification and of Python functions as controllers."""

import numpy as np
import pytest

import eomgen

MASS = """
[model]
name = "mass"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k_p = { value = 30, unit = "N/m" }
k_d = { value = 15, unit = "N s/m" }
[coordinates]
x = { unit = "m", initial = 0.3 }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
error = "r - x"
"""

LOOP = """
[controllers.pd]
period = { value = 50, unit = "ms" }
delay = { value = 20, unit = "ms" }
states = { last = { unit = "m", next = "error" } }
outputs = { u = "k_p*error - k_d*dot(x)" }
"""


def pd(t, x, y):
    return {"u": 30 * y[0] - 15 * x[1]}


@pytest.mark.parametrize("solver", ["exact", "rk", "radau"])
def test_function_gives_the_motion_of_the_declared_controller(solver):
    declared = eomgen.load(MASS + LOOP)
    right = declared.simulate(until=2, interval=0.01, solver=solver, inputs={"r": 1.0})
    assert right.names[-1] == "last" and right["last"][0] == 0.7
    assert np.allclose(right["last"][5:10], 1 - right["x"][5])
    m = eomgen.load(MASS)
    found = m.simulate(
        until=2, interval=0.01, solver=solver, inputs={"r": 1.0}, controller=pd, period=0.05, delay=0.02
    )
    assert np.array_equal(found.states, right.states)
    assert found.solver == solver and right.to_pandas().shape == (201, 6)


def test_expression_inputs_are_measured_by_controllers():
    declared = eomgen.load(MASS + LOOP)
    options = {"until": 1, "interval": 0.01, "solver": "rk"}
    found = declared.simulate(inputs={"r": "0.5*sin(3*t)"}, **options)
    right = declared.simulate(inputs={"r": lambda t: 0.5 * np.sin(3 * t)}, **options)
    assert np.allclose(found.states, right.states, atol=1e-12) and np.ptp(found["x"]) > 0.1
    m = eomgen.load(MASS)
    own = m.simulate(inputs={"r": "0.5*sin(3*t)"}, controller=pd, period=0.05, delay=0.02, **options)
    assert np.allclose(own.states, right.states, atol=1e-9)
    with pytest.raises(eomgen.SpecificationError, match="inputs"):
        declared.simulate(inputs={"r": "sin("}, **options)


def test_fixed_steps_converge_with_order_four():
    parameters = 'F = { value = 30, unit = "N" }\nk = { value = 9, unit = "rad/m" }\n[coordinates]'
    text = (MASS + LOOP).replace("[coordinates]", parameters).replace('value = "u"', 'value = "u - F*sin(k*x)"')
    m = eomgen.load(text)
    options = {"until": 1, "interval": 0.01, "inputs": {"r": 1.0}, "tolerance": 1e-12}
    settings = (("rk", None), ("fixed", 1e-2), ("fixed", 5e-3))
    runs = [m.simulate(solver=solver, max_step=step, **options) for solver, step in settings]
    errors = [np.abs(run.states - runs[0].states).max() for run in runs[1:]]
    assert 11 < errors[0] / errors[1] < 22, errors
    for step in (None, 3e-2):
        with pytest.raises(ValueError, match="fixed"):
            m.simulate(until=1, interval=0.01, solver="fixed", inputs={"r": 1.0}, max_step=step)


def test_controller_is_called_at_each_sample_with_values_before_it():
    seen = []

    def controller(t, x, y):
        seen.append((t, *x))
        return 0.5 * len(seen)

    r = eomgen.load(MASS).simulate(
        until=0.5, interval=0.05, inputs={"r": 0.0}, controller=controller, period=0.1, offset=0.05
    )
    assert np.allclose([t for t, *_ in seen], [0.05, 0.15, 0.25, 0.35, 0.45])
    assert np.allclose(seen[1][1:], [0.3 + 0.25 * 0.01 / 2, 0.25 * 0.1])
    assert np.allclose(r.states[3], seen[1][1:])


@pytest.mark.parametrize(
    "controller, error, said",
    [
        (lambda t, x, y: float("nan") if t > 0.5 else 0.0, ValueError, "the controller at t = 0.6.*: nan|NaN"),
        (lambda t, x, y: "1", TypeError, "the controller at t = 0"),
        (lambda t, x, y: {"v": 1.0}, ValueError, "the controller at t = 0: .*no controlled input `v`"),
        (lambda t, x, y: {}, ValueError, "^the controller at t = 0: it returned no value for u$"),
        (lambda t, x, y: [1.0, 2.0], ValueError, "^the controller at t = 0: it returned 2 values, expected 1 for u$"),
        (lambda t, x, y: None, TypeError, "^the controller at t = 0: it returned None, expected values for u$"),
        (lambda t, x, y: 1 / (t - 0.3 > 1e-9 or 0) if t > 0.25 else 0.0, eomgen.SimulationError, "at t = 0.3"),
    ],
)
def test_failures_name_the_controller_and_the_time(controller, error, said):
    m = eomgen.load(MASS)
    with pytest.raises(error, match=said) as raised:
        m.simulate(until=1, inputs={"r": 0.0}, controller=controller, period=0.1)
    if error is eomgen.SimulationError:
        assert raised.value.__cause__ is not None
        assert 0.28 < raised.value.trajectory.t[-1] <= 0.3


def test_period_with_too_many_samples_is_refused():
    m = eomgen.load(MASS)
    with pytest.raises(ValueError, match="the period of a controller, 1e-12 s, needs 1.0e12 samples"):
        m.simulate(until=1, inputs={"r": 0.0}, controller=lambda t, x, y: 0.0, period=1e-12)
    declared = MASS + '[controllers.p]\nperiod = 1e-12\noutputs = { u = "0*u" }\n'
    s = eomgen.load(declared).simulation()
    with pytest.raises(ValueError, match="1e-12 s, needs 1.0e12 samples"):
        s.advance(1)


def test_controller_drives_no_prescribed_motion():
    text = (
        '[model]\nname = "base"\n[parameters]\nm = { value = 2, unit = "kg" }\nk = { value = 8, unit = "N/m" }\n'
        '[coordinates]\nx = { unit = "m" }\n[inputs]\nu = { unit = "N" }\ns = { unit = "m", rates = 2 }\n'
        '[kinetic]\nmass = "1/2*m*(dot(x) + dot(s))^2"\n[potential]\nspring = "1/2*k*x^2"\n'
        '[forces]\npush = { on = "x", value = "u" }\n'
    )
    m = eomgen.load(text)
    r = m.simulate(until=1, controller=lambda t, x, y: {"u": 3.0}, period=0.1)
    # The first sample acts from 0 on: x = F/k (1 - cos(w t)), w = 2 rad/s.
    assert abs(r["x"][-1] - 3 / 8 * (1 - np.cos(2.0))) < 1e-8
    with pytest.raises(ValueError, match="s is prescribed motion"):
        m.simulate(until=1, controller=lambda t, x, y: 1.0, period=0.1, controls=["s"])


@pytest.mark.parametrize(
    "arguments, error, said",
    [
        ({"controller": pd}, TypeError, "needs period"),
        ({"period": 0.1}, TypeError, "need controller"),
        ({"controller": 3, "period": 0.1}, TypeError, "expected a function"),
        ({"controller": pd, "period": 0}, ValueError, "period = 0.0: expected a time in s above 0"),
        ({"controller": pd, "period": 0.1, "delay": -1}, ValueError, "delay = -1.0"),
        ({"controller": pd, "period": 0.1, "controls": ["v"]}, ValueError, "no input `v`"),
        ({"controller": pd, "period": 0.1, "controls": "r"}, ValueError, "the input r is driven"),
    ],
)
def test_invalid_controllers_are_rejected(arguments, error, said):
    with pytest.raises(error, match=said):
        eomgen.load(MASS).simulate(until=1, inputs={"r": 0.0}, **arguments)


def test_second_controller_of_an_input_is_rejected():
    m = eomgen.load(MASS + LOOP)
    with pytest.raises(ValueError, match="the input u is driven by the controller and by a controller"):
        m.simulate(until=1, inputs={"r": 0.0}, controller=pd, period=0.1, controls="u")


def test_ctrl_c_interrupts_a_controlled_simulation(interrupt):
    m = eomgen.load(MASS)
    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        m.simulate(until=1e4, interval=1e3, inputs={"r": 0.0}, controller=pd, period=1e-3)


def test_ctrl_c_interrupts_a_controller_that_does_not_return(interrupt):
    def never(t, x, y):
        while t > 0.1:
            pass
        return {"u": 0.0}

    m = eomgen.load(MASS)
    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        m.simulate(until=1, inputs={"r": 0.0}, controller=never, period=0.01)
    # The interrupt does not remain pending for the next call.
    assert m.simulate(until=1, inputs={"r": 0.0}, controller=pd, period=0.01).t[-1] == 1


STEP = 'u_step = { value = 0.5, unit = "N" }\n'

QUANTISED = """
[controllers.pd]
period = { value = 50, unit = "ms" }
delay = { value = 120, unit = "ms" }
states = { last = { unit = "m", next = "error" } }
outputs = { u = "quantise(k_p*error - k_d*dot(x), u_step)" }
"""


@pytest.mark.parametrize("loop", [LOOP, QUANTISED])
@pytest.mark.parametrize("solver", ["exact", "rk", "fixed"])
def test_simulation_that_continues_runs_declared_controllers(loop, solver):
    m = eomgen.load(MASS.replace("k_d =", STEP + "k_d =") + loop)
    options = {"solver": solver, "max_step": 0.005}
    steps = np.arange(201)
    held = np.where(steps < 70, 1.0, -0.5)
    right = m.simulate(until=2, interval=0.01, inputs={"r": held}, **options)
    s = m.simulation(inputs={"r": 1.0}, **options)
    assert s["last"] == right["last"][0] == 0.7
    for row, t in enumerate(right.t[1:], start=1):
        s.advance(t)
        if row == 70:
            s.set_inputs({"r": -0.5})
        assert np.allclose(s.state, right.states[row], rtol=0, atol=1e-8), (row, s.state)
        assert s["last"] == pytest.approx(right["last"][row], abs=1e-8)
    assert s.solver == right.solver and list(s.controller_states) == [s["last"]]
    assert np.ptp(right["x"]) > 0.5


def test_driven_inputs_of_a_continued_simulation_are_kept():
    m = eomgen.load(MASS + LOOP)
    with pytest.raises(ValueError, match="input u is driven by a controller"):
        m.simulation(inputs={"u": 1.0})
    with pytest.raises(ValueError, match="input u is driven by a controller"):
        m.simulation(inputs=[0.0, 1.0])
    s = m.simulation(inputs={"r": 1.0})
    s.advance(0.03)
    force = s.inputs[1]
    assert force == pytest.approx(21.0)
    with pytest.raises(ValueError, match="input u is driven by a controller"):
        s.set_inputs([2.0, 0.0])
    s.set_inputs([2.0, force])
    s.set_state({"x": 0.0})
    assert list(s.inputs) == [2.0, force] and s["last"] == 0.7
    s.advance(0.05)
    assert s["last"] == pytest.approx(2.0 - s["x"])


def test_failing_sample_of_a_continued_simulation_is_not_passed():
    m = eomgen.load(MASS + LOOP.replace("k_p*error", "k_p*sqrt(error)*sqrt(error)"))
    s = m.simulation(inputs={"r": 1.0})
    s.set_inputs({"r": -1.0})
    for _ in range(2):
        with pytest.raises(eomgen.SimulationError, match="at t = 0.05 s the output `u`"):
            s.advance(0.2)
        assert s.t == 0.05 and s["last"] == 0.7
    s.set_inputs({"r": 1.0})
    s.advance(0.2)
    assert s.t == 0.2


DATASET = """
[records]
train = ["one.csv"]
test = ["two.csv"]
[time]
column = "t"
unit = "s"
[inputs.u]
column = "u"
unit = "N"
hold = "zero-order"
[channels.x]
column = "x"
unit = "m"
noise = 1e-5
[windows]
length = 0.5
"""


def test_recorded_outputs_of_controllers_drive_a_comparison(tmp_path):
    m = eomgen.load(MASS + LOOP)
    random = np.random.default_rng(4)
    for name, amplitude in [("one.csv", 0.5), ("two.csv", -0.4)]:
        s = m.simulation(inputs={"r": amplitude})
        rows = []
        for row in range(401):
            s.advance(0.005 * row)
            rows.append([s.t, s.inputs[1], s["x"] + 1e-5 * random.standard_normal()])
            s.set_inputs({"r": amplitude * np.cos(4 * s.t)})
        np.savetxt(tmp_path / name, rows, delimiter=",", header="t,u,x", comments="", fmt="%.17g")
    dataset = tmp_path / "dataset.toml"
    dataset.write_text(DATASET, encoding="utf-8")
    assert m.compare(dataset).verdict == "no_significant_gap"
    dataset.write_text(DATASET.replace("[inputs.u]", "[inputs.r]"), encoding="utf-8")
    for search in (m.compare, lambda dataset: eomgen.discover(m, dataset)):
        with pytest.raises(eomgen.SpecificationError, match="no column for the input `u`"):
            search(dataset)
