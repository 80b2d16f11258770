"""Where samples are computed: processes, executors, clusters."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, ProcessPoolExecutor, wait
from functools import lru_cache

from . import _core

SECONDS = 0.2
"""How long the samples take together that are sent to a worker at once: long beside the way to it, and short beside
what one is ready to lose."""

MOST = 1000
"""How many these are at most."""

ATTEMPTS = 2
"""How often a sample that is alone may end its worker before it counts as failed."""


@lru_cache(maxsize=4)
def _sampler(text: str) -> _core.Sampler:
    return _core.Sampler(text)


def run_samples(sampler: str, samples: list[str]) -> tuple[list[tuple[int, str]], float]:
    """The rows of samples, and the seconds that they took. Runs in whatever process has the package."""
    begun = time.perf_counter()
    rows = [_sampler(sampler).row(sample) for sample in samples]
    return [row for row in rows if row is not None], time.perf_counter() - begun


class Processes:
    """Processes on this machine. They are started anew when one of them dies, for the others end with it."""

    def __init__(self, jobs: int | None):
        # Those that this process may use, of a container or a batch job fewer than there are.
        usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self.jobs = jobs or usable
        self.begin()

    def begin(self) -> None:
        self.executor = ProcessPoolExecutor(self.jobs, multiprocessing.get_context("spawn"))
        try:
            self.executor.submit(os.getpid).result()
        except BrokenExecutor as error:
            raise RuntimeError(GUARD) from error

    def slots(self) -> int:
        # One for each process, and one that it finds when it is done.
        return 2 * self.jobs

    def submit(self, *call) -> Future:
        return self.executor.submit(*call)

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, BrokenExecutor)

    def recover(self) -> None:
        self.executor.shutdown(wait=False, cancel_futures=True)
        self.begin()

    def end(self, at_once: bool) -> None:
        if at_once:
            # A sample may take long.
            for process in list((self.executor._processes or {}).values()):
                process.kill()
        self.executor.shutdown(wait=not at_once, cancel_futures=True)


GUARD = """worker processes do not start: in a script, call redysim.sweep below

    if __name__ == "__main__":

for every worker process imports the script; or give executor="""


class Given:
    """An executor that the caller has begun, and will end."""

    def __init__(self, executor):
        self.executor = executor

    def slots(self) -> int:
        return 2 * getattr(self.executor, "_max_workers", os.cpu_count() or 1)

    def submit(self, *call) -> Future:
        return self.executor.submit(*call)

    def is_loss(self, error: BaseException) -> bool:
        return False

    def recover(self) -> None:
        pass

    def end(self, at_once: bool) -> None:
        pass


class Dask(Given):
    """A cluster of dask. It has the samples of a worker that dies computed by another one, and gives them back after
    the third that they were on."""

    def __init__(self, client):
        super().__init__(client.get_executor(pure=False))
        self.client, self.looked, self.threads = client, float("-inf"), 1

    def slots(self) -> int:
        # Workers come and go, but to ask takes as long as a sample.
        if time.monotonic() - self.looked > 1:
            self.threads, self.looked = sum(self.client.nthreads().values()), time.monotonic()
        return 2 * max(self.threads, 1)

    def is_loss(self, error: BaseException) -> bool:
        from distributed import KilledWorker

        return isinstance(error, KilledWorker)

    def end(self, at_once: bool) -> None:
        self.executor.shutdown(wait=False)


class Ray(Given):
    """A cluster of Ray, which has what a dead worker leaves computed by others, too, and reports it as lost after the
    fourth that it was on."""

    LOSSES = ("NodeDiedError", "ObjectLostError", "OutOfMemoryError", "WorkerCrashedError")
    """What it reports where a worker or its machine has died, or where rows are lost with the machine that had them."""

    def __init__(self, ray):
        super().__init__(ray)
        self.remote = ray.remote(run_samples)
        self.losses = tuple(getattr(ray.exceptions, name) for name in self.LOSSES if hasattr(ray.exceptions, name))

    def slots(self) -> int:
        # As long as no machine is there, the cluster has no entry for its processors, or none of them.
        return 2 * max(int(self.executor.cluster_resources().get("CPU", 0)), 1)

    def submit(self, _, *arguments) -> Future:
        return self.remote.remote(*arguments).future()

    def is_loss(self, error: BaseException) -> bool:
        return isinstance(error, self.losses)


def workers(executor, jobs: int | None):
    """The workers that an executor stands for."""
    if executor is None:
        return Processes(jobs)
    if hasattr(executor, "get_executor"):
        return Dask(executor)
    if getattr(executor, "__name__", None) == "ray":
        return Ray(executor)
    if hasattr(executor, "submit"):
        return Given(executor)
    raise TypeError(
        "executor must be a dask.distributed.Client, the module ray, or a concurrent.futures.Executor, "
        f"not {type(executor).__name__}"
    )


def compute(study: _core.Study, rows, executor, jobs: int | None, progress) -> None:
    """Computes the rows that are missing, and adds them as they come."""
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise RuntimeError(GUARD)
    if missing := rows.missing():
        pool = workers(executor, jobs)
        at_once = True
        try:
            Computation(study, rows, pool, progress).run(missing)
            at_once = False
        except (BrokenExecutor, CancelledError) as error:
            # A cluster whose scheduler ends cancels what it was given, without a reason.
            reason = str(error) or "its calls are cancelled, as where the scheduler of a cluster has ended"
            kept = f"{len(rows)} of {len(study)} samples are kept in {rows.path}"
            help = "give another executor: the same call then goes on with the rest"
            raise _core.RedysimError(f"error: the executor is broken: {reason}; {kept}\n  = help: {help}") from error
        finally:
            pool.end(at_once)
    rows.finish()


class Computation:
    """The samples on their way."""

    def __init__(self, study, rows, pool, progress):
        self.study, self.rows, self.pool, self.progress = study, rows, pool, progress
        self.sampler = study.sampler()
        self.running: dict[Future, list[int]] = {}
        # Samples that were under way when a worker died. Each is run alone, to know which of them it is.
        self.suspects: deque[int] = deque()
        self.deaths: Counter[int] = Counter()
        self.size = 1

    def run(self, missing: list[int]) -> None:
        waiting = deque(missing)
        while waiting or self.suspects or self.running:
            if self.suspects:
                if not self.running:
                    self.submit([self.suspects.popleft()])
            else:
                slots = self.pool.slots()
                while waiting and len(self.running) < slots:
                    # At the end, each is to have a part of what is left.
                    size = max(1, min(self.size, len(waiting) // slots))
                    self.submit([waiting.popleft() for _ in range(size)])
            self.receive()

    def submit(self, indices: list[int]) -> None:
        samples = [self.study.sample(index) for index in indices]
        try:
            future = self.pool.submit(run_samples, self.sampler, samples)
        except BrokenExecutor as error:
            # A process has died between two samples; what was under way is known to be lost when it is received.
            future = Future()
            future.set_exception(error)
        self.running[future] = indices

    def receive(self) -> None:
        """Takes what is done, and what is lost."""
        done, _ = wait(self.running, return_when=FIRST_COMPLETED)
        lost = []
        for future in done:
            indices = self.running.pop(future)
            try:
                computed, seconds = future.result()
            except BaseException as error:
                if not self.pool.is_loss(error):
                    raise
                lost.append((indices, error))
                continue
            for index, row in computed:
                self.rows.add(index, row)
            if seconds > 0:
                self.size = max(1, min(MOST, int(SECONDS * len(indices) / seconds)))
            if self.progress:
                self.progress(len(self.rows), len(self.study))
        if lost:
            self.lose(lost)

    def lose(self, lost: list[tuple[list[int], BaseException]]) -> None:
        alone = len(lost) == 1 and len(lost[0][0]) == 1 and not self.running
        if isinstance(self.pool, Processes):
            # All others of the pool are lost with it, but for those that were done before.
            wait(self.running)
            for future, indices in list(self.running.items()):
                if (error := future.exception()) is not None:
                    del self.running[future]
                    lost.append((indices, error))
        self.pool.recover()
        for indices, error in lost:
            self.suspects.extend(indices)
            if alone:
                self.blame(indices[0], error)

    def blame(self, index: int, error: BaseException) -> None:
        """Notes that a worker died while it computed this sample alone."""
        self.deaths[index] += 1
        if self.deaths[index] < ATTEMPTS:
            return
        self.suspects.remove(index)
        reason = f"it has ended its worker {self.deaths[index]} times: {type(error).__name__}"
        self.rows.add(index, _sampler(self.sampler).failed_row(self.study.sample(index), reason))
