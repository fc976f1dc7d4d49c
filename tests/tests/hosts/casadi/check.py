"""Loads an emitted model by CasADi's `external`, and compares its Jacobians with differences.

Arguments: the shared library, the names of the state separated by commas, the numbers of inputs and
parameters, and the rates that the emitted C gives at the point made below, as the caller knows
them.
"""

import ctypes
import sys

import casadi
import numpy

library, names, inputs, parameters = sys.argv[1:5]
states = len(names.split(","))
inputs, parameters = int(inputs), int(parameters)
expected = numpy.array([float(number) for number in sys.argv[5:]])

rates = casadi.external("rates", library)
assert [rates.name_in(i) for i in range(rates.n_in())] == ["t", "x", "u", "p"]
assert [rates.size1_in(i) for i in range(4)] == [1, states, inputs, parameters]
assert rates.size_out(0) == (states, 1)

p = numpy.array(casadi.external("default_parameters", library)()["p"]).ravel()
assert p.size == parameters
t = 0.3
x = numpy.array([0.02 * (1 + i) * (-1) ** i for i in range(states)])
u = numpy.array([0.5 + 0.1 * i for i in range(inputs)])
point = [numpy.array([t]), x, u, p]
found = numpy.array(rates(t, x, u, p)).ravel()
assert (found == expected).all(), (found, expected)

# Jacobian from a CasADi graph, which calls `jac_rates`.
symbols = [casadi.MX.sym(name, rates.size1_in(i)) for i, name in enumerate("txup")]
value = rates(*symbols)
for argument, symbol in enumerate(symbols):
    jacobian = casadi.Function("jacobian", symbols, [casadi.jacobian(value, symbol)])
    exact = numpy.array(jacobian(*point))
    count = point[argument].size
    differences = numpy.zeros((states, count))
    for column in range(count):
        size = abs(point[argument][column])
        step = 1e-6 * (size if size > 0 else 1.0)
        ends = []
        for sign in (1, -1):
            moved = [part.copy() for part in point]
            moved[argument][column] += sign * step
            ends.append(numpy.array(rates(*moved)).ravel())
        differences[:, column] = (ends[0] - ends[1]) / (2 * step)
        # Rounding error of a difference of rates of this magnitude.
        rest = 1e-14 * numpy.abs(found).max() / step + 1e-6 * numpy.abs(exact[:, column]).max()
        worst = numpy.abs(differences[:, column] - exact[:, column]).max()
        assert worst <= rest, (argument, column, worst, rest)

# Second derivatives of the rates, weighted, against differences of the gradient.
if hasattr(ctypes.CDLL(library), "adj1_rates"):
    weights = numpy.array([0.3 + 0.2 * i * (-1) ** i for i in range(states)])
    weighted = casadi.dot(casadi.DM(weights), value)
    whole = casadi.vertcat(*symbols)
    together = casadi.MX.sym("z", whole.shape[0])
    parts = casadi.vertsplit(together, [0, *numpy.cumsum([part.size for part in point])])
    weighted = casadi.Function("weighted", symbols, [weighted])(*parts)
    hessian, gradient = casadi.hessian(weighted, together)
    hessian = casadi.Function("hessian", [together], [hessian])
    gradient = casadi.Function("gradient", [together], [gradient])
    z = numpy.concatenate(point)
    first = numpy.array(gradient(z)).ravel()
    blocks = [casadi.Function("jacobian", symbols, [casadi.jacobian(value, s)]) for s in symbols]
    right = numpy.concatenate([weights @ numpy.array(block(*point)) for block in blocks])
    assert numpy.allclose(first, right, rtol=1e-11, atol=1e-11 * numpy.abs(right).max())
    exact = numpy.array(hessian(z))
    assert numpy.allclose(exact, exact.T, rtol=1e-9, atol=1e-12 * numpy.abs(exact).max())
    assert numpy.abs(exact).max() > 0
    for column in range(z.size):
        step = 1e-5 * (abs(z[column]) or 1.0)
        ends = []
        for sign in (1, -1):
            moved = z.copy()
            moved[column] += sign * step
            ends.append(numpy.array(gradient(moved)).ravel())
        difference = (ends[0] - ends[1]) / (2 * step)
        # Each row is scaled by its gradient, because entries have different units.
        rest = 1e-10 * numpy.abs(first) / step + 1e-6 * numpy.abs(exact[:, column]) + 1e-12
        assert (numpy.abs(difference - exact[:, column]) <= rest).all(), (
            column,
            difference,
            exact[:, column],
        )
