"""How far a program of redysim's and Pinocchio are apart at random states."""

import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy
from exact import Errors, errors
from mimics import misread
from peer import Peer
from projected import Unsupported

STATES = 20
TOLERANCE = 1e-11


class Failed(Exception):
    """A robot that should work and does not; the message says what."""


@dataclass
class Comparison:
    """How far redysim and Pinocchio are apart: shares of the scale of each component."""

    joints: list[str]
    # How many other joints mimic these.
    mimics: int
    forces: float
    matrices: float
    accelerations: float
    jacobians: float
    # J̇ v.
    bias: float
    # Centre of mass and momenta, and q ⊞ v with p ⊟ q: of a floating base; else zero.
    whole: float
    positions: float
    # Of the accelerations, where they are farther apart than the tolerance.
    errors: Errors | None

    @property
    def largest(self) -> float:
        """The largest difference; no number if any is none."""
        return float(numpy.max([*self._shares, self.accelerations]))

    @property
    def agrees(self) -> bool:
        """Accelerations that are apart are judged by those in 50 digits."""
        accelerations = self.errors is None or self.errors.agree(TOLERANCE)
        return accelerations and all(share < TOLERANCE for share in self._shares)

    @property
    def _shares(self) -> list[float]:
        """All but accelerations."""
        return [self.forces, self.matrices, self.jacobians, self.bias, self.whole, self.positions]


def compared(command: list[str | Path], urdf: Path, model: Path) -> Comparison:
    """Computes at random states by this command, which has this model, and by Pinocchio."""
    names, _ = answers(command, [])
    imported = tomllib.loads(model.read_text())
    if wrong := misread(urdf, imported):
        raise Failed(f"the joint {wrong[0]} does not mimic as in the URDF")
    peer = Peer(urdf, names, imported)
    n, nq = peer.nv, sum(peer.sizes)
    shapes = [(n,), (n, n), (n,), (len(peer.frames), 6, n), (len(peer.frames), 6), (3, 3), (nq,), (n,)]
    random = numpy.random.default_rng(1)
    states = []
    for _ in range(STATES):
        q, v, a = peer.random_position(random), random.uniform(-2, 2, n), random.uniform(-5, 5, n)
        wrenches = (random.uniform(-1, 1, (len(peer.frames), 6)) * peer.wrench_scales()).ravel()
        # Forces that make accelerations of this size: those of light fingers and of a trunk differ by orders.
        states += [(q, v, a, wrenches), (q, v, peer.forces(q, v, a, wrenches), wrenches)]
    others = [peer.random_position(random) for _ in states]
    lines = [numpy.concatenate([q, v, a, other, w]) for (q, v, a, w), other in zip(states, others)]
    _, found = answers(command, lines)
    parts = [_split(line, shapes) for line in found]
    forces, computed, _, jacobians, bias, whole, moved, ways = zip(*parts[::2])
    accelerations = [part[2] for part in parts[1::2]]
    motions, driven = states[::2], states[1::2]
    matrices = [peer.matrix(q) for q, *_ in motions]
    theirs = [peer.accelerations(*state) for state in driven]
    apart = furthest(accelerations, theirs)
    floats = nq != n
    expected = [peer.jacobians(q) for q, *_ in motions], [peer.bias(q, v) for q, v, *_ in motions]
    return Comparison(
        joints=names,
        mimics=len(peer.mimics),
        forces=furthest(forces, [peer.forces(*state) for state in motions]),
        matrices=furthest_matrix(computed, matrices),
        accelerations=apart,
        jacobians=furthest(jacobians, expected[0], _by_frame(expected[0])),
        bias=furthest(bias, expected[1], _by_frame(expected[1])),
        whole=_furthest_whole(peer, motions, whole) if floats else 0.0,
        positions=_furthest_positions(peer, motions, others[::2], moved, ways) if floats else 0.0,
        errors=None if apart < TOLERANCE else _errors(urdf, names, imported, driven, accelerations, theirs),
    )


State = tuple[numpy.ndarray, ...]


def _furthest_whole(peer: Peer, motions: list[State], whole: tuple[numpy.ndarray, ...]) -> float:
    """Centre of mass and momenta, each as a share of its length."""
    expected = numpy.array([peer.whole(q, v).reshape(3, 3) for q, v, *_ in motions])
    lengths = numpy.linalg.norm(expected, axis=2, keepdims=True).max(axis=0, keepdims=True)
    return furthest(list(whole), list(expected), numpy.broadcast_to(lengths, expected.shape))


def _furthest_positions(
    peer: Peer,
    motions: list[State],
    others: list[numpy.ndarray],
    moved: tuple[numpy.ndarray, ...],
    ways: tuple[numpy.ndarray, ...],
) -> float:
    """q ⊞ v and p ⊟ q, in m and rad."""
    ones = [numpy.ones(len(q)) for q in moved]
    integrated = [peer.integrated(q, v) for q, v, *_ in motions]
    differences = [peer.difference(q, other) for (q, *_), other in zip(motions, others)]
    by_integrate = furthest([peer.with_signs(q) for q in moved], integrated, numpy.array(ones))
    scales = numpy.array([numpy.ones(len(way)) for way in ways])
    return max(by_integrate, furthest(list(ways), differences, scales))


def _errors(urdf: Path, names: list[str], model: dict, driven: list[State], *found: list[numpy.ndarray]) -> Errors:
    if not all(numpy.isfinite(found).ravel()):
        raise Failed("accelerations are not finite")
    try:
        return errors(urdf, names, model, driven, *found)
    except Unsupported as reason:
        raise Failed(f"accelerations differ, and {reason}") from None


def _split(line: numpy.ndarray, shapes: list[tuple[int, ...]]) -> list[numpy.ndarray]:
    """The parts of a line, which have these shapes one after the other."""
    ends = numpy.cumsum([numpy.prod(shape, dtype=int) for shape in shapes])
    if ends[-1] != len(line):
        raise Failed(f"an answer has {len(line)} numbers instead of {ends[-1]}")
    return [part.reshape(shape) for part, shape in zip(numpy.split(line, ends[:-1]), shapes)]


def _by_frame(quantity: list[numpy.ndarray]) -> numpy.ndarray:
    """The scale of each number: the largest of its frame at any state, in m, s and rad."""
    numbers = numpy.abs(numpy.array(quantity))
    states, frames = numbers.shape[:2]
    largest = numbers.reshape(states, frames, -1).max(axis=(0, 2))
    return numpy.broadcast_to(largest.reshape([1, frames] + [1] * (numbers.ndim - 2)), numbers.shape)


def answers(command: list[str | Path], states: list[numpy.ndarray]) -> tuple[list[str], list[numpy.ndarray]]:
    """Names of the joints that move, and what redysim computes at each state."""
    text = "".join(" ".join(repr(float(x)) for x in state) + "\n" for state in states)
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    if done.returncode != 0:
        sys.stderr.write(done.stderr)
        said = done.stderr.strip().splitlines() or [f"it ends with {done.returncode}"]
        raise Failed(f"{Path(command[0]).name} fails: {said[0]}")
    names, *lines = done.stdout.splitlines()
    return names.split("\t"), [numpy.array([float(word) for word in line.split()]) for line in lines]


def furthest_matrix(ours: list[numpy.ndarray], theirs: list[numpy.ndarray]) -> float:
    """Of mass matrices, as a share of √(M_ii M_jj)."""
    scales = [numpy.sqrt(numpy.outer(numpy.diag(matrix), numpy.diag(matrix))) for matrix in theirs]
    return furthest(ours, theirs, numpy.array(scales))


def furthest(ours: list[numpy.ndarray], theirs: list[numpy.ndarray], scales: numpy.ndarray | None = None) -> float:
    """The largest difference of a component, as a share of its scale: by default its largest value at any state."""
    ours, theirs = numpy.array(ours), numpy.array(theirs)
    scales = numpy.max(numpy.abs(theirs), axis=0) if scales is None else scales
    differences = numpy.abs(ours - theirs)
    # What is no number differs, too.
    with numpy.errstate(divide="ignore", invalid="ignore"):
        shares = numpy.where(differences == 0, 0, differences / scales)
    return float(numpy.max(shares))
