"""Steps of several models in one process: `steps.py (FOLDER MODULE METHOD)...` prints each last state on one line."""

import importlib
import sys

import numpy as np
from acados.acados_template import AcadosSim, AcadosSimSolver

STEP = 1e-3  # s
STEPS = 100

found = []
for folder, name, method in zip(sys.argv[1::3], sys.argv[2::3], sys.argv[3::3]):
    sys.path.insert(0, folder)
    module = importlib.import_module(name)
    del sys.path[0], sys.modules[name]
    sim = AcadosSim()
    sim.model = module.build_model()
    sim.model.name = folder
    sim.parameter_values = module.default_parameters()
    sim.solver_options.T = STEP
    sim.solver_options.integrator_type = method
    sim.solver_options.num_stages = 4
    sim.solver_options.num_steps = 10 if method == "ERK" else 2
    sim.solver_options.newton_iter = 10
    solver = AcadosSimSolver(sim, json_file=f"{folder}.json")
    state = 0.02 * np.arange(1, len(module.STATES) + 1)
    for _ in range(STEPS):
        solver.set("x", state)
        solver.set("u", np.full(len(module.INPUTS), 0.1))
        assert solver.solve() == 0
        state = solver.get("x")
    found.append(state)
for state in found:
    print("state", *(f"{value:.17g}" for value in state))
