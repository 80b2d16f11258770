"""Run-time parameters: of one robot, and of a robot for each state."""

import re

import numpy as np
import pytest
import redysim
from conftest import MODELS, states
from test_compile import bits, cache, numbers  # noqa: F401
from test_functions import FUNCTIONS, arguments

NAMES = ["link6.mass", "link6.com", "link6.inertia", "gravity", "joint2.damping", "joint3.stiffness", "joint3.rest"]
FLOATING = ["body.mass", "gravity", "body.damping"]
# A floating robot, with a joint with several degrees of freedom.
TEXT = """name = "floater"
gravity = [0, 0, -9.81]
[[link]]
name = "body"
parent = "base"
joint = "free"
origin = {}
mass = 3.0
com = [0.1, 0, 0]
inertia = { xx = 0.2, yy = 0.3, zz = 0.4 }
[[link]]
name = "arm"
parent = "body"
joint = "revolute"
axis = [0, 1, 0]
mass = 1.0
com = [0.5, 0, 0]
inertia = { xx = 0.01, yy = 0.05, zz = 0.05 }
"""


@pytest.fixture(params=[("kr5", False), ("kr5", True), ("floater", True)], ids=lambda case: f"{case[0]}-{case[1]}", scope="module")
def robot(request, tmp_path_factory, cache):  # noqa: F811
    model, compiled = request.param
    if model == "kr5":
        robot = redysim.load(MODELS / "kr5.toml", parameters=NAMES)
    else:
        path = tmp_path_factory.mktemp("floater") / "floater.toml"
        path.write_text(f"parameters = {FLOATING}\n{TEXT}".replace("'", '"'))
        robot = redysim.load(path)
    return robot.compile() if compiled else robot


def others(robot, rng, count):
    """Parameters of other robots: what is positive stays so, and inertia tensors of bodies too."""
    factors = rng.uniform(0.5, 2.0, (count, 1))
    values = factors * (robot.parameters + 0.3 * np.array([name.endswith("damping") for name in robot.parameter_names]))
    return np.ascontiguousarray(values)


def test_a_robot_with_parameters_is_that_of_a_file_with_these_numbers(robot, rng, tmp_path):
    other = robot.with_parameters(others(robot, rng, 1)[0])
    path = tmp_path / "other.toml"
    path.write_text(other.to_toml())
    expected = redysim.load(path)
    assert other.mass == expected.mass and other.gravity == expected.gravity
    assert other.is_compiled == robot.is_compiled and other.np == len(robot.parameter_names)
    for name, names, _ in FUNCTIONS:
        xs = arguments(robot, names, rng)
        ours, theirs = numbers(getattr(other, name)(*xs)), numbers(getattr(expected, name)(*xs))
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-11 * max(1.0, np.abs(theirs).max(initial=0)), err_msg=name)


def test_numbers_of_a_file_are_those_of_parameters(rng, tmp_path):
    text = (MODELS / "kr5.toml").read_text()
    mass = re.findall(r"^mass = (.*)$", text, re.MULTILINE)[-1]
    path = tmp_path / "kr5.toml"
    path.write_text("0.02".join(text.rsplit(mass, 1)))
    expected = redysim.load(path)
    robot = redysim.load(MODELS / "kr5.toml", parameters=["link6.mass"]).with_parameters([0.02])
    q, v, a = states(robot, rng)
    assert robot.inverse_dynamics(q, v, a).tobytes() == expected.inverse_dynamics(q, v, a).tobytes()
    t = np.linspace(0, 0.1, 5)
    np.testing.assert_array_equal(robot.simulate(t, q, v).q, expected.simulate(t, q, v).q)


def test_a_robot_for_each_state_has_the_bits_of_each_alone(robot, rng):
    values = others(robot, rng, 21)
    robots = robot.with_parameters(values)
    np.testing.assert_array_equal(robots.parameters, values)
    for name, names, _ in FUNCTIONS:
        xs = arguments(robot, names, rng, (21,))
        together = getattr(robots, name)(*xs)
        shared = getattr(robots, name)(*(x[4] for x in xs))
        out = np.empty_like(together)
        assert getattr(robots, name)(*xs, out=out) is out and bits(out) == bits(together)
        for k in (0, 4, 7, 8, 16, 20):
            alone = getattr(robot.with_parameters(values[k]), name)
            assert bits(together[k]) == bits(alone(*(x[k] for x in xs))), name
            assert bits(shared[k]) == bits(alone(*(x[4] for x in xs))), name


def test_parameters_have_names(robot, rng):
    names = robot.parameter_names
    values = robot.parameters
    assert values.shape == (robot.np,) and f"np={robot.np}" in repr(robot)
    masses = np.linspace(1.0, 2.0, 5)
    place = names.index(next(name for name in names if name.endswith(".mass")))
    robots = robot.with_parameters({names[place]: masses}).with_parameters({"gravity.x": 0.5})
    expected = np.tile(values, (5, 1))
    expected[:, place], expected[:, names.index("gravity.x")] = masses, 0.5
    np.testing.assert_array_equal(robots.parameters, expected)
    np.testing.assert_array_equal(robot.parameters, values)


FAULTS = {
    "a wrong length": ([1.0], ValueError, r"parameters must have the shape \(16,\) for one robot of \"kr5\" or \(k, 16\) for k robots"),
    "a negative mass": ({"link6.mass": -1}, ValueError, "parameter `link6.mass` is -1.0: it must not be negative"),
    "one of several": ({"link6.mass": [1.0, -1.0]}, ValueError, "robot 1: parameter `link6.mass` is -1.0"),
    "NaN": ({"gravity.y": np.nan}, ValueError, "parameter `gravity.y` is NaN: give a finite number"),
    "no body's inertia": ({"link6.inertia.xx": 7.0}, ValueError, "the inertia tensor with `link6.inertia.xx` = 7.0 is not that of a body"),
    "an unknown name": ({"link6.mas": 1.0}, KeyError, "link6.mas.* is not a parameter: give link6.mass, link6.com.x"),
    "other numbers of robots": ({"link6.mass": [1.0, 2.0], "gravity.x": [1.0]}, ValueError, "values for 1 robots, others for 2"),
    "a matrix": ({"link6.mass": np.zeros((2, 2))}, ValueError, r"the value must have the shape \(\) for one robot of \"link6.mass\""),
    "text": ("heavy", TypeError, "parameters must be an array of float64, not a str"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_parameters_is_one_clear_error(fault):
    values, error, message = FAULTS[fault]
    robot = redysim.load(MODELS / "kr5.toml", parameters=NAMES)
    with pytest.raises(error, match=message):
        robot.with_parameters(values)


def test_what_several_robots_do_not_have_is_one_clear_error():
    robot = redysim.load(MODELS / "kr5.toml", parameters=["link6.mass"])
    robots = robot.with_parameters(np.ones((3, 1)))
    for use in (lambda: robots.mass, robots.to_toml, robots.page, lambda: robots.simulate([0, 1])):
        with pytest.raises(ValueError, match='"kr5" is 3 robots here: select one'):
            use()
    with pytest.raises(ValueError, match="q has 2 states and parameters has 3"):
        robots.gravity_forces(np.zeros((2, 6)))
    with pytest.raises(ValueError, match='"kr5" has no run-time parameters: name them by redysim.load'):
        redysim.load(MODELS / "kr5.toml").with_parameters([1.0])
    with pytest.raises(redysim.RedysimError, match="(?s)parameter `link7.mass` of an unknown link or joint.*unknown parameter `m`"):
        redysim.load(MODELS / "kr5.toml", parameters=["link7.mass", "m"])
