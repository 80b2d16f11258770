"""A URDF's equations of motion in 50 digits, against which programs of doubles are measured.

Newton's and Euler's equations of every link, also of those that are fixed to others, in the axes of the base, projected onto
its partial velocities (Kane's equations): M = Σ Jᵀ I J, and no recursion over forces or inertias. The arithmetic is
Python's `decimal`; the URDF's numbers are taken as the doubles that every program takes them for, exactly.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from digits import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    added,
    applied,
    cross,
    dot,
    double,
    normalised,
    numbers,
    of_quaternion,
    of_rpy,
    product,
    scaled,
    solution,
    transposed,
    turned_about,
)
from mimics import Mimic, of_model, resolved

TURNING, SLIDING = ["revolute", "continuous"], ["prismatic"]


class Unsupported(Exception):
    """A robot whose equations are not made here; the message says why."""


@dataclass(frozen=True)
class Coordinate:
    """A joint's coordinate: `multiplier` times that of this number among the robot's, plus `offset`."""

    index: int
    multiplier: Decimal
    offset: Decimal


@dataclass(frozen=True)
class Motion:
    """Where a frame is, how it moves, and how its origin and itself accelerate where no velocity changes."""

    rotation: Matrix
    position: Vector
    spin: Vector
    spin_rate: Vector
    acceleration: Vector
    # Of each velocity that moves it: angular velocity, and velocity of the origin.
    partial: dict[int, tuple[Vector, Vector]]

    def at(self, offset: Vector) -> "Motion":
        """That of a frame of the same axes that is fixed to it, its origin here in the frame's axes."""
        arm = applied(self.rotation, offset)
        acceleration = added(self.acceleration, cross(self.spin_rate, arm), cross(self.spin, cross(self.spin, arm)))
        partial = {index: (spin, added(linear, cross(spin, arm))) for index, (spin, linear) in self.partial.items()}
        position = added(self.position, arm)
        return Motion(self.rotation, position, self.spin, self.spin_rate, acceleration, partial)

    def turned(self, rotation: Matrix) -> "Motion":
        """That of a frame with the same origin that is fixed to it, turned so."""
        return Motion(product(self.rotation, rotation), *list(vars(self).values())[1:])


AT_REST = Motion(IDENTITY, ZERO, ZERO, ZERO, ZERO, {})


class Projected:
    """The robot of a URDF whose coordinates are those of these joints, in this order; `model` is redysim's.

    The model says what the URDF does not: rotors, frames, gravity, and which joints mimic others.
    """

    def __init__(self, urdf: Path, joints: list[str], model: dict, number: Callable[[str], Decimal] = double):
        self.number = number
        root = ElementTree.parse(urdf).getroot()
        self.floats = model["link"][0]["joint"] == "free" and model["link"][0]["parent"] == "base"
        # A free base has six velocities, and one coordinate more.
        first, own = (6, joints[1:]) if self.floats else (0, joints)
        self.size = first + len(own)
        self.coordinates = {name: Coordinate(first + at, Decimal(1), Decimal(0)) for at, name in enumerate(own)}
        for name, mimic in resolved(of_model(model)).items():
            self.coordinates[name] = self._following(mimic)
        self.links = {link.get("name"): link for link in root.findall("link")}
        self.joints: dict[str, list[Element]] = {name: [] for name in self.links}
        for joint in root.findall("joint"):
            self.joints[joint.find("parent").get("link")].append(joint)
        children = {joint.find("child").get("link"): joint.get("name") for joint in root.findall("joint")}
        (self.root,) = self.links.keys() - children.keys()
        self.gravity = tuple(map(Decimal, model["gravity"]))
        carriers = {joint: link for link, joint in children.items()}
        named = {link["name"]: carriers.get(link["joint_name"], self.root) for link in model["link"]}
        frames = [(named[frame["link"]], frame["origin"]["xyz"]) for frame in model.get("frame", [])]
        self.frames = [(link, tuple(map(Decimal, origin))) for link, origin in frames]
        rotors = [(link["joint_name"], Decimal(link["armature"])) for link in model["link"] if "armature" in link]
        self.rotors = [(self.coordinates[joint], inertia) for joint, inertia in rotors]

    def _following(self, mimic: Mimic) -> Coordinate:
        return Coordinate(self.coordinates[mimic.joint].index, Decimal(mimic.multiplier), Decimal(mimic.offset))

    def forces(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float], wrenches: Sequence[float]
    ) -> list[Decimal]:
        """τ = M a + h."""
        matrix, rest = self._equations(q, v, wrenches)
        exact = list(map(Decimal, a))
        return [dot(row, exact) + entry for row, entry in zip(matrix, rest)]

    def accelerations(
        self, q: Sequence[float], v: Sequence[float], tau: Sequence[float], wrenches: Sequence[float]
    ) -> list[Decimal]:
        """M⁻¹ (τ − h)."""
        matrix, rest = self._equations(q, v, wrenches)
        return solution(matrix, [Decimal(force) - entry for force, entry in zip(tau, rest)])

    def _equations(
        self, q: Sequence[float], v: Sequence[float], wrenches: Sequence[float]
    ) -> tuple[list[list[Decimal]], list[Decimal]]:
        """M, and h: the forces that no acceleration takes."""
        matrix = [[Decimal(0)] * self.size for _ in range(self.size)]
        rest = [Decimal(0)] * self.size
        motions = dict(self._motions([Decimal(x) for x in q], [Decimal(x) for x in v]))
        for name, motion in motions.items():
            inertial = self.links[name].find("inertial")
            if inertial is not None:
                self._add(inertial, motion, matrix, rest)
        for coordinate, inertia in self.rotors:
            matrix[coordinate.index][coordinate.index] += coordinate.multiplier**2 * inertia
        for at, (link, origin) in enumerate(self.frames):
            wrench = tuple(map(Decimal, wrenches[6 * at : 6 * at + 6]))
            for index, (spin, linear) in motions[link].at(origin).partial.items():
                rest[index] -= dot(linear, wrench[:3]) + dot(spin, wrench[3:])
        return matrix, rest

    def _add(self, inertial: Element, motion: Motion, matrix: list[list[Decimal]], rest: list[Decimal]) -> None:
        """The part of a link, with centre of mass and principal axes where the URDF has them."""
        xyz, rpy = self._origin(inertial)
        mass = self.number(inertial.find("mass").get("value"))
        entries = {name: self.number(value) for name, value in inertial.find("inertia").attrib.items()}
        rows = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
        body = motion.at(xyz).turned(of_rpy(rpy))
        inertia = tuple(tuple(entries[name] for name in row) for row in rows)
        inertia = product(product(body.rotation, inertia), transposed(body.rotation))
        force = scaled(mass, added(body.acceleration, scaled(Decimal(-1), self.gravity)))
        moment = added(applied(inertia, body.spin_rate), cross(body.spin, applied(inertia, body.spin)))
        for index, (spin, linear) in body.partial.items():
            rest[index] += dot(linear, force) + dot(spin, moment)
            turning, moving = applied(inertia, spin), scaled(mass, linear)
            for other, (other_spin, other_linear) in body.partial.items():
                matrix[index][other] += dot(turning, other_spin) + dot(moving, other_linear)

    def _motions(self, q: list[Decimal], v: list[Decimal]) -> Iterator[tuple[str, Motion]]:
        """Of each link's frame, after its parent's."""
        waiting = [(self.root, _floating(q, v) if self.floats else AT_REST)]
        while waiting:
            name, motion = waiting.pop()
            yield name, motion
            for joint in self.joints[name]:
                waiting.append((joint.find("child").get("link"), self._moved(joint, motion, q[int(self.floats) :], v)))

    def _moved(self, joint: Element, parent: Motion, q: list[Decimal], v: list[Decimal]) -> Motion:
        """Of the joint's child. A joint that has no coordinate is held at zero."""
        xyz, rpy = self._origin(joint)
        frame = parent.at(xyz).turned(of_rpy(rpy))
        kind, own = joint.get("type"), self.coordinates.get(joint.get("name"))
        if own is None:
            return frame
        if kind not in TURNING + SLIDING:
            raise Unsupported(f"a {kind} joint, `{joint.get('name')}`, has no equations in {Path(__file__).name}")
        tag = joint.find("axis")
        axis = normalised(numbers("1 0 0" if tag is None else tag.get("xyz"), self.number))
        value, rate = own.multiplier * q[own.index] + own.offset, own.multiplier * v[own.index]
        along = applied(frame.rotation, axis)
        turns = kind in TURNING
        moved = frame.turned(turned_about(axis, value)) if turns else frame.at(scaled(value, axis))
        across = scaled(rate, cross(frame.spin, along))
        spin, linear = moved.partial.get(own.index, (ZERO, ZERO))
        own_part = scaled(own.multiplier, along)
        return Motion(
            moved.rotation,
            moved.position,
            added(moved.spin, scaled(rate, along)) if turns else moved.spin,
            added(moved.spin_rate, across) if turns else moved.spin_rate,
            # Coriolis' acceleration.
            moved.acceleration if turns else added(moved.acceleration, scaled(Decimal(2), across)),
            moved.partial | {own.index: (added(spin, own_part), linear) if turns else (spin, added(linear, own_part))},
        )

    def _origin(self, of: Element) -> tuple[Vector, Vector]:
        tag = of.find("origin")
        words = [("0 0 0" if tag is None else tag.get(name, "0 0 0")) for name in ["xyz", "rpy"]]
        return tuple(numbers(text, self.number) for text in words)


def _floating(q: list[Decimal], v: list[Decimal]) -> Motion:
    """Of a free base: position and quaternion, and the velocities of origin and frame in the frame's axes."""
    rotation = of_quaternion(q[3:7])
    linear, spin = (applied(rotation, tuple(v[at : at + 3])) for at in [0, 3])
    axes = transposed(rotation)
    partial = {index: (ZERO, axis) for index, axis in enumerate(axes)}
    partial |= {index: (axis, ZERO) for index, axis in enumerate(axes, 3)}
    return Motion(rotation, tuple(q[:3]), spin, ZERO, cross(spin, linear), partial)
