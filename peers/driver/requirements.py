"""What was asked of redysim's speed, and what came out."""

from dataclasses import dataclass
from statistics import median

from programs import FUNCTIONS, PEERS, SPECIAL

# What the ReDySim paper reports for its own tasks, s, on a processor of 2006 at 1.66 GHz.
PAPER = {"task_inverse": 0.025, "task_fall": 0.29}


class Times:
    """ns per state: of each program at each function, the median of the repetitions."""

    def __init__(self, results: dict):
        self.all = {tuple(key.split()): times for key, times in results["times"].items()}

    def of(self, program: str, robot: str, function: str) -> float | None:
        times = self.all.get((program, robot, function))
        return median(times) if times else None

    def ratio(self, peers: list[str], ours: str, robot: str, function: str) -> float | None:
        """How many times as fast `ours` is as the fastest of the peers."""
        mine = self.of(ours, robot, function)
        theirs = [time for peer in peers if (time := self.of(peer, robot, function)) is not None]
        return min(theirs) / mine if mine and theirs else None


@dataclass
class Outcome:
    asked: str
    robot: str
    function: str
    least: float
    ratio: float | None
    stretch: float | None = None

    @property
    def met(self) -> str:
        if self.ratio is None:
            return "not measured"
        if self.stretch and self.ratio >= self.stretch:
            return "yes, and the stretch"
        return "yes" if self.ratio >= self.least else "**no**"


def outcomes(times: Times) -> list[Outcome]:
    all_peers = [peer.key for peer in PEERS if peer.lanes == 1]
    found = []

    def ask(asked: str, robots: list, functions: list, peers: list, ours: str, least: float, stretch=None) -> None:
        for robot in robots:
            for function in functions:
                ratio = times.ratio(peers, ours, robot, function)
                found.append(Outcome(asked, robot, function, least, ratio, stretch))

    every, small = list(FUNCTIONS), ["kr5", "gripper"]
    generators = ["cppadcodegen", "casadi"]
    ask("f64, against the faster of CppADCodeGen and CasADi", small, every, generators, "native_f64", 2.3, 3.0)
    ask("f64, against Pinocchio", ["kr5"], ["inverse", "forward"], ["pinocchio"], "native_f64", 10.0)
    ask("f64 for any x86-64, against the fastest peer's native build", small, every, all_peers, "baseline_f64", 1.0)
    ask(
        "f64 × 8, per state, against CppADCodeGen's 8-state code",
        SPECIAL,
        every,
        ["cppadcodegen_x8"],
        "f64x8",
        1.6,
        2.0,
    )
    ask("f64, 30-joint tree, against CppADCodeGen", ["humanoid30"], every, ["cppadcodegen"], "native_f64", 1.8)
    return found
