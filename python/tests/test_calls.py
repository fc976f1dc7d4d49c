"""Tests of rates, observables, energy and Jacobians of single states and of arrays."""

import threading

import numpy as np
import pytest

import eomgen

from conftest import SPECIFICATIONS


def test_single_states_and_arrays_give_the_same_bits(arm, states):
    x = states(arm, 50)
    t, u = np.linspace(0, 1, 50), np.linspace(-1, 1, 50).reshape(-1, 1)
    for call in (arm.rates, arm.observables, arm.energy, arm.jacobian):
        many = call(t, x, u)
        for row in range(50):
            assert np.array_equal(call(t[row], x[row], u[row]), many[row])


def test_rates_of_coordinates_are_the_second_half_of_the_state(arm, states):
    x = states(arm, 20)
    half = len(arm.states) // 2
    assert np.array_equal(arm.rates(0.0, x)[:, :half], x[:, half:])


def test_pendulum_matches_closed_form(pendulum):
    p = pendulum.parameters
    x = np.array([[0.3, -2.0], [3.0, 1.0]])
    inertia = p["m"] * p["a"] ** 2 + p["I"]
    right = (p["m"] * p["g"] * p["a"] * np.sin(x[:, 0]) - p["k"] * x[:, 1]) / inertia
    assert np.allclose(pendulum.rates(0.0, x)[:, 1], right, rtol=1e-13)
    energy = inertia * x[:, 1] ** 2 / 2 + p["m"] * p["g"] * p["a"] * np.cos(x[:, 0])
    assert np.allclose(pendulum.energy(0.0, x), energy, rtol=1e-13)


@pytest.mark.parametrize("by", ["state", "inputs", "parameters"])
def test_jacobians_match_central_differences(cart, states, by):
    x = cart.initial + states(cart, 5, 0.1)
    u = np.full((1, len(cart.inputs)), 0.7)
    found = cart.jacobian(0.0, x, u, by=by)
    for column in range(found.shape[2]):
        if by == "state":
            h = 1e-6 * np.eye(len(cart.states))[column]
            ends = [cart.rates(0.0, x + s * h, u) for s in (1, -1)]
            step = 2e-6
        elif by == "inputs":
            h = 1e-3 * np.eye(len(cart.inputs))[column]
            ends = [cart.rates(0.0, x, u + s * h) for s in (1, -1)]
            step = 2e-3
        else:
            name = cart.independent_parameters[column]
            value = cart.parameters[name]
            step = 1e-5 * abs(value)
            ends = [
                cart.with_parameters(**{name: value + s * step}).rates(0.0, x, u) for s in (1, -1)
            ]
            step *= 2
        difference = (ends[0] - ends[1]) / step
        assert np.allclose(found[:, :, column], difference, rtol=1e-5, atol=1e-5), (by, column)


def test_array_layout_and_type_do_not_change_results(arm, states):
    x = states(arm, 30)
    right = arm.rates(0.0, x)
    assert np.array_equal(arm.rates(0.0, np.asfortranarray(x)), right)
    wide = np.zeros((60, 2 * x.shape[1]))
    wide[::2, ::2] = x
    assert np.array_equal(arm.rates(0.0, wide[::2, ::2]), right)
    assert np.array_equal(arm.rates(0, x.tolist()), right)
    single = x.astype(np.float32)
    assert np.array_equal(arm.rates(0.0, single), arm.rates(0.0, single.astype(float)))
    assert np.array_equal(arm.rates(0.0, x[::-1])[::-1], right)
    whole = np.ones_like(x, dtype=int)
    assert np.array_equal(arm.rates(0.0, whole), arm.rates(0.0, np.ones_like(x)))


def test_empty_arrays_give_empty_rates(arm):
    assert arm.rates(0.0, np.zeros((0, len(arm.states)))).shape == (0, len(arm.states))


def test_inputs_are_accepted_by_name(cart):
    x = cart.initial
    named = cart.rates(0.0, x, {cart.inputs[0]: 2.0})
    assert np.array_equal(named, cart.rates(0.0, x, [2.0]))
    assert not np.array_equal(named, cart.rates(0.0, x))
    rows = cart.rates(0.0, np.stack([x, x]), {cart.inputs[0]: [2.0, 3.0]})
    assert np.array_equal(rows[0], named)


def test_nan_propagates(arm):
    x = np.zeros((3, len(arm.states)))
    x[1] = np.nan
    found = arm.rates(0.0, x)
    assert np.isnan(found[1]).all()
    assert np.array_equal(found[[0, 2]], arm.rates(0.0, x[[0, 2]]))
    for extreme in (np.inf, 1e308, -1e308):
        assert arm.rates(extreme, np.full(len(arm.states), extreme)).shape == (len(arm.states),)


@pytest.mark.parametrize(
    "x, said",
    [
        (np.zeros(3), "expected (14,) or (n, 14), for the states x_sp, x_pr"),
        (np.zeros((14, 3)), "x has the shape (14, 3)"),
        (np.zeros((2, 2, 14)), "x has the shape (2, 2, 14)"),
        (0.0, "x has the shape ()"),
    ],
)
def test_wrong_shapes_are_rejected_with_the_expected_one(arm, x, said):
    for call in (arm.rates, arm.observables, arm.energy, arm.jacobian):
        with pytest.raises(ValueError) as raised:
            call(0.0, x)
        assert said in str(raised.value)


def test_wrong_times_and_inputs_are_rejected(arm):
    x = np.zeros((4, len(arm.states)))
    with pytest.raises(ValueError, match="one for each of 4 states"):
        arm.rates(np.zeros(3), x)
    with pytest.raises(ValueError, match=r"u has the shape \(3, 1\)"):
        arm.rates(0.0, x, np.zeros((3, 1)))
    with pytest.raises(ValueError, match="the model has no input `v`"):
        arm.rates(0.0, x, {"v": 1.0})
    with pytest.raises(ValueError, match="by = 'power'"):
        arm.jacobian(0.0, x, by="power")


@pytest.mark.parametrize(
    "x",
    [
        np.zeros(14, dtype=complex),
        ["a"] * 14,
        None,
        np.zeros(14, dtype=bool),
        np.ma.masked_array(np.zeros(14), mask=[True] + 13 * [False]),
        [[1.0], [2.0, 3.0]],
        object(),
    ],
)
def test_values_that_are_not_real_are_rejected(arm, x):
    with pytest.raises(TypeError):
        arm.rates(0.0, x)


def test_threads_share_a_model(arm, states):
    x = states(arm, 2000)
    right, derivatives = arm.rates(0.0, x), arm.jacobian(0.0, x[:50])
    wrong = []

    def work():
        for _ in range(20):
            if not np.array_equal(arm.rates(0.0, x), right):
                wrong.append("rates")
            if not np.array_equal(arm.jacobian(0.0, x[:50]), derivatives):
                wrong.append("jacobian")

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_derived_models_leave_the_original_unchanged(pendulum):
    x = [0.5, 1.0]
    before = pendulum.rates(0.0, x)
    longer = pendulum.with_parameters(a=2 * pendulum.parameters["a"])
    for _ in range(5):
        eomgen.load(SPECIFICATIONS / "double_pendulum.toml").rates(0.0, np.zeros(4))
    assert np.array_equal(pendulum.rates(0.0, x), before)
    assert not np.array_equal(longer.rates(0.0, x), before)
