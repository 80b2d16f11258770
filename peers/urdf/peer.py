"""Pinocchio's side: the same URDF, with the same joints free, and the rotors and frames of the model.

Joints that mimic others are free in Pinocchio's model. The velocities of all its joints are G v, where v are redysim's, so
that τ = Gᵀ τ_all, M = Gᵀ M_all G and J = J_all G.

Its quantities of frames are those of `LOCAL_WORLD_ALIGNED`: at the frame's own origin, in the axes of the base.
"""

from math import atan2, cos, pi, sin
from pathlib import Path

import numpy
import pinocchio
from mimics import of_model, resolved
from pinocchio import LOCAL_WORLD_ALIGNED as ALIGNED


# The joint of a floating root.
ROOT = "root_joint"


class Refused(Exception):
    """A robot that cannot be compared; the message says why."""


class Peer:
    """Pinocchio's robot with these joints, and those that mimic them, free; `model` is redysim's, as read from TOML."""

    def __init__(self, urdf: Path, joints: list[str], model: dict):
        mimics = resolved(of_model(model))
        floats = model["link"][0]["joint"] == "free" and model["link"][0]["parent"] == "base"
        try:
            if floats:
                whole = pinocchio.buildModelFromUrdf(str(urdf), pinocchio.JointModelFreeFlyer())
                joints = [ROOT if name == model["link"][0]["joint_name"] else name for name in joints]
            else:
                whole = pinocchio.buildModelFromUrdf(str(urdf))
            kept = {*joints, *mimics}
            locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in kept]
            self.model = pinocchio.buildReducedModel(whole, locked, pinocchio.neutral(whole)) if locked else whole
        except (RuntimeError, ValueError) as error:
            raise Refused(f"Pinocchio does not take it: {str(error).splitlines()[0]}") from error
        self.joints, self.mimicking = ([self._joint(name) for name in names] for names in [joints, mimics])
        # Of each joint that mimics, the one that it follows, by its number here.
        self.mimics = [(joints.index(mimic.joint), mimic) for mimic in mimics.values()]
        self.order = [joint.idx_v + i for joint in self.joints for i in range(joint.nv)]
        self.nv = len(self.order)
        if self.model.nv != self.nv + len(mimics):
            raise Refused(f"Pinocchio has {self.model.nv} velocities, redysim {self.nv} and {len(mimics)} that mimic")
        self.all_of = numpy.zeros((self.model.nv, self.nv))
        self.all_of[self.order] = numpy.eye(self.nv)
        for joint, (followed, mimic) in zip(self.mimicking, self.mimics):
            self.all_of[joint.idx_v] = mimic.multiplier * self.all_of[self.joints[followed].idx_v]
        armature = numpy.zeros(self.model.nv)
        for link in model["link"]:
            if "armature" in link:
                armature[self._joint(link["joint_name"]).idx_v] = link["armature"]
        self.model.armature = armature
        carriers = {link["name"]: link["joint_name"] for link in model["link"]}
        if floats:
            carriers[model["link"][0]["name"]] = ROOT
        self.frames = [self._added(frame, carriers[frame["link"]]) for frame in model.get("frame", [])]
        self.data = self.model.createData()

    def _joint(self, name: str) -> pinocchio.JointModel:
        return self.model.joints[self.model.getJointId(name)]

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

    @property
    def sizes(self) -> list[int]:
        """How many coordinates redysim has of each joint: of a continuous one an angle."""
        return [1 if joint.nv == 1 else joint.nq for joint in self.joints]

    def random_position(self, random: numpy.random.Generator) -> numpy.ndarray:
        """Angles of up to half a turn; of a free base a position within 1 m and any orientation."""
        parts = []
        for size in self.sizes:
            if size == 1:
                parts.append(random.uniform(-pi, pi, 1))
            else:
                quaternion = random.normal(size=4)
                parts += [random.uniform(-1, 1, size - 4), quaternion / numpy.linalg.norm(quaternion)]
        return numpy.concatenate(parts)

    def neutral(self) -> numpy.ndarray:
        """Where all coordinates are zero but the last of each quaternion."""
        return numpy.concatenate([[0.0] * (size - 1) + [float(size > 1)] for size in self.sizes])

    def _position(self, q: numpy.ndarray) -> numpy.ndarray:
        """A continuous joint's coordinates are cosine and sine."""
        position = numpy.zeros(self.model.nq)
        parts = numpy.split(q, numpy.cumsum(self.sizes)[:-1])
        parts += [mimic.multiplier * parts[followed] + mimic.offset for followed, mimic in self.mimics]
        for joint, own in zip(self.joints + self.mimicking, parts):
            if joint.nq == 2:
                own = [cos(own[0]), sin(own[0])]
            position[joint.idx_q : joint.idx_q + joint.nq] = own
        return position

    def _coordinates(self, position: numpy.ndarray, like: numpy.ndarray) -> numpy.ndarray:
        """The coordinates of a position; those of a continuous joint within half a turn of those of `like`."""
        parts = []
        for joint, near in zip(self.joints, numpy.split(like, numpy.cumsum(self.sizes)[:-1])):
            own = position[joint.idx_q : joint.idx_q + joint.nq]
            if joint.nq == 2:
                angle = atan2(own[1], own[0])
                own = [angle + 2 * pi * round((near[0] - angle) / (2 * pi))]
            parts.append(own)
        return numpy.concatenate(parts)

    def whole(self, q: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """The centre of mass, linear momentum, and angular momentum about it."""
        position, v = self._position(q), self.all_of @ v
        momentum = pinocchio.computeCentroidalMomentum(self.model, self.data, position, v)
        center = pinocchio.centerOfMass(self.model, self.data, position)
        return numpy.concatenate([center, momentum.linear, momentum.angular])

    def integrated(self, q: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """q ⊞ v, with the signs of quaternions that have a positive last component."""
        moved = pinocchio.integrate(self.model, self._position(q), self.all_of @ v)
        return self.with_signs(self._coordinates(moved, q + self._of_velocities(v)))

    def with_signs(self, q: numpy.ndarray) -> numpy.ndarray:
        """A quaternion and its negative are one orientation: those with a positive last component."""
        parts = numpy.split(q, numpy.cumsum(self.sizes)[:-1])
        turned = [numpy.concatenate([part[:-4], part[-4:] * numpy.copysign(1, part[-1])]) for part in parts]
        return numpy.concatenate([part if len(part) == 1 else signed for part, signed in zip(parts, turned)])

    def _of_velocities(self, v: numpy.ndarray) -> numpy.ndarray:
        """The velocity of each joint of one coordinate, and zero for the coordinates of others."""
        starts = numpy.cumsum([0] + [joint.nv for joint in self.joints])
        return numpy.concatenate([[v[at]] if size == 1 else [0.0] * size for at, size in zip(starts, self.sizes)])

    def difference(self, q: numpy.ndarray, other: numpy.ndarray) -> numpy.ndarray:
        """other ⊟ q; of continuous joints by their angles, which redysim does not take for the same after a turn."""
        found = pinocchio.difference(self.model, self._position(q), self._position(other))[self.order].copy()
        at, start = 0, 0
        for joint, size in zip(self.joints, self.sizes):
            if joint.nq == 2:
                found[at] = other[start] - q[start]
            at, start = at + joint.nv, start + size
        return found

    def frame_points(self, q: numpy.ndarray, v: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
        """The origins of the frames and their velocities, in the axes of the base."""
        pinocchio.forwardKinematics(self.model, self.data, self._position(q), self.all_of @ v)
        pinocchio.updateFramePlacements(self.model, self.data)
        velocities = [pinocchio.getFrameVelocity(self.model, self.data, frame, ALIGNED) for frame in self.frames]
        origins = [self.data.oMf[frame].translation.copy() for frame in self.frames]
        return numpy.array(origins), numpy.array([velocity.linear for velocity in velocities])

    def energy(self, q: numpy.ndarray, v: numpy.ndarray) -> float:
        """Kinetic and potential energy."""
        position, v = self._position(q), self.all_of @ v
        kinetic = pinocchio.computeKineticEnergy(self.model, self.data, position, v)
        return kinetic + pinocchio.computePotentialEnergy(self.model, self.data, position)

    def forces(self, q: numpy.ndarray, v: numpy.ndarray, a: numpy.ndarray, wrenches: numpy.ndarray) -> numpy.ndarray:
        position, v, a = self._position(q), self.all_of @ v, self.all_of @ a
        external = self._external(position, wrenches)
        return self.all_of.T @ pinocchio.rnea(self.model, self.data, position, v, a, external)

    def matrix(self, q: numpy.ndarray) -> numpy.ndarray:
        upper = numpy.triu(pinocchio.crba(self.model, self.data, self._position(q)))
        return self.all_of.T @ (upper + numpy.triu(upper, 1).T) @ self.all_of

    def accelerations(
        self, q: numpy.ndarray, v: numpy.ndarray, tau: numpy.ndarray, wrenches: numpy.ndarray
    ) -> numpy.ndarray:
        """By the recursion over articulated bodies, which takes all joints for free, or by the matrix."""
        if self.mimics:
            rest = self.forces(q, v, numpy.zeros(self.nv), wrenches)
            return numpy.linalg.solve(self.matrix(q), tau - rest)
        position = self._position(q)
        external = self._external(position, wrenches)
        a = pinocchio.aba(self.model, self.data, position, self.all_of @ v, self.all_of @ tau, external)
        return self.all_of.T @ a

    def jacobians(self, q: numpy.ndarray) -> numpy.ndarray:
        """Of each frame, six rows: the origin's velocity, then the angular velocity."""
        pinocchio.computeJointJacobians(self.model, self.data, self._position(q))
        pinocchio.updateFramePlacements(self.model, self.data)
        found = [pinocchio.getFrameJacobian(self.model, self.data, frame, ALIGNED) for frame in self.frames]
        return numpy.array([jacobian @ self.all_of for jacobian in found])

    def bias(self, q: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """J̇ v of each frame, with the derivative of its Jacobian."""
        v = self.all_of @ v
        pinocchio.computeJointJacobiansTimeVariation(self.model, self.data, self._position(q), v)
        pinocchio.updateFramePlacements(self.model, self.data)
        rate = pinocchio.getFrameJacobianTimeVariation
        return numpy.array([rate(self.model, self.data, frame, ALIGNED) @ v for frame in self.frames])
