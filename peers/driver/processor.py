"""The processor of this machine: what tells it from others, and what it can do."""

import csv
import os
import platform
import re
from pathlib import Path

REPOSITORY = Path(__file__).parent.parent.parent
# Those of the benches and examples, too.
TABLE = REPOSITORY / "examples/common/processors.csv"
# What decides how fast this code is; the data of a run have no others.
FEATURES = ("avx2", "fma", "avx512f", "asimd", "sve")
# What code for x86-64-v3 takes for granted, as /proc/cpuinfo calls it.
V3 = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe", "xsave"}


def cpuinfo() -> str:
    return Path("/proc/cpuinfo").read_text()


def fields(text: str) -> dict[str, str]:
    """What the first core says of itself."""
    pairs = [line.partition(":") for line in text.split("\n\n")[0].splitlines()]
    return {key.strip(): value.strip() for key, _, value in pairs}


def described(text: str) -> dict:
    """The processor, as the data of a run have it."""
    about = fields(text)
    flags = about.get("flags", about.get("Features", "")).split()
    numbers = {
        "family": about.get("cpu family"),
        "model": about.get("model", about.get("CPU part")),
        "stepping": about.get("stepping", about.get("CPU revision")),
    }
    return {
        "name": name(about),
        "brand": about.get("model name", platform.machine()),
        **{key: number for key, number in numbers.items() if number is not None},
        "features": [flag for flag in FEATURES if flag in flags],
        "cores": os.cpu_count(),
    }


def runs_v3(text: str) -> bool:
    return V3 <= set(fields(text).get("flags", "").split())


def has_avx512(text: str) -> bool:
    """Whether its vectors have 512 bits."""
    return "avx512f" in fields(text).get("flags", "").split()


def name(about: dict[str, str]) -> str:
    """The brand without what every brand has, with the microarchitecture where that is known."""
    brand, kind = _plain(about.get("model name", "")), _microarchitecture(about)
    if brand and kind:
        return f"{brand} ({kind})"
    return brand or kind or f"unknown {platform.machine()} processor"


def slug(of: str) -> str:
    """The name in the names of files."""
    return re.sub(r"[^a-z0-9]+", "-", of.lower()).strip("-")


def _plain(brand: str) -> str:
    brand = re.sub(r"\((R|TM|tm)\)", "", brand).split(" @ ")[0].split(" with ")[0]
    return " ".join(word for word in brand.split() if word not in ("CPU", "Processor") and not word.endswith("-Core"))


def _microarchitecture(about: dict[str, str]) -> str | None:
    vendor = about.get("vendor_id", about.get("CPU implementer"))
    numbers = [about.get("cpu family"), about.get("model", about.get("CPU part")), about.get("stepping")]
    flags = ["", *about.get("flags", "").split()]
    lines = [line for line in TABLE.read_text().splitlines() if not line.startswith("#")]
    for maker, *ranges, flag, found in csv.reader(lines):
        if maker == vendor and flag in flags and all(_covers(cell, number) for cell, number in zip(ranges, numbers)):
            return found
    return None


def _covers(cell: str, number: str | None) -> bool:
    if not cell:
        return True
    first, _, last = cell.partition("-")
    return number is not None and int(first, 0) <= int(number, 0) <= int(last or first, 0)
