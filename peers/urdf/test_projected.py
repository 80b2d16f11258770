"""Tests of the equations in 50 digits: closed forms, and Lagrange's equations by differences."""

import tempfile
import unittest
from decimal import Decimal
from math import cos, sin
from pathlib import Path

from digits import IDENTITY, double, of_quaternion, of_rpy, product, sine_cosine, solution, transposed
from projected import Projected, Unsupported

GRAVITY = [0.0, 0.0, -9.81]
SMALL = Decimal("1e-45")
INERTIA = '<inertia ixx="0.02" ixy="0.003" ixz="-0.001" iyy="0.03" iyz="0.002" izz="0.04"/>'
POINT = '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>'


def link(name: str, mass: float, at: str = "0 0 0", rpy: str = "0 0 0", inertia: str = INERTIA) -> str:
    return f'<link name="{name}"><inertial><origin xyz="{at}" rpy="{rpy}"/><mass value="{mass}"/>{inertia}</inertial></link>'


def joint(
    name: str, kind: str, parent: str, child: str, axis: str = "0 0 1", at: str = "0 0 0", rpy: str = "0 0 0"
) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}<origin xyz="{at}" rpy="{rpy}"/><axis xyz="{axis}"/></joint>'


def model(*links: dict, **more) -> dict:
    return {"gravity": GRAVITY, "link": list(links), **more}


def of_joint(name: str, child: str, **more) -> dict:
    return {"name": child, "parent": "root", "joint": "revolute", "joint_name": name, **more}


FREE = {"name": "root", "parent": "base", "joint": "free", "joint_name": "float"}
A, B, C = (of_joint(name, link) for name, link in [("a", "one"), ("b", "two"), ("c", "three")])
FOLLOWS = {"joint": "a", "multiplier": -0.5, "offset": 0.25}


class Robots(unittest.TestCase):
    def robot(self, text: list[str], joints: list[str], of: dict) -> Projected:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.urdf"
            path.write_text(f'<robot name="test">{"".join(text)}</robot>')
            return Projected(path, joints, of)

    def tree(self, of: dict, joints: list[str]) -> Projected:
        """Two turns and a slide about and along skew axes, the last on a branch; a link fixed to the second."""
        return self.robot(
            [
                link("root", 3, "0.1 0.2 0.3", "0.1 0.2 0.3"),
                link("one", 2, "0.2 -0.1 0.3", "0.3 0 0"),
                link("two", 1, "0.1 0.3 -0.2", "0 0.4 0"),
                link("three", 1.5, "0.3 0.1 0.2", "0 0 0.5"),
                link("tool", 0.5, "0.1 0 0.2", "1 2 3"),
                joint("a", "revolute", "root", "one", "1 2 3", "0.1 0.2 0.3", "0.4 0.5 0.6"),
                joint("b", "continuous", "one", "two", "0 -1 1", "0.3 0.2 0.1", "0.7 -0.4 0.2"),
                joint("c", "prismatic", "one", "three", "2 1 0", "-0.2 0.1 0.4", "-0.3 0.2 0.9"),
                joint("weld", "fixed", "two", "tool", "1 0 0", "0.1 0.2 0.1", "0.5 0.6 0.7"),
            ],
            joints,
            of,
        )

    def assert_near(self, found: list, expected: list, share: Decimal = SMALL) -> None:
        scale = max(abs(Decimal(entry)) for entry in expected)
        for entry, wanted in zip(found, expected, strict=True):
            self.assertLessEqual(abs(entry - Decimal(wanted)), share * scale, (found, expected))

    def test_a_double_pendulum_has_the_forces_of_the_closed_form(self):
        # Point masses at the ends of bars along x, which turn about y: down is positive.
        text = [link("root", 1), link("one", 2, "0.5 0 0", inertia=POINT), link("two", 3, "0.25 0 0", inertia=POINT)]
        text += [
            joint("a", "revolute", "root", "one", "0 1 0"),
            joint("b", "revolute", "one", "two", "0 1 0", "0.5 0 0"),
        ]
        robot = self.robot(text, ["a", "b"], model(A, B))
        q, v, a = [0.3, -0.7], [1.25, -2.5], [0.75, 1.5]
        (m1, m2), (l1, l2), g = (2.0, 3.0), (0.5, 0.25), 9.81
        (v1, v2), (a1, a2), turn = v, a, q[0] + q[1]
        coupling = m2 * l1 * l2
        second = (m2 * l2**2 + coupling * cos(q[1])) * a1 + m2 * l2**2 * a2 + coupling * sin(q[1]) * v1**2
        second -= m2 * g * l2 * cos(turn)
        first = (m1 + m2) * l1**2 * a1 + coupling * cos(q[1]) * (a1 + a2) - coupling * sin(q[1]) * (v1 + v2) ** 2
        first += second - (m1 + m2) * g * l1 * cos(q[0])
        self.assert_near(robot.forces(q, v, a, []), [first, second], Decimal("1e-14"))

    def test_a_slide_on_a_turn_has_coriolis_and_centrifugal_force(self):
        text = [link("root", 1), link("one", 1, inertia=POINT), link("two", 2, inertia=POINT)]
        text += [joint("a", "revolute", "root", "one"), joint("c", "prismatic", "one", "two", "1 0 0")]
        robot = self.robot(text, ["a", "c"], model(A, B))
        # m (r² θ" + 2 r r' θ') and m (r" − r θ'²).
        found = robot.forces([0.5, 0.75], [2.0, 3.0], [4.0, 5.0], [])
        self.assert_near(found, [2 * (0.75**2 * 4 + 2 * 0.75 * 3 * 2), 2 * (5 - 0.75 * 4)])

    def test_a_free_body_obeys_euler_and_newton_in_its_own_axes(self):
        inertia = '<inertia ixx="2" ixy="0" ixz="0" iyy="3" iyz="0" izz="4"/>'
        frame = {"name": "tip", "link": "root", "origin": {"xyz": [0.5, 0.25, 0.0], "rpy": [0.3, 0.2, 0.1]}}
        robot = self.robot([link("root", 5, inertia=inertia)], ["float"], model(FREE, frame=[frame]))
        q, v, a = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 2.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.5, 0.25, 0.75, 1.0, 2.0, 3.0]
        moments = [2 * 1 + (4 - 3) * 5 * 6, 3 * 2 + (2 - 4) * 6 * 4, 4 * 3 + (3 - 2) * 4 * 5]
        # v' + ω × v.
        linear = [0.5 + 5 * 3 - 6 * 2, 0.25 + 6 * 1 - 4 * 3, 0.75 + 4 * 2 - 5 * 1]
        forces = [5 * Decimal(linear[0]), 5 * Decimal(linear[1]), 5 * (Decimal(linear[2]) + Decimal(9.81))]
        self.assert_near(robot.forces(q, v, a, [0.0] * 6), forces + moments)
        # A wrench at a frame: its force, and its moment with the force's about the origin.
        wrench = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]
        turning = [8 + 0.25 * 4, 16 - 0.5 * 4, 32 + 0.5 * 2 - 0.25 * 1]
        differences = [forces[i] - Decimal(wrench[i]) for i in range(3)] + [moments[i] - turning[i] for i in range(3)]
        self.assert_near(robot.forces(q, v, a, wrench), differences)

    def test_an_inertia_is_in_the_axes_that_the_urdf_gives(self):
        # A quarter turn about z makes x of the inertia y of the link.
        given, turned = (f'<inertia ixx="{x}" ixy="0" ixz="0" iyy="{y}" iyz="0" izz="4"/>' for x, y in [(2, 3), (3, 2)])
        quarter = "0 0 1.5707963267948966"
        robots = [link("root", 5, rpy=quarter, inertia=given), link("root", 5, inertia=turned)]
        state = [0.0] * 6 + [1.0], [0.5, -1.0, 2.0, 1.5, -0.5, 0.25], [1.0, 2.0, -3.0, 4.0, 0.5, -1.5], []
        one, other = (self.robot([text], ["float"], model(FREE)).forces(*state) for text in robots)
        self.assert_near(one, other, Decimal("1e-16"))

    def test_gyroscopic_forces_are_those_of_the_mass_matrix_by_lagrange(self):
        robot = self.tree(model(A, B, C), ["a", "b", "c"])
        q, v = [Decimal(x) for x in (0.3, -0.8, 0.2)], [Decimal(x) for x in (1.5, -2.0, 0.7)]
        none = [Decimal(0)] * 3
        unit = [[Decimal(i == j) for j in range(3)] for i in range(3)]

        def matrix(at: list[Decimal]) -> list[list[Decimal]]:
            rest = robot.forces(at, none, none, [])
            return [[x - r for x, r in zip(robot.forces(at, none, one, []), rest)] for one in unit]

        step = Decimal("1e-16")
        slopes = []
        for one in unit:
            ahead, behind = ([x + side * step * e for x, e in zip(q, one)] for side in [1, -1])
            pairs = zip(matrix(ahead), matrix(behind))
            slopes.append([[(x - y) / (2 * step) for x, y in zip(*rows)] for rows in pairs])
        expected = []
        for k in range(3):
            terms = [(slopes[j][k][i] - slopes[k][i][j] / 2) * v[i] * v[j] for i in range(3) for j in range(3)]
            expected.append(sum(terms))
        moving, still = robot.forces(q, v, none, []), robot.forces(q, none, none, [])
        # The differences are of second order.
        self.assert_near([x - y for x, y in zip(moving, still)], expected, Decimal("1e-30"))

    def test_forces_and_accelerations_are_inverse(self):
        frame = {"name": "tip", "link": "three", "origin": {"xyz": [0.1, 0.2, 0.3], "rpy": [0.0, 0.0, 0.0]}}
        robot = self.tree(model(FREE, A, B, C, frame=[frame]), ["float", "a", "b", "c"])
        q = [0.1, 0.2, 0.3, 0.5, -0.5, 0.1, 0.7, 0.3, -0.8, 0.2]
        v, a = [0.5, -1.0, 2.0, 1.5, -0.5, 0.25, 1.0, -2.0, 3.0], [1.0, 2.0, -3.0, 4.0, 0.5, -1.5, 2.5, 3.5, -4.5]
        wrench = [1.0, -2.0, 3.0, 0.5, 0.25, -0.75]
        tau = robot.forces(q, v, a, wrench)
        self.assert_near(robot.accelerations(q, v, tau, wrench), a, Decimal("1e-44"))

    def test_a_free_base_that_does_not_move_carries_a_fixed_one(self):
        fixed, floating = (
            self.tree(model(A, B, C), ["a", "b", "c"]),
            self.tree(model(FREE, A, B, C), ["float", "a", "b", "c"]),
        )
        q, v, a = [0.3, -0.8, 0.2], [1.5, -2.0, 0.7], [0.5, 0.25, -0.75]
        at_origin = [0.0] * 6 + [1.0]
        found = floating.forces(at_origin + q, [0.0] * 6 + v, [0.0] * 6 + a, [])
        self.assert_near(found[6:], fixed.forces(q, v, a, []))

    def test_a_joint_that_mimics_moves_with_the_one_that_it_follows(self):
        free = self.tree(model(A, B, C), ["a", "b", "c"])
        coupled = self.tree(model(A, {**B, "mimic": FOLLOWS, "armature": 0.5}, C), ["a", "c"])
        q, v, a = [0.3, 0.2], [1.5, 0.7], [0.5, -0.75]
        tau = free.forces([q[0], -0.5 * q[0] + 0.25, q[1]], [v[0], -0.5 * v[0], v[1]], [a[0], -0.5 * a[0], a[1]], [])
        tau[1] += Decimal(0.5 * -0.5 * a[0])
        self.assert_near(coupled.forces(q, v, a, []), [tau[0] - tau[1] / 2, tau[2]], Decimal("1e-15"))

    def test_a_joint_without_coordinate_is_held_at_zero(self):
        q, v, a = [0.3, -0.8, 0.0], [1.5, -2.0, 0.0], [0.5, 0.25, 0.0]
        whole = self.tree(model(A, B, C), ["a", "b", "c"]).forces(q, v, a, [])
        held = self.tree(model(A, B), ["a", "b"]).forces(q[:2], v[:2], a[:2], [])
        self.assert_near(held, whole[:2])

    def test_joints_of_other_kinds_are_refused(self):
        text = [link("root", 1), link("one", 1), joint("a", "planar", "root", "one")]
        with self.assertRaises(Unsupported):
            self.robot(text, ["a"], model(A)).forces([0.1], [0.2], [0.3], [])


class Digits(unittest.TestCase):
    def test_sine_and_cosine_have_50_digits(self):
        sine, cosine = sine_cosine(Decimal(1))
        self.assertLess(abs(sine - Decimal("0.84147098480789650665250232163029899962256306079837")), SMALL)
        self.assertLess(abs(cosine - Decimal("0.54030230586813971740093660744297660373231042061792")), SMALL)
        for angle in [0.0, 1e-30, -3.0, 22.0, -50.0]:
            sine, cosine = sine_cosine(Decimal(angle))
            self.assertAlmostEqual(float(sine), sin(angle), delta=1e-16)
            self.assertAlmostEqual(float(cosine), cos(angle), delta=1e-16)
            self.assertLess(abs(sine * sine + cosine * cosine - 1), SMALL)

    def test_rotations_are_orthogonal_and_turn_as_a_urdf_says(self):
        quaternion = of_quaternion([Decimal(x) for x in (0.1, -0.2, 0.3, 2.0)])
        for rotation in [quaternion, of_rpy((Decimal("0.3"), Decimal("-0.5"), Decimal("0.7")))]:
            for row, wanted in zip(product(rotation, transposed(rotation)), IDENTITY):
                for entry, one in zip(row, wanted):
                    self.assertLess(abs(entry - one), SMALL)
        # Yaw is applied last, so that the first column lies where yaw and pitch alone take x.
        rotation = of_rpy((Decimal("0.3"), Decimal("-0.5"), Decimal("0.7")))
        for row, wanted in zip(rotation, [cos(0.7) * cos(0.5), sin(0.7) * cos(0.5), sin(0.5)]):
            self.assertAlmostEqual(float(row[0]), wanted, delta=1e-15)

    def test_equations_are_solved_to_all_digits_that_their_condition_leaves(self):
        # Hilbert's matrix, of condition 1e10; the sums of the rows of its inverse are integers.
        size = 8
        rows = [[1 / Decimal(i + j + 1) for j in range(size)] for i in range(size)]
        expected = [-8, 504, -7560, 46200, -138600, 216216, -168168, 51480]
        for entry, wanted in zip(solution(rows, [Decimal(1)] * size), expected):
            self.assertLess(abs(entry - wanted), Decimal("1e-33"))
        self.assertEqual(
            solution([[Decimal(0), Decimal(2)], [Decimal(4), Decimal(0)]], [Decimal(2), Decimal(8)]), [2, 1]
        )

    def test_a_double_is_taken_as_it_is(self):
        self.assertEqual(double("0.1"), Decimal("0.1000000000000000055511151231257827021181583404541015625"))


if __name__ == "__main__":
    unittest.main()
