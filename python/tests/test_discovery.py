"""Tests of a discovery on a small simulated dataset: results, files, rejected arguments."""

import json
import re
import shutil

import numpy as np
import pytest

import eomgen

from conftest import STAGE


# Friction at the arm's carrier and a dataset of two channels that contains it, for a long search.
HIDDEN = {
    "[parameters]": """[parameters]
level = { value = 0.4, unit = "N m" }
speed = { value = 1e-2, unit = "rad/s" }
""",
    "[forces]": """[forces]
hidden = { on = "theta_c", value = "-level*dot(theta_c)/sqrt(dot(theta_c)^2 + speed^2)" }
""",
}

ARM_DATASET = """
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[inputs.u]
column = "u"
unit = "N m"
[channels.theta_c]
column = "theta_c"
unit = "rad"
noise = 1e-6
[channels.tip]
column = "tip"
unit = "m"
noise = 1e-6
[windows]
length = 0.1
"""


@pytest.fixture(scope="module")
def stage():
    return eomgen.load(STAGE)


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def found(stage, dataset, tmp_path_factory, told):
    out = tmp_path_factory.mktemp("found") / "deep"
    return eomgen.discover(stage, dataset, out=out, progress=told.append), out


def test_hidden_friction_is_discovered(found, told):
    d, _ = found
    assert d.verdict == "effects_found"
    first = d.effects[0]
    assert (first["effect"], first["on"], first["status"]) == ("coulomb_friction", "q", "named")
    (level,) = first["parameters"].values()
    assert level["unit"] == "N" and level["value"] == pytest.approx(12.0, abs=0.2)
    gap = d.gap["q"]
    assert gap["after"]["test"] < 0.1 * gap["before"]["test"]
    assert d.document["validation"]["passed"]
    assert "q" in d.where and any("fitting" in line for line in told)


def test_control_characters_of_names_are_escaped_in_progress(stage, dataset, tmp_path):
    class Heard(Exception):
        pass

    def hear(line):
        lines.append(line)
        raise Heard

    for name in ("train.csv", "test.csv"):
        shutil.copy(dataset.parent / name, tmp_path)
    hostile = '\n[inputs."a\\u202e\\u001b"]\ncolumn = "t"\nunit = "N"\n'
    text = dataset.read_text(encoding="utf-8") + hostile
    (tmp_path / "dataset.toml").write_text(text, encoding="utf-8")
    lines = []
    with pytest.raises(Heard):
        eomgen.discover(stage, tmp_path / "dataset.toml", progress=hear)
    assert lines[0].startswith("note: the model has no input `a\\u{202e}\\u{1b}`"), lines


def test_written_files_match_the_result(found):
    d, out = found
    assert json.loads((out / "discovery.json").read_text(encoding="utf-8")) == d.document
    assert (out / "extended.toml").read_text(encoding="utf-8") == d.extended
    assert (out / "report.html").read_text(encoding="utf-8") == d.report
    assert sorted(path.name for path in out.iterdir()) == [
        "discovery.json",
        "extended.toml",
        "report.html",
    ]
    assert d.experiments == {}
    assert "srcdoc" in d._repr_html_() and "</iframe>" in d._repr_html_()


def test_extended_model_has_the_friction(stage, found):
    d, _ = found
    rates = [m.rates(0.0, [0.0, 0.1], [0.0])[1] for m in (d.model, stage)]
    mass = stage.parameters["M"]
    assert mass * (rates[1] - rates[0]) == pytest.approx(12.0, abs=0.2)


def test_complete_model_has_no_significant_gap(found, dataset):
    d, _ = found
    assert eomgen.discover(d.model, dataset).verdict == "no_significant_gap"


def test_ctrl_c_interrupts_a_discovery(arm, tmp_path, interrupt):
    t = np.arange(2000) * 5e-4
    text = arm.text
    for section, hidden in HIDDEN.items():
        text = text.replace(section, hidden, 1)
    truth = eomgen.load(text)
    for name, turn in [("train", 0.0), ("test", 1.0)]:
        u = 0.5 * np.cos(9 * t + turn) + 0.3 * np.sin(31 * t)
        r = truth.simulate(until=t[-1], interval=5e-4, solver="rk", inputs={"u": u})
        noise = 1e-6 * np.random.default_rng(int(turn)).standard_normal((2, len(t)))
        table = np.column_stack([t, u, r["theta_c"] + noise[0], r["tip"] + noise[1]])
        np.savetxt(
            tmp_path / f"{name}.csv", table, delimiter=",", header="t,u,theta_c,tip", comments=""
        )
    (tmp_path / "dataset.toml").write_text(ARM_DATASET, encoding="utf-8")
    # The interrupts occur during the fit of the null model, the analysis of its residual, screening and fits.
    for after in (0.3, 1.0, 3.0, 8.0):
        with pytest.raises(KeyboardInterrupt), interrupt(after):
            eomgen.discover(arm, tmp_path / "dataset.toml")


def test_progress_callback_may_raise(stage, dataset):
    def refuse(line):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        eomgen.discover(stage, dataset, progress=refuse)


def test_invalid_datasets_are_rejected(stage, dataset, tmp_path):
    with pytest.raises(eomgen.SpecificationError, match="dataset.toml"):
        eomgen.discover(stage, tmp_path / "dataset.toml")
    wrong = dataset.read_text(encoding="utf-8").replace("[channels.q]", "[channels.p]")
    (tmp_path / "dataset.toml").write_text(wrong, encoding="utf-8")
    with pytest.raises(eomgen.SpecificationError) as raised:
        eomgen.discover(stage, tmp_path / "dataset.toml")
    assert "no observable, coordinate or state" in str(raised.value) and "^" in str(raised.value)
    with pytest.raises(ValueError, match="train.csv"):
        (tmp_path / "dataset.toml").write_text(dataset.read_text(encoding="utf-8"))
        eomgen.discover(stage, tmp_path / "dataset.toml")
    with pytest.raises(TypeError, match="expected a model"):
        eomgen.discover("stage.toml", dataset)
    with pytest.raises(ValueError, match="seed"):
        eomgen.discover(stage, dataset, seed=-1)
