"""What Pinocchio computes for a tree.

It has armature, but neither damping nor springs. Frames are seen in `LOCAL_WORLD_ALIGNED`: at their own origins, in the
axes of the base.
"""

import numpy
import pinocchio
from pinocchio import LOCAL_WORLD_ALIGNED as ALIGNED
from tree import Frame, Link, Tree

JOINTS = {"revolute": pinocchio.JointModelRevoluteUnaligned, "prismatic": pinocchio.JointModelPrismaticUnaligned}


class PinocchioSide:
    """Pinocchio's model of a tree; vectors are in the order of the tree's model file."""

    def __init__(self, tree: Tree):
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
                joint = self.model.addJoint(joint, JOINTS[link.joint](link.axis), placed, link.name)
                placed = pinocchio.SE3.Identity()
                armature.append(link.physics["armature"])
            self.model.appendBodyToJoint(joint, inertia(link), placed)
            carriers[index] = (joint, placed)
        self.model.armature = numpy.array(armature)
        self.frames = [self._added(frame, *carriers[frame.link]) for frame in tree.frames]
        self.data = self.model.createData()
        joints = [self.model.joints[self.model.getJointId(link.name)] for link in tree.moving]
        self.order = [joint.idx_v for joint in joints]

    def _added(self, frame: Frame, joint: int, placed: pinocchio.SE3) -> int:
        whole = pinocchio.Frame(frame.name, joint, 0, placed * frame.origin.pose, pinocchio.FrameType.OP_FRAME)
        return self.model.addFrame(whole)

    def _ordered(self, vector: numpy.ndarray) -> numpy.ndarray:
        ordered = numpy.zeros(self.model.nv)
        ordered[self.order] = vector
        return ordered

    def answers(self, q, v, a, tau, wrenches) -> dict[str, numpy.ndarray]:
        model, data, order = self.model, self.data, self.order
        q, v, a, tau = (self._ordered(vector) for vector in [q, v, a, tau])
        found = {}
        found["pinocchio.rnea"] = pinocchio.rnea(model, data, q, v, a)[order].copy()
        found["pinocchio.aba"] = pinocchio.aba(model, data, q, v, tau)[order].copy()
        upper = numpy.triu(pinocchio.crba(model, data, q))
        matrix = (upper + numpy.triu(upper, 1).T)[numpy.ix_(order, order)]
        found["pinocchio.crba"] = matrix[numpy.triu_indices(len(order))]
        pinocchio.forwardKinematics(model, data, q, v, numpy.zeros(model.nv))
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
            rate = pinocchio.getFrameJacobianTimeVariation(model, data, frame, ALIGNED)
            per_frame["kinematics"] += [placed.rotation.ravel(), placed.translation, velocity.linear, velocity.angular]
            per_frame["jacobians"].append(jacobian[:, order].ravel())
            per_frame["jacobian_rates"].append(rate[:, order].ravel())
            per_frame["bias"] += [bias.linear, bias.angular]
            # External forces are given at the joint's frame, in its own axes.
            turned = pinocchio.Force(placed.rotation.T @ wrench[:3], placed.rotation.T @ wrench[3:])
            joint = model.frames[frame].parentJoint
            external[joint] += model.frames[frame].placement.act(turned)
        found |= {f"pinocchio.{name}": numpy.concatenate(numbers) for name, numbers in per_frame.items()}
        found["pinocchio.rnea_wrenches"] = pinocchio.rnea(model, data, q, v, a, external)[order].copy()
        found["pinocchio.aba_wrenches"] = pinocchio.aba(model, data, q, v, tau, external)[order].copy()
        return found


def inertia(link: Link) -> pinocchio.Inertia:
    return pinocchio.Inertia(link.mass, link.principal.xyz, link.inertia)
