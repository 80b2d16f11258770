"""Writes `docs/peers.md` and the picture in it from the times of a run."""

import os
import platform
import subprocess
from datetime import date
from importlib.metadata import version
from pathlib import Path
from statistics import median

import chart
import robots as robot_files
from programs import FUNCTIONS, PROGRAMS, REFERENCE, SPECIAL
from requirements import PAPER, Times, outcomes

TITLES = {
    "kr5": "KR5",
    "gripper": "gripper",
    "humanoid30": "tree of 30",
    **{f"chain{n}": f"chain of {n}" for n in (10, 20, 40, 80)},
}


def machine(_packages: Path) -> dict:
    """What the times were taken on and with."""

    def first_line(*command: str) -> str:
        return subprocess.run(command, capture_output=True, text=True).stdout.splitlines()[0]

    lines = Path("/proc/cpuinfo").read_text().splitlines()
    about = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)}
    vectors = [flag for flag in ("avx2", "fma", "avx512f") if flag in about.get("flags", "").split()]
    return {
        "date": date.today().isoformat(),
        "processor": f"{about.get('model name', platform.machine())}, family {about.get('cpu family', '?')}, "
        f"model {about.get('model', '?')}, {', '.join(vectors)}; {os.cpu_count()} cores",
        "redysim": first_line("git", "describe", "--always", "--dirty"),
        "compilers": [first_line(name, "--version") for name in ("rustc", "gcc", "clang")],
        "peers": [
            f"{name} {version(name)}" for name in ("pin", "cmeel-cppad", "cmeel-cppadcodegen", "casadi", "mujoco")
        ]
        + ["dynibo " + _locked("dynibo")],
    }


def _locked(crate: str) -> str:
    lines = (robot_files.FOLDER.parent / crate / "Cargo.lock").read_text().splitlines()
    return lines[lines.index(f'name = "{crate}"') + 1].split('"')[1]


def write(results: dict, docs: Path) -> None:
    times = Times(results)
    picture = docs / "pictures/peers.svg"
    picture.parent.mkdir(parents=True, exist_ok=True)
    picture.write_text(chart.drawn(times, TITLES))
    sections = [
        _head(results),
        _asked(times),
        _tasks(results),
        _times(times, results),
        _lanes(times),
        _agreement(results),
        _how(results),
    ]
    page = docs / "peers.md"
    page.write_text("\n".join(section for section in sections if section).replace("\n\n\n", "\n\n"))
    print(f"written: {page} and {picture}")


def _row(cells) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def _table(header: list[str], rows: list[list[str]], left: int = 1) -> str:
    rule = ["---"] * left + ["--:"] * (len(header) - left)
    return "\n".join([_row(header), _row(rule), *(_row(row) for row in rows)]) + "\n"


def _ns(time: float | None) -> str:
    if time is None:
        return "–"
    return f"{time:.1f}" if time < 100 else f"{time:.0f}"


def _head(results: dict) -> str:
    m = results["machine"]
    return f"""# Beside other programs

One run of `peers/run` on {m["date"]}, redysim {m["redysim"]}. {m["processor"]}; {results["pinned"]}.
Times are of one machine on one day: look at the ratios, and run it on yours.

![ns per call of all programs](pictures/peers.svg)
"""


def _asked(times: Times) -> str:
    rows = []
    for outcome in outcomes(times):
        if outcome.ratio is None and not any(outcome.robot in key for key in times.all):
            continue
        least = f"{outcome.least:g}" + (f" ({outcome.stretch:g})" if outcome.stretch else "")
        ratio = f"{outcome.ratio:.2f}" if outcome.ratio is not None else "–"
        what = f"{TITLES[outcome.robot]}, {FUNCTIONS[outcome.function]}"
        rows.append([outcome.asked, what, least, ratio, outcome.met])
    header = ["how many times as fast", "of", "asked (stretch)", "came out", "met"]
    return "## What was asked, and what came out\n\n" + _table(header, rows, 2)


def _tasks(results: dict) -> str:
    if not results["tasks"]:
        return ""
    names = {
        "task_inverse": "gripper, inverse dynamics over 1 s (101 instants, as shipped)",
        "task_fall": "gripper, free fall over 1 s (rtol 1e-4, atol 1e-6, as shipped)",
    }
    rows = []
    for symbol, ns in results["tasks"].items():
        rows.append([names[symbol], f"{PAPER[symbol]:g} s", f"{ns / 1e3:.3g} µs", f"{PAPER[symbol] * 1e9 / ns:,.0f}"])
    return (
        "## ReDySim's own tasks\n\n"
        + _table(["task", "ReDySim, in the paper", "redysim, f64", "ratio"], rows)
        + "\nThe paper's times are those of MATLAB on a processor of 2006 at 1.66 GHz: most of the ratio is that. It gives "
        "ADAMS 1.95 s and 39 s on the same machine.\n"
    )


def _times(times: Times, results: dict) -> str:
    names = [name for name in robot_files.NAMES if any(key[1] == name for key in times.all)]
    parts = ["## Times\n", "ns per call, one state per call; a dash: not built or not taken, see below.\n"]
    for function, title in FUNCTIONS.items():
        rows = []
        for program in (p for p in PROGRAMS if p.lanes == 1):
            cells = [_ns(times.of(program.key, name, function)) for name in names]
            rows.append([f"**{program.label}**" if program.key == "native_f64" else program.label, *cells])
        parts.append(_table([title, *(TITLES[name] for name in names)], rows))
    spreads = [max(all_times) / min(all_times) - 1 for all_times in times.all.values()]
    calibrations = results["calibrations"]
    parts.append(
        f"Medians of {len(next(iter(times.all.values())))} repetitions, each the median of 41 batches. Between repetitions a "
        f"time changes by {100 * median(spreads):.1f} % in the middle, {100 * max(spreads):.0f} % at most. The calibration "
        f"loop beside them took {min(calibrations) / 1e3:.1f} µs at its fastest, {median(calibrations) / 1e3:.1f} in the "
        f"middle, {max(calibrations) / 1e3:.1f} at its slowest; {results['disturbed']} of {len(calibrations)} measurements "
        "stayed disturbed by more than 5 %.\n"
    )
    return "\n".join(parts)


def _lanes(times: Times) -> str:
    programs = [p for p in PROGRAMS if p.lanes > 1 and any(key[0] == p.key for key in times.all)]
    if not programs:
        return ""
    names = [name for name in SPECIAL if any(key[1] == name for key in times.all)]
    pairs = [(name, function) for name in names for function in FUNCTIONS]
    rows = [
        [f"{TITLES[name]}, {FUNCTIONS[function]}", *(_ns(times.of(p.key, name, function)) for p in programs)]
        for name, function in pairs
    ]
    text = "## Several states at once\n\nns per state; the states lie side by side in memory already.\n\n"
    return text + _table(["", *(p.label for p in programs)], rows)


def _agreement(results: dict) -> str:
    rows = []
    for program in PROGRAMS:
        cells = []
        for function in FUNCTIONS:
            for long in (False, True):
                if long and function != "forward":
                    continue
                of = [
                    d["largest"]
                    for d in results["deviations"]
                    if d["program"] == program.key
                    and d["function"] == function
                    and (function != "forward" or (d["robot"] in ("chain40", "chain80")) == long)
                ]
                cells.append(f"{max(of):.0e}" if of else "–")
        if any(cell != "–" for cell in cells):
            rows.append([program.label, *(["reference"] * len(cells) if program is REFERENCE else cells)])
    header = ["", "inverse dynamics", "forward dynamics", "forward dynamics, chains of 40 and 80", "mass matrix"]
    return (
        "## Agreement\n\nThe largest deviation from redysim's f64 of any component at 256 random states, relative to the "
        "component, or to a part of the state's largest component if that is more: 1e-6 of it for f64, 1e-2 for f32. Nothing "
        "is timed unless f64 stays below 1e-8 (1e-7 in the forward dynamics of the chains of 40 and 80, whose mass matrices "
        "are ill-conditioned) and f32 below 1e-2.\n\n" + _table(header, rows)
    )


def _how(results: dict) -> str:
    m = results["machine"]
    left_out = [f"- Not built, since the compiler takes too long: {what}." for what in results["skipped"]]
    left_out += [f"- Not taken: {what}." for what in results["refused"]]
    return "\n".join(
        [
            "## How it is measured\n",
            f"Compilers: {'; '.join(m['compilers'])}. Peers: {', '.join(m['peers'])}.\n",
            (robot_files.FOLDER.parent / "driver/method.md").read_text(),
            *left_out,
            "",
        ]
    )
