"""A humanoid: its model with contact points, and the scenario in which it stands."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path

import numpy

GRAVITY = 9.81


@dataclass
class Law:
    """ReDySim's law of contact: K, N/m; C_v, N s/m; v_max, m/s; μ; C_h, N s/m."""

    stiffness: float
    damping: float
    leaving_speed: float
    friction: float
    sliding_damping: float

    # The penetration below which the ground does not act, m.
    ONSET = 1e-5

    def normal(self, penetration: float, rate: float) -> float:
        """The force out of the ground."""
        if penetration < self.ONSET:
            return 0.0
        share = penetration / (1.2 * self.leaving_speed * self.damping / self.stiffness)
        fades = rate < 0 and share <= 1
        return self.stiffness * penetration + self.damping * (share**2 * (3 - 2 * share) if fades else 1.0) * rate

    def friction_force(self, normal: float, sliding: numpy.ndarray) -> numpy.ndarray:
        """The force along the ground, of each direction by itself."""
        limit = 2 / numpy.pi * self.friction * abs(normal)
        return -limit * numpy.arctan(self.sliding_damping * sliding / limit) if limit > 0 else numpy.zeros(2)


@dataclass
class Humanoid:
    """A robot of a URDF whose feet have small spheres for `collision`: their lowest points touch the ground."""

    urdf: Path
    # That redysim makes of the URDF.
    imported: str
    # Of the joints that are not at zero, rad.
    posture: dict[str, float]
    # Stiffness and damping of a joint.
    gains: Callable[[str], tuple[float, float]]

    @cached_property
    def document(self) -> ElementTree.Element:
        """The root element of the URDF."""
        return ElementTree.parse(self.urdf).getroot()

    @cached_property
    def soles(self) -> dict[str, tuple[str, numpy.ndarray]]:
        """Names of the contact points, each with its link and its place in the link's frame, m."""
        found = {}
        for link in self.document.iter("link"):
            spheres = [shape for shape in link.findall("collision") if shape.find("geometry/sphere") is not None]
            if "ankle_roll" not in link.get("name"):
                continue
            for index, sphere in enumerate(spheres):
                center = numpy.array([float(x) for x in sphere.find("origin").get("xyz").split()])
                radius = float(sphere.find("geometry/sphere").get("radius"))
                found[f"{link.get('name')}_{index}"] = (link.get("name"), center - [0, 0, radius])
        return found

    @property
    def mass(self) -> float:
        """The sum of the masses in the URDF, kg."""
        return sum(float(mass.get("value")) for mass in self.document.iter("mass"))

    @property
    def model_file(self) -> str:
        """The model with a frame on each contact point."""
        text = self.imported
        for name, (link, place) in self.soles.items():
            xyz = ", ".join(repr(float(x)) for x in place)
            text += f'\n[[frame]]\nname = "{name}"\nlink = "{link}"\norigin = {{ xyz = [{xyz}], rpy = [0, 0, 0] }}\n'
        return text

    def scenario(self, model: Path, ground: Law, end: float, step: float) -> str:
        """It starts in its posture, with its weight on the soles, which have sunk in as far as the weight takes."""
        joints = self.driven_joints()
        kp, kd = ({name: self.gains(name)[which] for name in joints} for which in [0, 1])
        sunk = self.mass * GRAVITY / (len(self.soles) * ground.stiffness)
        base = f"base = {{ xyz = [0, 0, {float(self.height() - sunk)!r}] }}"
        law = "\n".join(f"{field.name} = {getattr(ground, field.name)!r}" for field in fields(ground))
        frames = ", ".join(f'"{name}"' for name in self.soles)
        return f"""\
model = "{model}"

[initial]
q = {{ {base}, {inline(self.posture)[2:]}

[forward]
end = {end}
step = {step}
integrator = {{ method = "Ode15s", rtol = 1e-6, atol = 1e-8 }}

[forward.torque]
law = "pd"
target = {inline(self.posture)}
kp = {inline(kp)}
kd = {inline(kd)}
limits = "range"

[[contact]]
law = "redysim"
frame = [{frames}]
{law}
"""

    def driven_joints(self) -> list[str]:
        """The joints that have an actuator: all that move in the URDF."""
        joints = self.document.findall("joint")
        return [joint.get("name") for joint in joints if joint.get("type") != "fixed"]

    def limits(self) -> dict[str, float]:
        """The largest force of each joint, N m."""
        joints = self.document.findall("joint")
        driven = [joint for joint in joints if joint.get("type") != "fixed"]
        return {joint.get("name"): float(joint.find("limit").get("effort")) for joint in driven}

    def height(self) -> float:
        """Of the base over the soles in its posture, m."""
        places = self.places()
        heights = [(places[link][0] @ place + places[link][1])[2] for link, place in self.soles.values()]
        return -min(heights)

    def places(self) -> dict[str, tuple[numpy.ndarray, numpy.ndarray]]:
        """Rotation and origin of each link in the frame of the root."""
        joints = self.document.findall("joint")
        children = {joint.find("child").get("link") for joint in joints}
        start = next(link.get("name") for link in self.document.iter("link") if link.get("name") not in children)
        places = {start: (numpy.eye(3), numpy.zeros(3))}
        while len(places) <= len(joints):
            for joint in joints:
                parent, child = (joint.find(side).get("link") for side in ["parent", "child"])
                if parent not in places or child in places:
                    continue
                rotation, origin = places[parent]
                turned = rotation @ rpy(numbers(joint, "origin", "rpy"))
                if joint.get("type") != "fixed":
                    turned = turned @ about(numbers(joint, "axis", "xyz"), self.posture.get(joint.get("name"), 0.0))
                places[child] = (turned, origin + rotation @ numbers(joint, "origin", "xyz"))
        return places


def inline(values: dict[str, float]) -> str:
    """A table of TOML on one line."""
    return "{ " + ", ".join(f"{name} = {value!r}" for name, value in values.items()) + " }"


def numbers(joint: ElementTree.Element, element: str, attribute: str) -> numpy.ndarray:
    """Three numbers of an element of a joint; zero where it is left out."""
    found = joint.find(element)
    return numpy.array([float(x) for x in ("0 0 0" if found is None else found.get(attribute, "0 0 0")).split()])


def rpy(angles: numpy.ndarray) -> numpy.ndarray:
    """The rotation about the fixed axes x, y, z one after the other."""
    return about(numpy.eye(3)[2], angles[2]) @ about(numpy.eye(3)[1], angles[1]) @ about(numpy.eye(3)[0], angles[0])


def about(axis: numpy.ndarray, angle: float) -> numpy.ndarray:
    """The rotation about a unit vector (Rodrigues)."""
    x, y, z = axis
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
