"""Every function that Pinocchio has, too, on random trees with fixed and floating bases.

Both compute in double precision by recursions that lose a few digits: the tolerance is a part of 1e-10
of the largest number.
"""

import numpy as np
import pinocchio as pin
import pytest
import redysim
from conftest import states
from random_urdf import random_urdf

TOLERANCE = 1e-10
CASES = [(joints, base) for joints in (1, 2, 6, 15) for base in ("fixed", "free")]


def close(ours, theirs):
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    assert ours.shape == theirs.shape
    scale = max(1.0, np.abs(theirs).max())
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=TOLERANCE * scale)


class Pair:
    """A robot in both programs. Pinocchio orders joints by name within a branch: `q` and `v` take its
    vectors to the model's order."""

    def __init__(self, tmp_path, joints, base):
        rng = np.random.default_rng([joints, len(base)])
        path = tmp_path / "robot.urdf"
        path.write_text(random_urdf(rng, joints))
        self.robot = redysim.load(path, base=base)
        self.model = pin.buildModelFromUrdf(str(path), *([pin.JointModelFreeFlyer()] if base == "free" else []))
        self.data = self.model.createData()
        names = [name if name in self.model.names else "root_joint" for name in self.robot.joint_names]
        joints = [self.model.joints[self.model.getJointId(name)] for name in names]
        self.q = np.concatenate([np.arange(joint.idx_q, joint.idx_q + joint.nq) for joint in joints])
        self.v = np.concatenate([np.arange(joint.idx_v, joint.idx_v + joint.nv) for joint in joints])
        self.states = states(self.robot, rng)

    def theirs(self):
        """The state in Pinocchio's order."""
        q, v, a = np.empty(self.model.nq), np.empty(self.model.nv), np.empty(self.model.nv)
        q[self.q], v[self.v], a[self.v] = self.states
        return q, v, a


@pytest.fixture(params=CASES, ids=lambda case: f"{case[0]}-{case[1]}")
def pair(request, tmp_path):
    return Pair(tmp_path, *request.param)


def test_joint_forces_are_those_of_pinocchio(pair):
    (q, v, a), (pq, pv, pa) = pair.states, pair.theirs()
    close(pair.robot.inverse_dynamics(q, v, a), pin.rnea(pair.model, pair.data, pq, pv, pa)[pair.v])
    close(pair.robot.bias_forces(q, v), pin.nonLinearEffects(pair.model, pair.data, pq, pv)[pair.v])
    close(pair.robot.gravity_forces(q), pin.computeGeneralizedGravity(pair.model, pair.data, pq)[pair.v])
    coriolis = pin.computeCoriolisMatrix(pair.model, pair.data, pq, pv)
    close(pair.robot.coriolis_matrix(q, v) @ v, (coriolis @ pv)[pair.v])
    close(pair.robot.passive_forces(q, v), np.zeros(pair.robot.nv))


def test_accelerations_are_those_of_pinocchio(pair):
    (q, v, tau), (pq, pv, ptau) = pair.states, pair.theirs()
    close(pair.robot.forward_dynamics(q, v, tau), pin.aba(pair.model, pair.data, pq, pv, ptau)[pair.v])


def test_the_mass_matrix_is_that_of_pinocchio(pair):
    matrix = pin.crba(pair.model, pair.data, pair.theirs()[0])
    matrix = np.triu(matrix) + np.triu(matrix, 1).T
    close(pair.robot.mass_matrix(pair.states[0]), matrix[np.ix_(pair.v, pair.v)])


def test_energy_and_momentum_are_those_of_pinocchio(pair):
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    energy = pair.robot.energy(q, v)
    close(energy.kinetic, pin.computeKineticEnergy(pair.model, pair.data, pq, pv))
    # What is fixed to the ground has a potential, too, which Pinocchio leaves out.
    neutral = pair.robot.neutral()
    other = np.empty(pair.model.nq)
    other[pair.q] = neutral
    difference = pin.computePotentialEnergy(pair.model, pair.data, pq) - pin.computePotentialEnergy(
        pair.model, pair.data, other
    )
    close(energy.potential - pair.robot.energy(neutral, v).potential, difference)
    momentum = pair.robot.momentum(q, v)
    theirs = pin.computeCentroidalMomentum(pair.model, pair.data, pq, pv)
    close(momentum.linear, theirs.linear)
    close(momentum.angular, theirs.angular)


def test_links_move_as_those_of_pinocchio(pair):
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    pin.forwardKinematics(pair.model, pair.data, pq, pv)
    links = pair.robot.link_kinematics(q, v)
    for index, name in enumerate(pair.robot.link_names):
        frame = pair.model.getFrameId(name)
        placement = pin.updateFramePlacement(pair.model, pair.data, frame)
        twist = pin.getFrameVelocity(pair.model, pair.data, frame, pin.LOCAL_WORLD_ALIGNED)
        close(links.rotation[index], placement.rotation)
        close(links.origin[index], placement.translation)
        close(links.velocity[index], twist.linear)
        close(links.angular_velocity[index], twist.angular)


def test_the_centre_of_mass_is_that_of_pinocchio(tmp_path):
    # Of a floating robot, since Pinocchio leaves out what is fixed to the ground.
    pair = Pair(tmp_path, 6, "free")
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    center = pair.robot.center_of_mass(q, v)
    close(center.position, pin.centerOfMass(pair.model, pair.data, pq, pv))
    close(center.velocity, pair.data.vcom[0])


def test_coordinates_and_displacements_are_those_of_pinocchio(pair):
    (q, dv, _), (pq, pdv, _) = pair.states, pair.theirs()
    theirs = pin.integrate(pair.model, pq, pdv)
    ours = pair.robot.integrate(q, dv)
    close(ours, theirs[pair.q])
    close(pair.robot.difference(q, ours), pin.difference(pair.model, pq, theirs)[pair.v])
    close(pair.robot.neutral(), pin.neutral(pair.model)[pair.q])
    step = 1e-7
    rates = (pair.robot.integrate(q, step * dv) - pair.robot.integrate(q, -step * dv)) / (2 * step)
    np.testing.assert_allclose(pair.robot.coordinate_rates(q, dv), rates, atol=1e-8)


def test_many_states_are_those_of_pinocchio(tmp_path, rng):
    pair = Pair(tmp_path, 6, "fixed")
    q, v, a = states(pair.robot, rng, (1000,))
    tau = pair.robot.inverse_dynamics(q, v, a)
    order = np.argsort(pair.v)
    theirs = [pin.rnea(pair.model, pair.data, *(x[order] for x in state))[pair.v] for state in zip(q, v, a)]
    close(tau, np.array(theirs))
