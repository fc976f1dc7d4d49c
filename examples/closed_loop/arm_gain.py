"""Regulator of the planetary arm for samples of 1 ms and a delay of one period, from `eomgen linearise --discrete`.

    eomgen linearise SPEC --state x_sp=1e-3 --state x_pr=1e-3 --discrete 0.001 --out arm.json
    python3 examples/closed_loop/arm_gain.py arm.json

The torque of the previous sample is an additional state. Prints the gain K of u = -K x, which minimises the sum of (x/1 mm)^2,
(rate/1 m/s)^2 and (u/1 N m)^2 over all samples, by the doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin,
C.-S. Wang, Int. J. Control 77 (2004) 767-788).
"""

import json
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("arm_gain.py: numpy is missing. Install it: pip install numpy")

with open(sys.argv[1], encoding="utf-8") as file:
    document = json.load(file)
scales = np.array([1e-3 if unit == "m" else 1.0 for unit in document["units"]["states"]])
A = np.array(document["A_d"]) * scales / scales[:, None]
B = np.array(document["B_d"]) / scales[:, None]
states = len(A)
A = np.block([[A, B], [np.zeros((1, states + 1))]])
B = np.eye(states + 1)[:, -1:]
P = np.diag([1.0] * states + [0.0])
flow, moved, one = A, B @ B.T, np.eye(states + 1)
for _ in range(40):
    inverse = np.linalg.inv(one + moved @ P)
    P = P + flow.T @ P @ inverse @ flow
    moved = moved + flow @ inverse @ moved @ flow.T
    flow = flow @ inverse @ flow
K = (B.T @ P @ A)[0] / (1.0 + (B.T @ P @ B)[0, 0]) / np.append(scales, 1.0)
for name, value in zip([*document["states"], "u"], K):
    print(f"k_{name:9} {value:.5g}")
