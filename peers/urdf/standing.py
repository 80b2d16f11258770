"""Does a humanoid stand? What its tables must be, by the URDF, Pinocchio and the formulas of the laws."""

from dataclasses import dataclass
from math import degrees

import numpy
from humanoid import GRAVITY, Humanoid, Law
from peer import Peer
from tables import Run


@dataclass
class Check:
    """A number that must not be larger than `most`, or not smaller than `least`."""

    what: str
    found: float
    most: float | None = None
    least: float | None = None

    @property
    def holds(self) -> bool:
        # A NaN is neither small nor large.
        return self.found <= self.most if self.least is None else self.found >= self.least

    @property
    def bound(self) -> str:
        return f"at most {self.most:.2g}" if self.least is None else f"at least {self.least:.2g}"


def standing(run: Run, humanoid: Humanoid) -> list[Check]:
    """Whether it stands where it is, and its feet carry it."""
    return [*still(run, humanoid), *carried(run, humanoid)]


def correct(run: Run, humanoid: Humanoid, ground: Law, peer: Peer) -> list[Check]:
    """Whether the run is that of the URDF under the given laws, whatever the robot does."""
    return [*laws(run, humanoid, ground, peer), *dynamics(run, peer)]


def fallen(run: Run) -> list[Check]:
    """Whether it falls."""
    base = run.columns("statevar", "q base.")
    return [
        Check("way of the base, m", way(base), least=0.3),
        Check("tilt of the base, deg", tilt(base), least=30),
    ]


def way(base: numpy.ndarray) -> float:
    """How far the base goes along an axis."""
    return abs(base[:, :3] - base[0, :3]).max()


def tilt(base: numpy.ndarray) -> float:
    """The largest angle between the base's z axis and the vertical, degrees."""
    x, y = base[:, 3], base[:, 4]
    return numpy.degrees(numpy.arccos(numpy.clip(1 - 2 * (x**2 + y**2), -1, 1))).max()


def still(run: Run, humanoid: Humanoid) -> list[Check]:
    """Base and joints stay where they are."""
    base = run.columns("statevar", "q base.")
    joints = humanoid.driven_joints()
    angles = numpy.hstack([run.columns("statevar", f"q {name} ") for name in joints])
    posture = numpy.array([humanoid.posture.get(name, 0.0) for name in joints])
    speeds = run.columns("statevar", "v ")[-1]
    return [
        Check("way of the base, m", way(base), 0.005),
        Check("tilt of the base, deg", tilt(base), 1.5),
        Check("angle of a joint from the posture, deg", degrees(abs(angles - posture).max()), 2.0),
        Check("speed at the end, rad/s or m/s", abs(speeds).max(), 1e-3),
    ]


def carried(run: Run, humanoid: Humanoid) -> list[Check]:
    """The feet carry the weight of the URDF."""
    normals, touching = run.columns("contacts", "normal "), run.columns("contacts", "touching ")
    weight = humanoid.mass * GRAVITY
    sums = [run.columns("contacts", f"force_{axis} ")[-1].sum() for axis in "xyz"]
    share = normals[-1] / normals[-1].mean()
    return [
        Check("rows with an open contact", (touching != 1).any(axis=1).sum(), 0),
        Check("smallest normal force at the end, as a share of their mean", share.min(), least=0.1),
        Check("their sum less the weight, as a share of the weight", abs(normals[-1].sum() / weight - 1), 1e-5),
        Check("sum of the forces along the ground, as a share of the weight", max(map(abs, sums[:2])) / weight, 1e-4),
    ]


def laws(run: Run, humanoid: Humanoid, ground: Law, peer: Peer) -> list[Check]:
    """Forces of the ground and of the joints are those of the formulas, at places that Pinocchio finds."""
    q, v = run.columns("statevar", "q "), run.columns("statevar", "v ")
    forces = numpy.stack([run.columns("contacts", f"force_{axis} ") for axis in "xyz"], axis=2)
    sunk = run.columns("contacts", "penetration ")
    apart, wrong = 0.0, 0.0
    for row in range(len(q)):
        points, speeds = peer.frame_points(q[row], v[row])
        apart = max(apart, abs(-points[:, 2] - sunk[row]).max())
        for point, speed, force in zip(points, speeds, forces[row]):
            normal = ground.normal(-point[2], -speed[2])
            expected = [*ground.friction_force(normal, speed[:2]), normal]
            wrong = max(wrong, abs(force - expected).max())
    weight = humanoid.mass * GRAVITY
    return [
        Check("penetrations beside Pinocchio's, m", apart, 1e-10),
        Check("forces of the ground beside the law, as a share of the weight", wrong / weight, 1e-7),
        Check("forces of the joints beside the law, N m", driven(run, humanoid), 1e-9),
    ]


def driven(run: Run, humanoid: Humanoid) -> float:
    """How far the forces of the joints are from those of springs and dampers within the limits."""
    limits, worst = humanoid.limits(), 0.0
    for name in humanoid.driven_joints():
        stiffness, damping = humanoid.gains(name)
        q, v = (run.columns("statevar", f"{symbol} {name} ")[:, 0] for symbol in "qv")
        tau = run.columns("tor", f"tau {name} ")[:, 0]
        expected = stiffness * (humanoid.posture.get(name, 0.0) - q) - damping * v
        worst = max(worst, abs(tau - numpy.clip(expected, -limits[name], limits[name])).max())
    return worst


def dynamics(run: Run, peer: Peer) -> list[Check]:
    """Accelerations are those that Pinocchio finds under the same forces, and the energy is accounted for."""
    q, v, tau = run.columns("statevar", "q "), run.columns("statevar", "v "), run.columns("tor", "tau ")
    recorded = run.columns("traj", "a ")
    forces = numpy.stack([run.columns("contacts", f"force_{axis} ") for axis in "xyz"], axis=2)
    wrenches = numpy.concatenate([forces, numpy.zeros_like(forces)], axis=2)
    found = numpy.array([peer.accelerations(*row) for row in zip(q, v, tau, wrenches)])
    # What gravity alone would make, m/s² or rad/s², bounds how small accelerations are to be compared.
    size = max(abs(found).max(), GRAVITY)
    energy = numpy.array([peer.energy(*row) for row in zip(q, v)])
    mechanical = (run.columns("energy", "kinetic ") + run.columns("energy", "potential "))[:, 0]
    parts = ["kinetic ", "potential ", "work ", "ground ", "ground_loss "]
    exchanged = max(numpy.ptp(run.columns("energy", part)) for part in parts)
    drift = abs(run.columns("energy", "drift ")).max()
    return [
        Check("accelerations beside Pinocchio's, as a share of the largest", abs(found - recorded).max() / size, 1e-9),
        Check("kinetic and potential energy beside Pinocchio's, J", numpy.ptp(mechanical - energy), 1e-9),
        Check("drift of the energy, as a share of what is exchanged", drift / exchanged, 1e-4),
    ]
