"""Random robots as URDF."""

import numpy as np

KINDS = ("revolute", "prismatic", "continuous", "fixed")


def inertia(rng) -> np.ndarray:
    """The inertia of a body about its centre of mass, kg m², as real ones are."""
    points = rng.normal(size=(3, 8)) * 0.1
    second = points @ points.T
    return np.trace(second) * np.eye(3) - second


def numbers(values) -> str:
    return " ".join(repr(float(value)) for value in values)


def random_urdf(rng, joints: int, serial: bool = False, kinds=KINDS) -> str:
    """A robot whose links branch unless it is serial, on joints of these kinds; what the base carries moves."""
    parts = []
    for index in range(joints + 1):
        i = inertia(rng).tolist()
        parts.append(f"""
  <link name="link{index}"><inertial>
    <origin xyz="{numbers(rng.uniform(-0.2, 0.2, 3))}" rpy="{numbers(rng.uniform(-1, 1, 3))}"/>
    <mass value="{float(rng.uniform(0.5, 3))!r}"/>
    <inertia ixx="{i[0][0]!r}" iyy="{i[1][1]!r}" izz="{i[2][2]!r}" ixy="{i[0][1]!r}" ixz="{i[0][2]!r}" iyz="{i[1][2]!r}"/>
  </inertial></link>""")
    for index in range(1, joints + 1):
        parent = index - 1 if serial else int(rng.integers(max(0, index - 3), index))
        axis = rng.normal(size=3)
        kind = kinds[0] if parent == 0 or rng.uniform() < 0.4 else rng.choice(kinds)
        parts.append(f"""
  <joint name="joint{index}" type="{kind}">
    <parent link="link{parent}"/><child link="link{index}"/>
    <origin xyz="{numbers(rng.uniform(-0.4, 0.4, 3))}" rpy="{numbers(rng.uniform(-3, 3, 3))}"/>
    <axis xyz="{numbers(axis / np.linalg.norm(axis))}"/>
    <limit lower="-3" upper="3" effort="100" velocity="10"/>
  </joint>""")
    return f'<robot name="random{joints}">{"".join(parts)}\n</robot>\n'
