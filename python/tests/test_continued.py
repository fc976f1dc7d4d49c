"""Tests of simulations that continue over several calls."""

import numpy as np
import pytest

import eomgen

from conftest import SPECIFICATIONS


def test_short_calls_give_the_motion_of_one_simulation(arm, pendulum):
    for model, state, inputs in [(arm, None, {"u": 0.3}), (pendulum, {"theta_dot": 2.0}, None)]:
        s = model.simulation(state=state, inputs=inputs)
        r = model.simulate(until=0.2, interval=1e-3, state=state, inputs=inputs)
        rows = []
        for t in r.t[1:]:
            s.advance(t)
            rows.append(np.concatenate([s.state, s.observables]))
        wanted = np.concatenate([r.states, r.observables], axis=1)[1:]
        sizes = np.abs(wanted).max(axis=0) + 1e-12
        assert np.abs((np.array(rows) - wanted) / sizes).max() < 1e-6
        assert s.t == r.t[-1] and s.solver == r.solver


def test_inputs_and_states_change_between_calls(cart):
    s = cart.simulation()
    for step in range(1, 101):
        s.set_inputs({cart.inputs[0]: -5.0 * s[cart.states[0]]})
        s.advance(0.01 * step)
    assert s.t == 1.0 and s.inputs[0] != 0.0
    before = s.state
    s.set_state({cart.states[0]: 0.1})
    assert s[cart.states[0]] == 0.1 and s.state[1] == before[1]


def test_events_are_taken_once():
    path = SPECIFICATIONS.parent.parent / "examples" / "impacts" / "bouncing_ball.toml"
    s = eomgen.load(path).simulation()
    s.advance(1.0)
    first = s.take_events()
    assert first and first[0].kind == "impact"
    assert s.take_events() == []


@pytest.mark.parametrize("until", [-1.0, float("nan"), float("inf")])
def test_invalid_times_change_nothing(pendulum, until):
    s = pendulum.simulation()
    s.advance(0.1)
    before = s.state
    with pytest.raises(ValueError, match="reached 0.1 s"):
        s.advance(until)
    assert np.array_equal(s.state, before) and s.t == 0.1


def test_unknown_names_and_values_are_rejected(arm):
    with pytest.raises(ValueError, match="did you mean"):
        arm.simulation(inputs={"U": 1.0})
    s = arm.simulation()
    with pytest.raises(ValueError, match="finite"):
        s.set_inputs({"u": float("nan")})
    with pytest.raises(KeyError, match="no state or observable"):
        s["nothing"]
    with pytest.raises(ValueError, match="expected one of"):
        arm.simulation(solver="euler")


@pytest.mark.parametrize("solver, until", [("rk", 5e4), ("fixed", 190)])
def test_ctrl_c_interrupts_a_simulation_that_continues(interrupt, cart, solver, until):
    s = cart.simulation(solver=solver, max_step=1e-5)
    s.advance(0.5)
    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        s.advance(until)
    with pytest.raises(eomgen.SimulationError, match="was interrupted and cannot continue"):
        s.advance(2 * until)
