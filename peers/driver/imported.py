"""Robots on free bases, made by `redysim import` from the package example-robot-data.

Their numbers belong to others, and are not in this repository.
"""

import subprocess
import tomllib
from math import cos, radians, sin
from pathlib import Path

import robots as robot_files
from robots import Link, Robot

Matrix = list[list[float]]
URDFS = {
    "anymal": "anymal_b_simple_description/robots/anymal.urdf",
    "talos": "talos_data/robots/talos_reduced.urdf",
}
IDENTITY = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
# Entries of rotations this near to -1, 0 or 1 are these: quarter turns are exact for every program.
ROUNDOFF = 1e-15
# Joint forces that Pinocchio leaves out.
LEFT_OUT = ("damping = ", "friction = ")


def write(name: str, redysim: Path, packages: Path, built: Path) -> None:
    """Writes the model for redysim and, from its numbers, the file for all others."""
    urdf = packages / "cmeel.prefix/share/example-robot-data/robots" / URDFS[name]
    command = [redysim, "import", urdf, "--base", "free", "--fuse-fixed", "--quarter-turns"]
    model = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    model = "".join(line for line in model.splitlines(keepends=True) if not line.startswith(LEFT_OUT))
    model = _depth_first(model)
    _write_changed(robot_files.path(name, "toml", built), model)
    _write_changed(robot_files.path(name, "txt", built), robot_files.txt(robot(name, tomllib.loads(model))))


def _write_changed(path: Path, text: str) -> None:
    """What is the same keeps its date, so that what is made of it is not built again."""
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def robot(name: str, model: dict) -> Robot:
    """The model with the frame of each link turned so that its joint's axis is z: no force or acceleration of a joint
    changes, and the root, whose velocities are in its own axes, stays as it is."""
    numbers, turns, links = {"base": -1}, {"base": IDENTITY}, []
    for number, link in enumerate(model["link"]):
        kind, parent = link["joint"], link["parent"]
        free = kind == "free"
        if kind not in ("revolute", "free") or free != (number == 0):
            raise ValueError(f"{name}: link `{link['name']}` has a joint `{kind}`: want a free root, all others revolute")
        turn = IDENTITY if free else _to_axis(link["axis"])
        origin = link["origin"]
        # Coordinates of a free joint are then the same in every program.
        if free and origin != {}:
            raise ValueError(f"{name}: link `{link['name']}` has the origin {origin}: want a root without one")
        placed = _product(_transposed(turns[parent]), _product(_rotation(origin.get("rpy", [0.0] * 3)), turn))
        position = _applied(_transposed(turns[parent]), origin.get("xyz", [0.0] * 3))
        of = link["inertia"]
        xx, yy, zz, xy, xz, yz = (of.get(key, 0.0) for key in ("xx", "yy", "zz", "xy", "xz", "yz"))
        inertia = _product(_transposed(turn), _product([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], turn))
        com = _applied(_transposed(turn), link["com"])
        upper = [inertia[row][column] for row in range(3) for column in range(row, 3)]
        links.append(Link(numbers[parent], _snapped(placed), position, link["mass"], com, upper, free))
        numbers[link["name"]], turns[link["name"]] = number, turn
    return Robot(name, model["gravity"], links)


def _depth_first(model: str) -> str:
    """The model with its links in depth-first order, as Pinocchio and MuJoCo number joints."""
    head, *links = (part.rstrip("\n") for part in model.split("\n[[link]]\n"))
    named = {link["name"]: (link["parent"], text) for link, text in zip(tomllib.loads(model)["link"], links)}
    ordered, open_links = [], ["base"]
    while open_links:
        current = open_links.pop()
        ordered += [named[current][1]] if current in named else []
        open_links += reversed([name for name, (parent, _) in named.items() if parent == current])
    return "\n\n[[link]]\n".join([head, *ordered]) + "\n"


def _to_axis(axis: list[float]) -> Matrix:
    """A rotation that turns z into this axis: a permutation where it is x, y or z."""
    length = sum(entry * entry for entry in axis) ** 0.5
    z = [entry / length for entry in axis]
    # The unit vector after the axis's largest component is far from parallel to it.
    largest = max(range(3), key=lambda i: abs(z[i]))
    near = [float(i == (largest + 1) % 3) for i in range(3)]
    along = sum(a * b for a, b in zip(near, z))
    x = [a - along * b for a, b in zip(near, z)]
    length = sum(entry * entry for entry in x) ** 0.5
    x = [entry / length for entry in x]
    y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
    return [[x[i] + 0.0, y[i] + 0.0, z[i] + 0.0] for i in range(3)]


def _rotation(rpy: list[float | str]) -> Matrix:
    """The rotation by roll, pitch and yaw about fixed x, y and z."""
    (sr, sp, sy), (cr, cp, cy) = ([function(_radians(angle)) for angle in rpy] for function in (sin, cos))
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def _radians(angle: float | str) -> float:
    """An angle of a model: a number, or degrees as `180 deg`."""
    return radians(float(angle.removesuffix("deg"))) if isinstance(angle, str) else angle


def _snapped(matrix: Matrix) -> Matrix:
    def snapped(entry: float) -> float:
        near = float(round(entry))
        return near + 0.0 if abs(entry - near) < ROUNDOFF else entry

    return [[snapped(entry) for entry in row] for row in matrix]


def _product(a: Matrix, b: Matrix) -> Matrix:
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def _applied(a: Matrix, vector: list[float]) -> list[float]:
    return [sum(a[i][k] * vector[k] for k in range(3)) for i in range(3)]


def _transposed(a: Matrix) -> Matrix:
    return [[a[j][i] for j in range(3)] for i in range(3)]
