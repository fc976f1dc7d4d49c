"""Imports a unit by CasADi's DaeBuilder and compares its Jacobians with differences.

Argument: the unit.
"""

import sys

import casadi
import numpy

dae = casadi.DaeBuilder("unit", sys.argv[1])
function = dae.create("function", ["x", "u", "p"], ["ode", "y"])


def starts(names):
    return numpy.array([numpy.ravel(dae.start(name))[0] for name in names], dtype=float)


x, u, p = starts(dae.x()), starts(dae.u()) + 0.5, starts(dae.p())
x = x + numpy.array([1e-3 * (1 + i) * (-1) ** i for i in range(x.size)])
point = [x, u, p]
symbols = [casadi.MX.sym(name, part.size) for name, part in zip("xup", point)]
for value in function(*symbols):
    whole = casadi.Function("whole", symbols, [value])
    size = numpy.abs(numpy.array(whole(*point))).max()
    for argument, symbol in enumerate(symbols):
        if point[argument].size == 0:
            continue
        jacobian = casadi.Function("jacobian", symbols, [casadi.jacobian(value, symbol)])
        exact = numpy.array(jacobian(*point))
        for column in range(point[argument].size):
            step = 1e-6 * (abs(point[argument][column]) or 1.0)
            ends = []
            for sign in (1, -1):
                moved = [part.copy() for part in point]
                moved[argument][column] += sign * step
                ends.append(numpy.array(whole(*moved)).ravel())
            difference = (ends[0] - ends[1]) / (2 * step)
            worst = numpy.abs(difference - exact[:, column]).max()
            # Rounding error of a difference of numbers of this magnitude.
            rest = 1e-15 * size / step * 10 + 1e-5 * numpy.abs(exact[:, column]).max()
            assert worst <= rest, (argument, column, worst, rest)
