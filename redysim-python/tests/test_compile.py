"""Compiled functions: their values, and what can go wrong."""

import os
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest
import redysim
from conftest import MODELS
from test_functions import FUNCTIONS, ROBOTS, arguments


@pytest.fixture(autouse=True, scope="module")
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("REDYSIM_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(params=ROBOTS, scope="module")
def pair(request, cache):
    return redysim.load(MODELS / request.param), redysim.load(MODELS / request.param).compile()


def numbers(result):
    """All numbers of arrays or records, one after another."""
    return np.ascontiguousarray(result).view(np.float64)


@pytest.mark.parametrize(("name", "names"), [row[:2] for row in FUNCTIONS])
def test_compiled_functions_have_the_values_of_the_others(pair, rng, name, names):
    plain, compiled = pair
    for shape in ((), (700,)) if names else ((),):
        xs = arguments(plain, names, rng, shape)
        ours, theirs = getattr(compiled, name)(*xs), getattr(plain, name)(*xs)
        assert ours.dtype == theirs.dtype and ours.shape == theirs.shape
        if theirs.size:
            # Both lose a few digits, which the factorisation of a mass matrix multiplies.
            scale = max(1.0, np.abs(numbers(theirs)).max())
            np.testing.assert_allclose(numbers(ours), numbers(theirs), rtol=0, atol=1e-10 * scale)


def bits(result):
    """The bytes of all numbers, with one that stands for all that are not numbers."""
    return np.nan_to_num(numbers(result), nan=1e300).tobytes()


@pytest.mark.parametrize(("model", "compiler"), [
    *((model, "cc") for model in [*ROBOTS, "chain_20.toml", "hexapod.toml", "kr5_drives.toml"]),
    *((model, "clang") for model in ["kr5.toml", "hexapod.toml"]),
])
def test_states_in_lanes_have_the_bits_of_each_alone(cache, rng, model, compiler):
    if shutil.which(compiler) is None:
        pytest.skip(f"{compiler} is not installed")
    robot = redysim.load(MODELS / model).compile(compiler=compiler)
    for name, names, _ in FUNCTIONS:
        xs = arguments(robot, names, rng, (21,))
        if not names:
            continue
        # Large angles, angles near a multiple of pi/2, and NaN, each in one lane.
        q = xs[0].copy()
        q[1], q[2, 0], q[11, 0], q[12, -1] = 1e6 * q[1], 1e22, np.pi / 2 * 12345678, np.nan
        xs = [q, *xs[1:]]
        function = getattr(robot, name)
        alone = [function(*(x[k] for x in xs)) for k in range(21)]
        for first, last in ((0, 21), (3, 6), (1, 17), (5, 13)):
            together = function(*(x[first:last] for x in xs))
            for k in range(first, last):
                assert bits(together[k - first]) == bits(alone[k]), f"{name}, state {k}"
        # One state for all of the others.
        if len(xs) > 1:
            shared = function(xs[0], *(x[0] for x in xs[1:]))
            assert bits(shared[9]) == bits(function(xs[0][9], *(x[0] for x in xs[1:])))


def test_the_compiled_library_is_kept(cache):
    first, second = (redysim.load(MODELS / "gripper.toml") for _ in range(2))
    first.compile()
    written = first.library.stat().st_mtime_ns
    assert second.compile().library == first.library
    assert second.library.stat().st_mtime_ns == written
    assert second.is_compiled and second.compile() is second
    assert redysim.load(MODELS / "rp.toml").compile().library != first.library


def test_the_times_of_the_documentation_are_measured_for_every_row(cache):
    command = [sys.executable, str(MODELS.parent / "redysim-python/benches/compiled.py"), "1"]
    table = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    document = (MODELS.parent / "docs/python.md").read_text()
    names = [line.split(" | ")[0] for line in table if not line.startswith("|---")]
    assert len(names) == 8
    for name in names:
        assert f"\n{name} | " in document, name


def test_a_missing_compiler_is_named():
    with pytest.raises(redysim.RedysimError, match=r"the C compiler `no-such-cc` cannot be run: .*\n.*apt install gcc"):
        redysim.load(MODELS / "kr5.toml").compile(compiler="no-such-cc")


def test_a_compiler_that_fails_is_reported(tmp_path):
    compiler = tmp_path / "cc"
    compiler.write_text('#!/bin/sh\n[ "$1" = --version ] && exit 0\necho "file.c:1: error: no" >&2\nexit 1\n')
    compiler.chmod(0o755)
    with pytest.raises(redysim.RedysimError, match="fails .*: file.c:1: error: no"):
        redysim.load(MODELS / "kr5.toml").compile(compiler=str(compiler))


def test_a_file_that_has_changed_is_reported(tmp_path):
    path = tmp_path / "kr5.toml"
    shutil.copy(MODELS / "kr5.toml", path)
    robot = redysim.load(path).compile()
    robot.check_unchanged()
    path.write_text(path.read_text() + "\n# Heavier.\n")
    for use in (robot.check_unchanged, robot.compile):
        with pytest.raises(redysim.RedysimError, match=r"kr5.toml has changed since it was loaded\n.*load it again"):
            use()


def test_a_call_reports_that_the_file_has_changed_since_it_was_compiled(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "kr5.toml"
    text = (MODELS / "kr5.toml").read_text()
    path.write_text(text)
    plain, robot = redysim.load("kr5.toml"), redysim.load("kr5.toml").compile()
    one, many = np.zeros(6), np.zeros((20, 6))
    robot.gravity_forces(one)
    path.write_text(text.replace("mass = ", "mass = 1"))
    monkeypatch.chdir("/")
    for q in (one, many, one):
        # A look at the file counts for 0.1 ms.
        time.sleep(0.001)
        with pytest.raises(redysim.RedysimError, match=r"kr5.toml has changed since .* compiled\n.*redysim.load\("):
            robot.gravity_forces(q)
    np.testing.assert_allclose(plain.gravity_forces(one), plain.gravity_forces(many)[0])
    # What counts is what is in the file.
    path.write_text(text)
    time.sleep(0.001)
    robot.gravity_forces(one)
    os.utime(path, (1, 1))
    time.sleep(0.001)
    robot.gravity_forces(many)
    path.unlink()
    time.sleep(0.001)
    robot.gravity_forces(one)
    with pytest.raises(redysim.RedysimError, match="kr5.toml cannot be read any more: No such file"):
        robot.check_unchanged()


def test_a_folder_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path / "file" / "cache"))
    with pytest.raises(redysim.RedysimError, match="cannot be written to .*file/cache"):
        redysim.load(MODELS / "kr5.toml").compile()
