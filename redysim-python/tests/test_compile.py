"""Compiled functions: their values, and what can go wrong."""

import contextlib
import os
import pickle
import resource
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest
import redysim
from conftest import MODELS, skip
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
        skip(f"{compiler} is not installed")
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


def test_functions_that_are_not_named_are_computed_by_the_run_time_path(cache, tmp_path):
    whole = redysim.load(MODELS / "kr5.toml")
    robot = redysim.load(MODELS / "kr5.toml").compile(functions=["mass_matrix"])
    assert "mass_matrix" in robot.compiled_functions and "energy" not in robot.compiled_functions
    q = np.linspace(0.1, 0.6, 6)
    np.testing.assert_allclose(robot.mass_matrix(q), whole.mass_matrix(q), atol=1e-13)
    assert robot.energy(q, q) == whole.energy(q, q), "the same bits"
    assert robot.compile(functions=["mass_matrix"]) is robot
    for again in (robot, pickle.loads(pickle.dumps(robot))):
        assert again.compiled_functions == robot.compiled_functions
        with pytest.raises(redysim.RedysimError, match="compiled already, without inverse_dynamics"):
            again.compile()
    with pytest.raises(ValueError, match=r'functions: "mass" is not a function of a mechanism; .*mass_matrix'):
        redysim.load(MODELS / "kr5.toml").compile(functions=["mass"])
    # Those of a model file are compiled by default.
    model = tmp_path / "kr5.toml"
    model.write_text('functions = ["energy"]\n' + (MODELS / "kr5.toml").read_text())
    compiled = redysim.load(model).compile().compiled_functions
    assert "energy" in compiled and "mass_matrix" not in compiled


def test_the_compiled_library_is_kept(cache):
    first, second = (redysim.load(MODELS / "gripper.toml") for _ in range(2))
    first.compile()
    written = first.library.stat().st_mtime_ns
    assert second.compile().library == first.library
    assert second.library.stat().st_mtime_ns == written
    assert second.is_compiled and second.compile() is second
    assert redysim.load(MODELS / "rp.toml").compile().library != first.library


BENCH = MODELS.parent / "redysim-python/benches/compiled.py"


def test_the_times_of_the_documentation_are_measured_for_every_row(cache):
    command = [sys.executable, str(BENCH), "1"]
    tables = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    document = (MODELS.parent / "docs/python.md").read_text()
    names = [line.split(" | ")[0] for line in tables if line and not line.startswith("|---")]
    assert len(names) == 8 + 3
    for name in names:
        assert f"\n{name} | " in document, name


def test_a_missing_compiler_is_named():
    with pytest.raises(redysim.RedysimError, match=r"the C compiler `no-such-cc` cannot be run: .*\n.*apt install gcc"):
        redysim.load(MODELS / "kr5.toml").compile(compiler="no-such-cc")


def test_the_variable_cc_may_have_flags_and_may_be_empty(tmp_path, monkeypatch):
    monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path))
    q = np.full(6, 0.3)
    expected = redysim.load(MODELS / "kr5.toml").gravity_forces(q)
    for variable in ["", " cc -g0", "cc -DUNUSED=1 -g0"]:
        monkeypatch.setenv("CC", variable)
        found = redysim.load(MODELS / "kr5.toml").compile().gravity_forces(q)
        np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-13)
    assert len(list(tmp_path.iterdir())) == 3, "flags count in what is kept"


def test_a_library_that_cannot_be_loaded_is_reported_with_its_reason(tmp_path, monkeypatch):
    monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path))
    redysim.load(MODELS / "kr5.toml").compile()
    [library] = tmp_path.iterdir()
    # What is loaded keeps its file; another process reads the new one.
    library.unlink()
    library.write_bytes(b"no library")
    script = f"import redysim; redysim.load({str(MODELS / 'kr5.toml')!r}).compile()"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert "file too short" in run.stderr and "delete it, so that it is compiled again" in run.stderr, run.stderr


def test_a_compiler_that_fails_is_reported(tmp_path):
    compiler = tmp_path / "cc"
    compiler.write_text('#!/bin/sh\n[ "$1" = --version ] && exit 0\necho "file.c:1: error: no" >&2\nexit 1\n')
    compiler.chmod(0o755)
    with pytest.raises(redysim.RedysimError, match="fails .*: file.c:1: error: no"):
        redysim.load(MODELS / "kr5.toml").compile(compiler=str(compiler))


@contextlib.contextmanager
def no_file_larger(size):
    """Refuses what would make a file larger, as a disk that is full does."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


# The header of the gripper has 19 kB, the source 126 kB, and what GCC makes of it as assembly some 800 kB.
@pytest.mark.parametrize(("size", "message"), [
    (1_000, r"compiled functions cannot be written to .*mechanism\.h: File too large"),
    (50_000, r"compiled functions cannot be written to .*mechanism\.c: File too large"),
    (200_000, r"the C compiler `cc` fails \(.*\): .*File too large"),
], ids=["header", "source", "assembly"])
def test_a_full_disk_is_one_error_and_leaves_nothing(tmp_path, monkeypatch, size, message):
    cache, temporary = tmp_path / "cache", tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setenv("REDYSIM_CACHE", str(cache))
    monkeypatch.setenv("TMPDIR", str(temporary))
    robot = redysim.load(MODELS / "gripper.toml")
    with no_file_larger(size), pytest.raises(redysim.RedysimError, match=message) as error:
        robot.compile()
    text = str(error.value)
    assert text.count("error: ") == 1 + text.count("fatal error: ") and "= help: make room" in text
    assert "REDYSIM_CACHE" in text and ("TMPDIR" in text) == ("the C compiler" in text)
    assert list(cache.iterdir()) == list(temporary.iterdir()) == [] and not robot.is_compiled
    robot.compile()
    assert robot.is_compiled and list(cache.iterdir()) == [robot.library]


@pytest.mark.parametrize("reason", ["No space left on device", "File too large", "Disk quota exceeded"])
def test_a_linker_without_room_is_reported_by_its_reason(tmp_path, monkeypatch, reason):
    monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("TMPDIR", "/a/folder/for/temporary/files")
    compiler = tmp_path / "cc"
    # It leaves a part of the library, and the last line has the word "error".
    compiler.write_text(f"""#!/bin/sh
[ "$1" = --version ] && exit 0
while [ $# -gt 1 ]; do [ "$1" = -o ] && echo part > "$2"; shift; done
echo "/usr/bin/ld: final link failed: {reason}" >&2
echo "collect2: error: ld returned 1 exit status" >&2
exit 1
""")
    compiler.chmod(0o755)
    with pytest.raises(redysim.RedysimError, match=f"fails .*: /usr/bin/ld: final link failed: {reason}\n.*help: make room") as error:
        redysim.load(MODELS / "gripper.toml").compile(compiler=str(compiler))
    assert str(tmp_path / "cache") in str(error.value) and "in /a/folder/for/temporary/files" in str(error.value)
    assert list((tmp_path / "cache").iterdir()) == []


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
