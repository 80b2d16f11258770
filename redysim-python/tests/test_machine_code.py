"""Vectors of compiled functions on processors with AVX-512: those of 512 bits are for many states, since a single one may slow
down the code for one state around it by more than it saves."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import redysim
from conftest import MODELS

NARROW = ["-mprefer-vector-width=256", "-mmove-max=256", "-mstore-max=256"]
# The compiler without these flags.
WIDE = """#!/bin/sh
for each do
    shift
    case $each in -mprefer-vector-width=* | -mmove-max=* | -mstore-max=*) ;; *) set -- "$@" "$each" ;; esac
done
exec cc "$@"
"""


@pytest.fixture(autouse=True)
def tools():
    processor = Path("/proc/cpuinfo")
    if not (processor.exists() and " avx512f " in processor.read_text()):
        pytest.skip("the processor has no vectors of 512 bits")
    for tool in ("objdump", "cc"):
        if shutil.which(tool) is None:
            pytest.skip(f"{tool} is not installed")
    if subprocess.run(["cc", *NARROW, "-fsyntax-only", "-x", "c", "/dev/null"], capture_output=True).returncode != 0:
        pytest.skip("the compiler is not GCC 12 or later")


ARITHMETIC = re.compile(r"^.*\tv(?:f?n?m(?:add|sub)\d+|mul|add|sub|div|sqrt)pd\s.*%zmm", re.MULTILINE)


def wide_instructions(library):
    """The numbers of instructions with a register of 512 bits in each function: of all, and of arithmetic."""
    command = ["objdump", "--disassemble", "--no-show-raw-insn", library]
    code = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    blocks = re.split(r"^[0-9a-f]+ <(.+)>:$", code, flags=re.MULTILINE)
    functions = {name: block for name, block in zip(blocks[1::2], blocks[2::2]) if "@" not in name}
    every = {name: len(re.findall("^.*%zmm", block, re.MULTILINE)) for name, block in functions.items()}
    return every, {name: len(ARITHMETIC.findall(block)) for name, block in functions.items()}


def library(model, compiler, cache, monkeypatch):
    monkeypatch.setenv("REDYSIM_CACHE", str(cache))
    return redysim.load(MODELS / model).compile(compiler=str(compiler)).library


@pytest.mark.parametrize("model", ["kr5.toml", "gripper.toml"])
def test_code_for_one_state_has_256_bits_and_lanes_have_512(model, tmp_path, monkeypatch):
    every, arithmetic = wide_instructions(library(model, "cc", tmp_path / "cache", monkeypatch))
    wide = tmp_path / "cc"
    wide.write_text(WIDE)
    wide.chmod(0o755)
    every_without, arithmetic_without = wide_instructions(library(model, wide, tmp_path / "wide", monkeypatch))
    # Sines and cosines are inlined, but for the slow path.
    single = [name for name in every if name.startswith("mechanism_") or "slow" in name]
    assert {"mechanism_inverse_dynamics", "redysim_slow_sin_cos"} < set(single)
    assert {name: every[name] for name in single if every[name] > 0} == {}
    # Functions in lanes, and what puts states into lanes, with no less of 512 bits than GCC chooses by itself.
    many = [name for name in every_without if name.startswith("redysim_") and name not in single]
    assert sum(arithmetic_without[name] for name in many if name.startswith("redysim_lanes_")) > 500
    for name in many:
        assert every[name] >= every_without[name] and arithmetic[name] >= arithmetic_without[name], name
