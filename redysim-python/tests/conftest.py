import os
from pathlib import Path

import numpy as np
import pytest

MODELS = Path(__file__).parents[2] / "models"


def skip(reason):
    """Leaves a test out for want of a tool; where REDYSIM_ALL_TOOLS is set, as by .ci/run, it fails."""
    if "REDYSIM_ALL_TOOLS" in os.environ:
        pytest.fail(f"{reason}, and REDYSIM_ALL_TOOLS is set: install it")
    pytest.skip(reason)


@pytest.fixture
def rng():
    return np.random.default_rng(18)


def states(robot, rng, shape=()):
    """Positions, velocities and accelerations."""
    dv = rng.uniform(-1.0, 1.0, (*shape, robot.nv))
    q0 = np.broadcast_to(robot.neutral(), (*shape, robot.nq))
    v, a = rng.uniform(-1.0, 1.0, (2, *shape, robot.nv))
    return robot.integrate(np.ascontiguousarray(q0), dv), v, a
