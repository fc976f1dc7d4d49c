"""Tests that all cells of the notebook run and that their assertions hold."""

import pytest

from conftest import PROJECT


def test_notebook_runs(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(PROJECT / "python" / "examples" / "walk.ipynb", as_version=4)
    client = nbclient.NotebookClient(
        notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}
    )
    client.execute()
    shown = [
        output for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output
    ]
    assert any("<math>" in output["data"].get("text/html", "") for output in shown)
    assert sum("image/png" in output["data"] for output in shown) == 4
