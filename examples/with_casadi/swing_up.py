"""Swing-up of Furuta's pendulum: direct multiple shooting with IPOPT and exact Hessians.

    eomgen generate model-spec/models/furuta_pendulum.toml --target casadi --with hessians --out furuta
    cc -shared -fPIC -std=c99 -O3 furuta/furuta_pendulum_casadi.c -o furuta_pendulum.so
    python examples/with_casadi/swing_up.py furuta_pendulum.so

The torque of minimum effort moves the pendulum from the lower to the upper equilibrium, with a limited rotation of the
shaft. The initial guess is a straight line between both. The program then solves the same problem with the equations
in CasADi symbols (`furuta.py`) and prints both times.
"""

import os
import sys
import time

import casadi as ca
import numpy as np

import furuta

DURATION = 2.0  # s
INTERVALS = 80
TORQUE = 0.15  # N m, limit of the motor
START = [0.0, 0.0, 0.0, 0.0]  # phi, theta, and their rates
END = [0.0, np.pi, 0.0, 0.0]


def step(rates, h):
    """Returns a step of the classical Runge-Kutta method with a constant input."""
    x, u, p = (ca.MX.sym(name, rates.size1_in(i)) for i, name in enumerate("xup", 1))
    k1 = rates(0, x, u, p)
    k2 = rates(0, x + h / 2 * k1, u, p)
    k3 = rates(0, x + h / 2 * k2, u, p)
    k4 = rates(0, x + h * k3, u, p)
    return ca.Function("step", [x, u, p], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])


def swing_up(rates, p):
    """Returns states (4, INTERVALS + 1), torques (INTERVALS,), statistics of IPOPT, and the time in s."""
    move = step(rates, DURATION / INTERVALS).map(INTERVALS)
    problem = ca.Opti()
    x = problem.variable(4, INTERVALS + 1)
    u = problem.variable(1, INTERVALS)
    problem.minimize(ca.sumsqr(u) * DURATION / INTERVALS)
    problem.subject_to(ca.vec(x[:, 1:] - move(x[:, :-1], u, ca.repmat(p, 1, INTERVALS))) == 0)
    problem.subject_to(x[:, 0] == START)
    problem.subject_to(x[:, -1] == END)
    problem.subject_to(problem.bounded(-TORQUE, u, TORQUE))
    problem.subject_to(problem.bounded(-np.pi, x[0, :], np.pi))
    problem.set_initial(x, np.linspace(START, END, INTERVALS + 1).T)
    problem.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "max_iter": 500})
    begin = time.perf_counter()
    found = problem.solve()
    seconds = time.perf_counter() - begin
    return found.value(x), found.value(u), problem.stats(), seconds


def main():
    library = os.path.abspath(sys.argv[1])
    emitted = ca.external("rates", library)
    p = np.array(ca.external("default_parameters", library)()["p"]).ravel()
    results = {}
    for name, rates in [("emitted", emitted), ("CasADi's own symbols", furuta.rates())]:
        x, u, stats, seconds = swing_up(rates, p)
        effort = np.sum(u**2) * DURATION / INTERVALS
        results[name] = x, effort, seconds
        print(
            f"{name}: {stats['iter_count']} iterations, {seconds:.2f} s, "
            f"effort {effort:.6e} N^2 m^2 s, largest torque {np.abs(u).max():.3f} N m"
        )
    (x, effort, seconds), (other, other_effort, other_seconds) = results.values()
    print(f"time relative to CasADi symbols: {seconds / other_seconds:.2f}")
    assert np.allclose(x[:, -1], END, atol=1e-6)
    assert abs(effort - other_effort) < 1e-6 * effort, "the optima differ"


if __name__ == "__main__":
    main()
