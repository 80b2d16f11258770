"""Mechanisms and results on their way to other processes."""

import copy
import multiprocessing
import pickle
import shutil

import numpy as np
import pytest
import redysim
from conftest import MODELS, states
from random_urdf import random_urdf
from test_compile import bits, cache  # noqa: F401
from test_functions import FUNCTIONS, ROBOTS, arguments

SCENARIOS = MODELS.parent / "scenarios"


def passed_on(value):
    return pickle.loads(pickle.dumps(value))


def same(ours, theirs, rng, shape=(), one=None):
    """At states of one robot."""
    assert repr(ours) == repr(theirs) and ours.is_compiled == theirs.is_compiled and ours.path == theirs.path
    for name, names, _ in FUNCTIONS:
        xs = arguments(one or theirs, names, rng, shape)
        assert bits(getattr(ours, name)(*xs)) == bits(getattr(theirs, name)(*xs)), name


@pytest.mark.parametrize("model", ROBOTS)
def test_a_pickled_mechanism_has_the_bits_of_the_original(rng, model):
    robot = redysim.load(MODELS / model)
    same(passed_on(robot), robot, rng)
    same(copy.deepcopy(robot), robot, rng)


def test_a_pickled_urdf_needs_no_file(rng, tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(random_urdf(rng, 5))
    fixed, free = redysim.load(path), redysim.load(path, base="free")
    kept = [pickle.dumps(robot) for robot in (fixed, free)]
    path.unlink()
    for text, robot in zip(kept, (fixed, free)):
        same(pickle.loads(text), robot, rng)


def test_a_pickled_compiled_mechanism_is_compiled_with_its_parameters(cache, rng, tmp_path):  # noqa: F811
    path = tmp_path / "kr5.toml"
    shutil.copy(MODELS / "kr5.toml", path)
    robot = redysim.load(path, parameters=["link6.mass", "gravity"]).compile()
    written = robot.library.stat().st_mtime_ns
    one, several = robot.with_parameters([2.0, 0, 0, -1.6]), robot.with_parameters(np.ones((17, 4)))
    same(passed_on(one), one, rng, (17,))
    same(passed_on(several), several, rng, (17,), one)
    assert passed_on(one).mass == one.mass
    assert passed_on(robot).library == robot.library and robot.library.stat().st_mtime_ns == written
    # It is what the file was when it was loaded, and reports that this has changed.
    path.write_text(path.read_text() + "\n# Changed.\n")
    with pytest.raises(redysim.RedysimError, match="kr5.toml has changed since"):
        passed_on(robot).gravity_forces(np.zeros(6))


def test_a_mechanism_is_an_argument_of_other_processes(rng):
    robot = redysim.load(MODELS / "kr5.toml", parameters=["link6.mass"]).with_parameters([3.0])
    q = states(robot, rng, (4,))[0]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        found = pool.map(robot.gravity_forces, list(q))
    np.testing.assert_array_equal(found, robot.gravity_forces(q))


def test_pickled_results_are_complete(tmp_path):
    results = redysim.scenario(SCENARIOS / "rp.toml").run("forward")
    kept, page = pickle.dumps(results), results.page()
    shutil.rmtree(results.folder)
    again = pickle.loads(kept)
    assert again.run == results.run and again.scenario == results.scenario and again.page() == page
    for name, table in results.tables.items():
        np.testing.assert_array_equal(again.tables[name].values, table.values)
    folder = again.folder
    del again
    assert not folder.exists()


def test_a_pickled_motion_is_complete():
    motion = redysim.load(MODELS / "two_link.toml").simulate(
        np.linspace(0, 1, 11), [0.3, 0.4], events=[lambda t, q, v: q[0]]
    )
    again = passed_on(motion)
    np.testing.assert_array_equal(again.to_pandas(), motion.to_pandas())
    assert again.statistics == motion.statistics and again.page() == motion.page()
    assert [event.t for event in again.events] == [event.t for event in motion.events]
