"""Linear-quadratic regulator for the planetary arm from its linearisation, tested on the arm with play.

    eomgen linearise model-spec/models/planetary_arm_rig.toml --state x_sp=1e-3 --state x_pr=1e-3 --out contact.json
    eomgen generate model-spec/models/planetary_arm_rig.toml --target c99 --out arm
    cc -shared -fPIC -std=c99 -O2 -I arm examples/controllers/closed_loop.c arm/planetary_arm_rig.c -o arm.so
    python examples/controllers/lqr.py contact.json arm.so

With both meshes in contact, the torque moves every state. At rest, without `--state`, the meshes are open and the
torque moves only the sun; the program then rejects the linearisation.
"""

import ctypes
import json
import sys

try:
    import numpy as np
    from scipy.integrate import simpson
    from scipy.linalg import matrix_balance, solve_continuous_are
except ImportError as error:
    print(f"lqr.py: {error.name} is missing. Install it: pip install numpy scipy", file=sys.stderr)
    sys.exit(2)

LARGE = {"m": 1e-3, "m/s": 1.0}  # same cost as 1 N m of torque, by unit of the state
STEP, DURATION = 20e-6, 2.0  # s
PLAY = 25e-6  # m, half the backlash


def reached(A, B):
    """Returns an orthonormal basis of the controllable subspace, the Krylov space of (A, B).

    Powers of A would lose small directions, so each new direction is orthogonalised against the previous ones
    (staircase algorithm of P. Van Dooren, IEEE Trans. Autom. Control 26, 1981).
    """
    size = np.linalg.norm(A, 2)
    basis = np.empty((len(A), 0))
    new = B / np.maximum(np.linalg.norm(B, axis=0), np.finfo(float).tiny)
    while new.size:
        for _ in range(2):
            new = new - basis @ (basis.T @ new)
        left, lengths, _ = np.linalg.svd(new, full_matrices=False)
        left = left[:, lengths > 1e-12 * (size if basis.size else 1.0)]
        basis = np.hstack([basis, left])
        new = A @ left
    return basis


def gain(document):
    """Returns the gain K of u = -K x, the matrix P of the cost x P x, and the scales of the states.

    Exits with an error if the input cannot control all states.
    """
    A, B = np.array(document["A"]), np.array(document["B"])
    _, (scale, _) = matrix_balance(A, permute=False, separate=True)
    basis = reached(A / scale[:, None] * scale, B / scale[:, None])
    print(f"controllability: rank {basis.shape[1]} of {len(A)}", flush=True)
    if basis.shape[1] < len(A):
        out = np.linalg.norm(basis, axis=1) < 1e-9
        out = ", ".join(name for name, alone in zip(document["states"], out) if alone) or "the rest"
        sys.exit(
            f"error: the torque does not move {out}: no gain controls them\n"
            "help: linearise with both meshes in contact: --state x_sp=1e-3 --state x_pr=1e-3"
        )
    large = np.array([LARGE[unit] for unit in document["units"]["states"]])
    A, B = A / large[:, None] * large, B / large[:, None]
    P = solve_continuous_are(A, B, np.eye(len(A)), np.eye(1))
    left = A.T @ P + P @ A - P @ B @ B.T @ P + np.eye(len(A))
    K = B.T @ P
    slowest = np.linalg.eigvals(A - B @ K).real.max()
    assert np.linalg.norm(left) < 1e-9 * np.linalg.norm(A.T @ P) and slowest < 0
    print(f"slowest pole with the regulator: {slowest:.2f} 1/s")
    return K[0] / large, P / np.outer(large, large), large


def motion(library, play, K, begin):
    """Simulates the arm with its contacts. Returns a row of states for each step."""
    states = np.zeros((round(DURATION / STEP) + 1, len(K)))
    states[0] = begin
    pointer = ctypes.POINTER(ctypes.c_double)
    K = np.ascontiguousarray(K)
    arguments = ctypes.c_double(play), K.ctypes.data_as(pointer), ctypes.c_double(STEP), len(states) - 1
    assert library.closed_loop(*arguments, states.ctypes.data_as(pointer)) == 1
    return states


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        document = json.load(file)
    K, P, large = gain(document)
    library = ctypes.CDLL(sys.argv[2] if "/" in sys.argv[2] else "./" + sys.argv[2])
    begin = np.zeros(len(K))
    begin[document["states"].index("x_c")] = 2e-3
    for play in [0.0, PLAY]:
        states = motion(library, play, K, begin)
        rates = ((states / large) ** 2).sum(axis=1) + (states @ K) ** 2
        cost = simpson(rates, dx=STEP) / (begin @ P @ begin)
        late = states[round(0.75 * len(states)) :, 2]
        print(f"play of {2e6 * play:.0f} um: cost {cost:.3f} times that of the Riccati equation")
        print(f"    the carrier within {1e6 * abs(late).max():.2f} um after {0.75 * DURATION} s")
        # Without play the arm is linear and the cost equals the prediction. Within the play no force acts on the arm.
        assert abs(cost - 1) < (0.05 if play else 1e-3) and abs(late).max() < (play or 1e-6)


if __name__ == "__main__":
    main()
