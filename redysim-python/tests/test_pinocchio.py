"""Every function of a tree and its frames that Pinocchio has, too, on random trees with fixed and floating bases.

Both compute in double precision by recursions that lose a few digits: the tolerance is a part of 1e-10
of the largest number.
"""

import numpy as np
import pinocchio as pin
import pytest
import redysim
from conftest import states
from random_urdf import inertia, random_urdf

TOLERANCE = 1e-10
CASES = [
    *((joints, base, False) for joints in (1, 2, 6, 15) for base in ("fixed", "free")),
    (15, "free", True),
]


def close(ours, theirs):
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    assert ours.shape == theirs.shape
    scale = max(1.0, np.abs(theirs).max(initial=0.0))
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=TOLERANCE * scale)


class Pair:
    """A robot in both programs. Pinocchio orders joints by name within a branch, and has the cosine and the sine of the
    angle of a joint without limits: `coordinates` and `velocities` take vectors to its order, and `v` back."""

    def __init__(self, robot, model, rng):
        self.robot, self.model, self.data = robot, model, model.createData()
        names = [name if name in model.names else "root_joint" for name in robot.joint_names]
        self.joints = [model.joints[model.getJointId(name)] for name in names]
        self.v = np.concatenate([np.arange(joint.idx_v, joint.idx_v + joint.nv) for joint in self.joints])
        self.states = states(robot, rng)

    @staticmethod
    def of_urdf(tmp_path, joints, base, compiled=False):
        """A random tree, with two frames of interest."""
        rng = np.random.default_rng([joints, len(base)])
        path = tmp_path / "robot.urdf"
        path.write_text(random_urdf(rng, joints))
        model = pin.buildModelFromUrdf(str(path), *([pin.JointModelFreeFlyer()] if base == "free" else []))
        text = redysim.load(path, base=base).to_toml()
        for index in range(2):
            link, xyz, rpy = f"link{rng.integers(1, joints + 1)}", rng.uniform(-1, 1, 3), rng.uniform(-3, 3, 3)
            text += f'[[frame]]\nname = "frame{index}"\nlink = "{link}"\n'
            text += f"origin = {{ xyz = {xyz.tolist()}, rpy = {rpy.tolist()} }}\n"
            of_link = model.frames[model.getFrameId(link)]
            place = of_link.placement * pin.SE3(pin.rpy.rpyToMatrix(rpy), xyz)
            model.addFrame(pin.Frame(f"frame{index}", of_link.parentJoint, place, pin.OP_FRAME))
        with_frames = tmp_path / "robot.toml"
        with_frames.write_text(text)
        robot = redysim.load(with_frames)
        return Pair(robot.compile() if compiled else robot, model, rng)

    def coordinates(self, q):
        """Coordinates in Pinocchio's order."""
        theirs, first = np.empty(self.model.nq), 0
        for joint in self.joints:
            is_angle = joint.nq == 2
            count = 1 if is_angle else joint.nq
            own = q[first : first + count]
            first += count
            theirs[joint.idx_q : joint.idx_q + joint.nq] = [np.cos(own[0]), np.sin(own[0])] if is_angle else own
        return theirs

    def velocities(self, v):
        """Velocities in Pinocchio's order."""
        theirs = np.empty(self.model.nv)
        theirs[self.v] = v
        return theirs

    def theirs(self):
        """The state in Pinocchio's order."""
        q, v, a = self.states
        return self.coordinates(q), self.velocities(v), self.velocities(a)

    def frames(self):
        """The frames of interest of Pinocchio."""
        return [self.model.getFrameId(name) for name in self.robot.frame_names]


@pytest.fixture(params=CASES, ids=lambda case: f"{case[0]}-{case[1]}{'-compiled' * case[2]}")
def pair(request, tmp_path):
    return Pair.of_urdf(tmp_path, *request.param)


def test_joint_forces_are_those_of_pinocchio(pair):
    (q, v, a), (pq, pv, pa) = pair.states, pair.theirs()
    close(pair.robot.inverse_dynamics(q, v, a), pin.rnea(pair.model, pair.data, pq, pv, pa)[pair.v])
    close(pair.robot.bias_forces(q, v), pin.nonLinearEffects(pair.model, pair.data, pq, pv)[pair.v])
    close(pair.robot.gravity_forces(q), pin.computeGeneralizedGravity(pair.model, pair.data, pq)[pair.v])
    coriolis = pin.computeCoriolisMatrix(pair.model, pair.data, pq, pv)
    close(pair.robot.coriolis_matrix(q, v) @ v, (coriolis @ pv)[pair.v])
    close(pair.robot.passive_forces(q, v), np.zeros(pair.robot.nv))
    close(pair.robot.dissipated_power(q, v), 0.0)


def test_accelerations_are_those_of_pinocchio(pair):
    (q, v, tau), (pq, pv, ptau) = pair.states, pair.theirs()
    close(pair.robot.forward_dynamics(q, v, tau), pin.aba(pair.model, pair.data, pq, pv, ptau)[pair.v])


def test_the_mass_matrix_is_that_of_pinocchio(pair):
    matrix = pin.crba(pair.model, pair.data, pair.theirs()[0])
    matrix = np.triu(matrix) + np.triu(matrix, 1).T
    close(pair.robot.mass_matrix(pair.states[0]), matrix[np.ix_(pair.v, pair.v)])


def test_coordinates_and_displacements_are_those_of_pinocchio(pair):
    (q, dv, _), (pq, pdv, _) = pair.states, pair.theirs()
    theirs = pin.integrate(pair.model, pq, pdv)
    ours = pair.robot.integrate(q, dv)
    close(pair.coordinates(ours), theirs)
    close(pair.robot.difference(q, ours), pin.difference(pair.model, pq, theirs)[pair.v])
    close(pair.coordinates(pair.robot.neutral()), pin.neutral(pair.model))
    step = 1e-7
    rates = (pair.robot.integrate(q, step * dv) - pair.robot.integrate(q, -step * dv)) / (2 * step)
    np.testing.assert_allclose(pair.robot.coordinate_rates(q, dv), rates, atol=1e-8)


def test_energy_and_momentum_are_those_of_pinocchio(pair):
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    energy = pair.robot.energy(q, v)
    close(energy.kinetic, pin.computeKineticEnergy(pair.model, pair.data, pq, pv))
    # What is fixed to the ground has a potential, too, which Pinocchio leaves out.
    neutral = pair.robot.neutral()
    difference = pin.computePotentialEnergy(pair.model, pair.data, pq) - pin.computePotentialEnergy(
        pair.model, pair.data, pair.coordinates(neutral)
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


def test_frames_move_as_those_of_pinocchio(pair):
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    # Without accelerations of the joints.
    pin.forwardKinematics(pair.model, pair.data, pq, pv, np.zeros(pair.model.nv))
    found, bias = pair.robot.frame_kinematics(q, v), pair.robot.frame_bias(q, v)
    for index, frame in enumerate(pair.frames()):
        placement = pin.updateFramePlacement(pair.model, pair.data, frame)
        twist = pin.getFrameVelocity(pair.model, pair.data, frame, pin.LOCAL_WORLD_ALIGNED)
        close(found.rotation[index], placement.rotation)
        close(found.origin[index], placement.translation)
        close(found.velocity[index], twist.linear)
        close(found.angular_velocity[index], twist.angular)
        acceleration = pin.getFrameClassicalAcceleration(pair.model, pair.data, frame, pin.LOCAL_WORLD_ALIGNED)
        close(bias.linear[index], acceleration.linear)
        close(bias.angular[index], acceleration.angular)


def test_jacobians_of_frames_and_joint_forces_of_wrenches_are_those_of_pinocchio(pair, rng):
    q, pq = pair.states[0], pair.theirs()[0]
    wrenches = rng.normal(size=(pair.robot.nf, 6))
    found = pair.robot.frame_jacobians(q)
    forces = np.zeros(pair.robot.nv)
    for index, frame in enumerate(pair.frames()):
        jacobian = pin.computeFrameJacobian(pair.model, pair.data, pq, frame, pin.LOCAL_WORLD_ALIGNED)
        # A matrix of one column comes as a vector.
        jacobian = jacobian.reshape(6, -1)[:, pair.v]
        close(found.linear[index], jacobian[:3])
        close(found.angular[index], jacobian[3:])
        forces += jacobian.T @ wrenches[index]
    close(pair.robot.frame_forces(q, wrenches), forces)


def test_the_centre_of_mass_is_that_of_pinocchio(tmp_path):
    # Of a floating robot, since Pinocchio leaves out what is fixed to the ground.
    pair = Pair.of_urdf(tmp_path, 6, "free")
    (q, v, _), (pq, pv, _) = pair.states, pair.theirs()
    center = pair.robot.center_of_mass(q, v)
    close(center.position, pin.centerOfMass(pair.model, pair.data, pq, pv))
    close(center.velocity, pair.data.vcom[0])


def test_spherical_joints_are_those_of_pinocchio(tmp_path, rng):
    # URDF does not support spherical joints.
    model, parent, text = pin.Model(), 0, 'name = "balls"\ngravity = [0, 0, -9.81]\n'
    for index, kind in enumerate(["spherical", "revolute", "spherical"]):
        xyz, rpy, axis, com = rng.uniform(-1, 1, (4, 3))
        axis, mass, i = axis / np.linalg.norm(axis), rng.uniform(0.5, 3), inertia(rng)
        joint = pin.JointModelSpherical() if kind == "spherical" else pin.JointModelRevoluteUnaligned(axis)
        text += f"""[[link]]
name = "link{index}"
parent = {f'"link{index - 1}"' if index else '"base"'}
joint = "{kind}"
{f"axis = {axis.tolist()}" if kind == "revolute" else ""}
origin = {{ xyz = {xyz.tolist()}, rpy = {rpy.tolist()} }}
mass = {float(mass)!r}
com = {com.tolist()}
inertia = {{ {", ".join(f"{name} = {float(i[row]):.17g}" for name, row in ELEMENTS)} }}
"""
        parent = model.addJoint(parent, joint, pin.SE3(pin.rpy.rpyToMatrix(rpy), xyz), f"link{index}")
        model.appendBodyToJoint(parent, pin.Inertia(mass, com, i), pin.SE3.Identity())
    path = tmp_path / "balls.toml"
    path.write_text(text)
    robot = redysim.load(path)
    assert (robot.nq, robot.nv) == (9, 7)
    pair = Pair(robot, model, rng)
    test_joint_forces_are_those_of_pinocchio(pair)
    test_accelerations_are_those_of_pinocchio(pair)
    test_the_mass_matrix_is_that_of_pinocchio(pair)
    test_coordinates_and_displacements_are_those_of_pinocchio(pair)


ELEMENTS = [("xx", (0, 0)), ("yy", (1, 1)), ("zz", (2, 2)), ("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))]


def test_every_kind_of_joint_of_the_random_trees_is_compared(tmp_path):
    rng = np.random.default_rng([15, len("free")])
    text = random_urdf(rng, 15)
    for kind in ("revolute", "prismatic", "continuous", "fixed"):
        assert f'type="{kind}"' in text, kind


def test_many_states_are_those_of_pinocchio(tmp_path, rng):
    pair = Pair.of_urdf(tmp_path, 6, "fixed")
    q, v, a = states(pair.robot, rng, (1000,))
    tau = pair.robot.inverse_dynamics(q, v, a)
    theirs = [
        pin.rnea(pair.model, pair.data, pair.coordinates(x), pair.velocities(y), pair.velocities(z))[pair.v]
        for x, y, z in zip(q, v, a)
    ]
    close(tau, np.array(theirs))
