"""Sweeps on a cluster of Ray: on one of this machine where Ray is installed, and on a stand-in that reports what Ray does."""

import os
import signal
import types
from concurrent.futures import Future

import pytest
import redysim
from redysim import _workers
from test_sweep import drawn, fall, text, threads  # noqa: F401


def computed(fall, name, samples, **options):  # noqa: F811
    """What a sweep has found, and its rows."""
    folder = fall.parent / name
    return redysim.sweep(fall, samples=samples, folder=folder, **options), text(folder)


@pytest.fixture
def losses(monkeypatch):
    """The errors by which samples are lost."""
    errors = []
    lose = _workers.Computation.lose

    def noted(self, lost):
        errors.extend(error for _, error in lost)
        lose(self, lost)

    monkeypatch.setattr(_workers.Computation, "lose", noted)
    return errors


@pytest.fixture
def ray(monkeypatch):
    """Ray, with a cluster of two workers on this machine."""
    ray = pytest.importorskip("ray")
    # It reports nothing to its makers, and leaves nothing in the folder of the user.
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    monkeypatch.setenv("RAY_AUTH_MODE", "disabled")
    ray.init(address="local", num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield ray
    ray.shutdown()


def with_notes(run_samples, folder):
    """The same function, which notes the begin and the end of each call in a file of its process."""

    def noted(sampler, samples):
        def note(sign):
            with open(folder / str(os.getpid()), "a") as file:
                file.write(sign)

        note("<")
        found = run_samples(sampler, samples)
        note(">")
        return found

    return noted


@pytest.mark.parametrize("retries", ["3", "0"], ids=["ray computes them again", "sweep computes them again"])
def test_a_killed_worker_of_ray_loses_nothing(ray, fall, threads, losses, tmp_path, monkeypatch, retries):  # noqa: F811
    fall.write_text(fall.read_text().replace("end = 0.5", "end = 5.0"))
    samples = drawn(300)
    _, expected = computed(fall, "threads", samples, executor=threads)
    # How often Ray has a task whose worker dies computed by another one.
    monkeypatch.setenv("RAY_TASK_MAX_RETRIES", retries)
    notes = tmp_path / "notes"
    notes.mkdir()
    monkeypatch.setattr(_workers, "run_samples", with_notes(_workers.run_samples, notes))
    killed = []

    def is_busy(place):
        return place.read_text().endswith("<")

    def kill(done, total):
        if not any(map(is_busy, killed)) and done < total:
            busy = filter(is_busy, notes.iterdir())
            for place in list(busy)[:1]:
                os.kill(int(place.name), signal.SIGKILL)
                killed.append(place)

    found, ours = computed(fall, "rows", samples, executor=ray, progress=kill)
    assert any(map(is_busy, killed)), "a worker had samples when it was killed"
    assert not found.failures and ours == expected
    assert {type(error) for error in losses} == ({ray.exceptions.WorkerCrashedError} if retries == "0" else set())
    assert len(list(notes.iterdir())) > 2, "two workers, and one in place of the killed one"


def test_what_ray_reports_of_lost_workers_and_machines_is_a_loss():
    ray = pytest.importorskip("ray")
    pool, errors = _workers.Ray(ray), ray.exceptions
    lost = [
        errors.WorkerCrashedError(),
        errors.NodeDiedError("the node is dead"),
        errors.OutOfMemoryError("the node is running low on memory"),
        errors.ObjectLostError("0", None, ""),
        errors.ObjectReconstructionFailedError("0", None, ""),
    ]
    others = [errors.RuntimeEnvSetupError("no module"), errors.TaskCancelledError(), ValueError(), KeyboardInterrupt()]
    assert [pool.is_loss(error) for error in lost + others] == [True] * len(lost) + [False] * len(others)


class Reported(Exception):
    """What a stand-in for Ray reports."""


def stand_in(name, resources, lost):
    """A module as Ray is to a sweep, which reports the tasks of these numbers as lost, by an error of this name."""
    ray = types.ModuleType("ray")
    ray.exceptions = types.SimpleNamespace(**{name: Reported})
    ray.cluster_resources = lambda: resources
    calls = []

    def call(function, arguments):
        future = Future()
        calls.append(arguments)
        if len(calls) in lost:
            future.set_exception(Reported())
        else:
            future.set_result(function(*arguments))
        return types.SimpleNamespace(future=lambda: future)

    ray.remote = lambda function: types.SimpleNamespace(remote=lambda *arguments: call(function, arguments))
    return ray


@pytest.mark.parametrize("name", _workers.Ray.LOSSES)
def test_samples_of_a_lost_worker_are_computed_again(fall, threads, losses, name):  # noqa: F811
    samples = drawn(60)
    _, expected = computed(fall, "threads", samples, executor=threads)
    found, ours = computed(fall, "rows", samples, executor=stand_in(name, {"CPU": 2.0}, lost={2, 7, 12}))
    assert len(losses) == 3 and not found.failures and ours == expected


@pytest.mark.parametrize("resources", [{"CPU": 0.0}, {"CPU": 0.5}, {}])
def test_a_cluster_without_processors_is_asked_nevertheless(fall, resources):  # noqa: F811
    found, _ = computed(fall, "rows", drawn(20), executor=stand_in("NodeDiedError", resources, lost={}))
    assert len(found) == 20 and not found.failures


def test_a_sample_that_ends_its_worker_is_kept_as_failed(fall):  # noqa: F811
    # The second task has the second sample, which is then computed alone.
    ray = stand_in("NodeDiedError", {"CPU": 1.0}, lost={2, 3})
    found, _ = computed(fall, "rows", drawn(20), executor=ray)
    assert found.failures == {1: "it has ended its worker 2 times: Reported"}


def test_other_errors_of_ray_are_those_of_the_caller(fall):  # noqa: F811
    with pytest.raises(Reported):
        computed(fall, "rows", drawn(20), executor=stand_in("RuntimeEnvSetupError", {"CPU": 1.0}, lost={2}))
