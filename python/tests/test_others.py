"""Tests of the examples of docs/python.md with other libraries, if these are installed."""

import numpy as np
import pytest

import eomgen

from conftest import PROJECT, SPECIFICATIONS


def written(section, block=0, **names):
    """Runs a block of code of a section of the page with given variables. Returns all variables."""
    page = (PROJECT / "docs" / "python.md").read_text(encoding="utf-8")
    text = page.split(f"## {section}\n", 1)[1].split("```python\n")[1 + block].split("```", 1)[0]
    exec(compile(text, f"docs/python.md, {section}", "exec"), names)
    return names


def test_first_example_runs(monkeypatch, capsys):
    monkeypatch.chdir(PROJECT)
    written("Start")
    tip, *shape = capsys.readouterr().out.split(maxsplit=1)
    assert abs(float(tip)) < 1 and shape == ["(14, 14)\n"]


def test_python_on_the_pages_compiles():
    pages = [PROJECT / "README.md", PROJECT / "python" / "README.md", *PROJECT.glob("docs/**/*.md")]
    blocks = 0
    for page in pages:
        for block in page.read_text(encoding="utf-8").split("```python\n")[1:]:
            compile(block.split("```", 1)[0], str(page), "exec")
            blocks += 1
    assert blocks > 5


def test_scipy_examples_run(pendulum):
    pytest.importorskip("scipy")
    found = written("SciPy", m=pendulum)["found"]
    assert found.success and np.allclose(found.t[-1], 2)


def test_casadi_examples_run(cart):
    pytest.importorskip("casadi")
    names = written("CasADi", m=cart)
    x = cart.initial
    assert np.allclose(np.array(names["step"](x, 0.3)).ravel(), x + 0.01 * cart.rates(0, x, [0.3]))


def test_solve_ivp_accepts_rates_and_jacobian(pendulum):
    scipy = pytest.importorskip("scipy.integrate")
    r = pendulum.simulate(until=2, interval=0.01)
    for method in ("Radau", "LSODA"):
        found = scipy.solve_ivp(
            pendulum.rates, (0, 2), pendulum.initial, method, r.t,
            jac=pendulum.jacobian, rtol=1e-9, atol=1e-11,
        )
        assert np.allclose(found.y.T, r.states, atol=1e-6), method


def test_casadi_values_and_jacobians_match(cart, states):
    casadi = pytest.importorskip("casadi")
    f = cart.to_casadi()
    x, u = cart.initial + states(cart, 1, 0.1)[0], [0.7]
    assert np.array_equal(np.array(f(0.0, x, u)).ravel(), cart.rates(0.0, x, u))
    t, xs, us = casadi.MX.sym("t"), casadi.MX.sym("x", 6), casadi.MX.sym("u", 1)
    rates = f(t, xs, us)
    by = casadi.Function("by", [t, xs, us], [casadi.jacobian(rates, v) for v in (t, xs, us)])
    by_t, by_x, by_u = by(0.0, x, u)
    assert not np.array(by_t).any()
    assert np.array_equal(np.array(by_x), cart.jacobian(0.0, x, u))
    assert np.array_equal(np.array(by_u), cart.jacobian(0.0, x, u, by="inputs"))


def test_casadi_derivative_by_time_matches(states):
    casadi = pytest.importorskip("casadi")
    m = eomgen.load(SPECIFICATIONS / "planetary_arm.toml")
    f, x = m.to_casadi(), states(m, 1)[0]
    t = casadi.MX.sym("t")
    by_t = casadi.Function("by", [t], [casadi.jacobian(f(t, x, []), t)])(0.3)
    difference = (m.rates(0.3 + 1e-5, x) - m.rates(0.3 - 1e-5, x)) / 2e-5
    assert np.abs(difference).max() > 1
    assert np.allclose(np.array(by_t).ravel(), difference, rtol=1e-6, atol=1e-6)


def test_jax_derivatives_match(cart, states):
    jax = pytest.importorskip("jax")
    rates = written("JAX")["jax_rates"](cart)
    t, x, u = 0.0, cart.initial + states(cart, 1, 0.1)[0], np.array([0.7])
    assert np.allclose(rates(t, x, u), cart.rates(0.0, x, u), rtol=1e-14)
    by_x = jax.jit(jax.jacfwd(rates, argnums=1))(t, x, u)
    assert np.allclose(by_x, cart.jacobian(0.0, x, u), rtol=1e-12)
    weights = np.arange(1.0, 7.0)
    gradient = jax.grad(lambda x: weights @ rates(t, x, u))(x)
    assert np.allclose(gradient, weights @ cart.jacobian(0.0, x, u), rtol=1e-12)


def test_gradient_example_runs(pendulum):
    g = written("Gradients of a motion", m=pendulum)["g"]
    assert np.isfinite(g.state).all() and set(g.parameters) <= set(pendulum.parameters)


def test_jax_differentiates_motion(pendulum):
    jax = pytest.importorskip("jax")
    motion = written("Gradients of a motion", 1)["jax_motion"](pendulum, ["m", "a"], "theta", 1.0, 0.1)
    values = np.array([pendulum.parameters[name] for name in ("m", "a")])
    found = jax.grad(lambda v: (motion(v) ** 2).sum())(values)
    for place, step in enumerate(1e-4 * np.eye(2)):
        difference = ((motion(values + step) ** 2).sum() - (motion(values - step) ** 2).sum()) / 2e-4
        assert np.isclose(found[place], difference, rtol=1e-4)


def test_torch_differentiates_motion(cart):
    torch = pytest.importorskip("torch")
    motion = written("Gradients of a motion", 2)["TorchMotion"]
    samples = torch.linspace(0.1, 0.6, 6, dtype=torch.float64, requires_grad=True)

    def run(u):
        return (motion.apply(u, cart, cart.inputs[0], cart.states[0], 0.5, 0.1) ** 2).sum()

    run(samples).backward()
    step = torch.zeros(6, dtype=torch.float64)
    step[2] = 1e-4
    difference = (run(samples.detach() + step) - run(samples.detach() - step)) / 2e-4
    assert np.isclose(float(samples.grad[2]), float(difference), rtol=1e-5)
