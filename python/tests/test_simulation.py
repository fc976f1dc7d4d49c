"""Tests of trajectories: comparison with the command line, access by name, tables, rejected arguments, Ctrl-C."""

import subprocess
import threading
import warnings

import numpy as np
import pytest

import eomgen

from conftest import SPECIFICATIONS


@pytest.mark.parametrize(
    "name, solver", [("planetary_arm", "auto"), ("double_pendulum", "rk"), ("pendulum", "adams")]
)
def test_trajectory_matches_the_command_line(tmp_path, program, name, solver):
    path, out = SPECIFICATIONS / f"{name}.toml", tmp_path / "motion.csv"
    command = [program, "simulate", path, "--until", "0.7", "--interval", "1e-3"]
    subprocess.run([*command, "--solver", solver, "--out", out], check=True, capture_output=True)
    with open(out, encoding="utf-8") as file:
        header = file.readline().strip().split(",")
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    r = eomgen.load(path).simulate(until=0.7, interval=1e-3, solver=solver)
    assert header == ["t", *r.names]
    assert np.array_equal(np.column_stack([r.t, r.states, r.observables]), table)


def test_arm_with_other_play_matches_the_documentation(arm):
    m = eomgen.load(SPECIFICATIONS / "planetary_arm.toml").with_parameters(b_sp=50e-6)
    r = m.simulate(until=2, interval=1e-3)
    assert (r.solver, len(r)) == ("exact", 2001)
    assert r["tip"].shape == r.t.shape and r.switches > 0
    assert r.reason.count("piecewise linear") == 1


def test_events_have_surface_kind_modes_and_jump():
    m = eomgen.load(SPECIFICATIONS.parent.parent / "examples" / "impacts" / "bouncing_ball.toml")
    r = m.simulate(until=1)
    assert r.switches == len(r.events) > 0
    first = r.events[0]
    assert (first.kind, first.before, first.after) == ("impact", "positive", "positive")
    assert first.jump[m.states[0]] > 0 and 0 < first.t < 1
    arm = eomgen.load(SPECIFICATIONS / "planetary_arm.toml").simulate(until=0.1)
    assert {event.kind for event in arm.events} == {"crossing"}
    assert all(event.jump == {} for event in arm.events)


def test_number_of_samples_follows_the_interval(pendulum):
    assert len(pendulum.simulate(until=1)) == 1001
    assert pendulum.simulate(until=1, interval=0.3).t.tolist() == pytest.approx([0, 0.3, 0.6, 0.9])
    assert pendulum.simulate(until=0.3, interval=0.1).t[-1] == pytest.approx(0.3)


def test_initial_state_is_accepted_by_name_or_as_array(pendulum):
    named = pendulum.simulate(until=1, state={"theta_dot": 2.0})
    whole = pendulum.simulate(until=1, state=[pendulum.initial[0], 2.0])
    assert np.array_equal(named.states, whole.states)
    assert named["theta_dot"][0] == 2.0


def test_inputs_are_numbers_samples_or_functions(cart):
    name = cart.inputs[0]
    t = np.arange(101) * 0.01
    of = lambda force: cart.simulate(until=1, interval=0.01, inputs={name: force})
    held = of(np.sin(t))
    assert not np.array_equal(held.states, of(lambda t: np.sin(t)).states)
    assert np.allclose(of(lambda t: np.sin(t)).states, of("sin(t)").states, rtol=2e-8, atol=2e-8)
    # Interpolated rows inside long steps have an error of at most 20 times the tolerance, 1e-9.
    assert np.allclose(of(0.5).states, of(np.full(101, 0.5)).states, rtol=2e-8, atol=2e-8)
    # The force is constant from sample to sample.
    step = eomgen.load(cart.text).simulate(
        until=0.01, interval=0.005, state=held.states[50], inputs={name: np.sin(t[50])}
    )
    assert np.allclose(step.states[-1], held.states[51], rtol=1e-7, atol=1e-9)


def test_missing_inputs_are_0_with_a_warning(cart):
    with pytest.warns(UserWarning, match=f"not driven and taken as 0: {cart.inputs[0]}"):
        r = cart.simulate(until=0.01)
    assert np.array_equal(r.states, cart.simulate(until=0.01, inputs={cart.inputs[0]: 0}).states)


def test_tables_and_plots_have_the_columns(pendulum):
    pandas = pytest.importorskip("pandas")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    r = pendulum.simulate(until=1, interval=0.1)
    table = r.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert list(table.columns) == list(r.names) and table.index.name == "t"
    assert np.array_equal(table["theta"].to_numpy(), r["theta"])
    axes = r.plot("theta", "energy")
    assert [axis.get_ylabel() for axis in axes] == ["theta (rad)", "energy (J)"]
    assert len(r.plot()) == 1


def test_earlier_names_of_arguments_work(pendulum):
    current = pendulum.simulate(until=1, interval=0.1, state={"theta": 0.2})
    earlier = pendulum.simulate(until=1, sample=0.1, initial={"theta": 0.2})
    assert np.array_equal(current.states, earlier.states)
    with pytest.raises(TypeError, match="give interval only"):
        pendulum.simulate(until=1, interval=0.1, sample=0.1)
    with pytest.raises(TypeError, match="give state only"):
        pendulum.simulate(until=1, state={"theta": 0.2}, initial={"theta": 0.2})
    assert pendulum.trim().running == pendulum.trim().steady_rates == ()


@pytest.mark.parametrize(
    "arguments, error, said",
    [
        ({"until": 0}, ValueError, "expected a time in s after 0"),
        ({"until": -1}, ValueError, "expected a time in s after 0"),
        ({"until": float("nan")}, ValueError, "until = nan"),
        ({"until": float("inf")}, ValueError, "until = inf"),
        ({"until": "2"}, TypeError, "until"),
        ({"until": 1, "interval": 0}, ValueError, "interval = 0.0"),
        ({"until": 1, "interval": 2}, ValueError, "at most 1.0"),
        ({"until": 1e9, "interval": 1e-9}, ValueError, "too many samples"),
        ({"until": 1, "solver": "euler"}, ValueError, 'expected one of "auto", "exact", "rk"'),
        ({"until": 1, "solver": None}, TypeError, "solver"),
        ({"until": 1, "tolerance": 0}, ValueError, "tolerance"),
        ({"until": 1, "state": {"thetta": 1}}, ValueError, "did you mean `theta`"),
        ({"until": 1, "state": [1.0]}, ValueError, "expected (2,)"),
        ({"until": 1, "state": [float("nan"), 0]}, ValueError, "the state theta = nan: expected a finite number"),
        ({"until": 1, "inputs": {"u": 1.0}}, ValueError, "the model has no input `u`"),
        ({"until": 1, "inputs": 3}, TypeError, "inputs"),
        ({"until": 1, "solver": "exact"}, ValueError, "sin"),
    ],
)
def test_invalid_arguments_are_rejected(pendulum, arguments, error, said):
    with pytest.raises(error) as raised:
        pendulum.simulate(**arguments)
    assert said in str(raised.value)


def test_invalid_inputs_are_rejected(cart):
    name = cart.inputs[0]
    for force, said in [
        (np.zeros(7), "expected a number, or 101 numbers"),
        (np.full(101, np.nan), f"the input {name} at t = 0.0: nan: expected a finite number"),
        (lambda t: np.nan if t > 0.5 else 1.0, f"the input {name} at t = 0.5.*: NaN: expected a"),
        ("sin(t", "(?s)is missing.*inputs:1:8"),
    ]:
        with pytest.raises(ValueError, match=said):
            cart.simulate(until=1, interval=0.01, inputs={name: force})
    with pytest.raises(TypeError, match=f"the input {name} at t = 0: expected a number"):
        cart.simulate(until=1, inputs={name: lambda t: "1"})


def test_input_exceptions_are_chained(cart):
    name = cart.inputs[0]
    with pytest.raises(eomgen.SimulationError, match=f"the input {name} at t = 0.3") as raised:
        cart.simulate(until=1, inputs={name: lambda t: 1 / 0 if t > 0.3 else 0.0})
    assert isinstance(raised.value.__cause__, ZeroDivisionError)
    so_far = raised.value.trajectory
    assert 0.1 < so_far.t[-1] <= 0.3 and np.isfinite(so_far.states).all()
    with pytest.raises(eomgen.SimulationError, match=f"the input {name} at t = 0 ") as raised:
        cart.simulate(until=1, inputs={name: lambda t: {}["missing"]})
    assert isinstance(raised.value.__cause__, KeyError)


@pytest.mark.parametrize(
    "arguments",
    [{}, {"gradients": True}, {"solver": "radau"}, {"solver": "adams"}, {"solver": "fixed", "max_step": 1e-3}],
)
@pytest.mark.parametrize("end", [0.3, 0.77, 2.5])
def test_samples_before_a_failed_call_are_kept(cart, arguments, end):
    name = cart.inputs[0]
    force = lambda t: 1 / 0 if t > end else np.sin(t)
    with pytest.raises(eomgen.SimulationError, match=f"the input {name} at t = ") as raised:
        cart.simulate(until=4, interval=0.01, inputs={name: force}, **arguments)
    so_far = raised.value.trajectory
    step = 1e-3 if arguments.get("solver") == "fixed" else 1e-6
    failed = float(str(raised.value).split("t = ")[1].split()[0])
    assert end < failed <= end + step
    whole = cart.simulate(until=end, interval=0.01, inputs={name: lambda t: np.sin(t)}, **arguments)
    assert so_far.t[-1] >= end - 0.01 - 1e-9 and np.array_equal(so_far.t, whole.t[: len(so_far)])
    assert np.allclose(so_far.states, whole.states[: len(so_far)], rtol=1e-6, atol=1e-6)


def test_a_failed_call_ends_the_motion_at_the_earliest_failure(cart):
    name = cart.inputs[0]
    calls = []

    def force(t):
        calls.append(t)
        if 0.3 < t < 0.4 or t > 1.0:
            raise RuntimeError("no value")
        return 0.0

    with pytest.raises(eomgen.SimulationError, match=f"the input {name} at t = 0.300") as raised:
        cart.simulate(until=4, interval=0.01, inputs={name: force})
    assert 0.28 < raised.value.trajectory.t[-1] <= 0.3
    first = next(place for place, t in enumerate(calls) if 0.3 < t < 0.4 or t > 1.0)
    assert all(t < calls[first] for t in calls[first + 1 :])


def test_inputs_without_a_finite_value_are_named_with_their_time(cart):
    name = cart.inputs[0]
    force = np.zeros(101)
    force[50] = np.inf
    with pytest.raises(ValueError, match=f"the input {name} at t = 0.5: inf: expected a finite number"):
        cart.simulate(until=1, interval=0.01, inputs={name: force})
    with pytest.raises(eomgen.SimulationError, match=f"`{name}` is infinite at t = 0.0 s"):
        cart.simulate(until=1, inputs={name: "1/t"})


AXIS = """
[model]
name = "axis"
[parameters]
J_m = { value = 2.1e-4, unit = "kg m^2" }
m = { value = 18, unit = "kg" }
k = { value = 24, unit = "N/um" }
c = { value = 9, unit = "N s/mm" }
p = { value = 10, unit = "mm" }
b = { value = 55, unit = "N s/m" }
[coordinates]
phi = { unit = "rad" }
x = { unit = "m" }
[inputs]
M = { unit = "N m" }
[definitions]
s = "p/(2*pi)*phi - x"
[kinetic]
motor = "1/2*J_m*dot(phi)^2"
table = "1/2*m*dot(x)^2"
[potential]
nut = "1/2*k*s^2"
[dissipation]
nut = "1/2*c*dot(s)^2"
guides = "1/2*b*dot(x)^2"
[forces]
motor = { on = "phi", value = "M" }
"""


@pytest.mark.parametrize("torque", [lambda t: 0.3 * np.sin(50 * t), "0.3*sin(50*t)"])
def test_output_interval_does_not_change_the_motion(torque):
    axis = eomgen.load(AXIS)
    ends = [axis.simulate(1, interval=h, inputs={"M": torque})["x"][-1] for h in (0.1, 0.05, 0.001)]
    # Reference: SciPy's Radau method at 1e-12 with the rates of the model.
    assert np.allclose(ends, 0.028995, rtol=0, atol=1e-6)
    assert np.ptp(ends) < 1e-9


@pytest.mark.parametrize("is_after", [lambda t, jump: t >= jump, lambda t, jump: t > jump])
def test_steps_end_where_a_function_jumps(cart, is_after):
    name = cart.inputs[0]
    jump = 0.123456789
    of = lambda force, **more: cart.simulate(until=0.5, interval=0.1, inputs={name: force}, **more)
    exact = of(f"3*above(t - {jump})")
    calls = []

    def stepped(t):
        calls.append(t)
        return 3.0 if is_after(t, jump) else 0.0

    r = of(stepped, breaks=[jump])
    assert np.allclose(r.states, exact.states, rtol=1e-7, atol=1e-7)
    assert jump not in calls
    assert np.nextafter(jump, 1) in calls and np.nextafter(jump, 0) in calls


def test_simulation_starts_at_a_given_time(cart):
    name = cart.inputs[0]
    whole = cart.simulate(until=1, interval=0.1, inputs={name: lambda t: np.sin(9 * t)})
    rest = cart.simulate(
        until=1, interval=0.1, start=0.5, state=whole.states[5], inputs={name: lambda t: np.sin(9 * t)}
    )
    assert rest.t[0] == 0.5 and rest.t[-1] == pytest.approx(1) and len(rest) == 6
    assert np.allclose(rest.states, whole.states[5:], rtol=1e-7, atol=1e-8)
    with pytest.raises(ValueError, match="expected a time in s after 2"):
        cart.simulate(until=1, start=2)


def test_max_step_resolves_a_short_pulse(cart):
    name = cart.inputs[0]
    pulse = lambda t: 100.0 * np.exp(-(((t - 31.4) / 0.005) ** 2))
    of = lambda **more: cart.simulate(
        until=40, interval=4, solver="rk", state=[0.0] * len(cart.states), inputs={name: pulse}, **more
    )
    seen, exact = of(max_step=0.004), of(breaks=[31.38, 31.39, 31.4, 31.41, 31.42])
    assert np.abs(exact.states[-1]).max() > 1e-3
    assert np.allclose(seen.states[-1], exact.states[-1], rtol=1e-3, atol=1e-3)
    for wrong in (0, -1, float("nan")):
        with pytest.raises(ValueError, match="max_step"):
            of(max_step=wrong)


def test_unexplained_energy_is_a_warning():
    base = """
[model]
name = "base"
[parameters]
m = { value = 1, unit = "kg" }
U = { value = 1, unit = "J" }
[coordinates]
x = { unit = "m", initial = -1, initial_rate = 1 }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
step = "U*above(x)"
"""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        r = eomgen.load(base).simulate(until=3, solver="rk")
    kept = np.ptp(r["energy"]) < 1e-6
    assert kept != any("J without work" in str(one.message) for one in caught)


def test_unknown_columns_are_rejected(pendulum):
    with pytest.raises(KeyError, match="did you mean `theta`"):
        pendulum.simulate(until=0.1)["thetha"]


def test_stopped_simulation_keeps_its_samples():
    runaway = """
[model]
name = "runaway"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m^2" }
[coordinates]
x = { unit = "m", initial = 1 }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
away = { on = "x", value = "k*x^2" }
"""
    with pytest.raises(eomgen.SimulationError) as raised:
        eomgen.load(runaway).simulate(until=100, interval=0.01)
    so_far = raised.value.trajectory
    assert 100 < len(so_far) < 2000 and so_far["x"][-1] > 1.0
    assert np.isfinite(so_far.states).all()
    with pytest.raises(eomgen.SimulationError) as raised:
        eomgen.load(runaway).simulate(until=100, interval=0.01, gradients=True)
    recorded = raised.value.trajectory
    assert np.array_equal(recorded.t, so_far.t)
    with pytest.raises(eomgen.SimulationError, match="no step meets the tolerance"):
        recorded.gradient({"x": np.ones(len(recorded))})


@pytest.fixture(scope="module")
def endless():
    """Returns a simulation that takes hours."""
    m = eomgen.load(SPECIFICATIONS / "double_pendulum.toml")
    return lambda **options: m.simulate(until=1e7, interval=1e4, solver="rk", **options)


def test_progress_is_reported_and_may_raise(endless):
    told = []

    def enough(part):
        told.append(part)
        if len(told) == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        endless(progress=enough)
    assert told == sorted(told) and all(0 < part < 1 for part in told)


@pytest.mark.parametrize("start", [100.0, -2.0, -1.0])
def test_progress_begins_at_the_start_of_the_motion(start):
    told = []

    def first(part):
        told.append(part)
        raise RuntimeError("first")

    m = eomgen.load(SPECIFICATIONS / "pendulum.toml")
    with pytest.raises(RuntimeError, match="first"):
        m.simulate(until=start + 1, start=start, interval=1e-3, solver="rk", max_step=1e-7, progress=first)
    assert 0 < told[0] < 0.5


def test_ctrl_c_interrupts_a_simulation(endless, interrupt):
    with pytest.raises(KeyboardInterrupt):
        with interrupt(after=0.7):
            endless()


def test_other_threads_run_during_a_simulation(endless):
    worked, turns = [], 0

    def enough(part):
        if part > 0 and turns > 1000:
            raise RuntimeError("enough")

    def work():
        with pytest.raises(RuntimeError, match="enough"):
            endless(progress=enough)
        worked.append(turns)

    thread = threading.Thread(target=work)
    thread.start()
    while thread.is_alive():
        turns += 1
    assert worked[0] > 1000


PIVOT = """
[model]
name = "pivot"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
th = { unit = "rad", initial = 0.3 }
[inputs]
s = { unit = "m", rates = 2 }
[definitions]
p = ["s + l*sin(th)", "-l*cos(th)"]
[kinetic]
a = "1/2*m*dot(dot(p),dot(p))"
[potential]
v = "m*g*p.y"
"""


def test_rates_beside_prescribed_motion_are_refused():
    m = eomgen.load(PIVOT)
    for name in ("s_dot", "s_ddot"):
        for value in (5.0, np.ones(11), lambda t: 5.0, "5"):
            with pytest.raises(ValueError, match=f"the input {name} is a rate of the prescribed motion s"):
                m.simulate(until=1, interval=0.1, inputs={"s": lambda t: 0.1 * np.sin(6 * t), name: value})


def test_prescribed_motion_that_jumps_is_refused():
    m = eomgen.load(PIVOT)
    at = 0.2512
    for step in (lambda t: 0.1 * (t >= at), lambda t: 0.1 * (t > at) + np.sin(3 * t)):
        for until in (1.0, 2.0, 4.0):
            for breaks in (None, [at]):
                with pytest.raises(ValueError, match="the input s at t = 0.251.*jumps from"):
                    m.simulate(until=until, interval=0.5, inputs={"s": step}, breaks=breaks)
    with pytest.raises(ValueError, match="the input s at t = 0.2512: .*jumps from 0.0 to 0.1|jumps from 0 to 0.1"):
        m.simulate(until=1, inputs={"s": lambda t: (0.1 * (t > at), 0.0, 0.0)}, breaks=[at])
    # Continuous motions with a corner, a steep slope, rounding errors or rest.
    for motion in (
        lambda t: abs(t - 0.3),
        lambda t: 0.1 * np.tanh(200 * (t - 0.3)),
        lambda t: np.sqrt(max(t - 0.3, 0.0)),
        lambda t: 1e3 + 1e-3 * np.sin(t),
        lambda t: 0.0,
    ):
        assert np.isfinite(m.simulate(until=1, interval=0.1, inputs={"s": motion})["th"]).all()
    moving = lambda t: (np.sin(t), np.cos(t), -np.sin(t))  # noqa: E731
    assert np.isfinite(m.simulate(until=1, inputs={"s": moving}, breaks=[0.5])["th"]).all()


def test_prescribed_motion_has_spline_rates():
    crane = eomgen.load(SPECIFICATIONS / "crane.toml")
    assert crane.inputs == ("s", "s_dot", "s_ddot", "l", "l_dot", "l_ddot")
    drive, sample = (lambda t: 0.3 * t**2 - 0.05 * t**3), 0.01
    r = crane.simulate(until=3, interval=sample, inputs={"s": drive, "l": 6.0})
    # Reference: m (l theta'' + s'' cos theta + g sin theta) + c (l theta' + s' cos theta) = 0, solved by SciPy.
    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp

    def rates(t, y):
        s_dot, s_ddot = 0.6 * t - 0.15 * t**2, 0.6 - 0.3 * t
        theta, rate = y
        across = 25 / 800 * (6 * rate + s_dot * np.cos(theta))
        return rate, -(s_ddot * np.cos(theta) + 9.81 * np.sin(theta) + across) / 6

    known = solve_ivp(rates, (0, 3), [0.1, 0], t_eval=r.t, rtol=1e-10, atol=1e-12, method="DOP853")
    assert np.abs(r["theta"] - known.y[0]).max() < 1e-8
    assert np.allclose(r["place"], drive(r.t) + 6 * np.sin(r["theta"]), rtol=0, atol=1e-12)
    with_rates = lambda t: (drive(t), 0.6 * t - 0.15 * t**2, 0.6 - 0.3 * t)
    r = crane.simulate(until=3, interval=0.1, inputs={"s": with_rates, "l": 6.0})
    assert np.abs(r["theta"] - known.y[0][::10]).max() < 1e-8
    with pytest.raises(TypeError, match="the input s at t = .*: expected 3 numbers"):
        crane.simulate(until=3, inputs={"s": lambda t: (drive(t), 0.0), "l": 6.0})


ARC = """
[model]
name = "arc"
[parameters]
mu = { value = 2, unit = "kg/m" }
F = { value = 40, unit = "N" }
l = { value = 1.5, unit = "m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "pinned_pinned"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"
[potential]
arc = "integral(F*(sqrt(1 + diff(w, x)^2) - 1), w)"
"""


def test_integral_that_quadrature_does_not_resolve_gives_a_warning():
    with pytest.warns(UserWarning, match=r"integrate `integral\(F\*\(sqrt.*relative error"):
        eomgen.load(ARC).simulate(until=0.01, interval=0.01, state={"q_1": 15, "q_2": 3})


def test_ctrl_c_interrupts_an_input_function(interrupt, cart):
    cleaned = []

    def never(t):
        try:
            while True:
                pass
        finally:
            cleaned.append(t)

    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        cart.simulate(until=1, inputs={cart.inputs[0]: never}, solver="rk")
    assert len(cleaned) == 1


def test_ctrl_c_interrupts_fixed_steps(interrupt, cart):
    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        cart.simulate(until=190, interval=10, solver="fixed", max_step=1e-5)
