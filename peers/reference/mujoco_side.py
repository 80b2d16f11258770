"""What MuJoCo computes for a tree.

It has armature, damping and springs (`springref` is where they are relaxed). All constraints are off, as is what its
integrators add: `mj_inverse` and `mj_forward` are those of continuous time.
"""

import mujoco
import numpy
from tree import Link, Placement, Tree

# The joints, one after the other, by name, type and axis; those with one degree of freedom have an axis of the link.
SLIDES = [("_x", "slide", (1, 0, 0)), ("_y", "slide", (0, 1, 0)), ("_z", "slide", (0, 0, 1))]
JOINTS = {
    "revolute": [("", "hinge", None)],
    "prismatic": [("", "slide", None)],
    "spherical": [("", "ball", None)],
    "planar": [*SLIDES[:2], ("", "hinge", (0, 0, 1))],
    # Its own free joints stand on the ground alone.
    "free": [*SLIDES, ("", "ball", None)],
}
ATTRIBUTES = {"armature": "armature", "damping": "damping", "stiffness": "stiffness", "springref": "rest"}


class MujocoSide:
    """MuJoCo's model of a tree; vectors are in the order of the tree's model file.

    Its velocities are T v, where v are redysim's: those of the slides of a free joint are in the axes of the joint, redysim's
    in those of the link. T is a rotation, so that τ = Tᵀ τ', where τ' are MuJoCo's forces, and a' = T a + Ṫ v.
    """

    def __init__(self, tree: Tree):
        self.tree = tree
        self.model = mujoco.MjModel.from_xml_string(document(tree))
        self.data = mujoco.MjData(self.model)

    def _mapped(self, q: numpy.ndarray, v: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
        """MuJoCo's coordinates, T and Ṫ."""
        position = numpy.zeros(self.model.nq)
        turn, rate = numpy.zeros((2, self.model.nv, self.model.nv))
        start = 0
        for link, own, moving in zip(self.tree.moving, self.tree.parts(q, 0), self.tree.parts(v, 1)):
            block, block_rate = numpy.eye(len(moving)), numpy.zeros((len(moving), len(moving)))
            if len(own) > len(moving):
                # Its quaternions begin with the real part.
                own = numpy.concatenate([own[:-4], own[-1:], own[-4:-1]])
            if link.joint == "free":
                rotation = numpy.zeros(9)
                mujoco.mju_quat2Mat(rotation, own[-4:])
                x, y, z = moving[3:]
                block[:3, :3] = rotation.reshape(3, 3)
                block_rate[:3, :3] = rotation.reshape(3, 3) @ [[0, -z, y], [z, 0, -x], [-y, x, 0]]
            first = self.model.joint(link.name + JOINTS[link.joint][0][0])
            position[first.qposadr[0] : first.qposadr[0] + len(own)] = own
            places = slice(first.dofadr[0], first.dofadr[0] + len(moving)), slice(start, start + len(moving))
            turn[places], rate[places] = block, block_rate
            start += len(moving)
        return position, turn, rate

    def answers(self, q, v, a, tau, wrenches) -> dict[str, numpy.ndarray]:
        model, data = self.model, self.data
        position, turn, rate = self._mapped(q, v)
        shift = rate @ v
        data.qpos[:], data.qvel[:], data.qacc[:] = position, turn @ v, turn @ a + shift
        mujoco.mj_inverse(model, data)
        matrix = numpy.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, matrix)
        found = {
            # What actuators must give: M a and the bias, less `qfrc_passive`.
            "mujoco.inverse": turn.T @ data.qfrc_inverse,
            # Damping and springs as forces on the joints, so that the sign is the other.
            "mujoco.passive": -turn.T @ data.qfrc_passive,
            "mujoco.mass_matrix": (turn.T @ matrix @ turn)[numpy.triu_indices(model.nv)],
        }
        data.qfrc_applied[:] = turn @ tau
        mujoco.mj_forward(model, data)
        found["mujoco.forward"] = turn.T @ (data.qacc - shift)
        # Potential, then kinetic.
        found["mujoco.energy"] = data.energy.copy()
        return found


def document(tree: Tree) -> str:
    """The tree as MJCF."""

    def body(index: int) -> str:
        link = tree.links[index]
        joint = "".join(joints(link))
        principal = f'mass="{link.mass!r}" {placed(link.principal)} diaginertia="{words(link.moments)}"'
        return f'<body name="{link.name}" {placed(link.origin)}><inertial {principal}/>{joint}{bodies(index)}</body>'

    def bodies(carrier: int | None) -> str:
        return "".join(body(index) for index in tree.children(carrier))

    return (
        f'<mujoco><compiler angle="radian" inertiafromgeom="false"/><option gravity="{words(tree.gravity)}">'
        '<flag constraint="disable" energy="enable" invdiscrete="disable"/></option>'
        f"<worldbody>{bodies(None)}</worldbody></mujoco>"
    )


def joints(link: Link) -> list[str]:
    """The elements of a link's joint."""
    physics = " ".join(f'{name}="{link.physics[key]!r}"' for name, key in ATTRIBUTES.items())
    elements = []
    for suffix, kind, axis in JOINTS.get(link.joint, []):
        along = "" if kind == "ball" else f'axis="{words(link.axis if axis is None else axis)}" '
        elements.append(f'<joint name="{link.name}{suffix}" type="{kind}" {along}{physics}/>')
    return elements


def placed(placement: Placement) -> str:
    quaternion = numpy.zeros(4)
    mujoco.mju_mat2Quat(quaternion, placement.rotation.ravel())
    return f'pos="{words(placement.xyz)}" quat="{words(quaternion)}"'


def words(numbers: numpy.ndarray) -> str:
    return " ".join(repr(float(number)) for number in numbers)
