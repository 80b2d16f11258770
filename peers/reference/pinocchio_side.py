"""What Pinocchio computes for a tree.

It has armature, but neither damping nor springs. Frames are seen in `LOCAL_WORLD_ALIGNED`: at their own origins, in the
axes of the base.
"""

import numpy
import pinocchio
from pinocchio import LOCAL_WORLD_ALIGNED as ALIGNED
from tree import Frame, Link, Tree

JOINTS = {
    "revolute": lambda link: pinocchio.JointModelRevoluteUnaligned(link.axis),
    "prismatic": lambda link: pinocchio.JointModelPrismaticUnaligned(link.axis),
    "spherical": lambda _: pinocchio.JointModelSpherical(),
    "planar": lambda _: pinocchio.JointModelPlanar(),
    "free": lambda _: pinocchio.JointModelFreeFlyer(),
}


class PinocchioSide:
    """Pinocchio's model of a tree; vectors are in the order of the tree's model file.

    Its velocities are T v, where v are redysim's: those of planar joints are in the axes of the link, redysim's in those of
    the joint. T is a rotation, so that τ = Tᵀ τ', where τ' are Pinocchio's forces, and a' = T a + Ṫ v.
    """

    def __init__(self, tree: Tree):
        self.tree = tree
        self.model = pinocchio.Model()
        self.model.gravity.linear = tree.gravity
        # The joint that carries each link, and where the link stands on it. No link is the ground.
        carriers = {None: (0, pinocchio.SE3.Identity())}
        armature = []
        # Its mass matrix takes the joints of a subtree to follow each other.
        for index in tree.depth_first():
            link = tree.links[index]
            joint, placed = carriers[link.parent]
            placed = placed * link.origin.pose
            if link.joint != "fixed":
                joint = self.model.addJoint(joint, JOINTS[link.joint](link), placed, link.name)
                placed = pinocchio.SE3.Identity()
                armature += [link.physics["armature"]] * self.model.joints[joint].nv
            self.model.appendBodyToJoint(joint, inertia(link), placed)
            carriers[index] = (joint, placed)
        self.model.armature = numpy.array(armature)
        self.frames = [self._added(frame, *carriers[frame.link]) for frame in tree.frames]
        self.data = self.model.createData()
        self.joints = [self.model.joints[self.model.getJointId(link.name)] for link in tree.moving]

    def _added(self, frame: Frame, joint: int, placed: pinocchio.SE3) -> int:
        whole = pinocchio.Frame(frame.name, joint, 0, placed * frame.origin.pose, pinocchio.FrameType.OP_FRAME)
        return self.model.addFrame(whole)

    def _mapped(self, q: numpy.ndarray, v: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
        """Pinocchio's coordinates, T and Ṫ."""
        position = numpy.zeros(self.model.nq)
        turn, rate = numpy.zeros((2, self.model.nv, self.model.nv))
        start = 0
        for link, joint, own, moving in zip(self.tree.moving, self.joints, self.tree.parts(q, 0), self.tree.parts(v, 1)):
            block, block_rate = numpy.eye(joint.nv), numpy.zeros((joint.nv, joint.nv))
            if link.joint == "planar":
                x, y, angle = own
                c, s = numpy.cos(angle), numpy.sin(angle)
                own = [x, y, c, s]
                block[:2, :2] = [[c, s], [-s, c]]
                block_rate[:2, :2] = moving[2] * numpy.array([[-s, c], [-c, -s]])
            position[joint.idx_q : joint.idx_q + joint.nq] = own
            places = slice(joint.idx_v, joint.idx_v + joint.nv), slice(start, start + joint.nv)
            turn[places], rate[places] = block, block_rate
            start += joint.nv
        return position, turn, rate

    def answers(self, q, v, a, tau, wrenches) -> dict[str, numpy.ndarray]:
        model, data = self.model, self.data
        q, turn, rate = self._mapped(q, v)
        shift = rate @ v
        v, a, tau = turn @ v, turn @ a + shift, turn @ tau
        found = {}
        found["pinocchio.rnea"] = turn.T @ pinocchio.rnea(model, data, q, v, a)
        found["pinocchio.aba"] = turn.T @ (pinocchio.aba(model, data, q, v, tau) - shift)
        upper = numpy.triu(pinocchio.crba(model, data, q))
        matrix = turn.T @ (upper + numpy.triu(upper, 1).T) @ turn
        found["pinocchio.crba"] = matrix[numpy.triu_indices(model.nv)]
        pinocchio.forwardKinematics(model, data, q, v, shift)
        pinocchio.computeJointJacobiansTimeVariation(model, data, q, v)
        pinocchio.updateFramePlacements(model, data)
        per_frame = {"kinematics": [], "jacobians": [], "jacobian_rates": [], "bias": []}
        external = [pinocchio.Force.Zero() for _ in model.joints]
        for frame, wrench in zip(self.frames, wrenches):
            placed = data.oMf[frame]
            velocity = pinocchio.getFrameVelocity(model, data, frame, ALIGNED)
            # At zero joint accelerations: J̇ v, since J is that of the origin's own velocity.
            bias = pinocchio.getFrameClassicalAcceleration(model, data, frame, ALIGNED)
            jacobian = pinocchio.getFrameJacobian(model, data, frame, ALIGNED)
            jacobian_rate = pinocchio.getFrameJacobianTimeVariation(model, data, frame, ALIGNED)
            per_frame["kinematics"] += [placed.rotation.ravel(), placed.translation, velocity.linear, velocity.angular]
            per_frame["jacobians"].append((jacobian @ turn).ravel())
            per_frame["jacobian_rates"].append((jacobian_rate @ turn + jacobian @ rate).ravel())
            per_frame["bias"] += [bias.linear, bias.angular]
            # External forces are given at the joint's frame, in its own axes.
            turned = pinocchio.Force(placed.rotation.T @ wrench[:3], placed.rotation.T @ wrench[3:])
            joint = model.frames[frame].parentJoint
            external[joint] += model.frames[frame].placement.act(turned)
        found |= {f"pinocchio.{name}": numpy.concatenate(numbers) for name, numbers in per_frame.items()}
        found["pinocchio.rnea_wrenches"] = turn.T @ pinocchio.rnea(model, data, q, v, a, external)
        found["pinocchio.aba_wrenches"] = turn.T @ (pinocchio.aba(model, data, q, v, tau, external) - shift)
        return found


def inertia(link: Link) -> pinocchio.Inertia:
    return pinocchio.Inertia(link.mass, link.principal.xyz, link.inertia)
