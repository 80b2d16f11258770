"""Studies: a scenario, run for many samples of its values, in whatever processes."""

from __future__ import annotations

import csv
import json
import warnings
from collections.abc import Callable, Iterator, Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._results import Scenario, in_temporary_folder
from ._workers import compute

if TYPE_CHECKING:
    import pandas


PART = 1000
"""The rows of a part in Parquet."""


class Sweep:
    """The rows of a study: `sweep["peak tau crank [N m]"]` is the array of a column, in the order of the
    samples; numbers that a failed sample does not have are nan."""

    def __init__(self, folder: Path, headers: list[str], numeric: list[bool]):
        self.folder = folder
        """The folder of the study, with `rows.csv`, and parts in Parquet where these were wanted."""
        self.columns = headers
        """What is above the columns: `sample`, a path or a few for each value, the outcomes, `status` and `reason`."""
        with open(folder / "rows.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))[1:]
        self._arrays = dict(zip(headers, arrays(rows, numeric)))

    def __getitem__(self, column: str) -> np.ndarray:
        if column not in self._arrays:
            raise KeyError(f"{column!r} is not a column of this sweep, which has {', '.join(self.columns)}")
        return self._arrays[column]

    def __len__(self) -> int:
        return len(self["sample"])

    @property
    def failures(self) -> dict[int, str]:
        """The samples that failed, with their reasons."""
        failed = self["status"] != "complete"
        return dict(zip(self["sample"][failed].tolist(), self["reason"][failed].tolist()))

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame over `sample`."""
        import pandas

        return pandas.DataFrame(self._arrays).set_index("sample")

    def __repr__(self) -> str:
        return f"<redysim.Sweep of {len(self)} samples, {len(self.failures)} failed: {self.folder}>"


def sweep(
    scenario: str | PathLike[str] | Scenario,
    *,
    over: Mapping[str, Any] | None = None,
    samples: Mapping[str, Any] | str | PathLike[str] | None = None,
    run: Literal["inverse", "forward"] | None = None,
    outcomes: Mapping[str, list[str]] | None = None,
    executor: Any = None,
    jobs: int | None = None,
    folder: str | PathLike[str] | None = None,
    format: Literal["csv", "parquet"] = "csv",
    force: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Sweep:
    """Runs a scenario for many values of its initial state, its gains, the parameters of its model.

    Rows are written as they come. The same call goes on with what was interrupted, and with more samples
    keeps those that there are.

    Parameters
    ----------
    scenario : str, os.PathLike or Scenario
        The scenario file; or, without `over` and `samples`, a study file, as `redysim sweep` takes it.
    over : mapping, optional
        Values at paths, such as `{"forward.torque.kp": [10, 20]}`: every combination is a sample. A table
        of `from`, `to` and `count` stands for values at equal distances.
    samples : mapping, data frame, str or os.PathLike, optional
        Values at paths, sample by sample: arrays of equal length, of shape (k,) or of shape (k, n) where n
        values stand at a path. With `count` and `seed` a column may be a distribution: `{"normal": [mean,
        deviation]}` or `{"uniform": [least, largest]}`. Or the path of a table in CSV.
    run : {"inverse", "forward"}, optional
        What is computed; a scenario that is for one of them needs no choice.
    outcomes : mapping, optional
        What is kept of each run: for `last`, `peak`, `largest`, `least`, `mean` and `rms` columns of its
        tables, by symbol, or by symbol and name: `{"peak": ["tau crank"]}`.
    executor : optional
        Where samples are computed: a `dask.distributed.Client`, the module `ray` after `ray.init`, or any
        `concurrent.futures.Executor`; by default processes on this machine.
    jobs : int, optional
        How many processes; by default one for each core.
    folder : str or os.PathLike, optional
        The folder of the study; by default a temporary one, which is kept as long as the result, and if the call
        is interrupted or fails after some samples: a warning then names it.
    format : {"csv", "parquet"}
        With "parquet", the folder `rows` in it has the rows in parts of Parquet, too, which
        `pandas.read_parquet` reads as one table.
    force : bool
        Replace another study that is there.
    progress : callable, optional
        Called with the number of samples that are done and the number of all.

    Raises
    ------
    RedysimError
        With what is wrong with the study, before anything is computed; or why rows cannot be written.
    """
    if format not in ("csv", "parquet"):
        raise ValueError(f'format must be "csv" or "parquet", not {format!r}')
    if jobs is not None and jobs < 1:
        raise ValueError(f"jobs must be 1 or more, not {jobs}")
    if jobs is not None and executor is not None:
        raise ValueError("jobs is the number of processes here: leave it out where there is an executor")
    path = Path(scenario.path if isinstance(scenario, Scenario) else scenario)
    if over is None and samples is None:
        study = _core.Study.load(path)
    else:
        text = definition(path, over, samples, run, outcomes)
        study = _core.Study.from_toml(text, Path.cwd(), path.stem)
    for warning in study.warnings:
        warnings.warn(warning, _core.ModelWarning, stacklevel=2)

    def computed(folder: Path) -> Sweep:
        return in_folder(folder, study, executor, jobs, format, force, progress)

    return in_temporary_folder(computed, "sweep", has_rows) if folder is None else computed(Path(folder))


def has_rows(folder: Path) -> bool:
    """Whether samples of a study are in a folder, which the user then is told of."""
    try:
        count = (folder / "rows.csv").read_bytes().count(b"\n") - 1
    except OSError:
        return False
    if count > 0:
        warnings.warn(f"{count} samples are kept: give folder={str(folder)!r} to go on with them", stacklevel=4)
    return count > 0


def in_folder(folder, study, executor, jobs, format, force, progress) -> Sweep:
    """Computes the rows that are missing in a folder."""
    rows = _core.Rows(folder, study, force, PART if format == "parquet" else None)
    try:
        compute(study, rows, executor, jobs, progress)
    finally:
        rows.close()
    return Sweep(folder, study.headers, study.numeric)


def definition(path, over, samples, run, outcomes) -> str:
    """The study as its file has it."""
    study = {"scenario": str(path), "run": run, "over": over, "outcomes": outcomes}
    if isinstance(samples, (str, PathLike)):
        study["samples"] = {"file": fspath(samples)}
    elif samples is not None:
        study["samples"] = samples
    tables = {key: value for key, value in study.items() if value is not None}
    text = ""
    for key, value in tables.items():
        if hasattr(value, "keys"):
            # A line for each path, which messages then show.
            text += f"[{key}]\n" + "".join(f"{json.dumps(name)} = {toml(value[name], name)}\n" for name in value.keys())
        else:
            text = f"{key} = {toml(value, key)}\n" + text
    return text


def toml(value: Any, name: str) -> str:
    """A value as TOML."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {toml(of, name)}" for key, of in value.items()) + " }"
    if isinstance(value, (list, tuple, range)):
        return "[" + ", ".join(toml(of, name) for of in value) + "]"
    raise TypeError(f"{name!r}: values are numbers, strings, True, False or arrays of these, not {type(value).__name__}")


def arrays(rows: list[list[str]], numeric: list[bool]) -> Iterator[np.ndarray]:
    """The columns of rows of CSV."""
    columns = zip(*rows) if rows else [()] * len(numeric)
    for index, (is_number, cells) in enumerate(zip(numeric, columns)):
        if index == 0:
            yield np.array(cells, dtype=np.int64)
        elif is_number:
            yield np.array([float(cell) if cell else np.nan for cell in cells])
        else:
            yield np.array(cells, dtype=object)
