"""Checks that all programs say the same, and times them in turns."""

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy

import robots as robot_files
from programs import FUNCTIONS, REFERENCE, Program

# Enough that no result can be foreseen, and few enough that those of KR5 lie in the innermost cache.
STATES = 256
REPETITIONS = 3
# A measurement during which the calibration loop was so much slower than at its fastest counts as disturbed; one in which more
# than half of the programs were disturbed is taken again.
DISTURBED = 1.05
AGAIN = 2
# What the timer has for a program where others kept taking the core.
INTERRUPTED = "interrupted"
TAKEN = "other programs kept taking the core"
# Deviations are relative to the component, or to this part of the state's largest one if that is more.
FLOOR = {"f64": 1e-6, "f32": 1e-2}


def tolerance(program: Program, robot: str, function: str) -> float:
    """How far a component may be off. Accelerations lose digits with the condition of the mass matrix, of long chains most."""
    if program.scalar == "f32":
        return 1e-2
    return 1e-7 if _is_ill_conditioned(robot, function) else 1e-8


def _is_ill_conditioned(robot: str, function: str) -> bool:
    return function == "forward" and robot in ("chain40", "chain80")


@dataclass
class Deviation:
    program: str
    robot: str
    function: str
    largest: float
    allowed: float


def agreement(deviations: list[Deviation]) -> dict[str, dict[str, float]]:
    """The largest deviations of each program, by function; those of ill-conditioned mass matrices apart."""
    largest: dict[str, dict[str, float]] = {}
    for d in deviations:
        column = d.function + ("_long" if _is_ill_conditioned(d.robot, d.function) else "")
        of = largest.setdefault(d.program, {})
        of[column] = max(of.get(column, 0.0), float(f"{d.largest:.1e}"))
    return largest


@dataclass
class Results:
    deviations: list[Deviation] = field(default_factory=list)
    # ns per state of each repetition, by (program, robot, function).
    times: dict[tuple[str, str, str], list[float]] = field(default_factory=dict)
    calibrations: list[float] = field(default_factory=list)
    disturbed: int = 0
    refused: list[str] = field(default_factory=list)
    # What takes too long to build.
    skipped: list[str] = field(default_factory=list)
    pinned: str = ""


class Bench:
    def __init__(self, built: Path, core: int):
        self.built = built
        self.core = core
        self.prefix, self.pinned = self._pin()
        self.fastest = float("inf")

    def _pin(self) -> tuple[list[str], str]:
        command = ["taskset", "-c", str(self.core)]
        try:
            subprocess.run([*command, "true"], check=True, capture_output=True)
            return command, f"pinned to core {self.core}"
        except (OSError, subprocess.CalledProcessError):
            print(f"cannot pin programs to core {self.core}: times are taken on any core", file=sys.stderr)
            return [], "not pinned to a core"

    def states(self, robot: str) -> numpy.ndarray:
        """Random coordinates, velocities, and accelerations or forces: ±π rad, ±3 rad/s, ±10 rad/s² or N m; of a free
        base a position within ±1 m and any orientation, ±3 m/s, ±10 m/s² or N."""
        known = self.robot(robot)
        random = numpy.random.default_rng(20120611)
        states = random.uniform(-1, 1, (STATES, known.nq + 2 * known.nv))
        states[:, : known.nq] *= numpy.pi
        states[:, known.nq :] *= numpy.repeat([3, 10], known.nv)
        if known.links[0].free:
            states[:, :3] /= numpy.pi
            quaternions = random.normal(size=(STATES, 4))
            states[:, 3:7] = quaternions / numpy.linalg.norm(quaternions, axis=1, keepdims=True)
        return states

    def robot(self, name: str) -> robot_files.Robot:
        return robot_files.read(robot_files.path(name, "txt", self.built))

    def command(self, mode: str, programs: list[Program], robot: str, function: str, states: Path) -> list[str]:
        known = self.robot(robot)
        outputs = known.nv * known.nv if function == "mass" else known.nv
        called = [
            (
                program.library_of(self.built, robot, function),
                program.symbol_of(robot, function),
                robot_files.path(robot, program.robot_file, self.built),
                program.scalar,
                program.lanes,
            )
            for program in programs
        ]
        return self._timer(mode, states, known.nq + 2 * known.nv, outputs, called)

    def _timer(self, mode: str, states: Path, inputs: int, outputs: int, programs: list[tuple]) -> list[str]:
        """The timer's command for programs by library, symbol, robot, scalar and lanes."""
        words = [self.built / "timer", mode, states, inputs, outputs, *(word for program in programs for word in program)]
        return [str(word) for word in words]

    def write_states(self, robot: str, states: numpy.ndarray, name: str = "states") -> Path:
        path = robot_files.path(robot, name, self.built)
        states.astype(numpy.float64).tofile(path)
        return path

    def result(self, program: Program, robot: str, function: str) -> numpy.ndarray:
        """What the program says at the states, one row for each."""
        known = self.robot(robot)
        links = known.breadth_first() if program.breadth_first else list(range(known.joints))
        coordinates, order = (known.numbered(links, sizes) for sizes in (known.coordinates, known.velocities))
        columns = [*coordinates, *(known.nq + v for v in order), *(known.nq + known.nv + v for v in order)]
        # With gravity k g, a motion is √k faster: τ(q, √k v, k a; k g) = k τ(q, v, a; g), and the same the other way.
        k = program.gravity / 9.81
        scale = numpy.repeat([1, numpy.sqrt(k), k], [known.nq, known.nv, known.nv])
        states = self.states(robot)[:, columns] * scale
        command = self.command("check", [program], robot, function, self.write_states(robot, states, "checked"))
        ran = subprocess.run(command, capture_output=True)
        if ran.returncode != 0:
            raise Refused(ran.stderr.decode().strip() or f"the program ended with {ran.returncode}")
        values = numpy.frombuffer(ran.stdout).reshape(STATES // program.lanes, -1, program.lanes)
        values = values.transpose(0, 2, 1).reshape(STATES, -1)
        back = numpy.argsort(order)
        if function != "mass":
            return values[:, back] / k
        matrices = values.reshape(STATES, known.nv, known.nv)
        if program.upper:
            upper = numpy.triu(matrices.transpose(0, 2, 1))
            matrices = upper + numpy.triu(upper, 1).transpose(0, 2, 1)
        return matrices[:, back][:, :, back].reshape(STATES, -1)

    def check(self, programs: list[Program], names: list[str], results: Results) -> None:
        for robot in names:
            for function in FUNCTIONS:
                expected = self.result(REFERENCE, robot, function)
                largest = numpy.abs(expected).max(axis=1, keepdims=True)
                for program in programs:
                    if not program.computes or not self._has(program, robot, function):
                        continue
                    try:
                        found = self.result(program, robot, function)
                    except Refused as refused:
                        results.refused.append(f"{program.label}, {robot}, {FUNCTIONS[function]}: {refused}")
                        continue
                    scale = numpy.maximum(numpy.abs(expected), FLOOR[program.scalar] * largest)
                    deviation = numpy.abs(found - expected) / scale
                    if not numpy.isfinite(found).all():
                        deviation = numpy.full_like(expected, numpy.inf)
                    allowed = tolerance(program, robot, function)
                    results.deviations.append(Deviation(program.key, robot, function, float(deviation.max()), allowed))

    def _has(self, program: Program, robot: str, function: str) -> bool:
        return program.takes(robot) and program.library_of(self.built, robot, function).exists()

    def time(self, programs: list[Program], names: list[str], results: Results) -> None:
        """All programs at one robot's function in turns, in an order that turns with each repetition."""
        agreed = {(d.program, d.robot, d.function) for d in results.deviations if d.largest <= d.allowed}

        def is_ready(program: Program, robot: str, function: str) -> bool:
            if program.computes:
                return (program.key, robot, function) in agreed
            return self._has(program, robot, function)

        results.pinned = self.pinned
        for repetition in range(REPETITIONS):
            for robot in names:
                states = self.write_states(robot, self.states(robot))
                print(f"repetition {repetition + 1} of {REPETITIONS}: {robot}", flush=True)
                for function in FUNCTIONS:
                    ready = [p for p in programs if is_ready(p, robot, function)]
                    if not ready:
                        continue
                    turn = repetition * len(ready) // REPETITIONS
                    ready = ready[turn:] + ready[:turn]
                    measured = self.measured(self.command("time", ready, robot, function, states), results)
                    for program, time in zip(ready, measured):
                        if time is None:
                            what = f"repetition {repetition + 1} of {program.label}, {robot}, {FUNCTIONS[function]}"
                            results.refused.append(f"{what}: {TAKEN}")
                            continue
                        results.times.setdefault((program.key, robot, function), []).append(time)

    def measured(self, command: list[str], results: Results) -> list[float | None]:
        """ns per state of each program of a command, `None` where others kept taking the core; taken again while the
        calibration loop says that something else slows the core."""
        best: list[tuple[float, float | None]] = []
        for _ in range(AGAIN + 1):
            ran = subprocess.run([*self.prefix, *command], capture_output=True, text=True)
            if ran.returncode != 0:
                raise SystemExit(f"peers: timing failed: {ran.stderr.strip()}\n  {' '.join(command)}")
            found = [_measurement(line) for line in ran.stdout.splitlines()]
            best = [min(pair) for pair in zip(best, found)] if best else found
            self.fastest = min([self.fastest, *(calibration for calibration, _ in found)])
            disturbed = sum(calibration > DISTURBED * self.fastest for calibration, _ in best)
            if 2 * disturbed <= len(best):
                break
        results.disturbed += disturbed
        results.calibrations += [calibration for calibration, time in best if time is not None]
        return [time for _, time in best]

    def tasks(self, results: Results) -> dict[str, float]:
        """ns that each of ReDySim's own tasks takes."""
        states = robot_files.path("gripper", "states", self.built)
        robot = robot_files.path("gripper", "toml", self.built)
        library = REFERENCE.library_of(self.built, "gripper", "inverse")
        symbols = ["task_inverse", "task_fall"]
        called = [(library, symbol, robot, "f64", 1) for symbol in symbols]
        command = self._timer("time", states, 12, 404, called)
        repetitions = [self.measured(command, results) for _ in range(REPETITIONS)]
        found = {}
        for symbol, times in zip(symbols, zip(*repetitions)):
            if None in times:
                results.refused.append(f"ReDySim's own `{symbol}`: {TAKEN}")
            else:
                found[symbol] = float(f"{numpy.median(times):.5g}")
        return found


def _measurement(line: str) -> tuple[float, float | None]:
    """Of a program: ns of the calibration loop and per state."""
    if line == INTERRUPTED:
        return float("inf"), None
    time, calibration = (float(word) for word in line.split())
    return calibration, time


class Refused(Exception):
    """A program that does not take a robot."""

