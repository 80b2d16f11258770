import multiprocessing
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas
import pytest
import redysim
from redysim import _workers

MODELS = Path(__file__).parents[2] / "models"
FALL = """[initial]
q = [0, 1]
[forward]
end = 0.5
step = 0.05
torque = { law = "pd", target = [0.5, 0.5], kp = 10.0, kd = [1.0, 1.0] }
"""
KP = "forward.torque.kp"
LAST = "last q joint2 [rad]"


@pytest.fixture
def fall(tmp_path):
    path = tmp_path / "fall.toml"
    path.write_text(f"model = '{MODELS / 'two_link.toml'}'\n{FALL}")
    return path


@pytest.fixture(scope="module")
def threads():
    with ThreadPoolExecutor(2) as threads:
        yield threads


def drawn(count, rng=np.random.default_rng(5)):
    return {KP: rng.uniform(5, 15, count), "initial.q": rng.uniform(-1, 1, (count, 2))}


def text(folder):
    return (folder / "rows.csv").read_text()


def test_rows_have_the_bits_of_single_runs(fall, tmp_path):
    mass = "model.link.link2.mass"
    found = redysim.sweep(fall, over={KP: [10.0, 20.0], mass: np.array([0.4, 0.7])}, outcomes={"last": ["q"], "peak": ["tau"]})
    assert found[KP].tolist() == [10, 10, 20, 20] and found[mass].tolist() == [0.4, 0.7, 0.4, 0.7]
    (tmp_path / "heavy.toml").write_text((MODELS / "two_link.toml").read_text().replace("mass = 0.4", "mass = 0.7"))
    alone = tmp_path / "alone.toml"
    alone.write_text("model = 'heavy.toml'\n" + FALL.replace("kp = 10.0", "kp = 20.0"))
    results = redysim.scenario(alone).run()
    assert found[LAST][3] == results.q[-1, 1]
    assert found["peak tau joint1 [N m]"][3] == np.abs(results.tau[:, 0]).max()
    assert found["energy_drift"][3] == results.run["energy_drift"]
    assert found["steps"][3] == results.run["steps"] and not found.failures


def test_all_executors_leave_the_same_rows(fall, tmp_path, threads):
    samples = drawn(12)
    for name, executor in [("processes", None), ("threads", threads)]:
        redysim.sweep(fall, samples=samples, executor=executor, folder=tmp_path / name)
    assert text(tmp_path / "processes") == text(tmp_path / "threads")
    study = tmp_path / "study.toml"
    values = "\n".join(f"{path} = {of.tolist()}" for path, of in samples.items())
    study.write_text(f"scenario = 'fall.toml'\n[samples]\n{values}\n")
    redysim.sweep(study, executor=threads, folder=tmp_path / "study")
    assert text(tmp_path / "study") == text(tmp_path / "threads")


def test_the_spread_of_a_pendulum_s_torque_is_that_of_its_closed_form(tmp_path, threads):
    (tmp_path / "rod.toml").write_text(
        "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n"
        "dh = {}\nmass = 2.0\ncom = [0.5, 0, 0]\n"
    )
    hold = "trajectory = { from = [0], to = [0], duration = 1 }\ninverse = { end = 0.1, step = 0.1 }\n"
    (tmp_path / "hold.toml").write_text("model = 'rod.toml'\n" + hold)
    length = {"count": 300, "seed": 4, "model.link.rod.com.0": {"normal": [0.5, 0.01]}}
    found = redysim.sweep(tmp_path / "hold.toml", samples=length, executor=threads)
    torque = found["peak tau rod [N m]"]
    np.testing.assert_allclose(torque, 2 * 9.81 * found["model.link.rod.com.0"], rtol=1e-14)
    # Five standard errors of the standard deviation of 300 draws, σ/√600.
    assert abs(torque.std() / (2 * 9.81 * 0.01) - 1) < 5 / 600**0.5


@pytest.mark.parametrize("format", ["csv", "parquet"])
def test_what_is_interrupted_goes_on_to_the_same_rows(fall, tmp_path, threads, format, monkeypatch):
    from redysim import _sweep

    monkeypatch.setattr(_sweep, "PART", 5)
    samples = drawn(24)
    whole = redysim.sweep(fall, samples=samples, executor=threads, folder=tmp_path / "whole")

    def stop(done, total):
        assert total == 24
        if done >= 13:
            raise KeyboardInterrupt

    call = dict(samples=samples, executor=threads, folder=tmp_path / "rows", format=format)
    with pytest.raises(KeyboardInterrupt):
        redysim.sweep(fall, **call, progress=stop)
    kept = text(tmp_path / "rows")
    assert 13 <= len(kept.splitlines()) - 1 < 24
    with open(tmp_path / "rows/rows.csv", "a") as file:
        file.write("23,7.5,0.2")  # torn
    counts = []
    found = redysim.sweep(fall, **call, progress=lambda done, total: counts.append(done))
    assert counts[0] > len(kept.splitlines()) - 1, "what is there is not computed again"
    assert text(tmp_path / "rows") == text(tmp_path / "whole")
    pandas.testing.assert_frame_equal(found.to_pandas(), whole.to_pandas())
    if format == "parquet":
        parts = pandas.read_parquet(tmp_path / "rows/rows").sort_values("sample")
        assert len(list((tmp_path / "rows/rows").glob("*.parquet"))) >= 5
        np.testing.assert_array_equal(parts["sample"], range(24))
        np.testing.assert_array_equal(parts[LAST], whole[LAST])
        assert set(parts["status"]) == {"complete"}


def test_a_killed_process_loses_nothing(fall, tmp_path, threads, monkeypatch):
    samples = drawn(300)
    fall.write_text(fall.read_text().replace("end = 0.5", "end = 5.0"))
    lost = []
    lose = _workers.Computation.lose
    monkeypatch.setattr(_workers.Computation, "lose", lambda self, of: (lost.extend(of), lose(self, of)))
    redysim.sweep(fall, samples=samples, executor=threads, folder=tmp_path / "whole")
    killed = []

    def kill(done, total):
        if not killed and done < total:
            killed.append(multiprocessing.active_children()[0].pid)
            os.kill(killed[0], signal.SIGKILL)

    redysim.sweep(fall, samples=samples, jobs=2, folder=tmp_path / "rows", progress=kill)
    assert killed and lost, "samples were under way"
    assert text(tmp_path / "rows") == text(tmp_path / "whole")


def deadly(sampler, samples):
    """Samples, of which the fourth is the end of its process."""
    if any('"index":3,' in sample for sample in samples):
        os.kill(os.getpid(), signal.SIGKILL)
    return ORIGINAL(sampler, samples)


ORIGINAL = _workers.run_samples


def test_a_sample_that_ends_its_worker_is_kept_as_failed(fall, monkeypatch):
    monkeypatch.setattr(_workers, "run_samples", deadly)
    found = redysim.sweep(fall, samples=drawn(8), jobs=2)
    assert found.failures == {3: "it has ended its worker 2 times: BrokenProcessPool"}
    assert np.isnan(found[LAST][3]) and np.isfinite(np.delete(found[LAST], 3)).all()


def test_a_killed_worker_of_a_cluster_loses_nothing(fall, tmp_path, threads):
    distributed = pytest.importorskip("distributed")
    samples = drawn(300)
    fall.write_text(fall.read_text().replace("end = 0.5", "end = 5.0"))
    redysim.sweep(fall, samples=samples, executor=threads, folder=tmp_path / "whole")
    options = dict(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, silence_logs=50)
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        client.wait_for_workers(2)
        processes = client.run(os.getpid)
        assert len(set(processes.values())) == 2 and os.getpid() not in processes.values()
        killed = []

        def kill(done, total):
            if not killed and done < total:
                killed.append(list(processes.values())[0])
                os.kill(killed[0], signal.SIGKILL)

        found = redysim.sweep(fall, samples=samples, executor=client, folder=tmp_path / "rows", progress=kill)
        # Samples that the killed worker had to compute, or had computed and not given back. Those that end regularly have none.
        removed = [event for _, event in client.get_events("all") if event["action"] == "remove-worker"]
        assert any(event["processing-tasks"] or event["lost-computed-tasks"] for event in removed)
    assert killed and not found.failures and text(tmp_path / "rows") == text(tmp_path / "whole")


def test_the_broken_executor_of_a_caller_is_one_error_and_keeps_rows(fall, tmp_path):
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        pid = pool.submit(os.getpid).result()
        kill = threading.Event()

        def progress(done, total):
            if not kill.is_set():
                kill.set()
                os.kill(pid, signal.SIGKILL)

        call = dict(samples=drawn(200), folder=tmp_path / "rows")
        with pytest.raises(redysim.RedysimError, match=r"the executor is broken: .* of 200 samples are kept in .*rows.csv"):
            redysim.sweep(fall, executor=pool, progress=progress, **call)
    assert len(redysim.sweep(fall, **call)) == 200


def test_an_executor_that_cancels_its_calls_is_one_error_with_a_reason(fall, tmp_path):
    class Cancelling:
        def submit(self, *call):
            future = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with pytest.raises(redysim.RedysimError, match="the executor is broken: its calls are cancelled, .* 0 of 5 samples"):
        redysim.sweep(fall, samples=drawn(5), executor=Cancelling(), folder=tmp_path / "rows")


@pytest.mark.parametrize("format", ["csv", "parquet"])
def test_a_full_disk_is_one_error_and_loses_no_row(fall, tmp_path, threads, format):
    samples = drawn(200)
    call = dict(samples=samples, executor=threads, folder=tmp_path / "rows", format=format)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    # No file may become larger: what would make it so is refused, as by a disk that is full.
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        with pytest.raises(redysim.RedysimError) as error:
            redysim.sweep(fall, **call)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    for part in ["cannot write", "rows.csv", "of 200 samples are kept", "then goes on with the rest"]:
        assert part in str(error.value)
    kept = text(tmp_path / "rows")
    assert kept.endswith("\n") and len(kept) > 15_000
    found = redysim.sweep(fall, **call)
    assert len(found) == 200 and not found.failures


def test_rows_in_a_temporary_folder_outlive_what_ends_the_call(fall, threads):
    call = dict(samples=drawn(200), executor=threads)

    def stop(done, _):
        if done >= 20:
            raise KeyboardInterrupt

    with pytest.warns(UserWarning, match="samples are kept: give folder=") as noted, pytest.raises(KeyboardInterrupt):
        redysim.sweep(fall, progress=stop, **call)
    folder = re.search(r"folder='(.*)' to go on", str(noted[-1].message))[1]
    counts = []
    found = redysim.sweep(fall, folder=folder, progress=lambda done, _: counts.append(done), **call)
    assert len(found) == 200 and min(counts) > 20
    shutil.rmtree(Path(folder).parent)


def test_a_number_of_processes_that_is_none_is_one_error(fall, threads):
    for jobs in (0, -1):
        with pytest.raises(ValueError, match=f"jobs must be 1 or more, not {jobs}"):
            redysim.sweep(fall, samples=drawn(2), jobs=jobs)
    with pytest.raises(ValueError, match="leave it out where there is an executor"):
        redysim.sweep(fall, samples=drawn(2), jobs=2, executor=threads)


def test_a_fault_of_a_study_is_one_error_before_anything_is_computed(fall, tmp_path):
    for call, message in [
        (dict(samples={KP: [1.0, np.nan]}), r"`samples.forward.torque.kp\[1\]` is `nan`, which is not a finite number"),
        (dict(over={"initial.q": [[0, 1], [0, 1, 2]]}), "is an array of 3"),
        (dict(over={"forward.torqe.kp": [1]}), "unknown key `forward.torqe`"),
        (dict(over={"model.link.link3.mass": [1]}), "`model.link` has nothing of the name `link3`"),
        (dict(samples={KP: [1, 2], "initial.q.0": [1]}), "`initial.q.0` has 1"),
        (dict(over={KP: [1]}, outcomes={"peak": ["tua"]}), "did you mean `tau`"),
        (dict(over={KP: [1]}, samples={KP: [1]}), "`over` or `samples`"),
    ]:
        with pytest.raises(redysim.RedysimError, match=message) as error:
            redysim.sweep(fall, **call, folder=tmp_path / "rows")
        assert str(error.value).count("error: ") == 1
    with pytest.raises(TypeError, match="'forward.torque.kp': values are numbers, strings"):
        redysim.sweep(fall, over={KP: [object()]}, folder=tmp_path / "rows")
    with pytest.raises(TypeError, match="executor must be a dask.distributed.Client"):
        redysim.sweep(fall, over={KP: [1]}, executor=3)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fall.toml"]


def test_a_sample_that_fails_is_kept_with_its_reason(fall, threads):
    found = redysim.sweep(fall, samples={"model.link.link2.mass": [1, -1]}, executor=threads)
    assert list(found.failures) == [1] and "mass" in found.failures[1]
    assert np.isnan(found[LAST][1]) and repr(found).startswith("<redysim.Sweep of 2 samples, 1 failed")


def test_a_script_without_a_guard_is_reported(fall, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(f"import redysim\nredysim.sweep({str(fall)!r}, over={{{KP!r}: [1.0]}}, jobs=1)\n")
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60)
    assert run.returncode == 1 and "RuntimeError: worker processes do not start" in run.stderr
    assert 'if __name__ == "__main__":' in run.stderr
