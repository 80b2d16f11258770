"""Time of a function for each state, by the run-time path and compiled: the tables of docs/python.md.

    python redysim-python/benches/compiled.py
"""

import sys
import time
from pathlib import Path

import numpy as np
import redysim

MODELS = Path(__file__).parents[2] / "models"
ROWS = [
    ("gripper", "gripper", "inverse_dynamics"),
    ("gripper", "gripper", "forward_dynamics"),
    ("KR5", "kr5", "inverse_dynamics"),
    ("KR5", "kr5", "forward_dynamics"),
    ("KR5", "kr5", "mass_matrix"),
    ("chain of 20", "chain_20", "inverse_dynamics"),
    ("chain of 20", "chain_20", "forward_dynamics"),
]
STATES = 65_536
BATCH, STATES_OF_BATCH = "peers/kr5", 512


def seconds(function, arguments, out, calls=20_000):
    """The time of a call, s, as a program makes it: `function(*arguments)` makes a tuple and a dictionary, too."""
    calls = max(1, calls // len(np.atleast_2d(arguments[0])))
    run = {(1, True): of_one, (3, True): of_three, (1, False): of_one_anew, (3, False): of_three_anew}
    run = run[len(arguments), out is not None]
    start = time.perf_counter()
    run(calls, function, *arguments, out)
    return (time.perf_counter() - start) / calls


def fastest(functions, arguments, out, repetitions, calls=20_000):
    """For each function the least of several times of a call, in turns: a machine with other work is slower, not faster."""
    times = [[seconds(function, arguments, out, calls) for function in functions] for _ in range(repetitions)]
    return np.min(times, axis=0)


def of_one(calls, function, q, out):
    for _ in range(calls):
        function(q, out=out)


def of_three(calls, function, q, v, a, out):
    for _ in range(calls):
        function(q, v, a, out=out)


def of_one_anew(calls, function, q, _):
    for _ in range(calls):
        function(q)


def of_three_anew(calls, function, q, v, a, _):
    for _ in range(calls):
        function(q, v, a)


def states(robot, name, shape, rng):
    """Random arguments of a function."""
    return [rng.uniform(-1, 1, (*shape, robot.nv)) for _ in range(1 if name == "mass_matrix" else 3)]


def main(repetitions):
    rng = np.random.default_rng(1)
    print(f"| ns for each state | one state: run-time path | compiled | | {STATES:,} states: run-time path | compiled | |")
    print("|---|---|---|---|---|---|---|")
    for label, model, name in ROWS:
        plain, compiled = (redysim.load(MODELS / f"{model}.toml") for _ in range(2))
        compiled.compile()
        cells = [f"{label}, {name.replace('_', ' ')}"]
        for shape in ((), (STATES,)):
            arguments = states(plain, name, shape, rng)
            out = getattr(plain, name)(*arguments)
            times = fastest([getattr(robot, name) for robot in (plain, compiled)], arguments, out, repetitions)
            each = [1e9 * time_of_call / (shape or (1,))[0] for time_of_call in times]
            cells += [*(f"{ns:.0f}" for ns in each), f"{each[0] / each[1]:.1f} ×"]
        print("| " + " | ".join(cells) + " |")
    # So few are computed by one thread.
    robot = redysim.load(MODELS / f"{BATCH}.toml").compile()
    print(f"\n| ns for each of {STATES_OF_BATCH} states, one thread | compiled |\n|---|---|")
    for name in ("inverse_dynamics", "forward_dynamics"):
        arguments = states(robot, name, (STATES_OF_BATCH,), rng)
        function = getattr(robot, name)
        [best] = fastest([function], arguments, function(*arguments), repetitions, 200_000)
        print(f"| {BATCH}, {name.replace('_', ' ')} | {1e9 * best / STATES_OF_BATCH:.1f} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
