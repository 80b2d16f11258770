"""Runs of scenario files, and what they leave."""

import csv
import os
import signal
import threading
import time

import matplotlib
import numpy as np
import pandas
import pytest
import redysim
from conftest import MODELS

matplotlib.use("Agg")
SCENARIOS = MODELS.parent / "scenarios"


@pytest.fixture(scope="module")
def fall():
    return redysim.scenario(SCENARIOS / "rp.toml").run("forward")


def test_a_run_has_the_tables_that_its_folder_has(tmp_path):
    results = redysim.scenario(SCENARIOS / "fourbar.toml").run("forward", folder=tmp_path / "fourbar")
    for name, table in results.tables.items():
        rows = list(csv.reader((tmp_path / "fourbar" / f"{name}.csv").read_text().splitlines()))
        assert rows[0] == ["t [s]", *table.headers]
        values = np.array(rows[1:], dtype=float)
        np.testing.assert_array_equal(values[:, 0], table.t)
        np.testing.assert_array_equal(values[:, 1:], table.values)
    again = redysim.results(tmp_path / "fourbar")
    assert again.run == results.run and again.scenario == results.scenario
    np.testing.assert_array_equal(again.q, results.q)


def test_accelerations_of_a_run_are_those_of_forward_dynamics(fall):
    robot = redysim.load(MODELS / "rp.toml")
    np.testing.assert_allclose(robot.forward_dynamics(fall.q, fall.v, fall.tau), fall.a, atol=1e-9)
    assert fall.run["ended"] == "complete" and len(fall.t) == fall.run["instants"]


def test_a_run_with_contacts_has_their_forces():
    results = redysim.scenario(SCENARIOS / "hexapod.toml").run("forward")
    assert results.run["touch_downs"] is not None
    forces = results.tables["contacts"]
    assert forces.values.shape[0] == len(results.t) and np.abs(forces.values).max() > 0


def test_results_become_a_data_frame(fall):
    frame = fall.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t [s]"
    np.testing.assert_array_equal(frame["kinetic [J]"], fall.tables["energy"]["kinetic"])
    assert [name for name in frame.columns if name.startswith("q ")] == fall.tables["traj"].headers[:2]


def test_results_are_plotted(fall):
    figure = fall.plot()
    lines = [line for axis in figure.axes for line in axis.lines]
    assert len(lines) == 2 + 2 + 2 + 3
    np.testing.assert_array_equal(lines[0].get_ydata(), fall.q[:, 0])
    assert figure.axes[-1].get_xlabel() == "t [s]"
    assert len(fall.plot("q").axes) == 2, "an angle and a length have axes of their own"
    with pytest.raises(KeyError, match="'torque' is not in these results, which have q, v, a, tau"):
        fall.plot("torque")


def test_results_are_shown_as_a_page(fall):
    page = fall.page()
    assert page.startswith("<!doctype html>") or page.startswith("<!DOCTYPE html>")
    html = fall._repr_html_()
    assert html.startswith("<iframe srcdoc=") and html.count('"') == 8


def test_a_fault_of_a_scenario_is_shown_as_by_the_command(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(f'model = "{MODELS / "rp.toml"}"\n[forward]\nend = 1\nstop = 0.1\n')
    with pytest.raises(redysim.RedysimError) as error:
        redysim.scenario(path)
    assert f"--> {path}:4:" in str(error.value) and "`forward.stop`" in str(error.value)


def test_results_that_are_there_are_kept(tmp_path):
    scenario = redysim.scenario(SCENARIOS / "rp.toml")
    scenario.run("forward", folder=tmp_path / "rp")
    # The advice names arguments, not the options of the command.
    advice = "is there already\n  = help: write elsewhere with folder=, or overwrite it with force=True"
    with pytest.raises(redysim.RedysimError, match=advice):
        scenario.run("forward", folder=tmp_path / "rp")
    scenario.run("forward", folder=tmp_path / "rp", force=True)


def test_the_run_of_a_scenario_must_be_chosen_where_it_has_both():
    scenario = redysim.scenario(SCENARIOS / "kuka.toml")
    assert scenario.runs == ["inverse", "forward"]
    with pytest.raises(ValueError, match=r'give run\("inverse"\) or run\("forward"\)'):
        scenario.run()
    with pytest.raises(ValueError, match='dynamics must be "inverse" or "forward", not "fwd"|not \'fwd\''):
        scenario.run("fwd")


def test_ctrl_c_ends_a_run(tmp_path):
    path = tmp_path / "long.toml"
    path.write_text(f'model = "{MODELS / "chain_20.toml"}"\n[forward]\nend = 100000.0\nstep = 0.01\n')
    scenario = redysim.scenario(path)
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        scenario.run("forward", folder=tmp_path / "long")
    assert time.monotonic() - start < 20
    # What was computed is kept, and the next run is not interrupted.
    assert redysim.results(tmp_path / "long").run["ended"] == "interrupted"
    assert redysim.scenario(SCENARIOS / "rp.toml").run("forward").run["ended"] == "complete"
