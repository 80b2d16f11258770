"""Checks and times redysim beside other programs. Started by `peers/run`, which installs what this needs."""

import argparse
import sys
from datetime import date
from pathlib import Path

import build
import processor
import report
import results as stored
import robots
from programs import REFERENCE


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="peers/run", description="redysim's speed beside that of other programs")
    parser.add_argument("--only", metavar="ROBOTS", help=f"these robots, by commas, of {','.join(robots.NAMES)}")
    parser.add_argument("--keep-as", metavar="PART", help="with --only: keep the run beside that on all robots")
    parser.add_argument("--core", type=int, default=1, help="the core that programs run on (1)")
    parser.add_argument("--skip-build", action="store_true", help="take what is built as it is")
    parser.add_argument("--skip-peers", action="store_true", help="build redysim alone, take the others as they are")
    parser.add_argument("--build-only", action="store_true", help="build, and stop")
    parser.add_argument("--check-only", action="store_true", help="build and check, but time nothing")
    parser.add_argument("--report-only", action="store_true", help="write page and pictures again from peers/results")
    parser.add_argument("--built", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--packages", type=Path, required=True, help=argparse.SUPPRESS)
    return parser.parse_args()


def main() -> None:
    chosen = arguments()
    names = chosen.only.split(",") if chosen.only else robots.NAMES
    unknown = [name for name in names if name not in robots.NAMES]
    if unknown:
        raise SystemExit(f"peers: there is no robot {unknown[0]}; there are {', '.join(robots.NAMES)}")
    if chosen.keep_as and len(names) == len(robots.NAMES):
        raise SystemExit("peers: --keep-as is for a run on some robots: name them with --only")
    folder, docs = stored.FOLDER, build.REPOSITORY / "docs"
    if not chosen.report_only:
        found = run(chosen, names)
        if found is None:
            return
        # Some robots alone do not replace a run on all.
        if found["partial"] and "part" not in found:
            folder, docs = chosen.built / "results", chosen.built / "docs"
        print(f"written: {stored.save(found, folder)}")
    report.write(stored.load(folder), docs)


def run(chosen: argparse.Namespace, names: list[str]) -> dict | None:
    import measure  # With numpy, which a report does without.

    builder = build.Builder(chosen.built, chosen.packages)
    if not chosen.skip_build:
        print("building", flush=True)
        if chosen.skip_peers:
            builder.redysim()
        else:
            builder.everything(names)
    if chosen.build_only:
        return None
    programs = build.runnable()
    bench, results = measure.Bench(chosen.built, chosen.core), measure.Results(skipped=builder.skipped(names))
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
    tasks = bench.tasks(results) if "gripper" in names else {}
    if not results.times:
        raise SystemExit("peers: other programs kept taking the core: stop them, or take another core (--core)")
    return {
        "processor": processor.described(processor.cpuinfo()),
        "date": date.today().isoformat(),
        "partial": len(names) < len(robots.NAMES),
        **({"part": chosen.keep_as} if chosen.keep_as else {}),
        "pinned": results.pinned,
        "in_turns": True,
        **report.made_with(),
        "times": stored.recorded(results.times),
        "tasks": tasks,
        "steadiness": stored.steadiness(results.times, results.calibrations, results.disturbed),
        "agreement": measure.agreement(results.deviations),
        "refused": results.refused,
        "skipped": results.skipped,
    }


if __name__ == "__main__":
    try:
        main()
    except build.Failed as failed:
        raise SystemExit(f"peers: {failed}") from None
    except KeyboardInterrupt:
        raise SystemExit("peers: stopped") from None
