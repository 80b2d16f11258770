"""Imports robots, computes at random states by redysim's generic path and by Pinocchio, and prints how far they differ.

Both read the same URDF. Joints that redysim fixes (floating bases, joints that move no mass) are locked at zero in Pinocchio;
joints that mimic others are free in both. The base is fixed in both.
"""

import subprocess
import sys
from dataclasses import dataclass
from math import cos, pi, sin
from pathlib import Path

import numpy
import pinocchio

STATES = 20
TOLERANCE = 1e-10


class Refused(Exception):
    """A robot that cannot be compared; the message says why."""


def example_robots() -> list[Path]:
    """Every URDF of the package example-robot-data."""
    folder = Path(pinocchio.__file__).parents[4] / "share/example-robot-data/robots"
    return sorted(folder.rglob("*.urdf"), key=lambda path: (path.stem.lower(), path))


def imported(programs: Path, urdf: Path, target: Path, options: list[str]) -> list[str]:
    """Makes the model file; what was said about it."""
    command = [programs / "redysim", "import", urdf, "--output", target, "--force", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        errors = [line.replace(str(urdf), urdf.name) for line in done.stderr.splitlines() if line.startswith("error: ")]
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise Refused((errors or [done.stderr])[0].removeprefix("error: ") + more)
    return done.stderr.splitlines()


def evaluated(programs: Path, model: Path, states: str) -> tuple[list[str], list[numpy.ndarray]]:
    """Names of the joints that move, and what redysim computes at each state."""
    command = [programs / "redysim-evaluate", model]
    done = subprocess.run(command, input=states, capture_output=True, text=True, check=True)
    names, *lines = done.stdout.splitlines()
    return names.split("\t"), [numpy.array([float(word) for word in line.split()]) for line in lines]


class Peer:
    """Pinocchio's robot with the joints of the given names, and no others, free."""

    def __init__(self, urdf: Path, joints: list[str]):
        try:
            whole = pinocchio.buildModelFromUrdf(str(urdf))
            locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in joints]
            self.model = pinocchio.buildReducedModel(whole, locked, pinocchio.neutral(whole)) if locked else whole
        except (RuntimeError, ValueError) as error:
            raise Refused(f"Pinocchio does not take it: {str(error).splitlines()[0]}") from error
        self.data = self.model.createData()
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in joints]
        self.order = [joint.idx_v for joint in self.joints]
        if self.model.nv != len(joints):
            raise Refused(f"Pinocchio has {self.model.nv} velocities, redysim {len(joints)}")

    def _position(self, q: numpy.ndarray) -> numpy.ndarray:
        """A continuous joint's coordinates are cosine and sine."""
        position = numpy.zeros(self.model.nq)
        for joint, value in zip(self.joints, q):
            own = [value] if joint.nq == 1 else [cos(value), sin(value)]
            position[joint.idx_q : joint.idx_q + joint.nq] = own
        return position

    def _ordered(self, vector: numpy.ndarray) -> numpy.ndarray:
        ordered = numpy.zeros(self.model.nv)
        ordered[self.order] = vector
        return ordered

    def forces(self, q: numpy.ndarray, v: numpy.ndarray, a: numpy.ndarray) -> numpy.ndarray:
        position, v, a = self._position(q), self._ordered(v), self._ordered(a)
        return pinocchio.rnea(self.model, self.data, position, v, a)[self.order].copy()

    def matrix(self, q: numpy.ndarray) -> numpy.ndarray:
        upper = numpy.triu(pinocchio.crba(self.model, self.data, self._position(q)))
        return (upper + numpy.triu(upper, 1).T)[numpy.ix_(self.order, self.order)]

    def accelerations(self, q: numpy.ndarray, v: numpy.ndarray, tau: numpy.ndarray) -> numpy.ndarray:
        position, v, tau = self._position(q), self._ordered(v), self._ordered(tau)
        return pinocchio.aba(self.model, self.data, position, v, tau)[self.order].copy()


def furthest(ours: list[numpy.ndarray], theirs: list[numpy.ndarray], scales: numpy.ndarray | None = None) -> float:
    """The largest difference of a component, as a share of its scale: by default its largest value at any state."""
    ours, theirs = numpy.array(ours), numpy.array(theirs)
    scales = numpy.max(numpy.abs(theirs), axis=0) if scales is None else scales
    differences = numpy.abs(ours - theirs)
    # What is no number differs, too.
    with numpy.errstate(divide="ignore", invalid="ignore"):
        shares = numpy.where(differences == 0, 0, differences / scales)
    return float(numpy.max(shares))


@dataclass
class Comparison:
    """How far redysim and Pinocchio are apart."""

    joints: int
    forces: float
    matrices: float
    accelerations: float
    # How far the forces that redysim's accelerations take, by Pinocchio, are from those that made them.
    taken: float
    # Of the mass matrix with a diagonal of ones: so many times its roundoff is in any program's accelerations.
    condition: float

    @property
    def agrees(self) -> bool:
        """Where the mass matrix is nearly singular, accelerations are right that take the right forces."""
        accelerations = self.taken if self.accelerations > TOLERANCE and self.ill_conditioned else self.accelerations
        return all(share < TOLERANCE for share in [self.forces, self.matrices, accelerations])

    @property
    def ill_conditioned(self) -> bool:
        return self.condition * numpy.finfo(float).eps > TOLERANCE / 100

    @property
    def remark(self) -> str:
        if not self.agrees:
            return "**differs**"
        if self.accelerations < TOLERANCE:
            return ""
        return f"M has a condition of {self.condition:.0e}; the accelerations take the right forces to {self.taken:.0e}"


def compared(programs: Path, urdf: Path, model: Path) -> Comparison:
    """Computes both at random states."""
    names, _ = evaluated(programs, model, "")
    peer, n = Peer(urdf, names), len(names)
    random = numpy.random.default_rng(1)
    states = []
    for _ in range(STATES):
        q, v, a = random.uniform(-pi, pi, n), random.uniform(-2, 2, n), random.uniform(-5, 5, n)
        # Forces that make accelerations of this size: those of light fingers and of a trunk differ by orders.
        states += [(q, v, a), (q, v, peer.forces(q, v, a))]
    text = "".join(" ".join(repr(float(x)) for x in numpy.concatenate(state)) + "\n" for state in states)
    _, found = evaluated(programs, model, text)
    motions, driven = states[::2], states[1::2]
    matrices = [peer.matrix(q) for q, _, _ in motions]
    scales = [numpy.sqrt(numpy.outer(numpy.diag(matrix), numpy.diag(matrix))) for matrix in matrices]
    accelerations = [line[n + n * n :] for line in found[1::2]]
    taken = [peer.forces(q, v, a) for (q, v, _), a in zip(driven, accelerations)]
    return Comparison(
        joints=n,
        forces=furthest([line[:n] for line in found[::2]], [peer.forces(*state) for state in motions]),
        matrices=furthest([line[n : n + n * n].reshape(n, n) for line in found[::2]], matrices, numpy.array(scales)),
        accelerations=furthest(accelerations, [peer.accelerations(*state) for state in driven]),
        taken=furthest(taken, [tau for _, _, tau in driven]),
        condition=max(float(numpy.linalg.cond(matrix / scale)) for matrix, scale in zip(matrices, scales)),
    )


def row(programs: Path, urdf: Path, folder: Path) -> tuple[str, bool]:
    """A robot's line of the table, and whether it agrees or is refused with a reason."""
    package = urdf.parent.parent.name.removesuffix("_description")
    robot = urdf.stem if package in urdf.stem else f"{package}/{urdf.stem}"
    model = folder / f"{robot.replace('/', '-')}.toml"
    comparisons, remarks = [], []
    for options in [[], ["--fuse-fixed"]]:
        try:
            said = imported(programs, urdf, model, options)
            comparisons.append(compared(programs, urdf, model))
        except Refused as reason:
            comparisons.append(None)
            remarks += [] if remarks else [str(reason)]
    kept, fused = comparisons
    for found in [kept, fused]:
        remarks += [found.remark] if found and found.remark and not remarks else []
    if kept or fused:
        fixed, mimics = (sum(text in line for line in said) for text in ["fixed at zero here", "free here"])
        remarks += [f"joints fixed at zero: {fixed}"] * (fixed > 0) + [f"mimic joints free: {mimics}"] * (mimics > 0)
    shares = [kept.forces, kept.matrices, kept.accelerations] if kept else [None] * 3
    shares += [max(fused.forces, fused.matrices, fused.accelerations)] if fused else [None]
    numbers = " | ".join("" if share is None else f"{share:.0e}" for share in shares)
    joints = (fused or kept).joints if fused or kept else ""
    return f"| {robot} | {joints} | {numbers} | {'; '.join(remarks)} |", all(c.agrees for c in [kept, fused] if c)


def main() -> None:
    built, *files = sys.argv[1:]
    programs, folder = Path(built) / "cargo/release", Path(built) / "models"
    folder.mkdir(parents=True, exist_ok=True)
    print(f"# Imported robots beside Pinocchio {pinocchio.__version__}\n")
    print(f"The largest difference at {STATES} random states; how it is found is in [peers/README.md](../README.md).\n")
    print("| robot | joints | inverse dynamics | mass matrix | forward dynamics | all, fused | |")
    print("|---|---|---|---|---|---|---|")
    agree = True
    for urdf in [Path(file) for file in files] or example_robots():
        line, agrees = row(programs, urdf, folder)
        print(line, flush=True)
        agree = agree and agrees
    if not agree:
        sys.exit(f"some robots differ by more than {TOLERANCE}")


main()
