"""Builds everything that is compared, each piece once: what is there and has not changed is not built again."""

import hashlib
import os
import shlex
import subprocess
import sys
from pathlib import Path

import imported
import processor
import robots as robot_files
from programs import FUNCTIONS, LANED, PROGRAMS, Program

HERE = Path(__file__).parent.parent
SOURCES = HERE / "programs"
REPOSITORY = HERE.parent

# Without these limits Pinocchio's headers do not compile with the Boost that they come with.
BOOST_LIMITS = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
]
FAST = ["-O3", "-march=native", "-DNDEBUG"]
# A function that takes the compiler longer than this is left out, and said to be.
PATIENCE = 1500.0


class Failed(Exception):
    """A build that did not work; the message says what to look at."""


def has_lanes() -> bool:
    """Whether this redysim has SIMD scalars."""
    return "pub mod lanes" in (REPOSITORY / "redysim-runtime/src/lib.rs").read_text()


def runs_v3() -> bool:
    """Whether this processor runs code for x86-64-v3."""
    return processor.runs_v3(processor.cpuinfo())


def runnable() -> list[Program]:
    """The programs that can be had of this redysim on this processor."""
    lanes, cpuinfo = has_lanes(), processor.cpuinfo()
    return [p for p in PROGRAMS if p.runs_on(cpuinfo) and (lanes or not (p.ours and p.lanes > 1))]


def _stamp(target: Path) -> Path:
    """The file beside `target` that says what it was made from."""
    return target.with_name(target.name + ".stamp")


class Builder:
    def __init__(self, built: Path, packages: Path):
        self.built = built
        self.packages = packages
        self.includes = [
            "-isystem",
            packages / "cmeel.prefix/include",
            "-isystem",
            packages / "cmeel.prefix/include/eigen3",
        ]

    def everything(self, names: list[str]) -> None:
        self.redysim()
        self._dynibo()
        self._mujoco()
        self._pinocchio()
        self._generators()
        for name in names:
            self._robot_files(name)
            for function in FUNCTIONS:
                self._cppadcodegen(name, function)
                self._casadi(name, function)
            if name in LANED:
                self._written(name)

    def skipped(self, names: list[str]) -> list[str]:
        """What takes the compiler too long."""
        found = []
        for name in names:
            for missing in sorted((self.built / "generated" / name).glob("*/*.too-long")):
                found.append(f"{missing.stem}, {name} {missing.parent.name}")
        return found

    def _run(self, command: list, patience: float | None = None, **environment: str) -> None:
        words = [str(word) for word in command]
        print("  " + shlex.join(words)[:160], flush=True)
        try:
            # Builds take long: whoever uses the machine meanwhile goes first.
            subprocess.run(["nice", *words], check=True, timeout=patience, env={**os.environ, **environment})
        except subprocess.CalledProcessError as failure:
            raise Failed(f"this command failed, see above:\n  {shlex.join(words)}") from failure

    def _make(self, target: Path, sources: list[Path], command: list, patience: float | None = None) -> None:
        """Runs the command that makes `target`, unless it has run before with these sources and words."""
        stamp = _stamp(target)
        hashed = hashlib.sha256(repr([str(word) for word in command]).encode())
        for source in sources:
            hashed.update(source.read_bytes())
        if target.exists() and stamp.exists() and stamp.read_text() == hashed.hexdigest():
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        self._run(command, patience)
        stamp.write_text(hashed.hexdigest())

    def _timer(self) -> None:
        source = SOURCES / "timer.c"
        self._make(self.built / "timer", [source], ["gcc", "-O2", source, "-o", self.built / "timer", "-ldl"])

    def _imported(self) -> None:
        """The robots of the package example-robot-data, all of them: redysim's library has every robot."""
        target = self.built / "urdf/cargo"
        command = ["cargo", "build", "--release", "--quiet", "--package", "redysim-cli", "--target-dir", target]
        self._run([*command, "--manifest-path", REPOSITORY / "Cargo.toml"])
        for name in robot_files.FREE:
            imported.write(name, target / "release/redysim", self.packages, self.built)

    def redysim(self) -> None:
        """All but the peers."""
        self.built.mkdir(parents=True, exist_ok=True)
        self._timer()
        self._imported()
        features = ["--features", "lanes"] if has_lanes() else []
        self._cargo("redysim", "native", "-C target-cpu=native", features)
        self._cargo("redysim", "baseline", "", features)
        if runs_v3():
            self._cargo("redysim", "x86-64-v3", "-C target-cpu=x86-64-v3", features)

    def _dynibo(self) -> None:
        self._cargo("dynibo", "native", "-C target-cpu=native", [])

    def _cargo(self, crate: str, target: str, flags: str, more: list[str]) -> None:
        manifest = HERE / crate / "Cargo.toml"
        folder = self.built / f"cargo-{target}"
        command = ["cargo", "build", "--release", "--quiet", "--manifest-path", manifest, "--target-dir", folder, *more]
        self._run(command, RUSTFLAGS=flags)

    def _mujoco(self) -> None:
        source, folder = SOURCES / "mujoco.c", self.packages / "mujoco"
        library = next(folder.glob("libmujoco.so*"))
        target = self.built / "mujoco.so"
        command = ["gcc", *FAST, "-fPIC", "-shared", source, "-isystem", folder / "include", library]
        self._make(target, [source], [*command, f"-Wl,-rpath,{folder}", "-o", target])

    def _pinocchio(self) -> None:
        """By clang: gcc's Pinocchio is much slower, which would flatter everybody else.

        Its functions call each other directly, as in a program: a library's usual detour costs some 4 %.
        """
        source, target = SOURCES / "pinocchio.cpp", self.built / "pinocchio.so"
        command = ["clang++", "-std=c++17", *FAST, *BOOST_LIMITS, *self.includes, source, "-o", target]
        command += ["-fPIC", "-shared", "-fvisibility-inlines-hidden", "-Wl,-Bsymbolic"]
        self._make(target, [source, SOURCES / "robot.hpp"], command)

    def _generators(self) -> None:
        """The programs that write C. By gcc: clang does not take CppADCodeGen's headers. Their own speed is of no matter."""
        shared = [SOURCES / "robot.hpp", SOURCES / "symbolic.hpp"]
        casadi = self.packages / "casadi"
        extra = {
            "cppadcodegen": ["-ldl"],
            "casadi": ["-isystem", casadi / "include", f"-L{casadi}", "-lcasadi", f"-Wl,-rpath,{casadi}"],
        }
        for name, words in extra.items():
            source, target = SOURCES / f"{name}.cpp", self.built / name
            command = [
                "g++",
                "-std=c++17",
                "-O1",
                "-DNDEBUG",
                *BOOST_LIMITS,
                *self.includes,
                source,
                "-o",
                target,
                *words,
            ]
            self._make(target, [source, *shared], command)

    def _robot_files(self, name: str) -> None:
        robot = robot_files.read(robot_files.path(name, "txt", self.built))
        (self.built / "robots").mkdir(exist_ok=True)
        robot_files.path(name, "urdf", self.built).write_text(robot_files.urdf(robot))
        robot_files.path(name, "xml", self.built).write_text(robot_files.mjcf(robot))

    def _cppadcodegen(self, name: str, function: str) -> None:
        robot = robot_files.path(name, "txt", self.built)
        folder = self.built / "generated" / name / function
        code = folder / "cppadcodegen.c"
        generator = self.built / "cppadcodegen"
        self._make(code, [robot, _stamp(generator)], [generator, robot, function, code])
        for lanes, ending in [(1, ""), (8, "_x8")]:
            if lanes == 1 or name in LANED:
                words = [f'-DSOURCE="{code}"', f"-DSYMBOL={function}", f"-DLANES={lanes}"]
                self._generated(folder / f"cppadcodegen{ending}.so", code, "generated.c", words, f"{name} {function}")

    def _casadi(self, name: str, function: str) -> None:
        robot = robot_files.path(name, "txt", self.built)
        folder = self.built / "generated" / name / function
        code = folder / "casadi" / f"{function}.c"
        code.parent.mkdir(parents=True, exist_ok=True)
        generator = self.built / "casadi"
        command = [generator, robot, function, code.parent]
        self._make(code, [robot, _stamp(generator)], command)
        words = [f'-DSOURCE="{code}"', f"-DSYMBOL={function}", f"-DCODE=casadi_{function}"]
        self._generated(folder / "casadi.so", code, "casadi_generated.c", words, f"{name} {function}")

    def _written(self, name: str) -> None:
        source = SOURCES / "written.c"
        target = self.built / "generated" / name / "mass/written_x8.so"
        values = robot_files.read(robot_files.path(name, "txt", self.built)).nv ** 2
        words = ["-DSYMBOL=mass", "-DLANES=8", f"-DVALUES={values}"]
        self._make(target, [source], ["gcc", *FAST, "-fPIC", "-shared", *words, source, "-o", target])

    def _generated(self, target: Path, code: Path, wrapper: str, words: list, what: str) -> None:
        source = SOURCES / wrapper
        command = ["gcc", *FAST, "-fPIC", "-shared", *words, source, "-o", target, "-lmvec", "-lm"]
        missing = target.with_suffix(".too-long")
        if missing.exists():
            return
        try:
            self._make(target, [source, code], command, PATIENCE)
        except subprocess.TimeoutExpired:
            missing.touch()
            print(f"  gcc takes longer than {PATIENCE:.0f} s for {what}: left out", file=sys.stderr)
