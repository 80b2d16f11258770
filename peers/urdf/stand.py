"""Unitree's G1 stands: its model and scenario, the run, and the table of what is checked."""

import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

from humanoid import Humanoid, Law
from peer import Peer
from robot import example_robots
from standing import Check, correct, fallen, standing
from tables import Run

URDF = "g1_29dof_rev_1_0.urdf"
# s. Without forces it has fallen long before.
STANDS, FALLS = 5.0, 1.0
STEP = 0.01

# The posture, rad; all other joints are at zero. The knees are bent, the soles level, and the centre of mass is over the
# middle of the soles.
LEG = {"hip_pitch": -0.27, "knee": 0.6, "ankle_pitch": -0.33}
ARM = {"shoulder_pitch": 0.2, "elbow": 0.6}
POSTURE = {f"{side}_{name}_joint": angle for side in ["left", "right"] for name, angle in (LEG | ARM).items()}
POSTURE |= {"left_shoulder_roll_joint": 0.2, "right_shoulder_roll_joint": -0.2}

# Stiffness, N m/rad, and damping, N m s/rad, of the joints with these words in their names; the first that fits.
GAINS = {"hip": (500.0, 10.0), "knee": (500.0, 10.0), "ankle": (500.0, 40.0), "waist": (500.0, 10.0)}
GAINS_OF_ARMS = (100.0, 3.0)

# ReDySim's law of contact. Eight points 0.085 m before and behind the middle of the soles are a spring of 5800 N m/rad
# against tilting; a body of this weight needs some 220 N m/rad.
GROUND = Law(stiffness=1e5, damping=300.0, leaving_speed=1.0, friction=0.7, sliding_damping=1000.0)


def main(redysim: Path, folder: Path) -> bool:
    """Whether it stands with the gains and falls without them."""
    folder.mkdir(parents=True, exist_ok=True)
    urdf = next(path for path in example_robots() if path.name == URDF)
    humanoid = Humanoid(urdf, imported(redysim, urdf), POSTURE, gains)
    (folder / "g1.toml").write_text(humanoid.model_file)
    model = tomllib.loads(humanoid.model_file)
    joints = [link["joint_name"] for link in model["link"] if link["joint"] != "fixed"]
    peer = Peer(urdf, joints, model)
    run = ran(redysim, folder / "stands", humanoid, STANDS)
    stands = all_hold([*standing(run, humanoid), *correct(run, humanoid, GROUND, peer)])
    print("\nWithout the forces of the joints:\n")
    limp = replace(humanoid, gains=lambda joint: (0.0, 0.0))
    run = ran(redysim, folder / "falls", limp, FALLS)
    falls = all_hold([*fallen(run), *correct(run, limp, GROUND, peer)])
    # The checks of a run that stands must be able to fail.
    seen = not any(check.holds for check in standing(run, limp))
    right = stands and falls and seen
    print("\nIt stands, and without forces it falls." if right else "\nNot as it must be: see above.")
    return right


def imported(redysim: Path, urdf: Path) -> str:
    """The model file that redysim makes of the URDF."""
    return called([redysim, "import", urdf, "--base", "free"])


def called(command: list[Path | str]) -> str:
    """What a command prints; it must succeed."""
    ended = subprocess.run(command, capture_output=True, text=True)
    if ended.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ends with {ended.returncode}:\n{ended.stderr}")
    return ended.stdout


def gains(joint: str) -> tuple[float, float]:
    """Stiffness and damping of a joint."""
    return next((gains for word, gains in GAINS.items() if word in joint), GAINS_OF_ARMS)


def ran(redysim: Path, folder: Path, humanoid: Humanoid, end: float) -> Run:
    """The run of a humanoid until `end`, s."""
    scenario = folder.with_suffix(".toml")
    scenario.write_text(humanoid.scenario(folder.with_name("g1.toml"), GROUND, end, STEP))
    print(called([redysim, "forward", scenario, "--output", folder, "--force"]))
    return Run(folder)


def all_hold(checks: list[Check]) -> bool:
    """Prints what is checked, and tells whether all of it holds."""
    print("| | found | bound | |\n|---|---|---|---|")
    for check in checks:
        print(f"| {check.what} | {check.found:.2g} | {check.bound} | {'' if check.holds else '**no**'} |")
    return all(check.holds for check in checks)


if __name__ == "__main__":
    sys.exit(0 if main(*(Path(argument) for argument in sys.argv[1:])) else 1)
