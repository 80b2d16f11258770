"""What a URDF has no place for: frames on the tips of a robot, and rotors in its joints."""

import tomllib
from pathlib import Path

import numpy
from mimics import without_mimics
from peer import Peer, Refused

# No humanoid with hands needs a frame on every finger.
FRAMES = 4


def with_frames(model: str) -> str:
    """The model with frames on links that carry no other, beside their origins and turned against them."""
    links = tomllib.loads(model)["link"]
    carriers = {link["parent"] for link in links}
    tips = [link["name"] for link in links if link["name"] not in carriers]
    chosen = tips[:: max(1, -(-len(tips) // FRAMES))]
    text = model
    for index, link in enumerate(chosen):
        text += f"\n[[frame]]\nname = \"frame{index}\"\nlink = {quoted(link)}\n"
        text += "origin = { xyz = [0.05, -0.03, 0.1], rpy = [0.3, -0.5, 0.7] }\n"
    return text


def with_rotors(model: str, urdf: Path) -> str:
    """The model with half of what resists each joint at zero, beside it, as its rotor: all joints moved alone."""
    parsed = without_mimics(tomllib.loads(model))
    joints = [link["joint_name"] for link in parsed["link"] if link["joint"] != "fixed"]
    try:
        peer = Peer(urdf, joints, parsed)
        resisting = numpy.diag(peer.matrix(peer.neutral()))
    except Refused:
        return model
    starts = numpy.cumsum([0] + [joint.nv for joint in peer.joints])
    # A free base has no rotor.
    moved = [(name, resisting[at]) for name, at, joint in zip(joints, starts, peer.joints) if joint.nv == 1]
    return with_keys(model, {joint: {"armature": inertia / 2} for joint, inertia in moved})


def with_keys(model: str, numbers: dict[str, dict[str, float]]) -> str:
    """The model with these keys of the links on these joints."""
    parts = model.split("\n[[link]]\n")
    for joint, keys in numbers.items():
        index = next(i for i, part in enumerate(parts) if f"\njoint_name = {quoted(joint)}\n" in part)
        lines = "".join(f"{key} = {float(number)!r}\n" for key, number in keys.items())
        parts[index] = parts[index].replace("\nmass = ", f"\n{lines}mass = ", 1)
    return "\n[[link]]\n".join(parts)


def quoted(name: str) -> str:
    """As `redysim import` writes names that have no quotes of their own."""
    return f'"{name}"'
