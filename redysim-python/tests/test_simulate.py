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
SETTINGS = [
    *({"integrator": name, "rtol": 1e-9, "atol": 1e-12} for name in ADAPTIVE),
    *({"integrator": name, "step": 1e-3} for name in [*FIXED, "SemiImplicitEuler"]),
]
every_integrator = pytest.mark.parametrize("settings", SETTINGS, ids=lambda settings: settings["integrator"])

# Of a pendulum of 1 m that swings by 1 rad: its largest speed and acceleration, rad/s and rad/s².
SPEED, ACCELERATION = np.sqrt(2 * 9.81 * (1 - np.cos(1.0))), 9.81 * np.sin(1.0)


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


def half_a_step(settings):
    """By how much time SemiImplicitEuler is wrong, s, and the other methods are not: it has the steps of Störmer and Verlet,
    whose error is of second order, with speeds half a step from their positions."""
    return 0.5 * settings["step"] if settings["integrator"] == "SemiImplicitEuler" else 0.0


@every_integrator
def test_every_integrator_swings_a_pendulum(pendulum, settings):
    # At q = 90 deg it hangs down.
    motion = pendulum.simulate(np.linspace(0, 1, 11), [np.pi / 2 + 1.0], **settings)
    angle, speed = reference(1.0, 1.0)
    late = half_a_step(settings)
    np.testing.assert_allclose(motion.q[-1], [np.pi / 2 + angle], rtol=0, atol=2e-8 + late * SPEED)
    np.testing.assert_allclose(motion.v[-1], [speed], rtol=0, atol=5e-8 + late * ACCELERATION)
    np.testing.assert_array_equal(motion.t, np.linspace(0, 1, 11))
    assert motion.statistics["steps"] > 0
    assert np.abs(motion.tables["energy"]["drift"]).max() < 1e-6 + late * SPEED * ACCELERATION


def test_the_error_of_semi_implicit_euler_is_of_first_order(pendulum):
    settings = {"integrator": "SemiImplicitEuler"}
    ends = [pendulum.simulate([0, 1], [np.pi / 2 + 1.0], step=step, **settings).q[-1, 0] for step in (1e-3, 5e-4)]
    wide, narrow = np.array(ends) - np.pi / 2 - reference(1.0, 1.0)[0]
    assert wide / narrow == pytest.approx(2, rel=1e-3), "the next order is some 1e-3 of the first"


def period(amplitude):
    """Of a pendulum of 1 m, s, by the arithmetic-geometric mean."""
    a, b = 1.0, np.cos(amplitude / 2)
    for _ in range(6):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return 2 * np.pi / np.sqrt(9.81) / a


@every_integrator
def test_every_integrator_finds_events(pendulum, settings):
    def lowest(t, q, v):
        return q[0] - np.pi / 2

    def falling(t, q, v):
        return q[0] - np.pi / 2

    def third(t, q, v):
        return t - 1.5

    falling.direction = -1
    third.terminal = True
    motion = pendulum.simulate(np.linspace(0, 5, 51), [np.pi / 2 + 1.0], events=[lowest, falling, third], **settings)
    expected = period(1.0) * np.array([0.25, 0.25])
    found = [event for event in motion.events if event.index != 2]
    assert sorted(event.index for event in found) == [0, 1], "it rises through the lowest point after 1.6 s"
    np.testing.assert_allclose([event.t for event in found], expected, rtol=0, atol=5e-8 + 1.01 * half_a_step(settings))
    # The position of an event is that of its time.
    np.testing.assert_allclose([event.q[0] for event in found], np.pi / 2, rtol=0, atol=1e-12)
    assert motion.events[-1].index == 2 and motion.t[-1] == motion.events[-1].t == pytest.approx(1.5, abs=1e-12)
    lowest.terminal = True
    motion = pendulum.simulate(np.linspace(0, 5, 51), [np.pi / 2 + 1.0], events=lowest, **settings)
    assert len(motion.events) == 1 and motion.t[-1] == motion.events[0].t < motion.t[-2] + 0.1
    assert motion.q[-1] == pytest.approx(np.pi / 2, abs=1e-12)
    late = half_a_step(settings)
    assert motion.v[-1] == pytest.approx(-SPEED, abs=5e-8 + late * ACCELERATION)


def test_directions_of_events_count(pendulum):
    def lowest(t, q, v):
        return q[0] - np.pi / 2

    crossings = {}
    for direction in (-1, 0, 1):
        lowest.direction = direction
        motion = pendulum.simulate([0, 5], [np.pi / 2 + 1.0], events=[lowest], rtol=1e-9, atol=1e-12)
        crossings[direction] = [event.t for event in motion.events]
    every = period(1.0) * (np.arange(5) / 2 + 0.25)
    for direction, times in {-1: every[::2], 0: every, 1: every[1::2]}.items():
        np.testing.assert_allclose(crossings[direction], times, rtol=0, atol=5e-8)


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


def test_no_step_passes_over_a_push_between_stops(pendulum):
    """It hangs at rest, and 1 N m for a millisecond gives it the speed that impulse and inertia determine."""
    push = (5.0, 5.001)
    settings = dict(torque=lambda t, q, v: [float(push[0] <= t <= push[1])], stops=push[::-1])
    speed = (push[1] - push[0]) / pendulum.mass_matrix([0.0])[0, 0]
    for integrator in ["Ode45", "Dop853", "Ode15s", "Radau5"]:
        motion = pendulum.simulate([0, 5, 5.001, 10], [np.pi / 2], integrator=integrator, **settings)
        np.testing.assert_allclose(motion.v[1], 0, atol=1e-8)
        np.testing.assert_allclose(motion.v[2], speed, rtol=1e-4, err_msg=integrator)


def test_loops_stay_closed():
    robot = redysim.load(MODELS / "fourbar.toml")
    motion = robot.simulate(np.linspace(0, 1, 51), [0.6, 0.0, 0.0], integrator="Dop853", rtol=1e-9)
    assert np.abs(robot.loop_residual(motion.q)).max() < 1e-10
    assert np.abs(np.einsum("kij,kj->ki", robot.loop_jacobian(motion.q), motion.v)).max() < 1e-9
    assert np.abs(motion.tables["energy"]["drift"]).max() < 1e-6 and np.ptp(motion.q) > 0.1


def test_events_of_closed_loops_are_found():
    robot = redysim.load(MODELS / "fourbar.toml")

    def passing(t, q, v):
        return q[0] - 0.3

    def rest(t, q, v):
        return v[0]

    settings = {"integrator": "Dop853", "rtol": 1e-9, "atol": 1e-12}
    motion = robot.simulate(np.linspace(0, 1, 51), [0.6, 0.0, 0.0], events=[passing, rest], **settings)
    # From rest to rest and back, the same way.
    down, turn, up, end = [event.t for event in motion.events[:4]]
    assert [event.index for event in motion.events[:4]] == [0, 1, 0, 1]
    np.testing.assert_allclose([end, down + up], 2 * turn, rtol=0, atol=1e-8)
    start = robot.energy(motion.q[0], motion.v[0])
    for event in motion.events:
        value = event.q[0] - 0.3 if event.index == 0 else event.v[0]
        assert abs(value) < 1e-9
        assert np.abs(robot.loop_residual(event.q)).max() < 1e-10
        assert np.abs(robot.loop_jacobian(event.q) @ event.v).max() < 1e-9
        energy = robot.energy(event.q, event.v)
        # Of some 2 J that are exchanged.
        assert energy.kinetic + energy.potential == pytest.approx(start.kinetic + start.potential, abs=1e-6)
    passing.terminal = True
    motion = robot.simulate(np.linspace(0, 1, 51), [0.6, 0.0, 0.0], events=passing, **settings)
    assert motion.t[-1] == motion.events[0].t == pytest.approx(down, abs=1e-9)
    assert motion.q[-1, 0] == pytest.approx(0.3, abs=1e-9)


def test_multipliers_are_those_of_the_scenario_s_run():
    results = redysim.scenario(MODELS.parent / "scenarios/fourbar.toml").run("forward")
    robot = redysim.load(MODELS / "fourbar.toml")
    motion = robot.simulate(results.t, [0.0, 0.9844, 4.3144], rtol=1e-4, atol=1e-6)
    ours, theirs = motion.tables["lambda"], results.tables["lambda"]
    assert ours.headers == theirs.headers == ["lambda crank-coupler 1 [N]", "lambda crank-coupler 2 [N]"]
    np.testing.assert_array_equal(motion.multipliers, results.multipliers)
    assert motion.multipliers.shape == (len(motion.t), robot.nc) and np.abs(motion.multipliers).max() > 100


@pytest.mark.parametrize(("model", "q"), [
    ("fourbar.toml", [0.0, 0.9844, 4.3144]),
    ("three_rrr.toml", None),
    ("test/bricard.toml", None),
])
@pytest.mark.filterwarnings("ignore::redysim.ModelWarning")
def test_multipliers_are_what_motion_and_joint_forces_leave(model, q, rng):
    robot = redysim.load(MODELS / model)
    torque = rng.normal(size=robot.nv) * np.array(robot.actuated)
    motion = robot.simulate(np.linspace(0, 0.1, 11), q, torque=torque)
    inertial = np.einsum("kij,kj->ki", robot.mass_matrix(motion.q), motion.a)
    forces = inertial + robot.bias_forces(motion.q, motion.v) - motion.tau
    of_loops = np.einsum("kij,ki->kj", robot.loop_jacobian(motion.q), motion.multipliers)
    np.testing.assert_allclose(of_loops, forces, rtol=0, atol=1e-9 * np.abs(inertial).max())
    headers = [f"lambda {name} [{unit}]" for name, unit in zip(robot.loop_row_names, robot.loop_force_units)]
    assert motion.tables["lambda"].headers == headers and len(headers) == robot.nc
    assert motion.plot("lambda").axes and "Lagrange multipliers" in motion.page()


def test_rows_of_loops_have_the_names_and_units_of_a_scenario_s_run(tmp_path):
    # Of this loop two rows align directions; their multipliers are moments.
    scenario = tmp_path / "bricard.toml"
    scenario.write_text(f"model = '{MODELS / 'test/bricard.toml'}'\n[forward]\nend = 0.01\nstep = 0.01\n")
    with pytest.warns(redysim.ModelWarning, match="redundant-constraints"):
        robot, results = redysim.load(MODELS / "test/bricard.toml"), redysim.scenario(scenario).run()
    columns = [("lambda", *row) for row in zip(robot.loop_row_names, robot.loop_force_units)]
    assert columns == results.tables["lambda"].columns
    assert robot.loop_force_units.count("N m") == 2
    tree = redysim.load(MODELS / "kr5.toml")
    motion = tree.simulate([0, 0.1])
    assert tree.loop_row_names == tree.loop_force_units == [] and motion.multipliers.shape == (2, 0)
    assert "lambda" not in motion.tables and "Lagrange multipliers" not in motion.page()


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
    "stops for steps of one size": (dict(integrator="Ode4", step=0.1, stops=[0.5]), ValueError, "which no `stops` change"),
    "a stop that is not a time": (dict(stops=[np.nan]), ValueError, "`stops` must be finite times"),
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
