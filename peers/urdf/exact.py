"""Accelerations of redysim and of Pinocchio, each beside the right ones, in 50 digits."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from projected import Projected

# So many times as far from the right accelerations as Pinocchio's may redysim's be.
MARGIN = 2


@dataclass(frozen=True)
class Errors:
    """Distances from the right values of each joint, as shares of its largest at any state."""

    ours: list[float]
    theirs: list[float]
    # Of the forces that redysim's accelerations take from those that made them.
    taken: list[float]
    # Of the accelerations of the URDF's numbers, as doubles, from those of its numbers as they are written.
    written: list[float]

    def agree(self, tolerance: float) -> bool:
        """Whether redysim is right, or as right as Pinocchio where doubles do not have the digits, and its forces are."""
        ours = all(own <= max(tolerance, MARGIN * other) for own, other in zip(self.ours, self.theirs))
        return ours and all(share < tolerance for share in self.taken)


def errors(
    urdf: Path,
    joints: list[str],
    model: dict,
    driven: Sequence[Sequence[Sequence[float]]],
    ours: Sequence[Sequence[float]],
    theirs: Sequence[Sequence[float]],
) -> Errors:
    """Of accelerations at states q, v under the forces τ and wrenches."""
    robot, written = Projected(urdf, joints, model), Projected(urdf, joints, model, Decimal)
    right = [robot.accelerations(*state) for state in driven]
    taken = [robot.forces(q, v, a, wrenches) for (q, v, _, wrenches), a in zip(driven, ours)]
    return Errors(
        ours=furthest(ours, right),
        theirs=furthest(theirs, right),
        taken=furthest(taken, [tau for _, _, tau, _ in driven]),
        written=furthest(right, [written.accelerations(*state) for state in driven]),
    )


def furthest(found: Sequence[Sequence[float | Decimal]], right: Sequence[Sequence[float | Decimal]]) -> list[float]:
    """The largest distance of each component at any state, as a share of its largest right value."""
    shares = []
    for own, wanted in zip(zip(*found, strict=True), zip(*right, strict=True), strict=True):
        scale = max(abs(Decimal(entry)) for entry in wanted)
        distance = max(abs(Decimal(entry) - Decimal(other)) for entry, other in zip(own, wanted, strict=True))
        shares.append(float(distance / scale) if distance else 0.0)
    return shares
