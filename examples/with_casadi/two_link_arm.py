"""Arm of two flexible links in CasADi symbols, for comparison: the Lagrangian of
`model-spec/models/two_link_arm.toml` with its integrals over the mode shapes as numbers,
differentiated by CasADi.
"""

import casadi as ca
import numpy as np


def shapes(count, s):
    """Returns clamped-free beam modes at the positions s of its length, and their second derivatives,
    one row per mode: sin z - sinh z + xi (cos z - cosh z), z = beta s."""
    values, curvatures = [], []
    for mode in range(count):
        beta = np.pi * (mode + 0.5)
        for _ in range(50):
            residual = np.cos(beta) + 1 / np.cosh(beta)
            beta -= residual / (-np.sin(beta) - np.tanh(beta) / np.cosh(beta))
        xi = -(np.sin(beta) + np.sinh(beta)) / (np.cos(beta) + np.cosh(beta))
        z = beta * s
        values.append(np.sin(z) - np.sinh(z) + xi * (np.cos(z) - np.cosh(z)))
        curvatures.append(-(beta**2) * (np.sin(z) + np.sinh(z) + xi * (np.cos(z) + np.cosh(z))))
    return np.array(values), np.array(curvatures)


def slopes_at_end(count):
    """Returns the derivatives of the modes with respect to s at the free end, as integrals of the second derivatives."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    return shapes(count, (nodes + 1) / 2)[1] @ (weights / 2)


def rates(modes):
    """Returns rates(t, x, u, p) with x = (theta_1, theta_2, q, p, and their rates), u = (u_1, u_2) and p the
    parameters of the specification in its order, SI."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    s, weights = (nodes + 1) / 2, weights / 2
    phi, curvature = shapes(modes, s)
    first, moment = phi @ weights, phi @ (weights * s)
    square, bending = (phi * weights) @ phi.T, (curvature * weights) @ curvature.T
    end, slope_end = shapes(modes, np.ones(1))[0][:, 0], slopes_at_end(modes)

    degrees = 2 + 2 * modes
    z, dz = ca.SX.sym("z", degrees), ca.SX.sym("dz", degrees)
    t, u, parameters = ca.SX.sym("t"), ca.SX.sym("u", 2), ca.SX.sym("p", 14)
    l_1, l_2, mu_1, mu_2, ei_1, ei_2, j_1, j_e, j_2, m_e, m_t, c_1, c_2, g = ca.vertsplit(parameters)
    theta_1, theta_2, q, p = ca.vertsplit(z, [0, 1, 2, 2 + modes, degrees])
    dtheta_1, dtheta_2, dq, dp = ca.vertsplit(dz, [0, 1, 2, 2 + modes, degrees])
    w_e, dw_e, v_t, dv_t = ca.dot(end, q), ca.dot(end, dq), ca.dot(end, p), ca.dot(end, dp)
    slope, dslope = ca.dot(slope_end, q) / l_1, ca.dot(slope_end, dq) / l_1
    turn = slope + theta_2
    angle, dangle = theta_1 + turn, dtheta_1 + dslope + dtheta_2
    along_1, across_1 = -w_e * dtheta_1, l_1 * dtheta_1 + dw_e
    along_2 = ca.cos(turn) * along_1 + ca.sin(turn) * across_1
    across_2 = ca.cos(turn) * across_1 - ca.sin(turn) * along_1

    def form(matrix, a):
        return ca.bilin(matrix, a, a)

    kinetic = j_1 * dtheta_1**2 / 2
    kinetic += mu_1 * l_1 / 2 * (form(square, q) * dtheta_1**2 + form(square, dq))
    kinetic += mu_1 * l_1 / 2 * (l_1**2 * dtheta_1**2 / 3 + 2 * l_1 * dtheta_1 * ca.dot(moment, dq))
    kinetic += m_e / 2 * (along_1**2 + across_1**2)
    kinetic += j_e / 2 * (dtheta_1 + dslope) ** 2 + j_2 / 2 * dangle**2
    across = across_2**2 + dangle**2 * l_2**2 / 3 + form(square, dp) + across_2 * dangle * l_2
    across += 2 * across_2 * ca.dot(first, dp) + 2 * dangle * l_2 * ca.dot(moment, dp)
    along = along_2**2 - 2 * along_2 * dangle * ca.dot(first, p) + form(square, p) * dangle**2
    kinetic += mu_2 * l_2 / 2 * (along + across)
    kinetic += m_t / 2 * ((along_2 - v_t * dangle) ** 2 + (across_2 + l_2 * dangle + dv_t) ** 2)

    height = l_1 * ca.sin(theta_1) + w_e * ca.cos(theta_1)
    potential = ei_1 / (2 * l_1**3) * form(bending, q) + ei_2 / (2 * l_2**3) * form(bending, p)
    potential += mu_1 * g * l_1 * (l_1 / 2 * ca.sin(theta_1) + ca.dot(first, q) * ca.cos(theta_1))
    potential += m_e * g * height
    hanging = height + l_2 / 2 * ca.sin(angle) + ca.dot(first, p) * ca.cos(angle)
    potential += mu_2 * g * l_2 * hanging
    potential += m_t * g * (height + l_2 * ca.sin(angle) + v_t * ca.cos(angle))

    torques = ca.vertcat(u[0] - c_1 * dtheta_1, u[1] - c_2 * dtheta_2, ca.SX.zeros(2 * modes))
    momenta = ca.gradient(kinetic, dz)
    mass = ca.jacobian(momenta, dz)
    bias = ca.jtimes(momenta, z, dz) - ca.gradient(kinetic - potential, z)
    accelerations = ca.solve(mass, torques - bias)
    x = ca.vertcat(z, dz)
    names = ["t", "x", "u", "p"]
    return ca.Function("rates", [t, x, u, parameters], [ca.vertcat(dz, accelerations)], names, ["rates"])
