"""Tests of what counts as right beside accelerations in 50 digits."""

import tempfile
import unittest
from dataclasses import replace
from decimal import Decimal
from pathlib import Path

from exact import MARGIN, Errors, errors, furthest

TOLERANCE = 1e-11
URDF = """
<robot name="slide"><link name="root"/>
<link name="one"><inertial><mass value="0.1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="a" type="prismatic"><parent link="root"/><child link="one"/><axis xyz="1 0 0"/></joint></robot>
"""
MODEL = {
    "gravity": [0.0, 0.0, -9.81],
    "link": [{"name": "one", "parent": "root", "joint": "prismatic", "joint_name": "a"}],
}


class Agreement(unittest.TestCase):
    def test_what_is_right_needs_no_peer(self):
        found = Errors(ours=[0.9 * TOLERANCE, 0.0], theirs=[0.0, 1.0], taken=[0.0, 0.0], written=[1.0, 1.0])
        self.assertTrue(found.agree(TOLERANCE))

    def test_every_joint_is_as_right_as_its_peer_but_for_the_margin(self):
        found = Errors(ours=[0.9 * MARGIN * 1e-9, 0.0], theirs=[1e-9, 1e-7], taken=[0.0, 0.0], written=[0.0, 0.0])
        self.assertTrue(found.agree(TOLERANCE))
        for ours in [[1.1 * MARGIN * 1e-9, 0.0], [0.0, 1.1 * MARGIN * 1e-7]]:
            self.assertFalse(replace(found, ours=ours).agree(TOLERANCE))

    def test_forces_are_right_whatever_the_peer_is(self):
        found = Errors(ours=[0.0], theirs=[1.0], taken=[1.1 * TOLERANCE], written=[1.0])
        self.assertFalse(found.agree(TOLERANCE))


class Distances(unittest.TestCase):
    def test_a_component_is_measured_by_its_largest_value_at_any_state(self):
        right = [[Decimal(2), Decimal(100)], [Decimal(-4), Decimal(50)]]
        self.assertEqual(furthest([[3.0, 100.0], [-4.0, 49.0]], right), [0.25, 0.01])

    def test_distances_far_below_a_double_are_seen(self):
        self.assertEqual(furthest([[1.0]], [[1 + Decimal("1e-40")]]), [1e-40])

    def test_states_and_components_must_be_the_same(self):
        for found in [[[1.0]], [[1.0, 2.0], [1.0, 2.0]]]:
            with self.assertRaises(ValueError):
                furthest(found, [[Decimal(1), Decimal(2)]])

    def test_a_slide_of_a_tenth_of_a_kilogram_is_judged_in_all_digits(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "slide.urdf"
            path.write_text(URDF)
            found = errors(path, ["a"], MODEL, [([0.5], [2.0], [1.0], [])], [[10.0]], [[11.0]])
        # The double next to 0.1 is larger by this share.
        rounded = Decimal(0.1) * 10 - 1
        self.assertAlmostEqual(found.ours[0], float(rounded), delta=1e-30)
        self.assertAlmostEqual(found.theirs[0], 0.1, delta=1e-15)
        self.assertAlmostEqual(found.taken[0], float(rounded), delta=1e-30)
        self.assertAlmostEqual(found.written[0], float(rounded), delta=1e-30)


if __name__ == "__main__":
    unittest.main()
