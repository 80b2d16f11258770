"""Checks and times redysim beside other programs. Started by `peers/run`, which installs what this needs."""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

import build
import measure
import report
import robots
from programs import PROGRAMS, REFERENCE


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="peers/run", description="redysim's speed beside that of other programs")
    parser.add_argument("--only", metavar="ROBOTS", help=f"these robots, by commas, of {','.join(robots.NAMES)}")
    parser.add_argument("--core", type=int, default=1, help="the core that programs run on (1)")
    parser.add_argument("--skip-build", action="store_true", help="take what is built as it is")
    parser.add_argument("--build-only", action="store_true", help="build, and stop")
    parser.add_argument("--check-only", action="store_true", help="build and check, but time nothing")
    parser.add_argument("--report-only", action="store_true", help="write table and picture from the last run's times")
    parser.add_argument("--built", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--packages", type=Path, required=True, help=argparse.SUPPRESS)
    return parser.parse_args()


def main() -> None:
    chosen = arguments()
    names = chosen.only.split(",") if chosen.only else robots.NAMES
    unknown = [name for name in names if name not in robots.NAMES]
    if unknown:
        raise SystemExit(f"peers: there is no robot {unknown[0]}; there are {', '.join(robots.NAMES)}")
    stored = chosen.built / "results.json"
    if not chosen.report_only:
        results = run(chosen, names)
        if results is None:
            return
        stored.write_text(json.dumps(results, indent=1))
    elif not stored.exists():
        raise SystemExit("peers: there are no times yet: run without --report-only")
    results = json.loads(stored.read_text())
    # Some robots alone do not replace the page of all.
    report.write(results, chosen.built / "docs" if results["partial"] else build.REPOSITORY / "docs")


def run(chosen: argparse.Namespace, names: list[str]) -> dict | None:
    builder = build.Builder(chosen.built, chosen.packages)
    if not chosen.skip_build:
        print("building", flush=True)
        builder.everything(names)
    if chosen.build_only:
        return None
    lanes = build.has_lanes()
    programs = [program for program in PROGRAMS if lanes or not (program.ours and program.lanes > 1)]
    bench, results = measure.Bench(chosen.built, chosen.core), measure.Results(skipped=builder.skipped)
    print(f"checking against {REFERENCE.label}", flush=True)
    bench.check(programs, names, results)
    wrong = [d for d in results.deviations if not d.largest <= d.allowed]
    for d in wrong:
        print(
            f"  {d.program} disagrees: {d.robot} {d.function}, off by {d.largest:.1e}, allowed {d.allowed:.0e}",
            file=sys.stderr,
        )
    for refused in results.refused:
        print(f"  not taken: {refused}", file=sys.stderr)
    if wrong:
        raise SystemExit("peers: nothing is timed before all agree")
    print("all agree", flush=True)
    if chosen.check_only:
        return None
    bench.time(programs, names, results)
    tasks = (
        {symbol: bench.task(symbol, results) for symbol in ("task_inverse", "task_fall")} if "gripper" in names else {}
    )
    return {
        "partial": len(names) < len(robots.NAMES),
        "deviations": [asdict(d) for d in results.deviations],
        "times": {" ".join(key): times for key, times in results.times.items()},
        "calibrations": results.calibrations,
        "disturbed": results.disturbed,
        "refused": results.refused,
        "skipped": results.skipped,
        "pinned": results.pinned,
        "tasks": tasks,
        "machine": report.machine(chosen.packages),
    }


if __name__ == "__main__":
    try:
        main()
    except build.Failed as failed:
        raise SystemExit(f"peers: {failed}") from None
    except KeyboardInterrupt:
        raise SystemExit("peers: stopped") from None
