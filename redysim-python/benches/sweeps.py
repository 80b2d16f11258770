#!/usr/bin/env python3
"""Samples and states a second of a sweep by the command and in Python, and what a cluster of dask on this machine adds to
each sample: in turns, the best of five. The four-bar's crank turns once, 134 instants.

    python redysim-python/benches/sweeps.py [SAMPLES [COMMAND]]

COMMAND is the command `redysim`, by default the one of `cargo build --release`; without it, its rows are left out."""

import datetime
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import redysim
from redysim._sweep import definition

ROOT = Path(__file__).parents[2]
SCENARIO = ROOT / "scenarios/fourbar.toml"
COUNT = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
COMMAND = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "target/release/redysim"
SAMPLES = {"count": COUNT, "model.loop.crank-coupler.point_a.0": {"normal": [0.038, 5e-5]}}
INSTANTS = 134


def in_python(folder: Path, **options) -> None:
    redysim.sweep(SCENARIO, run="inverse", samples=SAMPLES, folder=folder / "rows", **options)


def by_the_command(folder: Path, jobs: int) -> None:
    study = folder / "study.toml"
    study.write_text(definition(SCENARIO, None, SAMPLES, "inverse", None))
    subprocess.run([COMMAND, "sweep", study, "-o", folder / "rows", "--jobs", str(jobs)], check=True, capture_output=True)


def seconds(way, options) -> float:
    """Of all samples."""
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        way(Path(folder), **options)
        return time.perf_counter() - begun


def processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.exists() else []
    found = dict(tuple(map(str.strip, line.split(":", 1))) for line in lines if ":" in line)
    return f"{found.get('model name')}, family {found.get('cpu family')}, model {found.get('model')}"


def main() -> None:
    from distributed import Client, LocalCluster

    cores = len(os.sched_getaffinity(0))
    print(f"{datetime.date.today()}, {processor()}, {cores} cores, load {os.getloadavg()[0]:.1f}")
    ways = {}
    if COMMAND.exists():
        ways |= {f"redysim sweep --jobs {jobs}": (by_the_command, {"jobs": jobs}) for jobs in range(1, cores + 1)}
    ways |= {f"{jobs} processes, with their start": (in_python, {"jobs": jobs}) for jobs in range(1, cores + 1)}
    cluster = {"n_workers": cores, "threads_per_worker": 1, "host": "127.0.0.1", "dashboard_address": None, "silence_logs": 50}
    with LocalCluster(**cluster) as workers, Client(workers) as client, ThreadPoolExecutor(cores) as threads:
        client.wait_for_workers(cores)
        ways[f"{cores} threads"] = (in_python, {"executor": threads})
        ways[f"dask, {cores} workers"] = (in_python, {"executor": client})
        best = dict.fromkeys(ways, float("inf"))
        for _ in range(5):
            for name, way in ways.items():
                best[name] = min(best[name], seconds(*way))
        for name, least in best.items():
            rate = COUNT / least
            print(f"{name:32} {rate:8.0f} samples/s {rate * INSTANTS:10.0f} states/s {1e3 / rate:8.2f} ms for each sample")
        # The way to a worker and back of one task, without a sample.
        begun = time.perf_counter()
        tasks = [client.submit(os.getppid, pure=False) for _ in range(1000)]
        client.gather(tasks)
        print(f"a task of dask alone {1e3 * (time.perf_counter() - begun):.0f} µs")


if __name__ == "__main__":
    main()
