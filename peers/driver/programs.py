"""What is compared: each program, where its library is and what its functions are called there."""

from dataclasses import dataclass
from pathlib import Path

import processor
from robots import FREE

FUNCTIONS = {"inverse": "inverse dynamics", "forward": "forward dynamics", "mass": "mass matrix"}
SPECIAL = ["kr5", "gripper", "humanoid30"]
# The robots whose functions take several states at once, too.
LANED = [*SPECIAL, *FREE]


@dataclass(frozen=True)
class Program:
    key: str
    label: str
    # Of the library and of the function, with places for {robot} and {function}.
    library: str
    symbol: str
    # What its robots are written in: the ending of the file that it is prepared with.
    robot_file: str
    scalar: str = "f64"
    lanes: int = 1
    # Where the library leaves no more than the upper triangle of the mass matrix, by columns.
    upper: bool = False
    # Whether it numbers joints breadth first, whatever the file's order.
    breadth_first: bool = False
    # Its gravity, m/s², where that is built in.
    gravity: float = 9.81
    # All robots, unless named.
    robots: tuple[str, ...] | None = None
    ours: bool = False
    # Whether it runs on processors with AVX2 and FMA alone.
    v3: bool = False
    # Whether it is for processors with AVX-512 alone, or for those without.
    avx512: bool | None = None
    # Whether it computes the result; otherwise it writes as many zeros.
    computes: bool = True

    def runs_on(self, cpuinfo: str) -> bool:
        v3 = processor.runs_v3(cpuinfo) or not self.v3
        return v3 and self.avx512 in (None, processor.has_avx512(cpuinfo))

    def takes(self, robot: str) -> bool:
        return self.robots is None or robot in self.robots

    def library_of(self, built: Path, robot: str, function: str) -> Path:
        return built / self.library.format(robot=robot, function=function)

    def symbol_of(self, robot: str, function: str) -> str:
        return self.symbol.format(robot=robot, function=function)


NATIVE, V3, BASELINE = (f"cargo-{target}/release/libredysim_peers.so" for target in ("native", "x86-64-v3", "baseline"))
GENERATED = "generated/{robot}/{function}"


def _ours(key: str, label: str, library: str, symbol: str, **more) -> Program:
    return Program(key, label, library, symbol, "toml", ours=True, **more)


def _in_lanes(scalar: str, lanes: int, avx512: bool) -> Program:
    key, label, more = f"{scalar}x{lanes}", f"redysim, {scalar} × {lanes}", {"scalar": scalar, "avx512": avx512}
    return _ours(key, label, NATIVE, "{robot}_{function}_" + key, lanes=lanes, robots=tuple(LANED), **more)


PROGRAMS = [
    Program("pinocchio", "Pinocchio", "pinocchio.so", "{function}", "txt", upper=True),
    Program("cppadcodegen", "CppADCodeGen", GENERATED + "/cppadcodegen.so", "{function}", "txt"),
    Program("casadi", "CasADi", GENERATED + "/casadi.so", "{function}", "txt"),
    Program("mujoco", "MuJoCo", "mujoco.so", "{function}", "xml"),
    Program(
        "dynibo",
        "dynibo",
        "cargo-native/release/libdynibo_peer.so",
        "{function}",
        "urdf",
        breadth_first=True,
        gravity=9.80665,
    ),
    _ours("generic", "redysim, generic path", NATIVE, "generic_{function}"),
    _ours("native_f64", "redysim, f64", NATIVE, "{robot}_{function}_f64"),
    _ours("native_f32", "redysim, f32", NATIVE, "{robot}_{function}_f32", scalar="f32"),
    _ours("v3_f64", "redysim, f64, x86-64-v3", V3, "{robot}_{function}_f64", v3=True),
    _ours("baseline_f64", "redysim, f64, any x86-64", BASELINE, "{robot}_{function}_f64"),
    _ours("baseline_f32", "redysim, f32, any x86-64", BASELINE, "{robot}_{function}_f32", scalar="f32"),
    Program(
        "cppadcodegen_x8",
        "CppADCodeGen, 8 states",
        GENERATED + "/cppadcodegen_x8.so",
        "{function}",
        "txt",
        lanes=8,
        robots=tuple(LANED),
    ),
    # For the mass matrix only, which is the one large result.
    Program(
        "written_x8",
        "writing alone, 8 states",
        GENERATED + "/written_x8.so",
        "{function}",
        "txt",
        lanes=8,
        robots=tuple(LANED),
        computes=False,
    ),
    # As many lanes as the processor's vectors have.
    _in_lanes("f64", 8, avx512=True),
    _in_lanes("f32", 16, avx512=True),
    _in_lanes("f64", 4, avx512=False),
    _in_lanes("f32", 8, avx512=False),
]
BY_KEY = {program.key: program for program in PROGRAMS}
PEERS = [program for program in PROGRAMS if not program.ours]
# All are checked against this one, which has been checked itself against references outside this folder.
REFERENCE = BY_KEY["native_f64"]
