"""Tests of robots that are made from imported models: the same places, axes and inertias in frames whose axes are z."""

import unittest
from math import pi

import imported
import robots

HALF = 3.0**0.5 / 2
MODEL = {
    "gravity": [0.0, 0.0, -9.81],
    "link": [
        {"name": "root", "parent": "base", "joint": "free", "origin": {}, "mass": 9.0, "com": [1.0, 2.0, 3.0],
         "inertia": {"xx": 4.0, "yy": 5.0, "zz": 6.0, "xy": 0.1, "xz": 0.2, "yz": 0.3}},
        # In its own frame the axis is x, which the quarter turn about z makes the root's y.
        {"name": "arm", "parent": "root", "joint": "revolute", "axis": [1.0, 0.0, 0.0], "mass": 2.0,
         "origin": {"xyz": [0.5, 0.25, 0.125], "rpy": [0.0, 0.0, "90 deg"]}, "com": [1.0, 2.0, 3.0],
         "inertia": {"xx": 4.0, "yy": 5.0, "zz": 6.0, "xy": 0.1, "xz": 0.2, "yz": 0.3}},
        # 0.7 m along the arm's z axis, which is the root's. The axis is −y, after a turn by 30° about x.
        {"name": "hand", "parent": "arm", "joint": "revolute", "axis": [0.0, -1.0, 0.0], "mass": 1.0,
         "origin": {"xyz": [0.0, 0.0, 0.7], "rpy": ["30 deg", 0.0, 0.0]}, "com": [0.0, 0.0, 0.0],
         "inertia": {"xx": 1.0, "yy": 2.0, "zz": 3.0}},
    ],
}  # fmt: skip


class Imported(unittest.TestCase):
    def setUp(self):
        self.robot = imported.robot("test", MODEL)

    def assert_near(self, found: list[float], expected: list[float]) -> None:
        for entry, wanted in zip(found, expected, strict=True):
            self.assertAlmostEqual(entry, wanted, delta=1e-15)

    def test_a_root_stays_as_it_is(self):
        root = self.robot.links[0]
        self.assertTrue(root.free)
        self.assertEqual((root.rotation, root.com), (imported.IDENTITY, [1.0, 2.0, 3.0]))
        self.assertEqual(root.inertia, [4.0, 0.1, 0.2, 5.0, 0.3, 6.0])
        self.assertEqual((self.robot.nq, self.robot.nv), (9, 8))

    def test_a_quarter_turn_has_entries_0_and_1_alone(self):
        entries = {abs(entry) for row in self.robot.links[1].rotation for entry in row}
        self.assertEqual(entries, {0.0, 1.0})

    def test_every_axis_is_where_it_was(self):
        arm, hand = self.robot.links[1:]
        self.assert_near([row[2] for row in arm.rotation], [0.0, 1.0, 0.0])
        self.assert_near(arm.position, [0.5, 0.25, 0.125])
        # In the root: from the arm's x, y, z, which are the root's y, −x, z.
        whole = imported._product(arm.rotation, hand.rotation)
        self.assert_near([row[2] for row in whole], [HALF, 0.0, -0.5])
        self.assert_near(imported._applied(arm.rotation, hand.position), [0.0, 0.0, 0.7])

    def test_a_link_is_where_it_was_and_turns_as_hard(self):
        arm = self.robot.links[1]
        self.assert_near(imported._applied(arm.rotation, arm.com), [-2.0, 1.0, 3.0])
        # About the axis: Ixx of the model.
        self.assert_near([arm.inertia[5]], [4.0])
        xx, xy, xz, yy, yz, zz = arm.inertia
        turned = imported._product([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], imported._transposed(arm.rotation))
        turned = imported._product(arm.rotation, turned)
        # By the quarter turn: x is y, y is −x.
        self.assert_near(sum(turned, []), [5.0, -0.1, -0.3, -0.1, 4.0, 0.2, -0.3, 0.2, 6.0])

    def test_links_come_depth_first(self):
        def link(name: str, parent: str) -> str:
            return f'\n[[link]]\nname = "{name}"\nparent = "{parent}"\n'

        pairs = [("root", "base"), ("a", "root"), ("b", "root"), ("a1", "a"), ("b1", "b"), ("a2", "a1")]
        ordered = [("root", "base"), ("a", "root"), ("a1", "a"), ("a2", "a1"), ("b", "root"), ("b1", "b")]
        model = 'name = "test"\n' + "".join(link(*pair) for pair in pairs)
        self.assertEqual(imported._depth_first(model), 'name = "test"\n' + "".join(link(*pair) for pair in ordered))

    def test_what_no_program_takes_alike_is_refused(self):
        root, arm, _ = MODEL["link"]
        for links in [[{**root, "joint": "revolute"}], [root, {**arm, "joint": "prismatic"}],
                      [{**root, "origin": {"xyz": [0.0, 0.0, 1.0]}}]]:  # fmt: skip
            with self.assertRaises(ValueError):
                imported.robot("test", {**MODEL, "link": links})


class Files(unittest.TestCase):
    def test_angles_of_a_urdf_turn_as_the_rotation_does(self):
        for rpy in [[0.3, -0.5, 0.7], [0.3, pi / 2, 0.7], [0.0, -pi / 2, 0.0], [3.0, 0.2, -3.0]]:
            rotation = imported._snapped(imported._rotation(rpy))
            again = imported._rotation(robots._roll_pitch_yaw(rotation))
            for entry, wanted in zip(sum(again, []), sum(rotation, [])):
                self.assertAlmostEqual(entry, wanted, delta=1e-15)


if __name__ == "__main__":
    unittest.main()
