"""Models, what is wrong with them, and what the package says of itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import redysim
from conftest import MODELS, skip
from random_urdf import random_urdf

HERE = Path(__file__).parents[1]


def test_a_model_has_names_and_sizes():
    robot = redysim.load(MODELS / "kr5_floating.toml")
    assert (robot.nq, robot.nv) == (len(robot.coordinate_names), len(robot.velocity_names)) == (13, 12)
    assert len(robot.link_names) == robot.nl and len(robot.joint_names) == 7
    assert robot.actuated == [False] * 6 + [True] * 6
    assert robot.path == MODELS / "kr5_floating.toml"
    assert repr(redysim.load(MODELS / "fourbar.toml")).startswith("<redysim.Mechanism \"fourbar\", nq=3, nv=3, nl=")


@pytest.mark.parametrize("case", sorted((MODELS / "fail").glob("*.toml")), ids=lambda path: path.stem)
def test_the_faults_of_a_model_are_shown_as_by_the_command(case):
    expected = case.with_suffix(".txt").read_text()
    with pytest.raises(redysim.RedysimError) as error:
        redysim.load(case)
    # The command names the file by the path that it is given.
    assert str(error.value).replace(str(case), f"models/fail/{case.name}").strip() == expected.strip()


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(redysim.RedysimError, match=r"no_robot.toml.*\n.*help"):
        redysim.load(tmp_path / "no_robot.toml")


def test_warnings_of_a_model_are_warnings():
    case = sorted((MODELS / "warn").glob("*.toml"))[0]
    with pytest.warns(redysim.ModelWarning, match=r"warning\[.*\]: "):
        robot = redysim.load(case)
    assert robot.warnings


def test_the_root_of_a_urdf_may_float(tmp_path, rng):
    path = tmp_path / "robot.urdf"
    path.write_text(random_urdf(rng, 3, kinds=("revolute", "prismatic")))
    assert redysim.load(path).nv == 3
    assert redysim.load(path, base="free").nv == 9
    with pytest.raises(ValueError, match='base must be "fixed" or "free", not "loose"'):
        redysim.load(path, base="loose")
    with pytest.raises(redysim.RedysimError, match="not a URDF"):
        redysim.load(MODELS / "kr5.toml", base="free")


@pytest.fixture(scope="module")
def command():
    """The command `redysim`, which .ci/python builds."""
    found = os.environ.get("REDYSIM_COMMAND") or shutil.which("redysim")
    return found or skip("the command `redysim` is neither in REDYSIM_COMMAND nor in PATH")


FAULTS_OF_URDF = {
    "it ends early": ("</robot>", ""),
    "a parent that is not there": ('parent link="link0"', 'parent link="nothing"'),
    "a link with two parents": ('child link="link2"', 'child link="link1"'),
    "an unknown kind of joint": ('type="revolute"', 'type="revolving"'),
    "an invalid number": ('<axis xyz="', '<axis xyz="upward '),
}


@pytest.mark.parametrize("fault", FAULTS_OF_URDF)
def test_the_fault_of_a_urdf_is_shown_as_by_the_command(tmp_path, rng, command, fault):
    path = tmp_path / "robot.urdf"
    path.write_text(random_urdf(rng, 3).replace(*FAULTS_OF_URDF[fault]))
    with pytest.raises(redysim.RedysimError) as error:
        redysim.load(path)
    run = subprocess.run([command, "import", path, "--quiet"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 1 and run.stderr.strip() == str(error.value).strip()
    assert str(error.value).count("error: ") == 1 and "robot.urdf:" in str(error.value)


def test_the_stubs_are_those_of_the_package():
    sys.path.insert(0, str(HERE))
    try:
        from stubs import TARGET, stubs
    finally:
        sys.path.pop(0)
    assert TARGET.read_text(encoding="utf-8") == stubs(), "run redysim-python/stubs.py"


SETTINGS = str(HERE / "pyproject.toml")


@pytest.mark.parametrize("check", [
    ["mypy.stubtest", "redysim._core"],
    ["mypy", "--package", "redysim", "--config-file", SETTINGS],
], ids=["stubs", "types"])
def test_the_package_is_as_it_is_typed(tmp_path, check):
    # In a folder of its own, where the cache of mypy is.
    command = [sys.executable, "-m", *check]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_version_is_that_of_redysim():
    manifest = (HERE.parent / "Cargo.toml").read_text(encoding="utf-8")
    assert f'version = "{redysim.__version__}"' in manifest
