from pathlib import Path

import numpy as np
import pytest

MODELS = Path(__file__).parents[2] / "models"


@pytest.fixture
def rng():
    return np.random.default_rng(18)


def states(robot, rng, shape=()):
    """Positions, velocities and accelerations."""
    dv = rng.uniform(-1.0, 1.0, (*shape, robot.nv))
    q0 = np.broadcast_to(robot.neutral(), (*shape, robot.nq))
    v, a = rng.uniform(-1.0, 1.0, (2, *shape, robot.nv))
    return robot.integrate(np.ascontiguousarray(q0), dv), v, a
