"""Time of a function for each state, by the run-time path and compiled: the table of docs/python.md.

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


def fastest(function, arguments, out, repetitions):
    """The least of several times of a call, s: a machine with other work is slower, not faster."""
    calls = max(1, 20_000 // len(np.atleast_2d(arguments[0])))
    if len(arguments) == 1:
        run = of_one_argument
    else:
        run = of_three_arguments
    best = np.inf
    for _ in range(repetitions):
        start = time.perf_counter()
        run(calls, function, *arguments, out)
        best = min(best, (time.perf_counter() - start) / calls)
    return best


# As a program calls them: `function(*arguments)` makes a tuple and a dictionary, too.
def of_one_argument(calls, function, q, out):
    for _ in range(calls):
        function(q, out=out)


def of_three_arguments(calls, function, q, v, a, out):
    for _ in range(calls):
        function(q, v, a, out=out)


def main(repetitions):
    rng = np.random.default_rng(1)
    print(f"| ns for each state | one state: run-time path | compiled | | {STATES:,} states: run-time path | compiled | |")
    print("|---|---|---|---|---|---|---|")
    for label, model, name in ROWS:
        plain, compiled = (redysim.load(MODELS / f"{model}.toml") for _ in range(2))
        compiled.compile()
        cells = [f"{label}, {name.replace('_', ' ')}"]
        for shape in ((), (STATES,)):
            arguments = [rng.uniform(-1, 1, (*shape, plain.nv)) for _ in range(1 if name == "mass_matrix" else 3)]
            out = getattr(plain, name)(*arguments)
            times = [fastest(getattr(robot, name), arguments, out, repetitions) for robot in (plain, compiled)]
            each = [1e9 * seconds / (shape or (1,))[0] for seconds in times]
            cells += [*(f"{ns:.0f}" for ns in each), f"{each[0] / each[1]:.1f} ×"]
        print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
