"""Pinocchio's side: the same URDF, with the same joints free, and the rotors and frames of the model.

Its quantities of frames are those of `LOCAL_WORLD_ALIGNED`: at the frame's own origin, in the axes of the base.
"""

from math import cos, sin
from pathlib import Path

import numpy
import pinocchio
from pinocchio import LOCAL_WORLD_ALIGNED as ALIGNED


class Refused(Exception):
    """A robot that cannot be compared; the message says why."""


class Peer:
    """Pinocchio's robot with these joints, and no others, free; `model` is redysim's, as read from TOML."""

    def __init__(self, urdf: Path, joints: list[str], model: dict):
        try:
            whole = pinocchio.buildModelFromUrdf(str(urdf))
            locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in joints]
            self.model = pinocchio.buildReducedModel(whole, locked, pinocchio.neutral(whole)) if locked else whole
        except (RuntimeError, ValueError) as error:
            raise Refused(f"Pinocchio does not take it: {str(error).splitlines()[0]}") from error
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in joints]
        self.order = [joint.idx_v for joint in self.joints]
        if self.model.nv != len(joints):
            raise Refused(f"Pinocchio has {self.model.nv} velocities, redysim {len(joints)}")
        rotors = {link["joint_name"]: link.get("armature", 0.0) for link in model["link"]}
        self.model.armature = self._ordered(numpy.array([rotors[name] for name in joints]))
        carriers = {link["name"]: link["joint_name"] for link in model["link"]}
        self.frames = [self._added(frame, carriers[frame["link"]]) for frame in model.get("frame", [])]
        self.data = self.model.createData()

    def _added(self, frame: dict, joint: str) -> int:
        """A link's frame is that of its joint, whose name is the same in both."""
        kinds = [pinocchio.FrameType.JOINT, pinocchio.FrameType.FIXED_JOINT]
        body = next(frame for frame in self.model.frames if frame.name == joint and frame.type in kinds)
        placed = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(*frame["origin"]["rpy"]), numpy.array(frame["origin"]["xyz"]))
        kind = pinocchio.FrameType.OP_FRAME
        whole = pinocchio.Frame(frame["name"], body.parentJoint, 0, body.placement * placed, kind)
        # No frame of the URDF's own has this name.
        return self.model.addFrame(whole)

    def wrench_scales(self) -> numpy.ndarray:
        """Forces of the weight of the body that each frame is on, and moments of this on a decimetre."""
        joints = [self.model.frames[frame].parentJoint for frame in self.frames]
        weights = 10 * numpy.array([self.model.inertias[joint].mass for joint in joints])
        return numpy.outer(weights, [1, 1, 1, 0.1, 0.1, 0.1])

    def _external(self, position: numpy.ndarray, wrenches: numpy.ndarray) -> list[pinocchio.Force]:
        """The wrenches on the frames, as Pinocchio takes them: at the joints' frames, in their axes."""
        external = [pinocchio.Force.Zero() for _ in self.model.joints]
        pinocchio.framesForwardKinematics(self.model, self.data, position)
        for frame, wrench in zip(self.frames, wrenches.reshape(-1, 6)):
            turn = self.data.oMf[frame].rotation.T
            turned = pinocchio.Force(turn @ wrench[:3], turn @ wrench[3:])
            external[self.model.frames[frame].parentJoint] += self.model.frames[frame].placement.act(turned)
        return external

    def _position(self, q: numpy.ndarray) -> numpy.ndarray:
        """A continuous joint's coordinates are cosine and sine."""
        position = numpy.zeros(self.model.nq)
        for joint, value in zip(self.joints, q):
            own = [value] if joint.nq == 1 else [cos(value), sin(value)]
            position[joint.idx_q : joint.idx_q + joint.nq] = own
        return position

    def _ordered(self, vector: numpy.ndarray) -> numpy.ndarray:
        ordered = numpy.zeros(self.model.nv)
        ordered[self.order] = vector
        return ordered

    def forces(self, q: numpy.ndarray, v: numpy.ndarray, a: numpy.ndarray, wrenches: numpy.ndarray) -> numpy.ndarray:
        position, v, a = self._position(q), self._ordered(v), self._ordered(a)
        external = self._external(position, wrenches)
        return pinocchio.rnea(self.model, self.data, position, v, a, external)[self.order].copy()

    def matrix(self, q: numpy.ndarray) -> numpy.ndarray:
        upper = numpy.triu(pinocchio.crba(self.model, self.data, self._position(q)))
        return (upper + numpy.triu(upper, 1).T)[numpy.ix_(self.order, self.order)]

    def accelerations(
        self, q: numpy.ndarray, v: numpy.ndarray, tau: numpy.ndarray, wrenches: numpy.ndarray
    ) -> numpy.ndarray:
        position, v, tau = self._position(q), self._ordered(v), self._ordered(tau)
        external = self._external(position, wrenches)
        return pinocchio.aba(self.model, self.data, position, v, tau, external)[self.order].copy()

    def jacobians(self, q: numpy.ndarray) -> numpy.ndarray:
        """Of each frame, six rows: the origin's velocity, then the angular velocity."""
        pinocchio.computeJointJacobians(self.model, self.data, self._position(q))
        pinocchio.updateFramePlacements(self.model, self.data)
        found = [pinocchio.getFrameJacobian(self.model, self.data, frame, ALIGNED) for frame in self.frames]
        return numpy.array([jacobian[:, self.order] for jacobian in found])

    def bias(self, q: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """J̇ v of each frame, with the derivative of its Jacobian."""
        v = self._ordered(v)
        pinocchio.computeJointJacobiansTimeVariation(self.model, self.data, self._position(q), v)
        pinocchio.updateFramePlacements(self.model, self.data)
        rate = pinocchio.getFrameJacobianTimeVariation
        return numpy.array([rate(self.model, self.data, frame, ALIGNED) @ v for frame in self.frames])
