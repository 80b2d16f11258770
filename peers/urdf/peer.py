"""Pinocchio's side: the same URDF, with the same joints free."""

from math import cos, sin
from pathlib import Path

import numpy
import pinocchio


class Refused(Exception):
    """A robot that cannot be compared; the message says why."""


class Peer:
    """Pinocchio's robot with the joints of the given names, and no others, free."""

    def __init__(self, urdf: Path, joints: list[str]):
        try:
            whole = pinocchio.buildModelFromUrdf(str(urdf))
            locked = [index for index, name in enumerate(whole.names) if index > 0 and name not in joints]
            self.model = pinocchio.buildReducedModel(whole, locked, pinocchio.neutral(whole)) if locked else whole
        except (RuntimeError, ValueError) as error:
            raise Refused(f"Pinocchio does not take it: {str(error).splitlines()[0]}") from error
        self.data = self.model.createData()
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in joints]
        self.order = [joint.idx_v for joint in self.joints]
        if self.model.nv != len(joints):
            raise Refused(f"Pinocchio has {self.model.nv} velocities, redysim {len(joints)}")

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

    def forces(self, q: numpy.ndarray, v: numpy.ndarray, a: numpy.ndarray) -> numpy.ndarray:
        position, v, a = self._position(q), self._ordered(v), self._ordered(a)
        return pinocchio.rnea(self.model, self.data, position, v, a)[self.order].copy()

    def matrix(self, q: numpy.ndarray) -> numpy.ndarray:
        upper = numpy.triu(pinocchio.crba(self.model, self.data, self._position(q)))
        return (upper + numpy.triu(upper, 1).T)[numpy.ix_(self.order, self.order)]

    def accelerations(self, q: numpy.ndarray, v: numpy.ndarray, tau: numpy.ndarray) -> numpy.ndarray:
        position, v, tau = self._position(q), self._ordered(v), self._ordered(tau)
        return pinocchio.aba(self.model, self.data, position, v, tau)[self.order].copy()
