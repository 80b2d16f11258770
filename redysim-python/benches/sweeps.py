#!/usr/bin/env python3
"""Samples a second of a sweep against processes, and what a cluster of dask on this machine adds to each sample: in
turns, the best of three. The four-bar's crank turns once, 134 instants."""

import os
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import redysim

SCENARIOS = Path(__file__).parents[2] / "scenarios"
COUNT = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
SAMPLES = {"count": COUNT, "model.loop.crank-coupler.point_a.0": {"normal": [0.038, 5e-5]}}


def seconds(**options) -> float:
    """Of all samples, with processes that run already."""
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        redysim.sweep(SCENARIOS / "fourbar.toml", run="inverse", samples=SAMPLES, folder=Path(folder) / "rows", **options)
        return time.perf_counter() - begun


def main() -> None:
    from distributed import Client, LocalCluster

    cores = len(os.sched_getaffinity(0))
    ways = {f"{jobs} processes, with their start": {"jobs": jobs} for jobs in range(1, cores + 1)}
    cluster = {"n_workers": cores, "threads_per_worker": 1, "host": "127.0.0.1", "dashboard_address": None, "silence_logs": 50}
    with LocalCluster(**cluster) as workers, Client(workers) as client, ThreadPoolExecutor(cores) as threads:
        client.wait_for_workers(cores)
        ways["threads"] = {"executor": threads}
        ways[f"dask, {cores} workers"] = {"executor": client}
        best = dict.fromkeys(ways, float("inf"))
        for _ in range(3):
            for way, options in ways.items():
                best[way] = min(best[way], seconds(**options))
        for way, least in best.items():
            print(f"{way:32} {COUNT / least:8.0f} samples/s {1e3 * least / COUNT:8.2f} ms for each")
        # The way to a worker and back of one task, without a sample.
        begun = time.perf_counter()
        tasks = [client.submit(os.getppid, pure=False) for _ in range(1000)]
        client.gather(tasks)
        print(f"a task of dask alone {1e3 * (time.perf_counter() - begun):.0f} µs")


if __name__ == "__main__":
    main()
