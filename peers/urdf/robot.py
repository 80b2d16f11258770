"""Robots and the models that `redysim import` makes of them."""

import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pinocchio
from compiled import write_changed
from extras import with_frames, with_rotors

# The models: by the generic path with fixed links kept and fused, and the one that is compiled.
KEPT, FUSED, COMPILED = "generic", "fused", "compiled"
# Pinocchio leaves these out. Taken off afterwards, friction of 10 N m leaves ten digits of the 5 mN m that move a finger.
LEFT_OUT = ("damping = ", "friction = ")


@dataclass
class Robot:
    """A URDF and the models that are imported from it."""

    urdf: Path
    # Of its program and of its files.
    name: str
    # All with frames, but for the first with rotors, too.
    models: dict[str, Path] = field(default_factory=dict)
    # Why there are not both of them.
    refused: list[str] = field(default_factory=list)
    # What was said about the last.
    said: list[str] = field(default_factory=list)

    @property
    def title(self) -> str:
        """Its name in the table."""
        package = self.urdf.parent.parent.name.removesuffix("_description")
        return self.urdf.stem if package in self.urdf.stem else f"{package}/{self.urdf.stem}"

    def make_models(self, redysim: Path, folder: Path, base: str) -> None:
        """Imports it with fixed links kept, and fused. The first that is a model is to be compiled, with rotors."""
        for way, options in [(KEPT, []), (FUSED, ["--fuse-fixed"])]:
            done = run_import(redysim, self.urdf, ["--base", base, *options])
            if done.returncode == 1:
                self.refused.append(self._fault(done.stderr))
                continue
            self.said = done.stderr.splitlines()
            framed = with_frames(without_resistance(done.stdout))
            driven = with_rotors(framed, self.urdf)
            self._write(way, folder / way, framed if way == KEPT else driven)
            if COMPILED not in self.models:
                self._write(COMPILED, folder, driven)

    def _write(self, way: str, folder: Path, model: str) -> None:
        self.models[way] = folder / f"{self.name}.toml"
        write_changed(self.models[way], model)

    def _fault(self, said: str) -> str:
        """The first of the errors."""
        errors = [line for line in said.splitlines() if line.startswith("error: ")] or [said]
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        return errors[0].removeprefix("error: ").replace(str(self.urdf), self.urdf.name) + more


def run_import(redysim: Path, urdf: Path, options: list[str]) -> subprocess.CompletedProcess[str]:
    """The import of a URDF, whose input may be faulty: it ends with 0 or 1."""
    done = subprocess.run([redysim, "import", urdf, *options], capture_output=True, text=True)
    # 1 is faulty input; nothing else is for the file to answer for.
    if done.returncode not in [0, 1]:
        sys.exit(f"redysim import {urdf} ends with {done.returncode}:\n{done.stderr}")
    return done


def without_resistance(model: str) -> str:
    """The model without what Pinocchio leaves out."""
    return "".join(line for line in model.splitlines(True) if not line.startswith(LEFT_OUT))


def example_robots() -> list[Path]:
    """Every URDF of the package example-robot-data."""
    folder = Path(pinocchio.__file__).parents[4] / "share/example-robot-data/robots"
    return sorted(folder.rglob("*.urdf"), key=lambda path: (path.stem.lower(), path))


def robots(urdfs: list[Path]) -> list[Robot]:
    """The robots, with names that a program can have and no two share."""
    found: dict[str, Robot] = {}
    for urdf in urdfs:
        wanted = name = "robot_" + re.sub("[^A-Za-z0-9]", "_", Robot(urdf, "").title)
        while name in found:
            name = f"{wanted}_{len(found)}"
        found[name] = Robot(urdf, name)
    return list(found.values())
