"""Imports and compiles robots, computes at random states by redysim and by Pinocchio, and prints how far they differ.

Both read the same URDF. Joints that redysim fixes (floating bases, joints that move no mass) are locked at zero in Pinocchio;
joints that mimic others are free in both. The base is fixed in both.
"""

import sys
from pathlib import Path

import pinocchio
from comparison import STATES, TOLERANCE, Comparison, Failed, compared
from compiled import Compiled, compiled
from peer import Refused
from robot import FUSED, KEPT, Robot, example_robots, robots

COMPILED = "compiled"


def row(robot: Robot, evaluate: Path, compiled: Compiled) -> tuple[str, bool]:
    """A robot's line of the table, and whether all that is imported agrees."""
    commands = {way: [evaluate, model] for way, model in robot.models.items()}
    if robot.name in compiled.programs:
        commands[COMPILED] = [compiled.programs[robot.name]]
    refused, failed = robot.refused[:1], []
    if robot.name in compiled.errors:
        failed.append(f"**does not compile**: {compiled.errors[robot.name]}")
    found: dict[str, Comparison] = {}
    for way, command in commands.items():
        try:
            found[way] = compared(command, robot.urdf)
        except Refused as reason:
            refused = refused or [str(reason)]
        except Failed as reason:
            failed.append(f"**{way}**: {reason}")
    failed += [f"**{way} differs**" for way, comparison in found.items() if not comparison.agrees]
    joints = [comparison.joints for comparison in found.values()]
    if any(names != joints[0] for names in joints):
        failed.append("**the models do not move the same joints**")
    remarks = "; ".join(refused + failed + ill_conditioned(list(found.values())) + (lost(robot.said) if found else []))
    kept = found.get(KEPT)
    shares = [kept.forces, kept.matrices, kept.accelerations] if kept else [None] * 3
    shares += [found[way].largest if way in found else None for way in [FUSED, COMPILED]]
    numbers = " | ".join("" if share is None else f"{share:.0e}" for share in shares)
    return f"| {robot.title} | {len(joints[0]) if joints else ''} | {numbers} | {remarks} |", not failed


def ill_conditioned(found: list[Comparison]) -> list[str]:
    """What to say where accelerations are judged by the forces that they take."""
    judged = [comparison for comparison in found if comparison.by_forces]
    if not judged:
        return []
    condition, taken = max(c.condition for c in judged), max(c.taken for c in judged)
    return [f"M has a condition of {condition:.0e}; the accelerations take the right forces to {taken:.0e}"]


def lost(said: list[str]) -> list[str]:
    """What of the joints is not imported."""
    fixed, mimics = (sum(text in line for line in said) for text in ["fixed at zero here", "free here"])
    return [f"joints fixed at zero: {fixed}"] * (fixed > 0) + [f"mimic joints free: {mimics}"] * (mimics > 0)


def main() -> None:
    built, *files = sys.argv[1:]
    target, crate = Path(built) / "cargo", Path(built) / "robots"
    programs = target / "release"
    all_robots = robots([Path(file) for file in files] or example_robots())
    for robot in all_robots:
        robot.make_models(programs / "redysim", crate / "models")
    made = compiled(crate, [robot.name for robot in all_robots if robot.models], target)
    print(f"# Imported robots beside Pinocchio {pinocchio.__version__}\n")
    print(f"The largest difference at {STATES} random states; how it is found is in [peers/README.md](../README.md).")
    print("The last column is by the functions that `redysim!` makes, those before it by the generic path.\n")
    print("| robot | joints | inverse dynamics | mass matrix | forward dynamics | all, fused | all, compiled | |")
    print("|---|---|---|---|---|---|---|---|")
    agree = True
    for robot in all_robots:
        line, agrees = row(robot, programs / "redysim-evaluate", made)
        print(line, flush=True)
        agree = agree and agrees
    if not agree:
        sys.exit(f"some robots do not compile, or differ by more than {TOLERANCE}: see the remarks")


main()
