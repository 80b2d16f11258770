"""Random trees of rigid bodies, and the model files that say the same."""

from dataclasses import dataclass

import numpy
import pinocchio

PHYSICS = ["armature", "damping", "stiffness", "rest"]
# What redysim has of each joint that moves: how many coordinates, of which the last four are a quaternion where they are more
# than the velocities, and how many velocities.
SIZES = {"revolute": (1, 1), "prismatic": (1, 1), "spherical": (4, 3), "planar": (3, 3), "free": (7, 6)}


@dataclass
class Placement:
    """Where a frame stands in another: position, and roll, pitch and yaw, as in a URDF."""

    xyz: numpy.ndarray
    rpy: numpy.ndarray

    @property
    def rotation(self) -> numpy.ndarray:
        return pinocchio.rpy.rpyToMatrix(*self.rpy)

    @property
    def pose(self) -> pinocchio.SE3:
        return pinocchio.SE3(self.rotation, self.xyz)


@dataclass
class Link:
    """A body, and the joint that carries it."""

    name: str
    # By index, none of the ground.
    parent: int | None
    joint: str
    origin: Placement
    # Unit vector in the link's frame, of a joint with one degree of freedom.
    axis: numpy.ndarray
    # Of armature, damping, stiffness and rest, for each velocity.
    physics: dict[str, float]
    mass: float
    # Centre of mass and principal axes of inertia, and the principal moments.
    principal: Placement
    moments: numpy.ndarray

    @property
    def inertia(self) -> numpy.ndarray:
        """About the centre of mass, in the link's axes."""
        rotation = self.principal.rotation
        return rotation @ numpy.diag(self.moments) @ rotation.T

    @property
    def has_axis(self) -> bool:
        return SIZES.get(self.joint) == (1, 1)


@dataclass
class Frame:
    """A frame of interest."""

    name: str
    link: int | None
    origin: Placement


@dataclass
class Tree:
    """Links with parents before children."""

    name: str
    gravity: numpy.ndarray
    links: list[Link]
    frames: list[Frame]
    # The links' indices in the order of the model file.
    order: list[int]

    @classmethod
    def grown(cls, name: str, kinds: list[str], random: numpy.random.Generator) -> "Tree":
        """A tree of two to eight links on joints of these kinds, the last of them fixed, in any order, and two frames."""
        count = int(random.integers(2, 9))
        links = [link(random, index, kinds) for index in range(count)]
        frames = [
            # A third of the second frames stand on the ground.
            Frame("tip", count - 1, placement(random, 0.3)),
            Frame("point", int(random.integers(count)) if random.random() < 2 / 3 else None, placement(random, 0.3)),
        ]
        order = [int(index) for index in random.permutation(count)]
        return cls(name, random.uniform(-10, 10, 3), links, frames, order)

    @property
    def moving(self) -> list[Link]:
        """The links on joints that move, in the order of the model file."""
        return [self.links[index] for index in self.order if self.links[index].joint != "fixed"]

    @property
    def nv(self) -> int:
        return sum(SIZES[link.joint][1] for link in self.moving)

    def parts(self, vector: numpy.ndarray, size: int) -> list[numpy.ndarray]:
        """The coordinates (`size` 0) or velocities (1) of each joint that moves."""
        return numpy.split(vector, numpy.cumsum([SIZES[link.joint][size] for link in self.moving])[:-1])

    def random_position(self, random: numpy.random.Generator) -> numpy.ndarray:
        """Angles, rad, and displacements, m, of up to π, and any orientation."""
        parts = []
        for coordinates, velocities in (SIZES[link.joint] for link in self.moving):
            quaternion = 4 if coordinates > velocities else 0
            parts.append(random.uniform(-numpy.pi, numpy.pi, coordinates - quaternion))
            if quaternion:
                drawn = random.normal(size=quaternion)
                parts.append(drawn / numpy.linalg.norm(drawn))
        return numpy.concatenate(parts)

    def children(self, index: int | None) -> list[int]:
        return [child for child, link in enumerate(self.links) if link.parent == index]

    def depth_first(self, carrier: int | None = None) -> list[int]:
        """The links that hang on one, each followed by those that hang on it."""
        return [link for child in self.children(carrier) for link in [child, *self.depth_first(child)]]

    def link_name(self, index: int | None) -> str:
        return "base" if index is None else self.links[index].name

    def model_file(self) -> str:
        """The tree as a model of redysim's."""
        lines = [
            "# A random tree, written by peers/reference/run.",
            f'name = "{self.name}"',
            f"gravity = {vector(self.gravity)}",
        ]
        for index in self.order:
            link, inertia = self.links[index], self.links[index].inertia
            moments = zip(["xx", "yy", "zz", "xy", "yz", "xz"], inertia[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]])
            lines += [
                "",
                "[[link]]",
                f'name = "{link.name}"',
                f'parent = "{self.link_name(link.parent)}"',
                f'joint = "{link.joint}"',
                f"origin = {origin(link.origin)}",
            ]
            if link.has_axis:
                lines.append(f"axis = {vector(link.axis)}")
            if link.joint != "fixed":
                lines += [f"{key} = {float(link.physics[key])!r}" for key in PHYSICS if link.physics[key] != 0]
            lines += [
                f"mass = {link.mass!r}",
                f"com = {vector(link.principal.xyz)}",
                f"inertia = {{ {', '.join(f'{name} = {float(value)!r}' for name, value in moments)} }}",
            ]
        for frame in self.frames:
            lines += ["", "[[frame]]", f'name = "{frame.name}"', f'link = "{self.link_name(frame.link)}"']
            lines.append(f"origin = {origin(frame.origin)}")
        return "\n".join(lines) + "\n"


def link(random: numpy.random.Generator, index: int, kinds: list[str]) -> Link:
    """A body of a few kilogrammes and decimetres; half of the joints have each part of what acts in them.

    A spring of a spherical joint is relaxed at zero. In joints with displacements and rotations nothing acts: the velocities
    of which the programs have the armature, and those that they damp, are in other axes.
    """
    # Mostly on the one before, so that chains get long, else on any, or on the ground.
    parent = index - 1 if random.random() < 2 / 3 else int(random.integers(-1, index))
    joint = kinds[random.integers(len(kinds) if index > 1 else len(kinds) - 1)]
    axis = random.normal(size=3)
    largest = {"armature": 0.5, "damping": 2.0, "stiffness": 20.0, "rest": 1.0}
    a, b, c = random.uniform(0.002, 0.01, 3)
    physics = {key: float(random.uniform(0.1, 1) * most) for key, most in largest.items()}
    left_out = [key for key in PHYSICS if random.random() < 0.5]
    # A rest is that of a spring.
    left_out += ["rest"] if "stiffness" in left_out or joint == "spherical" else []
    left_out += PHYSICS if joint in ["planar", "free"] else []
    return Link(
        name=f"link{index}",
        parent=None if parent < 0 else parent,
        joint=joint,
        origin=placement(random, 0.5),
        axis=axis / numpy.linalg.norm(axis),
        physics=physics | dict.fromkeys(left_out, 0.0),
        mass=float(random.uniform(0.5, 3)),
        principal=placement(random, 0.2),
        # Sums of two each, as of any body.
        moments=numpy.array([b + c, a + c, a + b]),
    )


def placement(random: numpy.random.Generator, far: float) -> Placement:
    return Placement(random.uniform(-far, far, 3), random.uniform(-1.5, 1.5, 3))


def vector(numbers: numpy.ndarray) -> str:
    return f"[{', '.join(repr(float(number)) for number in numbers)}]"


def origin(placed: Placement) -> str:
    return f"{{ xyz = {vector(placed.xyz)}, rpy = {vector(placed.rpy)} }}"
