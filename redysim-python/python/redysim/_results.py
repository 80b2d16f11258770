"""Scenarios, and what their runs leave."""

from __future__ import annotations

import html
import json
import shutil
import tempfile
import weakref
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from . import _core

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure
    from numpy.typing import NDArray


class Table:
    """Quantities over time: `table["q"]` is the array, of shape (m,) or (m, n), of all columns whose
    symbol is `q`."""

    def __init__(self, t: NDArray, columns: list[tuple[str, str, str]], values: NDArray):
        self.t = t
        """The m instants, s."""
        self.columns = columns
        """Symbol, name and unit of each column, such as ("q", "joint1", "rad")."""
        self.values = values
        """The values, of shape (m, number of columns)."""

    @property
    def symbols(self) -> list[str]:
        """The symbols, each once."""
        return list(dict.fromkeys(symbol for symbol, _, _ in self.columns))

    @property
    def headers(self) -> list[str]:
        """The columns as files call them, such as `q joint1 [rad]`."""
        return [f"{f'{symbol} {name}'.strip()} [{unit}]" for symbol, name, unit in self.columns]

    def __getitem__(self, symbol: str) -> NDArray:
        columns = [index for index, column in enumerate(self.columns) if column[0] == symbol]
        if not columns:
            raise KeyError(f"{symbol!r} is not in this table, which has {', '.join(self.symbols)}")
        # A quantity of the whole mechanism, such as an energy, has no name.
        whole = len(columns) == 1 and not self.columns[columns[0]][1]
        return self.values[:, columns[0]] if whole else self.values[:, columns]

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame over t, whose columns are called as in the files: `q joint1 [rad]`."""
        import pandas

        return pandas.DataFrame(self.values, index=pandas.Index(self.t, name="t [s]"), columns=self.headers)

    def __repr__(self) -> str:
        return f"<redysim.Table of {len(self.t)} instants: {', '.join(self.symbols)}>"


class Recording:
    """A motion over time: the tables `traj`, `tor`, `energy` and others, and what is made of them."""

    tables: dict[str, Table]
    """The tables by their names."""

    @property
    def t(self) -> NDArray:
        """The m instants, s."""
        return self.tables["traj"].t

    @property
    def q(self) -> NDArray:
        """Coordinates, (m, nq), rad or m."""
        return self.tables["traj"]["q"]

    @property
    def v(self) -> NDArray:
        """Velocities, (m, nv), rad/s or m/s."""
        return self.tables["traj"]["v"]

    @property
    def a(self) -> NDArray:
        """Accelerations, (m, nv), rad/s² or m/s²."""
        return self.tables["traj"]["a"]

    @property
    def tau(self) -> NDArray:
        """Joint forces, (m, nv), N m or N."""
        return self.tables["tor"].values

    @property
    def multipliers(self) -> NDArray:
        """Multipliers λ of the loop constraints, (m, nc), N, or N m for a row that aligns directions:
        M a + h = τ + Jᵀ λ, where h is `bias_forces` and J `loop_jacobian`. Closed loops have a table `lambda`
        with their names, those of `Mechanism.loop_row_names`: the loop, and the number of the row in it."""
        return self.tables["lambda"].values if "lambda" in self.tables else np.empty((len(self.t), 0))

    def to_pandas(self) -> pandas.DataFrame:
        """Motion, joint forces and energy as one data frame over t."""
        import pandas

        return pandas.concat([self.tables[name].to_pandas() for name in ("traj", "tor", "energy")], axis=1)

    def plot(self, *symbols: str) -> Figure:
        """Plots quantities over time, an axis for each unit of each: by default the motion, the joint forces
        and the energies. Needs matplotlib."""
        import io

        from matplotlib.figure import Figure

        class Shown(Figure):
            """A figure that a notebook shows, without the global state of pyplot."""

            def _repr_png_(self) -> bytes:
                picture = io.BytesIO()
                self.savefig(picture, format="png")
                return picture.getvalue()

        columns = self._columns(symbols or ("q", "v", "tau", "kinetic", "potential", "total"))
        kinds = dict.fromkeys((self._kind(symbol), unit) for symbol, _, unit, _, _ in columns)
        figure = Shown(figsize=(8, 2.2 * len(kinds)), layout="constrained")
        axes = np.atleast_1d(figure.subplots(len(kinds), 1, sharex=True))
        for axis, (kind, unit) in zip(axes, kinds):
            for symbol, name, of, t, values in columns:
                if (self._kind(symbol), of) == (kind, unit):
                    axis.plot(t, values, label=name or symbol)
            axis.set_ylabel(f"{kind} [{unit}]")
            axis.legend(fontsize="small")
        axes[-1].set_xlabel("t [s]")
        return figure

    def _columns(self, symbols):
        """Symbol, name, unit, instants and values of all columns with these symbols."""
        found = []
        for symbol in symbols:
            tables = [self.tables[name] for name in ("traj", "tor", *self.tables) if name in self.tables]
            table = next((table for table in tables if symbol in table.symbols), None)
            if table is None:
                known = dict.fromkeys(symbol for table in tables for symbol in table.symbols)
                raise KeyError(f"{symbol!r} is not in these results, which have {', '.join(known)}")
            for (other, name, unit), values in zip(table.columns, table.values.T):
                if other == symbol:
                    found.append((symbol, name, unit, table.t, values))
        return found

    def _kind(self, symbol: str) -> str:
        energies = [column[0] for column in self.tables["energy"].columns]
        return "energy" if symbol in energies else symbol

    def page(self) -> str:
        """The page of HTML, complete in itself, that plays the motion in 3D, as `redysim animate` makes it."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return in_frame(self.page())


class Results(Recording):
    """What the run of a scenario has left: its tables, how it went, and its animation."""

    def __init__(self, folder: Path, found: dict[str, Any]):
        self.folder = folder
        """The folder of results."""
        self.run: dict[str, Any] = json.loads(found["run"])
        """How it went: `ended`, `steps`, `energy_drift` and all else of the table [run] of run.toml."""
        self.scenario: str = found["scenario"]
        """The scenario with every setting that it left open, as TOML."""
        self.tables = {name: Table(*table) for name, table in found["tables"].items()}

    def page(self) -> str:
        return _core.page(self.folder)

    def __reduce__(self):
        """Pickles what is in the folder, which may be a temporary one, or on another machine."""
        return restored, ({path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()},)

    def __repr__(self) -> str:
        run = self.run
        return f"<redysim.Results of {run['instants']} instants until {run['until']} s: {run['ended']}>"


class Event(NamedTuple):
    """A crossing of zero of one of the functions of `simulate`."""

    index: int  # type: ignore[assignment]
    """Which of the functions it was."""
    t: float
    """When, s."""
    q: NDArray
    """Coordinates then, (nq,)."""
    v: NDArray
    """Velocities then, (nv,)."""


class Motion(Recording):
    """What `Mechanism.simulate` has computed."""

    def __init__(self, mechanism: _core.Mechanism, found: dict[str, Any]):
        self.mechanism = mechanism
        """What moves."""
        self.events = [Event(*event) for event in found["events"]]
        """The events, in order of time."""
        self.statistics: dict[str, int] = found["statistics"]
        """What the integration took: `steps`, `rejected`, `evaluations` and others."""
        t, coordinates, velocities = found["t"], mechanism.coordinate_names, mechanism.velocity_names
        of_v = mechanism.velocity_units
        motion = [("q", *column) for column in zip(coordinates, mechanism.coordinate_units)]
        motion += [("v", name, unit + "/s") for name, unit in zip(velocities, of_v)]
        motion += [("a", name, unit + "/s^2") for name, unit in zip(velocities, of_v)]
        forces = [("tau", *column) for column in zip(velocities, mechanism.force_units)]
        energy = found["energy"]
        total = energy[:, 0] + energy[:, 1]
        # What of the energy has come from nowhere: an estimate of what the integration is wrong by.
        drift = total - total[0] - energy[:, 2]
        energies = np.column_stack([energy[:, :2], total, energy[:, 2], drift])
        names = [(name, "", "J") for name in ("kinetic", "potential", "total", "work", "drift")]
        self.tables = {
            "traj": Table(t, motion, np.hstack([found["q"], found["v"], found["a"]])),
            "tor": Table(t, forces, found["tau"]),
            "energy": Table(t, names, energies),
        }
        if mechanism.nc > 0:
            rows = [("lambda", *row) for row in zip(mechanism.loop_row_names, mechanism.loop_force_units)]
            self.tables["lambda"] = Table(t, rows, found["multipliers"])

    def page(self) -> str:
        try:
            with tempfile.TemporaryDirectory(prefix="redysim-") as folder:
                self._write(Path(folder))
                return _core.page(folder)
        except OSError as error:
            message = f"error: cannot write temporary files in {tempfile.gettempdir()}: {error}"
            help = "make room there, or name another folder by the environment variable TMPDIR"
            raise _core.RedysimError(f"{message}\n  = help: {help}") from error

    def _write(self, folder: Path) -> None:
        """The tables of the motion, as a run leaves them."""
        (folder / "model.toml").write_text(self.mechanism.to_toml(), encoding="utf-8")
        for name, table in self.tables.items():
            rows = np.column_stack([table.t, table.values])
            header = ",".join(["t [s]", *table.headers])
            np.savetxt(folder / f"{name}.csv", rows, "%.17g", ",", header=header, comments="")

    def __repr__(self) -> str:
        return f"<redysim.Motion of {len(self.t)} instants until {self.t[-1]} s, {len(self.events)} events>"


def simulate(
    mechanism, t, q=None, v=None, *, torque=None, events=(), integrator="Ode45", rtol=1e-6, atol=1e-9, max_step=None,
    step=None, stops=(),
):
    """`Mechanism.simulate`, which has the documentation."""
    if callable(events):
        events = [events]
    events = [(event, getattr(event, "direction", 0), getattr(event, "terminal", False)) for event in events]
    q = mechanism.neutral() if q is None else q
    v = np.zeros(mechanism.nv) if v is None else v
    times = np.atleast_1d(np.asarray(t, dtype=float))
    method = {"integrator": integrator, "rtol": rtol, "atol": atol, "max_step": max_step, "step": step}
    method["stops"] = np.unique(np.asarray(stops, dtype=float)).tolist()
    found = _core.simulate(mechanism, times.tolist(), (q, v), torque, events, method)
    return Motion(mechanism, found)


def in_frame(page: str) -> str:
    """A page within another one, such as that of a notebook."""
    return f'<iframe srcdoc="{html.escape(page)}" width="100%" height="600" style="border: none"></iframe>'


class Scenario:
    """A scenario file: what is to be computed of a model."""

    def __init__(self, path: str | PathLike[str]):
        self.path = Path(path)
        """The file."""
        self.runs: list[str] = _core.runs_of_scenario(self.path)
        """What it is for: "inverse", "forward", or both."""

    def run(
        self,
        dynamics: Literal["inverse", "forward"] | None = None,
        *,
        folder: str | PathLike[str] | None = None,
        force: bool = False,
    ) -> Results:
        """Computes it, as `redysim inverse` and `redysim forward` do; Ctrl-C ends it.

        Parameters
        ----------
        dynamics : {"inverse", "forward"}, optional
            What is computed; a scenario that is for one of them needs no choice.
        folder : str or os.PathLike, optional
            Where the results are written; by default they are kept in a temporary folder as long as the
            object.
        force : bool
            Overwrite results that are there.

        Raises
        ------
        RedysimError
            What the command reports.
        """
        if dynamics is None:
            if len(self.runs) > 1:
                raise ValueError(f'{self.path} is for both: give run("inverse") or run("forward")')
            dynamics = "inverse" if self.runs == ["inverse"] else "forward"
        elif dynamics not in ("inverse", "forward"):
            raise ValueError(f'dynamics must be "inverse" or "forward", not {dynamics!r}')
        if folder is not None:
            return Results(Path(folder), _core.compute(self.path, dynamics, folder, force))
        return in_temporary_folder(
            lambda folder: Results(folder, _core.compute(self.path, dynamics, folder, False)), "results"
        )

    def __repr__(self) -> str:
        return f"<redysim.Scenario {str(self.path)!r}: {', '.join(self.runs)}>"


def in_temporary_folder(make, name, worth_keeping=lambda folder: False):
    """What `make` finds in a temporary folder of this name, which is kept as long as that is; and where `make` fails, if
    what is in it is `worth_keeping`."""
    temporary = tempfile.mkdtemp(prefix="redysim-")
    folder = Path(temporary) / name
    try:
        found = make(folder)
    except BaseException:
        if not worth_keeping(folder):
            shutil.rmtree(temporary, ignore_errors=True)
        raise
    weakref.finalize(found, shutil.rmtree, temporary, ignore_errors=True)
    return found


def restored(files: dict[str, bytes]) -> Results:
    """Results that were pickled."""

    def write(folder):
        folder.mkdir()
        for name, content in files.items():
            (folder / name).write_bytes(content)
        return results(folder)

    return in_temporary_folder(write, "results")


def scenario(path: str | PathLike[str]) -> Scenario:
    """Reads a scenario file.

    Raises
    ------
    RedysimError
        With every fault of the file, as the command `redysim` shows them.
    """
    return Scenario(path)


def results(folder: str | PathLike[str]) -> Results:
    """Reads a folder of results that `redysim forward` or `redysim inverse` has written."""
    return Results(Path(folder), _core.read_results(folder))
