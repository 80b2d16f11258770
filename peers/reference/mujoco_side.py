"""What MuJoCo computes for a tree.

It has armature, damping and springs (`springref` is where they are relaxed). All constraints are off, as is what its
integrators add: `mj_inverse` and `mj_forward` are those of continuous time.
"""

import mujoco
import numpy
from tree import Placement, Tree

KINDS = {"revolute": "hinge", "prismatic": "slide"}
ATTRIBUTES = {"armature": "armature", "damping": "damping", "stiffness": "stiffness", "springref": "rest"}


class MujocoSide:
    """MuJoCo's model of a tree; vectors are in the order of the tree's model file."""

    def __init__(self, tree: Tree):
        self.model = mujoco.MjModel.from_xml_string(document(tree))
        self.data = mujoco.MjData(self.model)
        self.order = [int(self.model.joint(link.name).dofadr[0]) for link in tree.moving]

    def answers(self, q, v, a, tau, wrenches) -> dict[str, numpy.ndarray]:
        model, data, order = self.model, self.data, self.order
        data.qpos[order], data.qvel[order], data.qacc[order] = q, v, a
        mujoco.mj_inverse(model, data)
        matrix = numpy.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, matrix)
        found = {
            # What actuators must give: M a and the bias, less `qfrc_passive`.
            "mujoco.inverse": data.qfrc_inverse[order].copy(),
            # Damping and springs as forces on the joints, so that the sign is the other.
            "mujoco.passive": -data.qfrc_passive[order],
            "mujoco.mass_matrix": matrix[numpy.ix_(order, order)][numpy.triu_indices(len(order))],
        }
        data.qfrc_applied[order] = tau
        mujoco.mj_forward(model, data)
        found["mujoco.forward"] = data.qacc[order].copy()
        # Potential, then kinetic.
        found["mujoco.energy"] = data.energy.copy()
        return found


def document(tree: Tree) -> str:
    """The tree as MJCF."""

    def body(index: int) -> str:
        link = tree.links[index]
        joint = ""
        if link.joint != "fixed":
            physics = " ".join(f'{name}="{link.physics[key]!r}"' for name, key in ATTRIBUTES.items())
            joint = f'<joint name="{link.name}" type="{KINDS[link.joint]}" axis="{words(link.axis)}" {physics}/>'
        principal = f'mass="{link.mass!r}" {placed(link.principal)} diaginertia="{words(link.moments)}"'
        return f'<body name="{link.name}" {placed(link.origin)}><inertial {principal}/>{joint}{bodies(index)}</body>'

    def bodies(carrier: int | None) -> str:
        return "".join(body(index) for index in tree.children(carrier))

    return (
        f'<mujoco><compiler angle="radian" inertiafromgeom="false"/><option gravity="{words(tree.gravity)}">'
        '<flag constraint="disable" energy="enable" invdiscrete="disable"/></option>'
        f"<worldbody>{bodies(None)}</worldbody></mujoco>"
    )


def placed(placement: Placement) -> str:
    quaternion = numpy.zeros(4)
    mujoco.mju_mat2Quat(quaternion, placement.rotation.ravel())
    return f'pos="{words(placement.xyz)}" quat="{words(quaternion)}"'


def words(numbers: numpy.ndarray) -> str:
    return " ".join(repr(float(number)) for number in numbers)
