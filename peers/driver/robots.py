"""The robots, and the files that each program wants of them."""

from dataclasses import dataclass
from math import asin, atan2
from pathlib import Path

NAMES = ["kr5", "gripper", "humanoid30", "chain10", "chain20", "chain40", "chain80"]
FOLDER = Path(__file__).parent.parent / "robots"


@dataclass
class Link:
    parent: int
    rotation: list[list[float]]
    position: list[float]
    mass: float
    com: list[float]
    # Ixx, Ixy, Ixz, Iyy, Iyz, Izz about the centre of mass.
    inertia: list[float]

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

    def breadth_first(self) -> list[int]:
        """The links, those nearer to the ground first."""
        order = [-1]
        for parent in order:
            order += [number for number, link in enumerate(self.links) if link.parent == parent]
        return order[1:]


def read(name: str) -> Robot:
    lines = (FOLDER / f"{name}.txt").read_text().splitlines()
    title, joints, *gravity = lines[0].split()
    links = []
    for line in lines[1 : int(joints) + 1]:
        parent, *values = line.split()
        v = [float(value) for value in values]
        links.append(Link(int(parent), [v[0:3], v[3:6], v[6:9]], v[9:12], v[12], v[13:16], v[16:22]))
    return Robot(title, [float(value) for value in gravity], links)


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
    out = [f'<robot name="{robot.name}">', '<link name="base"/>']
    for number, link in enumerate(robot.links, 1):
        r, position = link.rotation, link.position
        if link.parent < 0:
            turn = _upright(robot)
            r = [[sum(turn[i][k] * r[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
            position = [sum(turn[i][k] * position[k] for k in range(3)) for i in range(3)]
        turns = [atan2(r[2][1], r[2][2]), -asin(r[2][0]), atan2(r[1][0], r[0][0])]
        parent = f"link{link.parent + 1}" if link.parent >= 0 else "base"
        moments = zip(["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], link.inertia)
        out += [
            f'<link name="link{number}"><inertial><origin xyz="{_words(link.com)}" rpy="0 0 0"/>',
            f'<mass value="{link.mass!r}"/>',
            "<inertia " + " ".join(f'{name}="{value!r}"' for name, value in moments) + "/></inertial></link>",
            f'<joint name="joint{number}" type="continuous"><parent link="{parent}"/><child link="link{number}"/>',
            f'<origin xyz="{_words(position)}" rpy="{_words(turns)}"/><axis xyz="0 0 1"/></joint>',
        ]
    return "\n".join([*out, "</robot>", ""])


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
                f'<inertial pos="{_words(link.com)}" mass="{link.mass!r}" {inertia}/><joint type="hinge" axis="0 0 1"/>',
            ]
        )
        for child in children[number]:
            body(child)
        out.append("</body>")

    for root in children[-1]:
        body(root)
    return "\n".join([*out, "</worldbody></mujoco>", ""])
