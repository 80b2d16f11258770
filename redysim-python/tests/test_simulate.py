"""Motion under joint forces and events that are functions of Python."""

import os
import signal
import threading

import numpy as np
import pytest
import redysim
from conftest import MODELS

ADAPTIVE = ["Ode45", "Dop853", "Ode15s", "Radau5"]
FIXED = ["Ode4", "Ode5", "Dop8", "Gauss4", "Gauss6"]


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory):
    """A point mass of 1 kg at 1 m, about the y axis: q̈ = 9.81 cos(q) from the horizontal."""
    path = tmp_path_factory.mktemp("pendulum") / "pendulum.toml"
    path.write_text("""name = "pendulum"
gravity = [0, 0, -9.81]
[[link]]
name = "rod"
parent = "base"
joint = "revolute"
axis = [0, 1, 0]
mass = 1.0
com = [1.0, 0, 0]
""")
    return redysim.load(path)


def reference(q, t):
    """The swing from the angle q from the downward vertical, by Runge-Kutta steps of 1e-4 s."""
    state, steps = np.array([q, 0.0]), round(t / 1e-4)
    rate = lambda y: np.array([y[1], -9.81 * np.sin(y[0])])  # noqa: E731
    for _ in range(steps):
        k1 = rate(state)
        k2 = rate(state + 0.5e-4 * k1)
        k3 = rate(state + 0.5e-4 * k2)
        state = state + 1e-4 / 6 * (k1 + 2 * k2 + 2 * k3 + rate(state + 1e-4 * k3))
    return state


@pytest.mark.parametrize("settings", [
    *({"integrator": name, "rtol": 1e-9, "atol": 1e-12} for name in ADAPTIVE),
    *({"integrator": name, "step": 1e-3} for name in FIXED),
], ids=lambda settings: settings["integrator"])
def test_every_integrator_swings_a_pendulum(pendulum, settings):
    # At q = 90 deg it hangs down.
    motion = pendulum.simulate(np.linspace(0, 1, 11), [np.pi / 2 + 1.0], **settings)
    angle, speed = reference(1.0, 1.0)
    np.testing.assert_allclose(motion.q[-1], [np.pi / 2 + angle], atol=2e-8)
    np.testing.assert_allclose(motion.v[-1], [speed], atol=5e-8)
    np.testing.assert_array_equal(motion.t, np.linspace(0, 1, 11))
    assert motion.statistics["steps"] > 0
    assert np.abs(motion.tables["energy"]["drift"]).max() < 1e-6


def test_events_are_found_and_end_the_motion(pendulum):
    def lowest(t, q, v):
        return q[0] - np.pi / 2

    lowest.direction = -1
    motion = pendulum.simulate([0, 10], [np.pi / 2 + 0.01], events=[lowest], rtol=1e-10)
    # Small swings take 2 pi sqrt(l/g).
    period = 2 * np.pi * np.sqrt(1 / 9.81)
    np.testing.assert_allclose([event.t for event in motion.events], period * (np.arange(5) + 0.25), rtol=1e-4)
    lowest.terminal = True
    motion = pendulum.simulate(np.linspace(0, 10, 101), [np.pi / 2 + 0.01], events=lowest, rtol=1e-10)
    assert len(motion.events) == 1 and motion.t[-1] == motion.events[0].t == pytest.approx(period / 4, rel=1e-4)
    assert motion.q[-1] == pytest.approx(np.pi / 2, abs=1e-9)


def test_a_control_law_is_a_function():
    robot = redysim.load(MODELS / "kr5.toml")
    target = np.full(6, 0.4)

    def law(t, q, v):
        return robot.inverse_dynamics(q, v, 25 * (target - q) - 10 * v)

    motion = robot.simulate(np.linspace(0, 8, 81), torque=law)
    np.testing.assert_allclose(motion.q[-1], target, atol=1e-3)
    np.testing.assert_allclose(motion.tau[3], law(0.3, motion.q[3], motion.v[3]))
    np.testing.assert_allclose(robot.forward_dynamics(motion.q, motion.v, motion.tau), motion.a, atol=1e-9)
    assert motion.to_pandas().shape == (81, 6 * 4 + 5)
    assert "<iframe" in motion._repr_html_()


def test_loops_stay_closed():
    robot = redysim.load(MODELS / "fourbar.toml")
    motion = robot.simulate(np.linspace(0, 1, 51), [0.6, 0.0, 0.0], integrator="Dop853", rtol=1e-9)
    assert np.abs(robot.loop_residual(motion.q)).max() < 1e-10
    assert np.abs(np.einsum("kij,kj->ki", robot.loop_jacobian(motion.q), motion.v)).max() < 1e-9
    assert np.abs(motion.tables["energy"]["drift"]).max() < 1e-6 and np.ptp(motion.q) > 0.1


def test_what_a_function_raises_is_raised(pendulum):
    def law(t, q, v):
        raise ArithmeticError("no torque")

    with pytest.raises(ArithmeticError, match="no torque"):
        pendulum.simulate([0, 1], torque=law)
    with pytest.raises(ValueError, match=r"tau must have the shape \(1,\)"):
        pendulum.simulate([0, 1], torque=lambda t, q, v: np.zeros(2))
    with pytest.raises(TypeError, match="an event must return a number"):
        pendulum.simulate([0, 1], events=[lambda t, q, v: "low"])


FAULTS = {
    "an unknown integrator": (dict(integrator="RK4"), ValueError, "integrator must be one of .*Ode45.*, not \"RK4\""),
    "no step": (dict(integrator="Ode4"), ValueError, "Ode4 takes steps of one size: give `step`"),
    "a step for tolerances": (dict(step=0.1), ValueError, "Ode45 chooses its steps: give `max_step`"),
    "a wrong start": (dict(q=[0.0, 0.0]), ValueError, r"q must have the shape \(1,\)"),
    "a NaN at the start": (dict(q=[np.nan]), redysim.RedysimError, "not a number|NaN|finite"),
    "times that go back": (dict(t=[0, 2, 1]), ValueError, "t must be finite, and no instant before"),
    "no times": (dict(t=[]), ValueError, "t must have the instants"),
    "negative tolerance": (dict(rtol=-1.0), redysim.RedysimError, "rtol|tolerance"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_a_simulation_is_one_clear_error(pendulum, fault):
    change, error, message = FAULTS[fault]
    with pytest.raises(error, match=message):
        pendulum.simulate(**{"t": [0, 1], **change})


def test_ctrl_c_ends_a_simulation(pendulum):
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        pendulum.simulate([0, 1e6], [0.0], max_step=1e-3)
