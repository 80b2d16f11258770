"""Writes random trees as model files, and beside each what Pinocchio and MuJoCo compute for it, as a table.

A line of the table is the index of a state, the name of a quantity, and its numbers, in the order of the model's file.
"""

import sys
from pathlib import Path

import numpy
from mujoco_side import MujocoSide
from pinocchio_side import PinocchioSide
from tree import Tree

# Trees, and the kinds of their joints, the last of which is fixed.
ON_AXES, IN_SPACE = 20, 10
OF_ONE_FREEDOM = ["revolute", "revolute", "revolute", "prismatic", "prismatic", "fixed"]
OF_SEVERAL = ["revolute", "prismatic", "spherical", "spherical", "planar", "free", "fixed"]
STATES = 2


def lines(tree: Tree, random: numpy.random.Generator) -> list[str]:
    """The table of a tree at random states."""
    sides, n = [PinocchioSide(tree), MujocoSide(tree)], tree.nv
    table = []
    for state in range(STATES):
        given = {
            "q": tree.random_position(random),
            "v": random.uniform(-3, 3, n),
            "a": random.uniform(-10, 10, n),
            "tau": random.uniform(-10, 10, n),
            "wrenches": random.uniform(-10, 10, (len(tree.frames), 6)),
        }
        found = [side.answers(**given) for side in sides]
        for quantities in [given, *found]:
            for name, numbers in quantities.items():
                numbers = numpy.asarray(numbers).ravel()
                # Adding zero leaves no negative zero.
                table.append(",".join([str(state), name, *(repr(float(x) + 0.0) for x in numbers)]))
    return table


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for index in range(1, ON_AXES + IN_SPACE + 1):
        random = numpy.random.default_rng(index)
        tree = Tree.grown(f"peer_tree_{index:02}", OF_ONE_FREEDOM if index <= ON_AXES else OF_SEVERAL, random)
        (folder / f"{index:02}.toml").write_text(tree.model_file())
        (folder / f"{index:02}.csv").write_text("\n".join(lines(tree, random)) + "\n")


main()
