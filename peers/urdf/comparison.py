"""How far a program of redysim's and Pinocchio are apart at random states."""

import subprocess
import sys
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy
from peer import Peer

STATES = 20
TOLERANCE = 1e-10


class Failed(Exception):
    """A robot that should work and does not; the message says what."""


@dataclass
class Comparison:
    """How far redysim and Pinocchio are apart: shares of the scale of each component."""

    joints: list[str]
    forces: float
    matrices: float
    accelerations: float
    # How far the forces that redysim's accelerations take, by Pinocchio, are from those that made them.
    taken: float
    # Of the mass matrix with a diagonal of ones: so many times its roundoff is in any program's accelerations.
    condition: float

    @property
    def largest(self) -> float:
        """The largest difference; no number if any is none."""
        return float(numpy.max([self.forces, self.matrices, self.accelerations]))

    @property
    def agrees(self) -> bool:
        """Where the mass matrix is nearly singular, accelerations are right that take the right forces."""
        accelerations = self.taken if self.by_forces else self.accelerations
        return all(share < TOLERANCE for share in [self.forces, self.matrices, accelerations])

    @property
    def by_forces(self) -> bool:
        """Whether the accelerations are judged by the forces that they take."""
        return self.accelerations > TOLERANCE and self.condition * numpy.finfo(float).eps > TOLERANCE / 100


def compared(command: list[str | Path], urdf: Path) -> Comparison:
    """Computes at random states by this command and by Pinocchio."""
    names, _ = _answers(command, "")
    peer, n = Peer(urdf, names), len(names)
    random = numpy.random.default_rng(1)
    states = []
    for _ in range(STATES):
        q, v, a = random.uniform(-pi, pi, n), random.uniform(-2, 2, n), random.uniform(-5, 5, n)
        # Forces that make accelerations of this size: those of light fingers and of a trunk differ by orders.
        states += [(q, v, a), (q, v, peer.forces(q, v, a))]
    text = "".join(" ".join(repr(float(x)) for x in numpy.concatenate(state)) + "\n" for state in states)
    _, found = _answers(command, text)
    motions, driven = states[::2], states[1::2]
    matrices = [peer.matrix(q) for q, _, _ in motions]
    scales = [numpy.sqrt(numpy.outer(numpy.diag(matrix), numpy.diag(matrix))) for matrix in matrices]
    accelerations = [line[n + n * n :] for line in found[1::2]]
    taken = [peer.forces(q, v, a) for (q, v, _), a in zip(driven, accelerations)]
    return Comparison(
        joints=names,
        forces=_furthest([line[:n] for line in found[::2]], [peer.forces(*state) for state in motions]),
        matrices=_furthest([line[n : n + n * n].reshape(n, n) for line in found[::2]], matrices, numpy.array(scales)),
        accelerations=_furthest(accelerations, [peer.accelerations(*state) for state in driven]),
        taken=_furthest(taken, [tau for _, _, tau in driven]),
        condition=max(float(numpy.linalg.cond(matrix / scale)) for matrix, scale in zip(matrices, scales)),
    )


def _answers(command: list[str | Path], states: str) -> tuple[list[str], list[numpy.ndarray]]:
    """Names of the joints that move, and what redysim computes at each state."""
    done = subprocess.run(command, input=states, capture_output=True, text=True)
    if done.returncode != 0:
        sys.stderr.write(done.stderr)
        said = done.stderr.strip().splitlines() or [f"it ends with {done.returncode}"]
        raise Failed(f"{Path(command[0]).name} fails: {said[0]}")
    names, *lines = done.stdout.splitlines()
    return names.split("\t"), [numpy.array([float(word) for word in line.split()]) for line in lines]


def _furthest(ours: list[numpy.ndarray], theirs: list[numpy.ndarray], scales: numpy.ndarray | None = None) -> float:
    """The largest difference of a component, as a share of its scale: by default its largest value at any state."""
    ours, theirs = numpy.array(ours), numpy.array(theirs)
    scales = numpy.max(numpy.abs(theirs), axis=0) if scales is None else scales
    differences = numpy.abs(ours - theirs)
    # What is no number differs, too.
    with numpy.errstate(divide="ignore", invalid="ignore"):
        shares = numpy.where(differences == 0, 0, differences / scales)
    return float(numpy.max(shares))
