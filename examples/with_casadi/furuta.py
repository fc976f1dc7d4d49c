"""Furuta's pendulum in CasADi symbols, for comparison: the Lagrangian of
`model-spec/models/furuta_pendulum.toml`, differentiated by CasADi.
"""

import casadi as ca


def rates():
    """Returns rates(t, x, u, p) with x = (phi, theta, phi_dot, theta_dot) and the parameters p of the specification
    (J_a, L, m, l, c_a, c_p, g), SI."""
    q, dq = ca.SX.sym("q", 2), ca.SX.sym("dq", 2)
    t, u, p = ca.SX.sym("t"), ca.SX.sym("u"), ca.SX.sym("p", 7)
    arm, length, m, l, c_a, c_p, g = ca.vertsplit(p)
    inertia = m * l**2 / 3
    sin, cos = ca.sin(q[1]), ca.cos(q[1])
    across, along, up = length * dq[0] + l * cos * dq[1], -l * sin * dq[0], l * sin * dq[1]
    kinetic = arm * dq[0] ** 2 / 2 + m * (across**2 + along**2 + up**2) / 2
    kinetic += inertia * (dq[1] ** 2 + (sin * dq[0]) ** 2) / 2
    potential = -m * g * l * cos
    forces = ca.vertcat(u - c_a * dq[0], -c_p * dq[1])
    momenta = ca.gradient(kinetic, dq)
    mass = ca.jacobian(momenta, dq)
    bias = ca.jtimes(momenta, q, dq) - ca.gradient(kinetic - potential, q)
    accelerations = ca.solve(mass, forces - bias)
    x = ca.vertcat(q, dq)
    return ca.Function(
        "rates", [t, x, u, p], [ca.vertcat(dq, accelerations)], ["t", "x", "u", "p"], ["rates"]
    )
