"""Published robots with rotors, dampers and springs in their joints, beside MuJoCo.

MuJoCo reads the same URDF, without pictures and shapes. What acts in a joint is in proportion to what resists it at zero, so that
all of it counts: a rotor of half as much, and a damper and a spring of random sizes. Friction is left out: MuJoCo's sticks.

Joints that mimic others are free in MuJoCo's robot. The velocities of all its joints are G v, where v are redysim's, so that joint
forces are Gᵀ τ and the mass matrix is Gᵀ M G; accelerations follow from both.
"""

import os
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy
from comparison import STATES, TOLERANCE, Failed, answers, furthest, furthest_matrix
from extras import with_keys
from mimics import Mimic, of_model, resolved
from peer import Refused
from robot import example_robots, robots, run_import, without_resistance

COMPILER = {"fusestatic": "false", "balanceinertia": "false"}


@dataclass
class Physics:
    """What acts in the joints, a number for each."""

    armature: numpy.ndarray
    damping: numpy.ndarray
    stiffness: numpy.ndarray
    rest: numpy.ndarray

    @classmethod
    def random(cls, resisting: numpy.ndarray, random: numpy.random.Generator) -> "Physics":
        share = lambda: resisting * random.uniform(0.2, 1, len(resisting))
        return cls(0.5 * resisting, 5 * share(), 30 * share(), random.uniform(-1, 1, len(resisting)))

    def keys(self, joint: int) -> dict[str, float]:
        """Of a link in a model file."""
        return {key: values[joint] for key, values in vars(self).items()}


class Simulator:
    """MuJoCo's robot; vectors are in the order of `joints`, and of what acts in the joints in that of `joints` and `mimics`."""

    def __init__(self, urdf: Path, joints: list[str], mimics: dict[str, Mimic]):
        try:
            self.model = mujoco.MjModel.from_xml_string(self._without_shapes(urdf))
        except ValueError as error:
            raise Refused(f"MuJoCo does not take it: {str(error).splitlines()[0].removeprefix('Error: ')}") from error
        names = [*joints, *mimics]
        if self.model.nv != len(names):
            raise Refused(f"MuJoCo has {self.model.nv} velocities, redysim {len(joints)} and {len(mimics)} that mimic")
        # Of all joints: coordinates G q + offsets.
        self.of_all = numpy.zeros((len(names), len(joints)))
        self.of_all[: len(joints)] = numpy.eye(len(joints))
        self.offsets = numpy.zeros(len(names))
        for index, mimic in enumerate(mimics.values(), len(joints)):
            self.of_all[index, joints.index(mimic.joint)] = mimic.multiplier
            self.offsets[index] = mimic.offset
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        self.data = mujoco.MjData(self.model)
        self.joints = [self.model.joint(name).id for name in names]
        self.order = [int(self.model.jnt_dofadr[joint]) for joint in self.joints]
        self.act(Physics(*(numpy.zeros(len(names)) for _ in range(4))))

    @staticmethod
    def _without_shapes(urdf: Path) -> str:
        robot = ElementTree.parse(urdf).getroot()
        for link in robot.iter("link"):
            for shape in link.findall("visual") + link.findall("collision"):
                link.remove(shape)
        for own in robot.findall("mujoco"):
            robot.remove(own)
        ElementTree.SubElement(ElementTree.SubElement(robot, "mujoco"), "compiler", COMPILER)
        return ElementTree.tostring(robot, encoding="unicode")

    def act(self, physics: Physics) -> None:
        """Has this and nothing else act in the joints."""
        model, dofs, joints = self.model, self.order, self.joints
        model.dof_armature[dofs], model.dof_damping[dofs] = physics.armature, physics.damping
        model.jnt_stiffness[joints] = physics.stiffness
        model.qpos_spring[dofs] = physics.rest
        model.dof_frictionloss[:] = 0

    def resisting(self) -> numpy.ndarray:
        """What resists each joint at zero by itself, of those that mimic, too."""
        return numpy.diag(self._matrix_of_all(numpy.zeros(self.of_all.shape[1])))

    def matrix(self, q: numpy.ndarray) -> numpy.ndarray:
        return self.of_all.T @ self._matrix_of_all(q) @ self.of_all

    def forces(self, q: numpy.ndarray, v: numpy.ndarray, a: numpy.ndarray) -> numpy.ndarray:
        # All joints have one coordinate, so that coordinates and velocities have one order.
        data, order = self.data, self.order
        data.qpos[order], data.qvel[order], data.qacc[order] = self._place(q), self.of_all @ v, self.of_all @ a
        mujoco.mj_inverse(self.model, data)
        return self.of_all.T @ data.qfrc_inverse[order]

    def accelerations(self, q: numpy.ndarray, v: numpy.ndarray, tau: numpy.ndarray) -> numpy.ndarray:
        if len(self.order) > len(q):
            return numpy.linalg.solve(self.matrix(q), tau - self.forces(q, v, numpy.zeros(len(q))))
        data, order = self.data, self.order
        data.qpos[order], data.qvel[order], data.qfrc_applied[order] = q, v, tau
        mujoco.mj_forward(self.model, data)
        return data.qacc[order].copy()

    def _place(self, q: numpy.ndarray) -> numpy.ndarray:
        return self.of_all @ q + self.offsets

    def _matrix_of_all(self, q: numpy.ndarray) -> numpy.ndarray:
        self.forces(q, numpy.zeros(len(q)), numpy.zeros(len(q)))
        matrix = numpy.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, matrix)
        return matrix[numpy.ix_(self.order, self.order)]


def row(urdf: Path, model: str, evaluate: Path, file: Path) -> tuple[list[float], int]:
    """Differences of inverse dynamics, mass matrix and forward dynamics, and the number of joints."""
    file.write_text(model)
    joints, _ = answers([evaluate, file], [])
    if 'joint = "free"' in model or 'joint = "planar"' in model:
        raise Refused("joints with several degrees of freedom: not compared here")
    mimics = resolved(of_model(tomllib.loads(model)))
    peer, n, random = Simulator(urdf, joints, mimics), len(joints), numpy.random.default_rng(1)
    physics = Physics.random(peer.resisting(), random)
    peer.act(physics)
    acting = {name: physics.keys(joint) for joint, name in enumerate([*joints, *mimics])}
    file.write_text(with_keys(without_resistance(model), acting))
    motions = [
        (random.uniform(-numpy.pi, numpy.pi, n), random.uniform(-2, 2, n), random.uniform(-5, 5, n))
        for _ in range(STATES)
    ]
    driven = [(q, v, peer.forces(q, v, a)) for q, v, a in motions]
    states = [state for pair in zip(motions, driven) for state in pair]
    lines = [numpy.concatenate([q, v, third, q]) for q, v, third in states]
    _, found = answers([evaluate, file], lines)
    ours = [(line[:n], line[n : n + n * n].reshape(n, n), line[n + n * n : 2 * n + n * n]) for line in found]
    return [
        furthest([forces for forces, *_ in ours[::2]], [tau for *_, tau in driven]),
        furthest_matrix([matrix for _, matrix, _ in ours[::2]], [peer.matrix(q) for q, *_ in motions]),
        furthest([a for *_, a in ours[1::2]], [peer.accelerations(*state) for state in driven]),
    ], n


def main() -> None:
    built, *files = sys.argv[1:]
    programs, folder = Path(built) / "cargo" / "release", Path(built) / "physics"
    folder.mkdir(parents=True, exist_ok=True)
    all_robots = robots([Path(file) for file in files] or example_robots())
    # MuJoCo writes its log into the current folder.
    os.chdir(folder)
    print(f"# Imported robots with rotors, dampers and springs beside MuJoCo {mujoco.__version__}\n")
    print(f"The largest difference at {STATES} random states, as a share of the largest value of the component (of √(M_ii M_jj) for the")
    print("mass matrix), by the generic path; how it is found is in [peers/README.md](../README.md).\n")
    print("| robot | joints | inverse dynamics | mass matrix | forward dynamics | |")
    print("|---|---|---|---|---|---|")
    differ = []
    for robot in all_robots:
        shares, joints, remark = [], "", ""
        try:
            done = run_import(programs / "redysim", robot.urdf, [])
            if done.returncode == 1:
                raise Refused("not imported: see robots.md")
            file = folder / f"{robot.name}.toml"
            shares, joints = row(robot.urdf, done.stdout, programs / "redysim-evaluate", file)
        except (Refused, Failed) as reason:
            remark = str(reason)
        if not all(share < TOLERANCE for share in shares):
            differ.append(robot.title)
        cells = [f"{share:.0e}" for share in shares] or [""] * 3
        print(f"| {robot.title} | {joints} | " + " | ".join(cells) + f" | {remark} |", flush=True)
    if differ:
        sys.exit(f"these differ by more than {TOLERANCE}: {', '.join(differ)}")


main()
