"""Identification in MuJoCo and discovery on the same records of a linear stage.

    pip install "mujoco[sysid]"
    python3 examples/measured/identify.py

MuJoCo's toolbox `mujoco.sysid` fits the parameters that its user declares: first mass, damping and stiffness, which are
the parameters of a stage without dry friction, then dry friction too. `eomgen discover` gets the model without dry friction.
The table shows the estimates with the half-widths of their 95 % intervals. The RMS residuals are from simulations of
the complete records from rest. Every fit uses first.csv only. The environment variable EOMGEN_PROGRAM may name the program
`eomgen`; otherwise it is searched on the path.

Exit status: 0 if the table was printed, 2 if MuJoCo, its toolbox or `eomgen` is missing.
"""

import contextlib
import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
TRUTH = {"mass": 4.0, "damping": 12.0, "stiffness": 0.0, "friction": 2.5}  # of make.py: kg, N s/m, N/m, N
BOUNDS = {"mass": (0.4, 40), "damping": (0, 100), "stiffness": (0, 100), "friction": (0, 20)}
START = {"mass": 4.0, "damping": 12.0, "stiffness": 1.0, "friction": 1.0}
STEP = 5e-4  # s, of MuJoCo's integrator; the records have samples every 5 ms
NORMAL_95 = 1.96  # half-width of a 95 % interval in standard deviations

# Dry friction is a soft constraint in MuJoCo. `solref` contains its time constant in s and its damping ratio.
STAGE = """
<mujoco model="stage">
  <option timestep="{step}" integrator="implicitfast" gravity="0 0 0"/>
  <worldbody>
    <body name="carriage">
      <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>
      <joint name="x" type="slide" axis="1 0 0" damping="{damping}" stiffness="{stiffness}"
             frictionloss="{friction}" solreffriction="{time_constant} 1"/>
    </body>
  </worldbody>
  <actuator><motor name="force" joint="x"/></actuator>
  <sensor><jointpos name="position" joint="x"/></sensor>
</mujoco>
"""
DEFAULT_TIME_CONSTANT, SHORT_TIME_CONSTANT = 0.02, 0.001  # s


def fail(message):
    """Prints the message and exits with status 2."""
    print(f"identify.py: {message}", file=sys.stderr)
    sys.exit(2)


try:
    import mujoco
    import numpy as np
    from mujoco import sysid

    import absl.logging

    sysid.optimize  # the toolbox imports nothing, without an error, if a package that it needs is missing
except (ImportError, AttributeError) as error:
    fail(f'MuJoCo with its toolbox sysid is missing ({error}). Install it: pip install "mujoco[sysid]"')

program = shutil.which(os.environ.get("EOMGEN_PROGRAM") or "eomgen")
if program is None:
    fail("the program eomgen is missing. Install it (cargo install --path cli) or name it in EOMGEN_PROGRAM")


def read_record(name):
    """Returns the columns of a record: time in s, force in N, position in m."""
    lines = (FOLDER / name).read_text(encoding="utf-8").replace(",", ".").splitlines()[4:]
    t, force, position = np.array([[float(cell) for cell in line.split(";")] for line in lines]).T
    return t, force, 1e-3 * position


def rms(values):
    """Returns the root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


RECORDS = {name: read_record(name) for name in ("first.csv", "second.csv")}


def build(parameters, time_constant):
    """Returns MuJoCo's model of the stage. Effects of parameters that are not given are absent."""
    values = {"mass": TRUTH["mass"], "damping": 0.0, "stiffness": 0.0, "friction": 0.0} | parameters
    return mujoco.MjSpec.from_string(STAGE.format(step=STEP, time_constant=time_constant, **values))


def residual_function(name, time_constant):
    """Returns the residual function of the toolbox for a record that starts from rest."""
    t, force, position = RECORDS[name]
    spec = build({}, time_constant)
    model = spec.compile()
    times = STEP * np.arange(round(t[-1] / STEP) + 1)
    held = force[np.searchsorted(t, times + 0.5 * STEP, side="right") - 1]  # each force until the next sample
    sequence = sysid.ModelSequences(
        "stage",
        spec,
        name,
        sysid.create_initial_state(model, np.zeros(1), np.zeros(1)),
        sysid.TimeSeries(times, held[:, None]),
        sysid.TimeSeries.from_names(t, position[:, None], model),
    )

    def rebuild(parameters, _):
        return build({key: value.value[0] for key, value in parameters.items()}, time_constant).compile()

    return sysid.build_residual_fn(models_sequences=[sequence], build_model=rebuild)


def identify(names, time_constant):
    """Fits the named parameters to first.csv; returns estimates, half-widths and RMS residuals (m)."""
    parameters = sysid.ParameterDict()
    for name in names:
        low, high = BOUNDS[name]
        parameters.add(sysid.Parameter(name, nominal=START[name], min_value=low, max_value=high))
    residuals = residual_function("first.csv", time_constant)
    with contextlib.redirect_stdout(io.StringIO()):  # a line for each iteration
        found, result = sysid.optimize(parameters, residuals, verbose=False)
    left, _, _ = residuals(result.x, found)
    _, intervals = sysid.calculate_intervals([part.ravel() for part in left], result.jac)
    estimates = {name: (float(found[name].value[0]), float(half)) for name, half in zip(names, intervals)}
    remaining = []
    for record in RECORDS:
        _, predicted, measured = residual_function(record, time_constant)(result.x, found)
        remaining.append(rms(predicted[0][0].data - measured[0][0].data))
    return estimates, remaining


def discover():
    """Runs `eomgen discover`; returns estimates, half-widths and RMS residuals (m) like `identify`."""
    dataset = FOLDER / "dataset.toml"
    with tempfile.TemporaryDirectory() as out:
        command = [program, "discover", FOLDER / "stage.toml", dataset, "--out", out]
        subprocess.run(command, check=True, capture_output=True)
        document = json.loads((pathlib.Path(out) / "discovery.json").read_text(encoding="utf-8"))
        numbers = {"damping": document["refitted"]["c"]}
        for effect in document["effects"]:
            if effect["effect"] == "coulomb_friction":
                numbers["friction"] = effect["parameters"]["T_c"]
        remaining = []
        for record, name in zip(RECORDS, ("train[0]", "test[0]")):
            motion = pathlib.Path(out) / "motion.csv"
            model = pathlib.Path(out) / "extended.toml"
            command = [program, "simulate", model, "--record", dataset, "--record-name", name, "--out", motion]
            subprocess.run(command, check=True, capture_output=True)
            columns = np.genfromtxt(motion, delimiter=",", names=True)
            remaining.append(rms(columns["x"] - RECORDS[record][2][: len(columns)]))
    estimates = {key: (number["value"], NORMAL_95 * number["sd"]) for key, number in numbers.items()}
    return estimates, remaining


def processor_time():
    """Returns the processor time of this process and of its finished subprocesses in s."""
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def show(title, fit, missing):
    """Runs a fit and prints its row of the table; `missing` is printed for estimates that the fit does not return."""
    start = processor_time()
    estimates, remaining = fit()
    seconds = processor_time() - start
    cells = [
        "{:.3f} ± {:#.2g}".format(*estimates[name]) if name in estimates else missing
        for name in ("mass", "damping", "friction")
    ]
    cells += [f"{1e3 * value:.3f}" for value in remaining] + [f"{seconds:.1f}"]
    print(f"| {title} | " + " | ".join(cells) + " |", flush=True)


absl.logging.set_verbosity(absl.logging.ERROR)
COLUMNS = ["fit", "mass, kg", "damping, N s/m", "dry friction, N"]
COLUMNS += ["RMS first.csv, mm", "RMS second.csv, mm", "processor time, s"]
print("| " + " | ".join(COLUMNS) + " |")
print("| --- " * len(COLUMNS) + "|")
print("| values in make.py | 4 | 12 | 2.5 | 0.020 | 0.020 | |")
VISCOUS = ["mass", "damping", "stiffness"]
DRY = [*VISCOUS, "friction"]
show("MuJoCo, without dry friction", lambda: identify(VISCOUS, DEFAULT_TIME_CONSTANT), "not declared")
show("MuJoCo, dry friction declared", lambda: identify(DRY, DEFAULT_TIME_CONSTANT), "")
show("the same, time constant 1 ms", lambda: identify(DRY, SHORT_TIME_CONSTANT), "")
show("`eomgen discover`", discover, "4, given")
