"""What one run found, as a section of the page."""

import robots as robot_files
from markdown import item, nanoseconds, paragraph, table
from programs import FUNCTIONS, LANED, PROGRAMS, REFERENCE
from requirements import PAPER, outcomes
from results import Times, subject

TITLES = {
    "kr5": "KR5",
    "gripper": "gripper",
    "humanoid30": "tree of 30",
    "anymal": "ANYmal",
    "talos": "TALOS",
    **{f"chain{n}": f"chain of {n}" for n in (10, 20, 40, 80)},
}


def section(run: dict, picture: str | None) -> str:
    """The section, with a picture if there is one at this path."""
    times = Times(run)
    drawn = f"![ns per call of all programs on the {run['processor']['name']}]({picture})\n" if picture else ""
    parts = [_head(run), drawn, _asked(times, run), _tasks(run), _times(times, run), _lanes(times), _agreement(run)]
    return "\n".join(part for part in parts if part)


def title(run: dict) -> str:
    return f"{subject(run)}, {run['date']}"


def _head(run: dict) -> str:
    it = run["processor"]
    numbers = [f"{key} {it[key]}" for key in ("family", "model", "stepping") if key in it]
    machine = [", ".join([it["brand"], *numbers, *it["features"]]), f"{it['cores']} cores" if "cores" in it else ""]
    text = "; ".join(part for part in [*machine, run.get("pinned", "")] if part) + "."
    if "redysim" in run:
        text += f" redysim {run['redysim']}."
    if run.get("compilers"):
        text += f" Compilers: {'; '.join(run['compilers'])}. Peers: {', '.join(run['peers'])}."
    note = paragraph(run["note"]) if "note" in run else ""
    return "\n".join(part for part in [f"## {title(run)}\n", note, paragraph(text)] if part)


def _asked(times: Times, run: dict) -> str:
    rows = []
    for outcome in outcomes(times):
        if outcome.ratio is None and run["partial"]:
            continue
        least = f"{outcome.least:g}" + (f" ({outcome.stretch:g})" if outcome.stretch else "")
        ratio = f"{outcome.ratio:.2f}" if outcome.ratio is not None else "–"
        what = f"{TITLES[outcome.robot]}, {FUNCTIONS[outcome.function]}"
        rows.append([outcome.asked, what, least, ratio, outcome.met])
    header = ["how many times as fast", "of", "asked (stretch)", "came out", "met"]
    return "### What was asked, and what came out\n\n" + table(header, rows, 2) if rows else ""


def _tasks(run: dict) -> str:
    names = {
        "task_inverse": "gripper, inverse dynamics over 1 s (101 instants, as shipped)",
        "task_fall": "gripper, free fall over 1 s (rtol 1e-4, atol 1e-6, as shipped)",
    }
    rows = []
    for symbol, ns in run.get("tasks", {}).items():
        rows.append([names[symbol], f"{PAPER[symbol]:g} s", f"{ns / 1e3:.3g} µs", f"{PAPER[symbol] * 1e9 / ns:,.0f}"])
    header = ["task", "ReDySim, in the paper", "redysim, f64", "ratio"]
    return "### ReDySim's own tasks\n\n" + table(header, rows) if rows else ""


def _times(times: Times, run: dict) -> str:
    names = [name for name in robot_files.NAMES if name in times.robots()]
    parts = ["### Times\n"]
    for function, function_title in FUNCTIONS.items():
        rows = []
        for program in (p for p in PROGRAMS if p.lanes == 1 and p.key in times.programs()):
            cells = [nanoseconds(times.of(program.key, name, function)) for name in names]
            rows.append([f"**{program.label}**" if program.key == "native_f64" else program.label, *cells])
        parts.append(table([function_title, *(TITLES[name] for name in names)], rows))
    if "steadiness" in run:
        parts.append(_steadiness(run))
    left_out = [f"Not built, since the compiler takes too long: {what}." for what in run.get("skipped", [])]
    left_out += [f"Not taken: {what}." for what in run.get("refused", [])]
    if left_out:
        parts.append("\n".join(map(item, left_out)) + "\n")
    return "\n".join(parts)


def _steadiness(run: dict) -> str:
    found = run["steadiness"]
    turns = "All programs took turns" if run.get("in_turns") else "Each program was timed in a process of its own"
    spread, loop = found["spread"], {key: ns / 1e3 for key, ns in found["calibration_ns"].items()}
    return paragraph(
        f"{turns}; medians of {found['repetitions']} repetitions. Between repetitions a time changes by "
        f"{100 * spread['median']:.1f} % in the middle, {100 * spread['largest']:.0f} % at most. The calibration loop "
        f"beside them took {loop['fastest']:.1f} µs at its fastest, {loop['median']:.1f} in the middle, "
        f"{loop['slowest']:.1f} at its slowest; {found['disturbed']} of {found['measurements']} measurements stayed "
        "disturbed by more than 5 %."
    )


def _lanes(times: Times) -> str:
    programs = [p for p in PROGRAMS if p.lanes > 1 and p.key in times.programs()]
    if not programs:
        return ""
    pairs = [(name, function) for name in LANED if name in times.robots() for function in FUNCTIONS]
    rows = [
        [f"{TITLES[name]}, {FUNCTIONS[function]}", *(nanoseconds(times.of(p.key, name, function)) for p in programs)]
        for name, function in pairs
    ]
    return "### Several states at once\n\n" + table(["", *(p.label for p in programs)], rows)


def _agreement(run: dict) -> str:
    columns = ["inverse", "forward", "forward_long", "mass"]
    rows = []
    for program in (p for p in PROGRAMS if p.key in run.get("agreement", {})):
        of = run["agreement"][program.key]
        cells = ["reference" if program is REFERENCE else f"{of[c]:.0e}" if c in of else "–" for c in columns]
        rows.append([program.label, *cells])
    header = ["", "inverse dynamics", "forward dynamics", "forward dynamics, chains of 40 and 80", "mass matrix"]
    return "### Agreement\n\n" + table(header, rows) if rows else ""
