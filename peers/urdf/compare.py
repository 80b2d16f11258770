"""Imports and compiles robots, computes at random states by redysim and by Pinocchio, and prints how far they differ.

Both read the same URDF. Joints that redysim fixes, as they move no mass, are locked at zero in Pinocchio. Joints that
mimic others are free in Pinocchio's model, and follow these by what the URDF says. The base is fixed in both, or with
`--free` floats in both. Frames on the tips, wrenches on them, and rotors are added to both.
"""

import sys
from pathlib import Path

import pinocchio
from comparison import STATES, TOLERANCE, Comparison, Failed, compared
from compiled import Compiled, compiled
from digits import DIGITS
from exact import MARGIN
from peer import Refused
from robot import COMPILED, FUSED, KEPT, Robot, example_robots, robots


def row(
    robot: Robot, evaluate: Path, compiled: Compiled, at_run_time: bool, floats: bool
) -> tuple[str, list[str], bool]:
    """A robot's line of the table, its lines of that of accelerations, and whether all that is imported agrees."""
    commands = {way: [evaluate, model] for way, model in robot.models.items() if at_run_time or way != COMPILED}
    if robot.name in compiled.programs:
        commands[COMPILED] = [compiled.programs[robot.name]]
    refused, failed = robot.refused[:1], []
    if robot.name in compiled.errors:
        failed.append(f"**does not compile**: {compiled.errors[robot.name]}")
    found: dict[str, Comparison] = {}
    for way, command in commands.items():
        try:
            found[way] = compared(command, robot.urdf, robot.models[way])
        except Refused as reason:
            refused = refused or [str(reason)]
        except Failed as reason:
            failed.append(f"**{way}**: {reason}")
    failed += [f"**{way} differs**" for way, comparison in found.items() if not comparison.agrees]
    joints = [comparison.joints for comparison in found.values()]
    mimics = [comparison.mimics for comparison in found.values()]
    if any(names != joints[0] for names in joints) or any(number != mimics[0] for number in mimics):
        failed.append("**the models do not move the same joints**")
    coupled = [f"joints that mimic others: {mimics[0]}"] if any(mimics) else []
    imported = coupled + lost(robot.said) if found else []
    accelerations = apart(robot.title, found)
    judged = ["accelerations are judged below"] if accelerations else []
    remarks = "; ".join(refused + failed + judged + imported)
    kept = found.get(KEPT)
    shares = [None] * (7 if floats else 5)
    if kept:
        shares = [kept.forces, kept.matrices, kept.accelerations, kept.jacobians, kept.bias]
        shares += [kept.whole, kept.positions] * floats
    shares += [found[way].largest if way in found else None for way in [FUSED, COMPILED]]
    numbers = " | ".join("" if share is None else f"{share:.0e}" for share in shares)
    line = f"| {robot.title} | {len(joints[0]) if joints else ''} | {numbers} | {remarks} |"
    return line, accelerations, not failed


def apart(title: str, found: dict[str, Comparison]) -> list[str]:
    """A line for each model whose accelerations are farther apart than the tolerance."""
    lines = []
    for way, comparison in found.items():
        if errors := comparison.errors:
            shares = [comparison.accelerations]
            shares += [max(part) for part in [errors.theirs, errors.ours, errors.taken, errors.written]]
            lines.append(f"| {title} | {way} | " + " | ".join(f"{share:.1e}" for share in shares) + " |")
    return lines


def lost(said: list[str]) -> list[str]:
    """What of the joints is not imported."""
    fixed, free = (sum(text in line for line in said) for text in ["fixed at zero here", "it is free here"])
    return [f"joints fixed at zero: {fixed}"] * (fixed > 0) + [f"mimics of the URDF free here: {free}"] * (free > 0)


def main() -> None:
    built, *words = sys.argv[1:]
    at_run_time, floats = "--run-time" in words, "--free" in words
    files = [word for word in words if word not in ["--run-time", "--free"]]
    base = "free" if floats else "fixed"
    target, crate = Path(built) / "cargo", Path(built) / ("floating" if floats else "robots")
    programs = target / "release"
    all_robots = robots([Path(file) for file in files] or example_robots())
    for robot in all_robots:
        robot.make_models(programs / "redysim", crate / "models", base)
    made = Compiled()
    if not at_run_time:
        made = compiled(crate, [robot.name for robot in all_robots if robot.models], target)
    on = " on a free base" if floats else ""
    print(f"# Imported robots{on} beside Pinocchio {pinocchio.__version__}\n")
    print(f"The largest difference at {STATES} random states; how it is found is in [peers/README.md](../README.md).")
    if at_run_time:
        print("All is by the generic path (`--run-time`); the last two columns have rotors in all joints.\n")
    else:
        print("The last column is by the functions that `redysim!` makes, those before it by the generic path. The")
        print("last two have rotors in all joints.\n")
    columns = "inverse dynamics | mass matrix | forward dynamics | Jacobians | their rates"
    columns += " | centre of mass, momenta | integrate, difference" * floats + " | all, fused"
    print(f"| robot | joints | {columns} | all, {'kept' if at_run_time else 'compiled'} | |")
    print("|---" * (12 if floats else 10) + "|")
    agree, accelerations = True, []
    for robot in all_robots:
        line, more, agrees = row(robot, programs / "redysim-evaluate", made, at_run_time, floats)
        print(line, flush=True)
        accelerations += more
        agree = agree and agrees
    if accelerations:
        print(f"\n## Accelerations more than {TOLERANCE} apart\n")
        print(f"How far each program is from the right ones, in {DIGITS} digits: redysim may be off by {TOLERANCE}, or")
        print(
            f"{MARGIN} times what Pinocchio is off by. Then how far the forces that redysim's accelerations take are from"
        )
        print("those given; and how far the right ones move when the URDF's decimal numbers are read as doubles.\n")
        print("| robot | model | apart | Pinocchio's error | redysim's error | forces taken | decimals as doubles |")
        print("|---" * 7 + "|")
        print("\n".join(accelerations))
    if not agree:
        sys.exit(f"some robots do not compile, or differ by more than {TOLERANCE}: see the remarks")


main()
