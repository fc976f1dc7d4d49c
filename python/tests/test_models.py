"""Tests of loading, parameters, linearisation and error messages."""

import json
import pickle
import subprocess
import warnings

import numpy as np
import pytest

import eomgen

from conftest import SPECIFICATIONS

OSCILLATOR = """
[model]
name = "class"
title = "An oscillator with <hostile> & names"
[parameters]
m = { value = 200, unit = "g", min = 0 }
k = { value = 8, unit = "N/m" }
lambda = { value = "2*k", unit = "N/m" }
[coordinates]
x = { unit = "m", initial = 0.1 }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*lambda*x^2"
[forces]
motor = { on = "x", value = "u" }
"""


@pytest.mark.parametrize("path", sorted(SPECIFICATIONS.glob("*.toml")), ids=lambda path: path.stem)
def test_every_shipped_specification_loads(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", eomgen.SpecificationWarning)
        m = eomgen.load(path)
    assert m.rates(0.0, m.initial).shape == (len(m.states),)
    assert m.observable_names[-2:] == ("energy", "power")
    assert "<math>" in m._repr_html_()


def test_text_and_file_give_the_same_model(tmp_path):
    path = tmp_path / "oscillator.toml"
    path.write_text(OSCILLATOR, encoding="utf-8")
    for m in (eomgen.load(OSCILLATOR), eomgen.load(path), eomgen.load(str(path))):
        assert (m.name, m.states, m.inputs) == ("class", ("x", "x_dot"), ("u",))
        assert np.allclose(m.rates(0.0, [0.1, 0.0], [3.0]), [0.0, (3 - 1.6) / 0.2])


def test_parameters_are_read_only_in_declared_units():
    m = eomgen.load(OSCILLATOR)
    assert dict(m.parameters) == {"m": 200.0, "k": 8.0, "lambda": 16.0}
    assert m.units["m"] == "g"
    with pytest.raises(TypeError):
        m.parameters["m"] = 3.0


def test_dependent_parameters_follow_and_expressions_can_be_replaced():
    m = eomgen.load(OSCILLATOR)
    softer = m.with_parameters(k=4)
    assert softer.parameters["lambda"] == 8.0
    set_apart = softer.with_parameters(**{"lambda": 5.0})
    assert dict(set_apart.parameters) == {"m": 200.0, "k": 4.0, "lambda": 5.0}
    assert np.allclose(set_apart.rates(0.0, [1.0, 0.0]), [0.0, -25.0])
    assert np.allclose(eomgen.load(set_apart.text).rates(0.0, [1.0, 0.0]), [0.0, -25.0])
    assert dict(m.parameters) == {"m": 200.0, "k": 8.0, "lambda": 16.0}


@pytest.mark.parametrize(
    "values, said",
    [
        ({"mm": 1.0}, "did you mean `m`?"),
        ({"m": -1.0}, "m"),
        ({"m": float("nan")}, "cannot be NaN"),
        ({"k": float("inf")}, "give a finite number"),
    ],
)
def test_invalid_parameters_are_rejected(values, said):
    with pytest.raises(eomgen.SpecificationError) as raised:
        eomgen.load(OSCILLATOR).with_parameters(**values)
    assert said in str(raised.value)


def test_values_that_are_no_numbers_are_rejected():
    m = eomgen.load(OSCILLATOR)
    for value in ("1", None, [1.0, 2.0], 1j):
        with pytest.raises(TypeError):
            m.with_parameters(m=value)


def test_largest_numbers_are_accepted():
    m = eomgen.load(OSCILLATOR).with_parameters(k=1e308 / 4)
    assert np.isfinite(m.rates(0.0, [0.0, 1.0])).all()
    with pytest.raises(eomgen.SpecificationError):
        eomgen.load(OSCILLATOR).with_parameters(k=1e308)


def test_specification_errors_match_the_command_line(tmp_path, program):
    wrong = OSCILLATOR.replace("1/2*lambda*x^2", "1/2*lambda*x").replace('"g"', '"gg"')
    path = tmp_path / "wrong.toml"
    path.write_text(wrong, encoding="utf-8")
    with pytest.raises(eomgen.SpecificationError) as raised:
        eomgen.load(path)
    run = subprocess.run([program, "check", str(path)], capture_output=True, text=True)
    assert run.returncode == 2
    assert str(raised.value).strip() == run.stderr.strip()
    assert "^^" in str(raised.value)
    assert isinstance(raised.value, ValueError)


@pytest.mark.parametrize(
    "given, said",
    [
        ("no/such/file.toml", "cannot be read"),
        ("", "cannot be read"),
        ("[model", "cannot be read"),
        ("this is\nno TOML", "<text>:1"),
        ("\x00\n", "<text>"),
        (SPECIFICATIONS, "is not a file"),
    ],
)
def test_input_that_is_no_specification_is_rejected(given, said):
    with pytest.raises(eomgen.SpecificationError) as raised:
        eomgen.load(given)
    assert said in str(raised.value)


def test_wrong_argument_types_are_rejected():
    for given in (None, 3, b"bytes\n", ["a"]):
        with pytest.raises(TypeError):
            eomgen.load(given)
    path = SPECIFICATIONS / "planetary_arm.toml"
    for order, error in [
        (-1, ValueError),
        (10**30, ValueError),
        (1.5, TypeError),
        ("4", TypeError),
        (True, TypeError),
    ]:
        with pytest.raises(error, match="expected a whole number from 0 to 128"):
            eomgen.load(path, order)
    with pytest.raises(eomgen.SpecificationError, match="no field"):
        eomgen.load(OSCILLATOR, 3)


def test_specification_warnings_are_python_warnings():
    with pytest.warns(eomgen.SpecificationWarning, match="spare"):
        eomgen.load(OSCILLATOR.replace("[coordinates]", "spare = { value = 1 }\n[coordinates]"))


def test_linearisation_matches_the_jacobians(cart, states):
    x, u = cart.initial + states(cart, 1, 0.1)[0], [0.5]
    found = cart.linearise(0.0, x, u)
    a, b, c, d = found
    assert np.array_equal(a, cart.jacobian(0.0, x, u))
    assert np.array_equal(b, cart.jacobian(0.0, x, u, by="inputs"))
    assert np.array_equal(found.rates, cart.rates(0.0, x, u))
    assert np.array_equal(found.y, cart.observables(0.0, x, u))
    assert c.shape == (len(found.outputs), len(found.states)) and d.shape == (len(found.outputs), 1)
    for column, h in enumerate(1e-6 * np.eye(len(x))):
        difference = (cart.observables(0.0, x + h, u) - cart.observables(0.0, x - h, u)) / 2e-6
        assert np.allclose(c[:, column], difference, rtol=1e-5, atol=1e-5)


def test_arrays_of_the_command_line_match_the_package(tmp_path, program, cart):
    out, spec = tmp_path / "matrices.npz", tmp_path / "cart.toml"
    spec.write_text(cart.text, encoding="utf-8")
    point = ["--state", f"{cart.states[1]}=0.3", "--state", "t=0.5"]
    subprocess.run([program, "linearise", spec, *point, "--out", out], check=True, capture_output=True)
    written, found = np.load(out), cart.linearise(0.5, {cart.states[1]: 0.3})
    for name, matrix in zip("ABCD", found):
        assert np.array_equal(written[name], matrix), name
    assert np.array_equal(written["x"], found.x) and written["t"].tolist() == [0.5]
    assert np.array_equal(written["rates"], found.rates)
    assert tuple(written["states"]) == tuple(cart.states)
    assert tuple(written["outputs"]) == tuple(found.outputs)
    assert written["state_units"].tolist()[0] == "m" and len(written["output_units"]) == len(found.y)


def test_discrete_linearisation_is_the_exponential_over_a_period(cart):
    linear = cart.linearise(0.0, {cart.states[1]: 0.3})
    discrete = linear.discretise(0.01)
    n, m = linear.B.shape
    block = np.zeros((n + m, n + m))
    block[:n, :n], block[:n, n:] = linear.A, linear.B
    # Reference: Euler steps of a millionth of the period, by repeated squaring.
    power = np.eye(n + m) + block * 0.01 / 2**30
    for _ in range(30):
        power = power @ power
    assert np.allclose(discrete.A, power[:n, :n], rtol=1e-6, atol=1e-8)
    assert np.allclose(discrete.B, power[:n, n:], rtol=1e-6, atol=1e-8)
    assert np.array_equal(discrete.C, linear.C) and discrete.period == 0.01
    with pytest.raises(ValueError, match="above 0"):
        linear.discretise(0)


def test_linearisation_accepts_names(cart):
    name = cart.states[1]
    at = cart.linearise(x={name: 0.3})
    assert at.x[1] == 0.3 and np.array_equal(np.delete(at.x, 1), np.delete(cart.initial, 1))
    with pytest.raises(ValueError, match=f"did you mean `{name}`"):
        cart.linearise(x={name + "x": 0.3})


def test_equilibrium_matches_the_command_line(program, pendulum, tmp_path):
    spec = tmp_path / "pendulum.toml"
    spec.write_text(pendulum.text, encoding="utf-8")
    (angle,) = pendulum.states[:1]
    start = ["--state", f"{angle}=3"]
    written = subprocess.run([program, "trim", spec, *start], check=True, capture_output=True)
    written, found = json.loads(written.stdout), pendulum.trim({angle: 3.0})
    assert [written["at"][name] for name in found.states] == found.x.tolist()
    assert written["stability"] == found.stability and written["free"] == list(found.free)
    assert np.allclose(pendulum.rates(0.0, found.x, found.u), 0.0, atol=1e-9)


def test_inputs_balance_fixed_coordinates(cart):
    held = cart.states[1]
    found = cart.trim(fixed={held: 0.0}, u=[0.3])
    assert found[held] == 0.0 and held not in found.free and "at rest" in repr(found)
    assert np.allclose(cart.rates(0.0, found.x, found.u), 0.0, atol=1e-9)


def test_invalid_starts_of_trim_are_rejected(cart):
    name = cart.states[1]
    for start, error in [
        ({name + "x": 0.3}, f"did you mean `{name}`"),
        ({name: np.nan}, "finite"),
        ([0.0], "shape"),
    ]:
        with pytest.raises(ValueError, match=error):
            cart.trim(start)
        with pytest.raises(ValueError, match=error):
            cart.trim(fixed=start)


def test_models_can_be_pickled():
    m = eomgen.load(SPECIFICATIONS / "planetary_arm_rig.toml", 2).with_parameters(b_sp=30e-6)
    again = pickle.loads(pickle.dumps(m))
    x = np.full(len(m.states), 1e-4)
    assert np.array_equal(again.rates(0.0, x), m.rates(0.0, x))
    assert dict(again.parameters) == dict(m.parameters) and again.orders == (2,)


def test_names_are_escaped_in_html():
    shown = eomgen.load(OSCILLATOR)._repr_html_()
    assert "<math>" in shown and "<hostile>" not in shown


ROD = """
[model]
name = "rod"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { unit = "m", initial = 0.1 }
y = { unit = "m", initial = -0.7, initial_rate = 0.2 }
[kinetic]
load = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"""


def test_linearisation_and_modes_move_the_state_onto_constraints():
    model = eomgen.load(ROD)
    with pytest.warns(UserWarning, match="the state was moved onto the constraints: x from 0.1 to"):
        moved = model.linearise()
    x, y, x_dot, y_dot = moved.x
    assert abs(x * x + y * y - 0.49) < 1e-12
    assert abs(x * x_dot + y * y_dot) < 1e-12
    with pytest.warns(UserWarning, match="moved"):
        frequencies = [mode.frequency for mode in model.modes()]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = model.linearise(x=moved.x)
        assert frequencies == [mode.frequency for mode in model.modes(x=moved.x)]
    assert np.allclose(again.A, moved.A, rtol=1e-9, atol=1e-9)
