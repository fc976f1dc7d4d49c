"""Gains of a linear-quadratic regulator from the matrices of `eomgen linearise --out NAME.npz`.

    python3 gains.py NAME.npz

The gains K of u = -K x minimise the integral of x' Q x + R u^2. The script prints them as options of `simulate`, and the
poles of A - B K. It requires numpy and scipy.
"""

import sys

try:
    import numpy
    from scipy.linalg import solve_continuous_are
except ImportError as error:
    print(f"gains.py: {error.name} is missing. Install it: pip install numpy scipy", file=sys.stderr)
    sys.exit(2)

model = numpy.load(sys.argv[1])
A, B = model["A"], model["B"]
Q = numpy.diag([10.0, 100.0, 1.0, 1.0])  # of x, theta, x_dot, theta_dot
R = numpy.array([[0.1]])

K = numpy.linalg.solve(R, B.T @ solve_continuous_are(A, B, Q, R))[0]
for state, gain in zip(model["states"], K):
    print(f"--set k_{state}={gain:.3f}")
for pole in sorted(numpy.linalg.eigvals(A - B @ K[None, :]), key=abs):
    print(f"pole {pole.real:.3f} {pole.imag:+.3f}i 1/s")
