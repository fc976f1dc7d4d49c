"""Nonlinear model predictive control of the tip of two flexible links, above their first bending frequency.

    eomgen generate model-spec/models/two_link_arm.toml --order 1 --target casadi --with hessians --out arm1
    cc -shared -fPIC -std=c99 -O1 arm1/two_link_arm_casadi.c -o arm1.so
    python examples/with_casadi/track_tip.py arm1.so

At every sample IPOPT solves an optimal control problem over the horizon with exact Hessians, starting from the previous
solution. Its first torques are applied until the next sample. The tip follows an ellipse with a frequency above the first
bending mode with fixed joints. The controlled machine is the model with one mode per link, integrated with smaller steps
than in the controller. The program also solves the first samples with the equations in CasADi symbols
(`two_link_arm.py`), from the same states, and prints both times.
"""

import os
import sys
import time

import casadi as ca
import numpy as np

import two_link_arm

SAMPLE = 0.005  # s
HORIZON = 30  # samples
DURATION = 0.4  # s
FREQUENCY = 8.0  # Hz, of the ellipse
SIZE = np.array([0.005, 0.010])  # m, its half axes
POSTURE = [0.6, -1.2]  # rad, about which it lies
LINKS = 0.5  # m, of each
COMPARED = 10  # samples that are solved with CasADi's own symbols as well


def tip(x, modes):
    """Returns the position of the tip, x_tip and y_tip of the specification."""
    ends, slopes = two_link_arm.shapes(modes, np.ones(1))[0], two_link_arm.slopes_at_end(modes)
    theta_1, theta_2, q, p = x[0], x[1], x[2 : 2 + modes], x[2 + modes : 2 + 2 * modes]
    w_e, v_t, slope = ca.dot(ends, q), ca.dot(ends, p), ca.dot(slopes, q) / LINKS
    angle = theta_1 + slope + theta_2
    return ca.vertcat(
        LINKS * ca.cos(theta_1) - w_e * ca.sin(theta_1) + LINKS * ca.cos(angle) - v_t * ca.sin(angle),
        LINKS * ca.sin(theta_1) + w_e * ca.cos(theta_1) + LINKS * ca.sin(angle) + v_t * ca.cos(angle),
    )


def reference(t, rest):
    """Returns the reference position of the tip: an ellipse about its rest position, with a smooth start."""
    size = SIZE * np.clip(t / 0.2, 0, 1) ** 2
    turn = 2 * np.pi * FREQUENCY * t
    return rest + size * np.array([np.cos(turn), np.sin(turn)])


def equilibrium(rates, p, modes):
    """Returns state and torques of the equilibrium in the posture."""
    u, bend = ca.MX.sym("u", 2), ca.MX.sym("bend", 2 * modes)
    unknown = ca.vertcat(bend, u)
    state = ca.vertcat(ca.DM(POSTURE), bend, ca.DM.zeros(2 + 2 * modes))
    residual = rates(0, state, u, p)[2 + 2 * modes :]
    solve = ca.rootfinder("rest", "newton", {"x": unknown, "g": residual})
    found = np.array(solve(x0=np.zeros(2 * modes + 2))["x"]).ravel()
    return np.concatenate([POSTURE, found[: 2 * modes], np.zeros(2 + 2 * modes)]), found[2 * modes :]


def bending_frequency(rates, p, modes):
    """Returns the lowest natural frequency with fixed joints in Hz."""
    rest, u = equilibrium(rates, p, modes)
    by_state = np.array(rates.factory("by", ["t", "x", "u", "p"], ["jac:rates:x"])(0, rest, u, p))
    degrees = 2 + 2 * modes
    held = by_state[degrees + 2 :, 2:degrees]
    return np.sqrt(-np.linalg.eigvals(held).real.max()) / (2 * np.pi)


def step(rates, p, h, name="step"):
    """Returns a step of the classical Runge-Kutta method with constant torques."""
    x, u = ca.MX.sym("x", rates.size1_in(1)), ca.MX.sym("u", 2)
    k1 = rates(0, x, u, p)
    k2 = rates(0, x + h / 2 * k1, u, p)
    k3 = rates(0, x + h / 2 * k2, u, p)
    k4 = rates(0, x + h * k3, u, p)
    return ca.Function(name, [x, u], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])


class Controller:
    """Optimal control problem over the horizon. It is solved at each sample, starting from the previous solution."""

    def __init__(self, rates, p):
        states = rates.size1_in(1)
        move = step(rates, p, SAMPLE).map(HORIZON)
        self.problem = ca.Opti()
        self.x = self.problem.variable(states, HORIZON + 1)
        self.u = self.problem.variable(2, HORIZON)
        self.now = self.problem.parameter(states)
        self.wanted = self.problem.parameter(2, HORIZON)
        self.problem.subject_to(self.x[:, 0] == self.now)
        self.problem.subject_to(ca.vec(self.x[:, 1:] - move(self.x[:, :-1], self.u)) == 0)
        places = ca.horzcat(*[tip(self.x[:, k + 1], 1) for k in range(HORIZON)])
        changes = self.u[:, 1:] - self.u[:, :-1]
        effort = 0.03 * ca.sumsqr(changes) + 0.01 * ca.sumsqr(self.x[4:, :])
        self.problem.minimize(1e6 * ca.sumsqr(places - self.wanted) + effort)
        options = {"print_level": 0, "sb": "yes", "tol": 1e-6, "max_iter": 100}
        self.problem.solver("ipopt", {"print_time": False}, options)
        rest, torques = equilibrium(rates, p, 1)
        self.rest = np.array(tip(ca.DM(rest), 1)).ravel()
        self.guess = np.tile(rest[:, None], HORIZON + 1), np.tile(torques[:, None], HORIZON)
        self.seconds, self.iterations = [], []

    def torques(self, t, state):
        """Returns the torques until the next sample."""
        times = t + SAMPLE * np.arange(1, HORIZON + 1)
        wanted = np.array([reference(time, self.rest) for time in times]).T
        self.problem.set_value(self.now, state)
        self.problem.set_value(self.wanted, wanted)
        self.problem.set_initial(self.x, self.guess[0])
        self.problem.set_initial(self.u, self.guess[1])
        begin = time.perf_counter()
        found = self.problem.solve()
        self.seconds.append(time.perf_counter() - begin)
        self.iterations.append(self.problem.stats()["iter_count"])
        x, u = found.value(self.x), found.value(self.u)
        self.guess = np.c_[x[:, 1:], x[:, -1]], np.c_[u[:, 1:], u[:, -1]]
        return u[:, 0]


def main():
    library = os.path.abspath(sys.argv[1])
    rates = ca.external("rates", library)
    p = np.array(ca.external("default_parameters", library)()["p"]).ravel()
    bending = bending_frequency(rates, p, 1)
    print(f"first bending mode with fixed joints: {bending:.2f} Hz; ellipse: {FREQUENCY} Hz")
    assert FREQUENCY > bending
    controller, other = Controller(rates, p), Controller(two_link_arm.rates(1), p)
    substeps = 10
    move = step(rates, p, SAMPLE / substeps).mapaccum(substeps)
    state, _ = equilibrium(rates, p, 1)
    misses = []
    for sample in range(round(DURATION / SAMPLE)):
        t = sample * SAMPLE
        torques = controller.torques(t, state)
        if sample < COMPARED:
            assert np.allclose(other.torques(t, state), torques, atol=1e-4), "another optimum"
        state = np.array(move(state, np.tile(torques[:, None], substeps)))[:, -1]
        place = np.array(tip(ca.DM(state), 1)).ravel()
        misses.append(np.linalg.norm(place - reference(t + SAMPLE, controller.rest)))
    late = np.array(misses[round(0.3 / SAMPLE) :])
    print(
        f"distance of the tip from the ellipse after 0.3 s: {1e3 * np.sqrt(np.mean(late**2)):.2f} mm (RMS), "
        f"{1e3 * late.max():.2f} mm (maximum); half axes {1e3 * SIZE[0]:g} and {1e3 * SIZE[1]:g} mm"
    )
    seconds = 1e3 * np.array(controller.seconds)
    print(
        f"per sample: {np.median(seconds):.1f} ms (median), {seconds.max():.1f} ms (maximum), "
        f"{np.median(controller.iterations):.0f} iterations"
    )
    compared, others = np.sum(controller.seconds[:COMPARED]), np.sum(other.seconds)
    print(
        f"the first {COMPARED} samples: {compared:.2f} s, with CasADi symbols {others:.2f} s; "
        f"time relative to CasADi symbols: {compared / others:.2f}"
    )
    assert late.max() < 0.2 * SIZE.max()


if __name__ == "__main__":
    main()
