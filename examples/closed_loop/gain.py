"""Linear-quadratic regulator of sampled states, from `eomgen linearise --discrete`.

    eomgen linearise SPEC --state theta=pi --discrete 0.002 --out upright.json
    python3 examples/closed_loop/gain.py upright.json

Prints the gain K of u = -K x. It minimises the sum of (phi/0.5 rad)^2 + (theta/0.1 rad)^2 + (phi_dot/5 rad/s)^2 +
(theta_dot/5 rad/s)^2 + (u/0.2 N m)^2 over all samples, by iteration of the Riccati equation.
"""

import json
import sys

SCALES, LARGEST_TORQUE = [0.5, 0.1, 5.0, 5.0], 0.2


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


with open(sys.argv[1], encoding="utf-8") as file:
    document = json.load(file)
A, B, names = document["A_d"], document["B_d"], document["states"]
count = range(len(A))
cost = [[SCALES[i] ** -2 if i == j else 0.0 for j in count] for i in count]
P, K, change = cost, [0.0] * len(A), 1.0
while change > 1e-12:
    weight = product(transposed(B), product(P, B))[0][0] + LARGEST_TORQUE**-2
    new = [value / weight for value in product(transposed(B), product(P, A))[0]]
    change = max(abs(a - b) for a, b in zip(K, new)) / max(abs(a) for a in new)
    K = new
    closed = [[A[i][j] - B[i][0] * K[j] for j in count] for i in count]
    later = product(transposed(A), product(P, closed))
    P = [[cost[i][j] + later[i][j] for j in count] for i in count]
for name, value in zip(names, K):
    print(f"k_{name:10} {value:8.4f}")
