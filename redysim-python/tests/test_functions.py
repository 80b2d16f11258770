"""Functions over arrays: shapes, dtypes, memory, and faults of arguments."""

import re
import threading
import time

import numpy as np
import pytest
import redysim
from conftest import MODELS, states
from redysim import _core

FUNCTIONS = _core.table_of_functions()
ROBOTS = ["kr5.toml", "test/frames.toml", "fourbar.toml", "cart_pole.toml", "kr5_floating.toml"]


@pytest.fixture(params=ROBOTS)
def robot(request):
    return redysim.load(MODELS / request.param)


@pytest.fixture
def kr5():
    return redysim.load(MODELS / "kr5.toml")


def arguments(robot, names, rng, shape=()):
    """Random arguments of the given names."""
    q, v, a = states(robot, rng, shape)
    other = states(robot, rng, shape)[0]
    known = {"q": q, "q0": q, "q1": other, "v": v, "dv": v, "a": a, "tau": a, "u": a}
    known["wrenches"] = rng.normal(size=(*shape, robot.nf, 6))
    return [known[name] for name in names]


@pytest.mark.parametrize(("name", "names"), [row[:2] for row in FUNCTIONS])
def test_many_states_have_the_results_of_each(robot, rng, name, names):
    function = getattr(robot, name)
    xs = arguments(robot, names, rng, (600,))
    together = function(*xs)
    if not names:
        return
    for k in (0, 1, 299, 300, 599):
        alone = function(*(x[k] for x in xs))
        assert together[k].tobytes() == alone.tobytes()
        assert alone.shape == together.shape[1:]


@pytest.mark.parametrize(("name", "names"), [row[:2] for row in FUNCTIONS])
def test_results_are_written_to_out(robot, rng, name, names):
    function = getattr(robot, name)
    for shape in ((), (3,)) if names else ((),):
        xs = arguments(robot, names, rng, shape)
        expected = function(*xs)
        out = np.full_like(expected, np.nan)
        assert function(*xs, out=out) is out
        assert out.tobytes() == expected.tobytes()


def test_an_argument_of_one_state_counts_for_all(kr5, rng):
    q, v, a = states(kr5, rng, (5,))
    expected = [kr5.inverse_dynamics(q[0], v[k], np.zeros(6)) for k in range(5)]
    np.testing.assert_array_equal(kr5.inverse_dynamics(q[0], v, np.zeros(6)), expected)


def test_slices_and_lists_are_read(kr5, rng):
    q, v, a = states(kr5, rng, (8,))
    np.testing.assert_array_equal(kr5.bias_forces(q[::2], v[::-2][::-1]), kr5.bias_forces(q[::2].copy(), v[1::2].copy()))
    np.testing.assert_array_equal(kr5.gravity_forces([0, 1, 2, 3, 4, 5]), kr5.gravity_forces(np.arange(6.0)))
    backwards = np.asfortranarray(q)
    np.testing.assert_array_equal(kr5.mass_matrix(backwards), kr5.mass_matrix(q))


def test_records_have_named_parts(kr5, rng):
    q, v, _ = states(kr5, rng, (4,))
    links = kr5.link_kinematics(q, v)
    assert links.shape == (4, kr5.nl)
    assert links.rotation.shape == (4, kr5.nl, 3, 3)
    np.testing.assert_allclose(links.rotation @ links.rotation.swapaxes(-1, -2), np.tile(np.eye(3), (4, kr5.nl, 1, 1)), atol=1e-14)
    energy = kr5.energy(q, v)
    kinetic = 0.5 * np.einsum("ki,kij,kj->k", v, kr5.mass_matrix(q), v)
    np.testing.assert_allclose(energy.kinetic, kinetic, rtol=1e-12)


def test_frames_agree_with_their_jacobians(rng):
    robot = redysim.load(MODELS / "test/frames.toml")
    q, v, _ = states(robot, rng)
    wrenches = rng.normal(size=(robot.nf, 6))
    frames, jacobians = robot.frame_kinematics(q, v), robot.frame_jacobians(q)
    np.testing.assert_allclose(jacobians.linear @ v, frames.velocity, atol=1e-12)
    np.testing.assert_allclose(jacobians.angular @ v, frames.angular_velocity, atol=1e-12)
    power = (wrenches[:, :3] * frames.velocity + wrenches[:, 3:] * frames.angular_velocity).sum()
    assert robot.frame_forces(q, wrenches) @ v == pytest.approx(power, rel=1e-12)
    step = 1e-6
    ahead, behind = (robot.frame_kinematics(robot.integrate(q, sign * step * v), v) for sign in (1, -1))
    np.testing.assert_allclose(robot.frame_bias(q, v).linear, (ahead.velocity - behind.velocity) / (2 * step), atol=1e-7)


def test_the_loops_jacobian_is_the_derivative_of_their_residual(rng):
    robot = redysim.load(MODELS / "fourbar.toml")
    q, v, _ = states(robot, rng)
    step = 1e-6
    ahead, behind = (robot.loop_residual(robot.integrate(q, sign * step * v)) for sign in (1, -1))
    np.testing.assert_allclose(robot.loop_jacobian(q) @ v, (ahead - behind) / (2 * step), atol=1e-8)
    assert robot.loop_residual(q).shape == (robot.nc,) and robot.nc > 0


def test_hybrid_dynamics_give_what_forward_dynamics_give(rng):
    robot = redysim.load(MODELS / "cart_pole.toml")
    q, v, u = states(robot, rng)
    motion = robot.hybrid_dynamics(q, v, u)
    np.testing.assert_allclose(robot.forward_dynamics(q, v, motion.tau.copy()), motion.a, atol=1e-12)
    actuated = np.array(robot.actuated)
    np.testing.assert_array_equal(motion.a[actuated], u[actuated])
    np.testing.assert_array_equal(motion.tau[~actuated], u[~actuated])


@pytest.mark.parametrize(("is_compiled", "count"), [(False, 200_000), (True, 4_000_000)], ids=["recursions", "compiled"])
def test_other_threads_run_during_a_call(kr5, rng, monkeypatch, tmp_path, is_compiled, count):
    if is_compiled:
        monkeypatch.setenv("REDYSIM_CACHE", str(tmp_path))
        kr5.compile()
    q, v, _ = states(kr5, rng)
    # The call takes at least some 50 ms, of which a thread that runs beside it counts the milliseconds.
    tau = rng.uniform(-1, 1, (count, 6))
    out = np.zeros_like(tau)
    worker = threading.Thread(target=kr5.forward_dynamics, args=(q, v, tau), kwargs={"out": out})
    during = 0
    worker.start()
    while worker.is_alive():
        during += 1
        time.sleep(0.001)
    assert during > 10 and out[-1].any()


FAULTS = {
    "a wrong length": (lambda q: q[:5], ValueError, r"q must have the shape \(6,\) .* or \(k, 6\) .*, not \(5,\)"),
    "too many axes": (lambda q: q[None, None], ValueError, r"q must have the shape .*, not \(1, 1, 6\)"),
    "single precision": (lambda q: q.astype("f4"), TypeError, r"q must be an array of float64, not of float32: convert"),
    "swapped bytes": (lambda q: q.astype(">f8"), TypeError, r"q must be an array of float64, not of >f8"),
    "integers": (lambda q: np.arange(6), TypeError, r"q must be an array of float64, not of int64"),
    "complex numbers": (lambda q: q * 1j, TypeError, r"q must be an array of float64, not of complex128"),
    "text": (lambda q: "q", TypeError, r"q must be an array of float64, not a str"),
    "nothing": (lambda q: None, ValueError, r"q must have the shape"),
    "other numbers of states": (lambda q: np.zeros((3, 6)), ValueError, r"q has 3 states and v has 2"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_an_argument_is_one_clear_error(kr5, fault):
    change, error, message = FAULTS[fault]
    q, v = np.zeros(6), np.zeros((2, 6))
    with pytest.raises(error, match=message):
        kr5.bias_forces(change(q), v)


OUTS = {
    "a list": (lambda out: out.tolist(), TypeError, "out must be a numpy.ndarray for tau, not a list"),
    "single precision": (lambda out: out.astype("f4"), TypeError, "out must have the dtype float64 for tau, not float32"),
    "a wrong shape": (lambda out: out[None], ValueError, r"out must have the shape \(6,\) for tau, not \(1, 6\)"),
    "a slice": (lambda out: np.zeros(12)[::2], ValueError, "out must be contiguous"),
    "constants": (lambda out: np.frombuffer(bytes(48)), ValueError, "out is read-only"),
}


@pytest.mark.parametrize("fault", OUTS)
def test_a_fault_of_out_is_one_clear_error(kr5, fault):
    change, error, message = OUTS[fault]
    with pytest.raises(error, match=message):
        kr5.gravity_forces(np.zeros(6), out=change(np.zeros(6)))


def test_out_must_not_overlap_an_argument(kr5):
    q = np.zeros(6)
    with pytest.raises(ValueError, match="out must not overlap q"):
        kr5.gravity_forces(q, out=q)


UNIT = re.compile(
    r"\b(rad|m|kg m²|kg m|kg|N m s|N s|N m|N|J|W)(/s²|/s|/rad|/m)?(?=[.,;)]| or | and )|\b1/(s²|s|rad|m)|dimensionless"
)


def described(text):
    """What a docstring tells of each argument and of each result, or of each part of it, without the lines on shapes."""
    names = r"\n(?=\w+ : |(?: {4})- `|An argument of one state)"
    sections = text[text.index("Parameters\n---") :].replace("\n\nReturns\n-------", "")
    for entry in re.split(names, sections)[1:]:
        name, _, what = entry.strip().partition("\n" if " : " in entry.split("\n")[0] else ":")
        if "recarray" not in name and not name.startswith(("out", "An argument")):
            yield name, " ".join(what.split())


@pytest.mark.parametrize(("name", "arguments", "record"), FUNCTIONS)
def test_every_function_has_a_docstring_with_shapes_and_units(name, arguments, record):
    text = getattr(redysim.Mechanism, name).__doc__
    assert "Returns\n-------" in text
    for argument in arguments:
        assert f"\n{argument} : float64, (" in text
    assert all(len(line) <= 100 for line in text.splitlines())
    entries = list(described(text))
    # Of a record each part.
    assert len(entries) == len(arguments) + (text.count("\n    - `") if record else 1)
    for entry, what in entries:
        assert UNIT.search(what), f"{entry}: {what}"
