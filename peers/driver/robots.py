"""The robots, and the files that each program wants of them."""

from dataclasses import dataclass
from math import atan2, hypot
from pathlib import Path

# On free bases, imported from a package (`imported.py`).
FREE = ["anymal", "talos"]
NAMES = ["kr5", "gripper", "humanoid30", "chain10", "chain20", "chain40", "chain80", *FREE]
FOLDER = Path(__file__).parent.parent / "robots"


def path(name: str, ending: str, built: Path) -> Path:
    """The robot's file with this ending: in the repository, or made by a build."""
    committed = {"txt": FOLDER, "toml": FOLDER.parent.parent / "models/peers"}
    folder = built / "robots" if name in FREE else committed.get(ending, built / "robots")
    return folder / f"{name}.{ending}"


@dataclass
class Link:
    # The number of a link, or −1 for the ground.
    parent: int
    rotation: list[list[float]]
    position: list[float]
    mass: float
    com: list[float]
    # Ixx, Ixy, Ixz, Iyy, Iyz, Izz about the centre of mass.
    inertia: list[float]
    # Whether its joint is a free one on the ground, instead of a revolute one about z.
    free: bool = False

    @property
    def physical(self) -> bool:
        """Whether a body could have this inertia, by its diagonal. Rods (one moment zero) and worse could not."""
        moments = [self.inertia[0], self.inertia[3], self.inertia[5]]
        return min(moments) > 0 and 2 * max(moments) <= sum(moments)


@dataclass
class Robot:
    name: str
    gravity: list[float]
    links: list[Link]

    @property
    def joints(self) -> int:
        return len(self.links)

    @property
    def nq(self) -> int:
        """How many coordinates it has; those of a free joint are x y z qx qy qz qw."""
        return sum(self.coordinates)

    @property
    def nv(self) -> int:
        """How many velocities it has; those of a free joint are linear, then angular, in the link's axes."""
        return sum(self.velocities)

    @property
    def coordinates(self) -> list[int]:
        """How many coordinates each link's joint has."""
        return [7 if link.free else 1 for link in self.links]

    @property
    def velocities(self) -> list[int]:
        """How many velocities each link's joint has."""
        return [6 if link.free else 1 for link in self.links]

    @staticmethod
    def numbered(links: list[int], sizes: list[int]) -> list[int]:
        """The numbers of the coordinates, or velocities, of these links, with how many each link of the robot has."""
        starts = [sum(sizes[:link]) for link in range(len(sizes))]
        return [starts[link] + i for link in links for i in range(sizes[link])]

    def breadth_first(self) -> list[int]:
        """The links, those nearer to the ground first."""
        order = [-1]
        for parent in order:
            order += [number for number, link in enumerate(self.links) if link.parent == parent]
        return order[1:]


def read(file: Path) -> Robot:
    lines = file.read_text().splitlines()
    title, joints, *gravity = lines[0].split()
    links = []
    for line in lines[1 : int(joints) + 1]:
        parent, *values = line.split()
        v = [float(value) for value in values]
        number = -1 if parent == "free" else int(parent)
        rotation = [v[0:3], v[3:6], v[6:9]]
        links.append(Link(number, rotation, v[9:12], v[12], v[13:16], v[16:22], parent == "free"))
    return Robot(title, [float(value) for value in gravity], links)


def txt(robot: Robot) -> str:
    """The robot as `read` takes it."""
    rows = [[robot.name, str(robot.joints), _words(robot.gravity)]]
    for link in robot.links:
        rotation = [entry for row in link.rotation for entry in row]
        numbers = [*rotation, *link.position, link.mass, *link.com, *link.inertia]
        rows.append(["free" if link.free else str(link.parent), _words(numbers)])
    return "".join(" ".join(row) + "\n" for row in rows)


def _words(values) -> str:
    return " ".join(repr(value) for value in values)


def _upright(robot: Robot) -> list[list[float]]:
    """The turn of the base after which gravity points along −z."""
    if robot.gravity[:2] == [0, 0]:
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    assert robot.gravity[0] == robot.gravity[2] == 0, f"{robot.name}: gravity along −y or −z"
    return [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]


def urdf(robot: Robot) -> str:
    """The robot for dynibo, which knows gravity along −z alone."""
    out = [f'<robot name="{robot.name}">', *([] if robot.links[0].free else ['<link name="base"/>'])]
    for number, link in enumerate(robot.links, 1):
        r, position = link.rotation, link.position
        if link.parent < 0 and not link.free:
            turn = _upright(robot)
            r = [[sum(turn[i][k] * r[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
            position = [sum(turn[i][k] * position[k] for k in range(3)) for i in range(3)]
        parent = f"link{link.parent + 1}" if link.parent >= 0 else "base"
        moments = zip(["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], link.inertia)
        out += [
            f'<link name="link{number}"><inertial><origin xyz="{_words(link.com)}" rpy="0 0 0"/>',
            f'<mass value="{link.mass!r}"/>',
            "<inertia " + " ".join(f'{name}="{value!r}"' for name, value in moments) + "/></inertial></link>",
        ]
        # A root that floats is on no joint there.
        if link.free:
            continue
        out += [
            f'<joint name="joint{number}" type="continuous"><parent link="{parent}"/><child link="link{number}"/>',
            f'<origin xyz="{_words(position)}" rpy="{_words(_roll_pitch_yaw(r))}"/><axis xyz="0 0 1"/></joint>',
        ]
    return "\n".join([*out, "</robot>", ""])


def _roll_pitch_yaw(r: list[list[float]]) -> list[float]:
    level = hypot(r[0][0], r[1][0])
    # With x straight up or down, roll and yaw turn about the same axis.
    if level < 1e-12:
        return [0.0, atan2(-r[2][0], level), atan2(-r[0][1], r[1][1])]
    return [atan2(r[2][1], r[2][2]), atan2(-r[2][0], level), atan2(r[1][0], r[0][0])]


def mjcf(robot: Robot) -> str:
    """The robot for MuJoCo.

    Its compiler refuses inertias that no body has. Such a link gets a stand-in, and the true moments as a custom number
    `inertia <body>`, which `mujoco.c` puts in place once the model is loaded.
    """
    children = {parent: [] for parent in range(-1, robot.joints)}
    for number, link in enumerate(robot.links):
        children[link.parent].append(number)
    out = ['<mujoco><compiler angle="radian"/>', f'<option gravity="{_words(robot.gravity)}"/><custom>']
    for number, link in enumerate(robot.links, 1):
        if not link.physical:
            assert link.inertia[1] == link.inertia[2] == link.inertia[4] == 0, f"{robot.name}: link {number}"
            moments = [link.inertia[0], link.inertia[3], link.inertia[5]]
            out.append(f'<numeric name="inertia {number}" data="{_words(moments)}"/>')
    out.append("</custom><worldbody>")

    def body(number: int) -> None:
        link = robot.links[number]
        x, y = ([row[column] for row in link.rotation] for column in (0, 1))
        xx, xy, xz, yy, yz, zz = link.inertia
        if link.physical:
            inertia = f'fullinertia="{_words([xx, yy, zz, xy, xz, yz])}"'
        else:
            inertia = f'diaginertia="{_words([max(link.inertia)] * 3)}"'
        out.extend(
            [
                f'<body pos="{_words(link.position)}" xyaxes="{_words(x + y)}">',
                f'<inertial pos="{_words(link.com)}" mass="{link.mass!r}" {inertia}/>',
                '<joint type="free"/>' if link.free else '<joint type="hinge" axis="0 0 1"/>',
            ]
        )
        for child in children[number]:
            body(child)
        out.append("</body>")

    for root in children[-1]:
        body(root)
    return "\n".join([*out, "</worldbody></mujoco>", ""])
