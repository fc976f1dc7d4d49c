"""Tests that Python functions give the same results as the commands."""

import json
import subprocess

import numpy as np
import pytest

import eomgen

from conftest import STAGE

CHAIN = """
[model]
name = "chain"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k = { value = 8, unit = "N/m" }
c = { value = "0.1*sqrt(k*m)", unit = "kg/s" }
tau = { value = 50, unit = "ms" }
omega = { value = 2, unit = "rad/s", doc = "frequency of the drive" }
[coordinates]
x = { unit = "m", initial = 0.1 }
y = { unit = "m" }
[inputs]
u = { unit = "N" }
[states]
z = { unit = "N", rate = "(u - z)/tau" }
[kinetic]
masses = "1/2*m*dot(x)^2 + 1/2*m*(dot(x) + dot(y))^2"
[potential]
springs = "1/2*k*x^2 + 1/2*k*y^2"
[dissipation]
dampers = "1/2*c*dot(x)^2 + 1/2*c*dot(y)^2"
[forces]
drive = { on = "y", value = "z*(2 + cos(omega*t))/3" }
"""


@pytest.fixture(scope="module")
def chain():
    return eomgen.load(CHAIN)


@pytest.fixture
def run(program, tmp_path):
    """Runs the program on a model, whose specification is written to a file. Returns its output."""

    def ran(model, command, *arguments):
        path = tmp_path / "model.toml"
        path.write_text(model.text, encoding="utf-8")
        done = subprocess.run(
            [program, command, str(path), *arguments], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return ran


def test_version_is_that_of_the_program(program):
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    assert said.stdout.split()[-1] == eomgen.__version__


def test_mass_matrix_gives_the_kinetic_energy(chain, arm, states):
    M = chain.mass_matrix(0.0, chain.initial)
    assert np.allclose(M, [[4, 2], [2, 2]])
    x = states(arm, 7)
    many = arm.mass_matrix(0.0, x)
    half = len(arm.states) // 2
    assert many.shape == (7, half, half)
    for row in range(7):
        assert np.array_equal(many[row], arm.mass_matrix(0.0, x[row]))
        moving, resting = x[row].copy(), x[row].copy()
        resting[half:] = 0
        kinetic = arm.energy(0.0, moving) - arm.energy(0.0, resting)
        v = moving[half:]
        assert np.isclose(kinetic, v @ many[row] @ v / 2, rtol=1e-9)


def test_modes_match_the_program_and_the_eigenvalues(chain, run):
    softer = chain.with_parameters(k=5)
    found = softer.modes(x={"x": 0.2})
    document = json.loads(run(softer, "modes", "--state", "x=0.2", "--json"))
    assert document["coordinates"] == list(found[0].names) == ["x", "y", "z"]
    assert len(found) == len(document["modes"]) == 3
    for mode, right in zip(found, document["modes"]):
        assert mode.frequency == right["frequency"] and mode.damping == right["damping"]
        assert mode.eigenvalue == complex(*right["eigenvalue"])
        assert np.array_equal(mode.shape.real, right["shape"])
    own = np.linalg.eigvals(softer.linearise(x={"x": 0.2}).A)
    for mode in found:
        assert np.abs(own - mode.eigenvalue).min() < 1e-9


@pytest.mark.parametrize("format", ["text", "latex", "json"])
def test_derived_equations_are_those_of_the_program(chain, run, format):
    right = run(chain, "derive", "--format", format)
    found = chain.derive(format)
    assert found == (json.loads(right) if format == "json" else right)


def test_certificate_is_that_of_the_program(chain, run, tmp_path):
    certificate = chain.validate(extras=["jacobians"])
    assert certificate.passed and certificate.verdict == "passed"
    path = tmp_path / "certificate.json"
    run(chain, "validate", "--with", "jacobians", "--out", str(path))
    right = json.loads(path.read_text(encoding="utf-8"))
    assert certificate.checks == right["checks"]


@pytest.mark.parametrize(
    "target, extras",
    [("rust", ["jacobians"]), ("c99", []), ("cuda", []), ("casadi", ["hessians"])],
)
def test_generated_files_are_those_of_the_program(chain, run, tmp_path, target, extras):
    with_extras = ["--with", ",".join(extras)] if extras else []
    run(chain, "generate", "--target", target, "--out", str(tmp_path / "program"), *with_extras)
    written = chain.generate(tmp_path / "python", target, extras)
    names = sorted(path.name for path in (tmp_path / "program").iterdir())
    assert sorted(path.name for path in written) == names
    assert sorted(path.name for path in (tmp_path / "python").iterdir()) == names
    for path in written:
        assert path.read_bytes() == (tmp_path / "program" / path.name).read_bytes()


def test_invalid_generation_is_rejected(chain, tmp_path):
    for arguments, said in [
        ({"target": "ada"}, 'expected one of "rust", "c99", "cuda", "casadi"'),
        ({"extras": ["jacobian"]}, "jacobians"),
        ({"target": "fmu2"}, "eomgen generate SPEC --target fmu2"),
        ({"target": "c99", "extras": ["lanes"]}, "lanes"),
    ]:
        with pytest.raises(ValueError, match=said):
            chain.generate(tmp_path / "out", **arguments)
    assert not (tmp_path / "out").exists()
    with pytest.raises(ValueError, match='expected "text", "latex" or "json"'):
        chain.derive("word")


def test_set_parameters_are_emitted(chain, tmp_path):
    (header, *_) = chain.with_parameters(k=5).generate(tmp_path, "c99")
    assert "5.0" in header.read_text(encoding="utf-8")


def test_comparison_is_that_of_the_program(dataset, run, tmp_path):
    stage = eomgen.load(STAGE)
    told = []
    found = stage.compare(dataset, out=tmp_path / "found", progress=told.append)
    right = json.loads(run(stage, "compare", str(dataset), "--out", str(tmp_path / "right"), "--json"))
    assert found.verdict == right["verdict"] and found.gap == right["gap"]
    assert found.where == right["where"] and found.summary == right["summary"]
    written = json.loads((tmp_path / "found" / "comparison.json").read_text(encoding="utf-8"))
    assert written == found.document
    assert (tmp_path / "found" / "report.html").read_text(encoding="utf-8") == found.report
    with pytest.raises(ValueError, match="nothing.toml"):
        stage.compare(tmp_path / "nothing.toml")


def columns_of(path):
    header, *rows = path.read_text(encoding="utf-8").splitlines()
    numbers = np.array([[float(field) for field in row.split(",")] for row in rows])
    return dict(zip(header.split(","), numbers.T))


def test_sweep_is_that_of_the_program(chain, run, tmp_path):
    softer = chain.with_parameters(m=1.5)
    done = []
    s = softer.sweep(
        {"k": (4, 9, 3), "tau": (10, 100, 2, "log")},
        ["max:x", "poincare"],
        periods=4,
        inputs={"u": "0.5*sin(2*t)"},
        state={"x": "0.3", "y_dot": -0.1},
        out=tmp_path / "out",
        progress=done.append,
    )
    options = [
        "--vary", "k=4:9:3", "--vary", "tau=10:100:2:log", "--measure", "max:x,poincare", "--periods", "4",
        "--input", "u=0.5*sin(2*t)", "--state", "x=0.3", "--state", "y_dot=-0.1",
    ]  # fmt: skip
    run(softer, "sweep", *options, "--out", str(tmp_path / "right"))
    right = columns_of(tmp_path / "right" / "sweep.csv")
    assert s.names == tuple(right) and len(s) == 6
    for name in s.names:
        assert np.array_equal(s[name], right[name]), name
    assert s.units["max:x"] == "m" and s.units["tau"] == "ms"
    assert done and done[-1] == 1.0
    with pytest.raises(KeyError, match="did you mean `max:x`"):
        s["max_x"]


def test_sweep_of_one_axis_needs_no_folder(chain):
    s = chain.sweep("k=4:9:3", "final:x", until=2, inputs={"u": 0.0})
    for k, last in zip(s["k"], s["final:x"]):
        r = chain.with_parameters(k=k).simulate(until=2, inputs={"u": 0.0})
        assert abs(r["x"][-1] - last) < 1e-9
    with pytest.warns(UserWarning, match="input `u` is not driven"):
        chain.sweep("k=4:9:3", "final:x", until=2)


@pytest.mark.parametrize(
    "arguments, error, said",
    [
        ({}, TypeError, "either vary or samples"),
        ({"vary": {"k": (1, 2)}}, TypeError, "from, to, count"),
        ({"vary": {"kk": (1, 2, 3)}}, ValueError, "kk"),
        ({"vary": "k=1:2:3", "measure": "mean:x"}, ValueError, "unknown measure"),
        ({"vary": "k=1:2:3", "inputs": {"v": 1}}, ValueError, "inputs:1:1"),
        ({"vary": "k=1:2:3", "state": {"x": "2*kk"}}, ValueError, "state:1:5"),
        ({"vary": "k=1:2:3", "until": -1}, ValueError, "until=-1.0"),
        ({"samples": 10}, ValueError, "uncertainty"),
    ],
)
def test_invalid_sweeps_are_rejected(chain, arguments, error, said):
    arguments = {"measure": "max:x", "until": 1, "inputs": {"u": 0}, **arguments}
    with pytest.raises(error, match=said):
        chain.sweep(**arguments)


def test_ctrl_c_interrupts_a_sweep_that_can_be_resumed(chain, interrupt, tmp_path):
    slow = dict(until=5, inputs={"u": "0.5*sin(2*t)"}, out=tmp_path / "out", threads=1)
    with pytest.raises(KeyboardInterrupt), interrupt(0.5):
        chain.sweep("k=4:9:4000", "max:x", **slow)
    assert (tmp_path / "out").exists()


def test_ctrl_c_interrupts_the_points_of_a_sweep(chain, interrupt, tmp_path):
    # A single point takes minutes.
    slow = dict(until=1e6, inputs={"u": "0.5*sin(2*t)"}, out=tmp_path / "out", threads=2)
    with pytest.raises(KeyboardInterrupt), interrupt(1.0):
        chain.sweep("k=4:9:40", "max:x", **slow)
