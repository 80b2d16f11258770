"""The programs of the documentation run."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from conftest import skip
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("document", ["docs/python.md", "docs/sweeps.md", "redysim-python/README.md"])
def test_the_programs_of_a_document_run(document, monkeypatch):
    monkeypatch.chdir(ROOT)
    programs = re.findall(r"```python\n(.*?)```", (ROOT / document).read_text(encoding="utf-8"), re.DOTALL)
    assert programs
    exec(compile("\n".join(programs), document, "exec"), {})


def test_the_monte_carlo_example_has_the_spread_that_a_linearisation_predicts(tmp_path):
    example = ROOT / "examples/python/monte_carlo.py"
    call = [sys.executable, example, "--count", "200", "--jobs", "2"]
    places = ["--folder", tmp_path / "rows", "--picture", tmp_path / "torque.svg"]
    run = subprocess.run([*call, *places], capture_output=True, text=True, check=True, timeout=300)
    assert "200 four-bars" in run.stdout and ", 0 failed" in run.stdout
    spreads = re.findall(r"standard deviation ([\d.]+), linearised ([\d.]+)", run.stdout)
    assert len(spreads) == 2
    for found, linearised in spreads:
        # Five standard errors of the standard deviation of 200 draws, and what the linearisation leaves out.
        assert abs(float(found) / float(linearised) - 1) < 5 / 400**0.5 + 0.01
    assert (tmp_path / "torque.svg").read_text().count("<path") > 100, "bars of two histograms"


def test_the_notebook_runs(monkeypatch, tmp_path):
    monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path))
    # The environment of the tests, whatever kernels the user has.
    monkeypatch.setenv("JUPYTER_PREFER_ENV_PATH", "1")
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    folder = ROOT / "redysim-python/notebooks"
    notebook = nbformat.read(folder / "urdf_to_torques.ipynb", as_version=4)
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(folder)}}).execute()
    shown = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    pages = [output for output in shown if "<iframe" in output.get("data", {}).get("text/html", "")]
    pictures = [output for output in shown if "image/png" in output.get("data", {})]
    assert len(pages) == 2 and len(pictures) == 2
    for name, page in zip(("model", "motion"), pages):
        html = f"<!DOCTYPE html><title>A notebook</title>{page['data']['text/html']}"
        (tmp_path / f"{name}.html").write_text(html, encoding="utf-8")
    the_pages_move_in_a_browser(tmp_path)


def the_pages_move_in_a_browser(folder):
    """Drags sliders of the pages, in their frames, in Chromium: what redysim-cli/viewer/check installs."""
    viewer = ROOT / "redysim-cli/viewer"
    has_browser = Path(os.environ.get("CHROMIUM", "/usr/bin/chromium")).exists() and shutil.which("node")
    if not (has_browser and (viewer / "node_modules").exists()):
        skip("node, Chromium and the modules of redysim-cli/viewer are not all there")
    command = ["node", viewer / "notebook.mjs", folder]
    run = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr
