"""Motion of one machine in Python and in functional mock-up units. The argument is a job as JSON; the answers of all
hosts are written as JSON."""

import contextlib
import json
import signal
import sys

# Importer steps in an interval of model exchange: CVode takes 500 internal steps at most in each.
SUBSTEPS = 20

signal.alarm(300)
job = json.load(open(sys.argv[1]))
times, states, tolerance = job["times"], job["states"], job["tolerance"]


def python_motion():
    try:
        import eomgen
    except ImportError:
        return {"missing": "Python: the package eomgen is not installed"}
    import warnings

    warnings.simplefilter("ignore")
    try:
        model = eomgen.load(job["specification"])
        result = model.simulate(
            until=times[-1],
            interval=times[-1] / (len(times) - 1),
            state=dict(zip(states, job["initial"])),
            inputs={one["name"]: one["expression"] for one in job["inputs"]},
            tolerance=tolerance,
        )
        return {"states": [[float(result[name][k]) for name in states] for k in range(len(times))]}
    except (eomgen.SpecificationError, eomgen.SimulationError, ValueError) as error:
        return {"rejected": str(error).splitlines()[0]}


def unit_motions(unit):
    try:
        import fmpy
    except ImportError:
        return [{"missing": "units: FMPy is not installed"}] * 2
    import numpy

    if any(not one["samples"] for one in job["inputs"]):
        return [{"rejected": "the importer supplies the inputs"}] * 2
    description = fmpy.read_model_description(unit)
    start = dict(zip(states, job["initial"]))
    return [co_simulation(fmpy, unit, description, start), exchange(fmpy, numpy, unit, start)]


def co_simulation(fmpy, unit, description, start):
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave

    is_two = description.fmiVersion == "2.0"
    references = {one.name: one.valueReference for one in description.modelVariables}
    slave = (FMU2Slave if is_two else FMU3Slave)(
        guid=description.guid if is_two else description.instantiationToken,
        unzipDirectory=fmpy.extract(unit),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="one",
    )
    put = slave.setReal if is_two else slave.setFloat64
    get = slave.getReal if is_two else slave.getFloat64
    numbers = [references[name] for name in states]

    def drive(sample):
        for one in job["inputs"]:
            put([references[one["name"]]], [one["samples"][sample]])

    slave.instantiate()
    if is_two:
        slave.setupExperiment(startTime=times[0], tolerance=tolerance)
        slave.enterInitializationMode()
    else:
        slave.enterInitializationMode(startTime=times[0], tolerance=tolerance)
    put([references[name] for name in start], list(start.values()))
    drive(0)
    slave.exitInitializationMode()
    rows = [list(get(numbers))]
    try:
        for k in range(len(times) - 1):
            drive(k)
            slave.doStep(
                currentCommunicationPoint=times[k], communicationStepSize=times[k + 1] - times[k]
            )
            rows.append(list(get(numbers)))
    except fmpy.fmi1.FMICallException as error:
        return {"rejected": str(error)}
    finally:
        slave.terminate()
        slave.freeInstance()
    return {"states": rows}


def exchange(fmpy, numpy, unit, start):
    signals = None
    if job["inputs"]:
        names = [one["name"] for one in job["inputs"]]
        rows = []
        for k, t in enumerate(times):
            before = [one["samples"][max(k - 1, 0)] for one in job["inputs"]]
            after = [one["samples"][k] for one in job["inputs"]]
            rows.append((t, *before))
            if after != before:
                rows.append((t, *after))
        signals = numpy.array(rows, dtype=[(name, numpy.float64) for name in ("time", *names)])
    try:
        found = fmpy.simulate_fmu(
            unit,
            fmi_type="ModelExchange",
            stop_time=times[-1],
            output_interval=times[-1] / (len(times) - 1) / SUBSTEPS,
            relative_tolerance=0.01 * tolerance,
            solver="CVode",
            start_values=start,
            input=signals,
            output=states,
            record_events=False,
        )
    except Exception as error:
        return {"rejected": str(error).splitlines()[0]}
    return {"states": [[float(row[name]) for name in states] for row in found[::SUBSTEPS]]}


# FMPy prints its warnings.
with contextlib.redirect_stdout(sys.stderr):
    answers = {"python": python_motion()}
    for target, unit in job["units"].items():
        answers[f"{target}_cs"], answers[f"{target}_me"] = unit_motions(unit)
json.dump(answers, sys.stdout)
