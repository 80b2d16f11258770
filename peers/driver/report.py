"""Writes `docs/peers.md`, with a picture for each processor, from the data of all runs."""

import subprocess
from importlib.metadata import version
from pathlib import Path

import chart
import processor
import robots as robot_files
from markdown import nanoseconds, paragraph, table
from programs import FUNCTIONS
from results import Times, subject
from section import TITLES, section, title

DRIVER = Path(__file__).parent


def made_with() -> dict:
    """The commit, the compilers and the versions of the peers."""

    def first_line(*command: str) -> str:
        return subprocess.run(command, capture_output=True, text=True).stdout.splitlines()[0]

    peers = [f"{name} {version(name)}" for name in ("pin", "cmeel-cppad", "cmeel-cppadcodegen", "casadi", "mujoco")]
    return {
        "redysim": first_line("git", "describe", "--always", "--dirty"),
        "compilers": [first_line(name, "--version") for name in ("rustc", "gcc", "clang")],
        "peers": [*peers, "dynibo " + _locked("dynibo")],
    }


def _locked(crate: str) -> str:
    lines = (robot_files.FOLDER.parent / crate / "Cargo.lock").read_text().splitlines()
    return lines[lines.index(f'name = "{crate}"') + 1].split('"')[1]


def write(runs: list[dict], docs: Path) -> None:
    """The page of these runs, in this order."""
    page = docs / "peers.md"
    pictures = docs / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    for run in (run for run in runs if _is_drawn(run)):
        (docs / picture_of(run)).write_text(chart.drawn(Times(run), TITLES))
    page.write_text(text(runs))
    print(f"written: {page} and the pictures in {pictures}")


def _is_drawn(run: dict) -> bool:
    """A part of a run has a table alone."""
    return "agreement" in run


def picture_of(run: dict) -> str:
    return f"pictures/peers_{processor.slug(subject(run))}.svg"


def text(runs: list[dict]) -> str:
    sections = [section(run, picture_of(run) if _is_drawn(run) else None) for run in runs]
    return "\n".join([*_head(runs), (DRIVER / "reading.md").read_text(), *sections, _method()])


def _head(runs: list[dict]) -> list[str]:
    rows = []
    for run in runs:
        times = Times(run)
        ours = [times.of("native_f64", "kr5", function) for function in FUNCTIONS]
        if not any(ours):
            continue
        against = [_ratios(times, peers) for peers in (["cppadcodegen", "casadi"], ["pinocchio"])]
        name = f"[{title(run)}](#{_anchor(title(run))})" + (f", {run['remark']}" if "remark" in run else "")
        rows.append([name, " / ".join(map(nanoseconds, ours)), *against])
    header = [
        "KR5: inverse dynamics / forward dynamics / mass matrix",
        "redysim, f64, native, ns",
        "times as fast as the faster of CppADCodeGen and CasADi",
        "as Pinocchio",
    ]
    intro = paragraph(
        "redysim's speed beside that of Pinocchio, CppADCodeGen, CasADi, MuJoCo and dynibo, on the same robots: for "
        "each processor its last run of `peers/run`. Times are of one machine on one day: look at the ratios, and run "
        "it on yours."
    )
    return ["# Beside other programs\n", intro, *([table(header, rows)] if rows else [])]


def _ratios(times: Times, peers: list[str]) -> str:
    found = [times.ratio(peers, "native_f64", "kr5", function) for function in FUNCTIONS]
    return " / ".join("–" if ratio is None else f"{ratio:.1f}" for ratio in found)


def _anchor(heading: str) -> str:
    """The anchor that a heading has where Markdown is shown."""
    return "".join(c for c in heading.lower().replace(" ", "-") if c.isalnum() or c in "-_")


def _method() -> str:
    return "## How it is measured\n\n" + (DRIVER / "method.md").read_text()
