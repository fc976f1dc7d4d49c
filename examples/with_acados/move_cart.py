"""Least-squares optimal control of a cart with two arms by acados.

    eomgen generate model-spec/models/cart_two_arms.toml --target acados --out cart
    python examples/with_acados/move_cart.py cart

The force moves the cart by one metre. Cart and arms are at rest before and after. The program writes the force to
`force.csv`, with the states at the ends of the intervals, and prints iterations and the time of one solution.
acados and its Python interface must be installed.
"""

import sys

import numpy as np

try:
    from acados_template import AcadosOcp, AcadosOcpSolver
except ImportError:
    from acados.acados_template import AcadosOcp, AcadosOcpSolver

DURATION = 2.0  # s
INTERVALS = 80
DISTANCE = 1.0  # m
FORCE = 12.0  # N, limit of the drive


def build_problem(module):
    """Returns the optimal control problem for the emitted module of the model."""
    ocp = AcadosOcp()
    ocp.model = module.build_model()
    ocp.parameter_values = module.default_parameters()
    states, end = len(module.STATES), np.zeros(len(module.STATES))
    end[module.STATES.index("x")] = DISTANCE
    ocp.dims.N = INTERVALS
    ocp.solver_options.tf = DURATION

    ocp.cost.cost_type = ocp.cost.cost_type_e = "LINEAR_LS"
    ocp.cost.Vx, ocp.cost.Vu = np.zeros((1, states)), np.ones((1, 1))
    ocp.cost.W, ocp.cost.yref = np.ones((1, 1)), np.zeros(1)
    ocp.cost.Vx_e, ocp.cost.W_e, ocp.cost.yref_e = np.zeros((0, states)), np.zeros((0, 0)), np.zeros(0)
    ocp.constraints.x0 = np.zeros(states)
    ocp.constraints.idxbx_e = np.arange(states)
    ocp.constraints.lbx_e = ocp.constraints.ubx_e = end
    ocp.constraints.idxbu = np.array([0])
    ocp.constraints.lbu, ocp.constraints.ubu = np.array([-FORCE]), np.array([FORCE])

    options = ocp.solver_options
    options.integrator_type = "ERK"
    options.sim_method_num_steps = 4
    options.nlp_solver_type = "SQP"
    options.hessian_approx = "GAUSS_NEWTON"
    options.qp_solver = "PARTIAL_CONDENSING_HPIPM"
    return ocp


def main():
    sys.path.insert(0, sys.argv[1])
    import cart_two_arms_acados as module

    solver = AcadosOcpSolver(build_problem(module), json_file="cart.json")
    status = solver.solve()
    assert status == 0, f"acados stopped with status {status}"
    states = np.array([solver.get(k, "x") for k in range(INTERVALS + 1)])
    forces = np.array([solver.get(min(k, INTERVALS - 1), "u") for k in range(INTERVALS + 1)])
    times = np.linspace(0.0, DURATION, INTERVALS + 1)[:, None]
    header = ",".join(["t", *module.INPUTS, *module.STATES])
    np.savetxt("force.csv", np.hstack([times, forces, states]), delimiter=",", header=header, comments="", fmt="%.17g")
    iterations, seconds = (float(np.ravel(solver.get_stats(name))[0]) for name in ("sqp_iter", "time_tot"))
    print(f"largest force: {np.abs(forces).max():.3f} N")
    print(f"{iterations:.0f} iterations, {1e3 * seconds:.2f} ms a solution")


if __name__ == "__main__":
    main()
