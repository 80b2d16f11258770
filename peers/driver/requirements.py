"""What was asked of redysim's speed, and what came out."""

from dataclasses import dataclass

from programs import BY_KEY, FUNCTIONS, PEERS, SPECIAL
from robots import FREE
from results import Times

# What the ReDySim paper reports for its own tasks, s, on a processor of 2006 at 1.66 GHz.
PAPER = {"task_inverse": 0.025, "task_fall": 0.29}
# The most that repetitions may excuse where two builds of the same code are compared.
EXCUSED = 0.05


@dataclass
class Outcome:
    asked: str
    robot: str
    function: str
    least: float
    ratio: float | None
    stretch: float | None = None
    # How far the ratio may be below the least one: as far as the repetitions were apart.
    spread: float | None = None
    # An upper bound of the ratio: that of a program that only writes the result.
    bound: float | None = None

    @property
    def met(self) -> str:
        if self.ratio is None:
            return "not measured"
        if self.stretch and self.ratio >= self.stretch:
            return "yes, and the stretch"
        if self.ratio >= self.least:
            return "yes"
        if self.spread is not None and self.ratio * (1 + self.spread) >= self.least:
            return "yes, within the spread"
        if self.bound is not None and self.bound < self.least:
            return f"**no**; writing alone gives {self.bound:.2f}"
        return "**no**"


def outcomes(times: Times) -> list[Outcome]:
    """What was asked of the robots and programs that the run has."""
    all_peers = [peer.key for peer in PEERS if peer.lanes == 1]
    found = []

    def ask(
        asked: str, robots: list, functions: list, peers: list, ours: str, least: float, stretch=None, spread=False
    ) -> None:
        if ours not in times.programs() or times.programs().isdisjoint(peers):
            return
        for robot in robots:
            if robot not in times.robots():
                continue
            for function in functions:
                ratio = times.ratio(peers, ours, robot, function)
                apart = None
                if spread and ratio is not None:
                    apart = min(EXCUSED, max(times.spread(program, robot, function) for program in [*peers, ours]))
                bound = times.ratio(peers, "written_x8", robot, function) if BY_KEY[ours].lanes > 1 else None
                found.append(Outcome(asked, robot, function, least, ratio, stretch, apart, bound))

    every, small = list(FUNCTIONS), ["kr5", "gripper"]
    generators = ["cppadcodegen", "casadi"]
    ask("f64, against the faster of CppADCodeGen and CasADi", small, every, generators, "native_f64", 2.3, 3.0)
    ask("f64, against Pinocchio", ["kr5"], every, ["pinocchio"], "native_f64", 10.0)
    ask("f64, against redysim for x86-64-v3", small, every, ["v3_f64"], "native_f64", 1.0, spread=True)
    ask("f64 for any x86-64, against the fastest peer's native build", small, every, all_peers, "baseline_f64", 1.0)
    for lanes in (8, 4):
        against = f"f64 × {lanes}, per state, against CppADCodeGen's 8-state code"
        ask(against, SPECIAL, every, ["cppadcodegen_x8"], f"f64x{lanes}", 1.6, 2.0)
    ask("f64, 30-joint tree, against CppADCodeGen", ["humanoid30"], every, ["cppadcodegen"], "native_f64", 1.8)
    ask("f64, free base, against the faster of CppADCodeGen and CasADi", FREE, every, generators, "native_f64", 3.0)
    ask("f64, free base, against Pinocchio", FREE, every, ["pinocchio"], "native_f64", 10.0)
    for lanes in (8, 4):
        against = f"f64 × {lanes}, free base, per state, against CppADCodeGen's 8-state code"
        ask(against, FREE, every, ["cppadcodegen_x8"], f"f64x{lanes}", 2.0)
    return found
