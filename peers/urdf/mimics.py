"""Joints that mimic others: the coordinate of each is `multiplier` times that of another joint, plus `offset`."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

# The joints of a model that mimic others or are mimicked.
WITH_AXIS = ["revolute", "prismatic"]


@dataclass(frozen=True)
class Mimic:
    """How a joint follows the joint of this name."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def after(self, following: "Mimic") -> "Mimic":
        """How it follows the joint that its own one follows so."""
        offset = self.multiplier * following.offset + self.offset
        return Mimic(following.joint, self.multiplier * following.multiplier, offset)


def of_model(model: dict) -> dict[str, Mimic]:
    """What mimics, by the names of the joints, in a model of redysim's."""
    return {link["joint_name"]: Mimic(**link["mimic"]) for link in model["link"] if "mimic" in link}


def of_urdf(urdf: Path) -> dict[str, Mimic]:
    """What mimics in a URDF."""
    tags = {joint.get("name"): joint.find("mimic") for joint in ElementTree.parse(urdf).getroot().findall("joint")}
    return {
        name: Mimic(tag.get("joint"), float(tag.get("multiplier", 1)), float(tag.get("offset", 0)))
        for name, tag in tags.items()
        if tag is not None
    }


def resolved(mimics: dict[str, Mimic]) -> dict[str, Mimic]:
    """The same, each by a joint that mimics no other."""

    def ending(mimic: Mimic) -> Mimic:
        return ending(mimic.after(mimics[mimic.joint])) if mimic.joint in mimics else mimic

    return {name: ending(mimic) for name, mimic in mimics.items()}


def misread(urdf: Path, model: dict) -> list[str]:
    """The joints whose mimics are not those of the URDF, as far as these are possible."""
    kinds = {link["joint_name"]: link["joint"] for link in model["link"]}
    # Joints mimic others about or along one axis each, and never so that they are held.
    coupled = {
        name: mimic
        for name, mimic in of_urdf(urdf).items()
        if mimic.multiplier != 0 and all(kinds.get(joint) in WITH_AXIS for joint in [name, mimic.joint])
    }
    expected = {name: mimic for name, mimic in coupled.items() if _ends(name, coupled)}
    found = of_model(model)
    return sorted(name for name in expected.keys() | found.keys() if expected.get(name) != found.get(name))


def _ends(name: str, mimics: dict[str, Mimic]) -> bool:
    """Whether the way from mimic to mimic comes to a joint that mimics no other."""
    for _ in mimics:
        name = mimics[name].joint
        if name not in mimics:
            return True
    return False


def without_mimics(model: dict) -> dict:
    """The model with all joints free."""
    links = [{key: value for key, value in link.items() if key != "mimic"} for link in model["link"]]
    return {**model, "link": links}
