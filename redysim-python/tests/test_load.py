"""Models, what is wrong with them, and what the package says of itself."""

import subprocess
import sys
from pathlib import Path

import pytest
import redysim
from conftest import MODELS
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
    path.write_text(random_urdf(rng, 3))
    assert redysim.load(path).nv == 3
    assert redysim.load(path, base="free").nv == 9
    with pytest.raises(ValueError, match='base must be "fixed" or "free", not "loose"'):
        redysim.load(path, base="loose")
    with pytest.raises(redysim.RedysimError, match="not a URDF"):
        redysim.load(MODELS / "kr5.toml", base="free")


def test_a_fault_of_a_urdf_has_its_line(tmp_path, rng):
    path = tmp_path / "robot.urdf"
    path.write_text(random_urdf(rng, 3).replace("prismatic", "revolute").replace('parent link="link0"', 'parent link="nothing"'))
    with pytest.raises(redysim.RedysimError, match=r"robot.urdf:\d+: .*nothing"):
        redysim.load(path)


def test_the_stubs_are_those_of_the_package():
    sys.path.insert(0, str(HERE))
    try:
        from stubs import TARGET, stubs
    finally:
        sys.path.pop(0)
    assert TARGET.read_text(encoding="utf-8") == stubs(), "run redysim-python/stubs.py"


def test_the_stubs_have_what_the_package_has(tmp_path):
    # In a folder of its own, where the cache of mypy is.
    command = [sys.executable, "-m", "mypy.stubtest", "redysim._core"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_version_is_that_of_redysim():
    manifest = (HERE.parent / "Cargo.toml").read_text(encoding="utf-8")
    assert f'version = "{redysim.__version__}"' in manifest
