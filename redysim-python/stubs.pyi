from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import Motion

__all__ = [
    "ModelWarning",
    "RedysimError",
    "load",
    "restored",
    "Mechanism",
    "compute",
    "page",
    "read_results",
    "runs_of_scenario",
    "simulate",
    "Rows",
    "Sampler",
    "Study",
    "table_of_functions",
    "__version__",
]

_Array = NDArray[np.float64]
# Within `Mechanism`, np is the number of run-time parameters.
_Out = NDArray[Any]

__version__: str

class RedysimError(Exception):
    """What is wrong and what to do, as the command `redysim` reports it."""

class ModelWarning(UserWarning):
    """What a model may have, but is rarely meant."""

def load(
    path: str | PathLike[str], *, base: Literal["fixed", "free"] = "fixed", parameters: Sequence[str] | None = None
) -> Mechanism:
    """Reads a model file (TOML) or a URDF, with run-time parameters such as "gravity", "tool.mass" or
    "joint2.damping"; by default those of the file."""

def restored(
    source: tuple[bytes, str | PathLike[str], bool, Sequence[str] | None],
    values: ArrayLike | None,
    compiled: Sequence[str] | None,
) -> Mechanism: ...
def table_of_functions() -> list[tuple[str, list[str], str | None]]: ...
def runs_of_scenario(path: str | PathLike[str]) -> list[str]: ...
def compute(path: str | PathLike[str], dynamics: str, folder: str | PathLike[str], force: bool) -> dict[str, Any]: ...
def read_results(folder: str | PathLike[str]) -> dict[str, Any]: ...
def page(folder: str | PathLike[str]) -> str: ...
def simulate(
    owner: Mechanism,
    times: list[float],
    start: tuple[ArrayLike, ArrayLike],
    torque: Callable[[float, _Array, _Array], ArrayLike] | ArrayLike | None,
    events: list[tuple[Callable[[float, _Array, _Array], float], float, bool]],
    method: dict[str, Any],
) -> dict[str, Any]: ...

@final
class Study:
    """A study: a scenario, and the values of each sample at paths into it."""

    name: str
    headers: list[str]
    numeric: list[bool]
    warnings: list[str]
    @staticmethod
    def load(path: str | PathLike[str]) -> Study: ...
    @staticmethod
    def from_toml(text: str, folder: str | PathLike[str], name: str) -> Study: ...
    def sampler(self) -> str: ...
    def sample(self, index: int) -> str: ...
    def __len__(self) -> int: ...

@final
class Sampler:
    """Computes the rows of samples."""

    def __new__(cls, text: str) -> Sampler: ...
    def row(self, sample: str) -> tuple[int, str] | None: ...
    def failed_row(self, sample: str, reason: str) -> str: ...

@final
class Rows:
    """The rows of a study in its folder."""

    path: Path
    def __new__(cls, folder: str | PathLike[str], study: Study, force: bool, part: int | None) -> Rows: ...
    def missing(self) -> list[int]: ...
    def add(self, index: int, row: str) -> None: ...
    def finish(self) -> None: ...
    def close(self) -> None: ...
    def __len__(self) -> int: ...

# The records.
@final
class Mechanism:
    """A mechanism that was read from a model file or a URDF: names, sizes and functions."""

    @property
    def name(self) -> str: ...
    @property
    def path(self) -> Path:
        """The file of which it was made."""
    @property
    def warnings(self) -> list[str]:
        """What the command `redysim check` would warn of, as it is shown there."""
    @property
    def nq(self) -> int:
        """Number of coordinates."""
    @property
    def nv(self) -> int:
        """Number of velocities."""
    @property
    def nl(self) -> int:
        """Number of links."""
    @property
    def nc(self) -> int:
        """Number of rows of the loop constraints."""
    @property
    def nf(self) -> int:
        """Number of frames of interest."""
    @property
    def np(self) -> int:
        """Number of run-time parameters."""
    @property
    def parameter_names(self) -> list[str]:
        """Names of the run-time parameters."""
    @property
    def parameters(self) -> _Array:
        """Values of the run-time parameters, (np,), or (k, np) of k robots."""
    def with_parameters(self, parameters: ArrayLike | dict[str, ArrayLike]) -> Mechanism:
        # The documentation of with_parameters.
    @property
    def mass(self) -> float:
        """Mass of all links, kg."""
    @property
    def gravity(self) -> tuple[float, float, float]:
        """Acceleration of gravity in the base frame, m/s²."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the moving joints."""
    @property
    def coordinate_names(self) -> list[str]:
        """Names of the coordinates; a joint of one coordinate gives it its own name."""
    @property
    def velocity_names(self) -> list[str]:
        """Names of the velocities."""
    @property
    def coordinate_units(self) -> list[str]:
        """Units of the coordinates: rad, m, or 1 for a component of a quaternion."""
    @property
    def velocity_units(self) -> list[str]:
        """Units of what the velocities change: rad or m."""
    @property
    def force_units(self) -> list[str]:
        """Units of the joint forces: N m or N."""
    @property
    def loop_row_names(self) -> list[str]:
        """Names of the rows of the loop constraints, as in results: the loop, and the number of the row in it, from 1."""
    @property
    def loop_force_units(self) -> list[str]:
        """Units of the multipliers of the loop constraints: N, or N m for a row that aligns directions."""
    @property
    def link_names(self) -> list[str]:
        """Names of the links."""
    @property
    def frame_names(self) -> list[str]:
        """Names of the frames of interest."""
    @property
    def actuated(self) -> list[bool]:
        """Whether each velocity has an actuator."""
    @property
    def is_compiled(self) -> bool:
        """Whether functions are compiled."""
    @property
    def compiled_functions(self) -> list[str]:
        """The names of the functions that are compiled."""
    @property
    def library(self) -> Path | None:
        """The library of compiled functions, if they are compiled."""
    def compile(self, *, functions: Sequence[str] | None = None, compiler: str | None = None) -> Mechanism:
        # The documentation of compile.
    def check_unchanged(self) -> None:
        """Fails if the file has changed since it was loaded."""
    def simulate(
        self,
        t: ArrayLike,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        *,
        torque: Callable[[float, _Array, _Array], ArrayLike] | ArrayLike | None = None,
        events: Callable[[float, _Array, _Array], float] | Sequence[Callable[[float, _Array, _Array], float]] | None = None,
        integrator: str = "Ode45",
        rtol: float = 1e-6,
        atol: float = 1e-9,
        max_step: float | None = None,
        step: float | None = None,
        stops: ArrayLike | None = None,
    ) -> Motion:
        # The documentation of simulate.
    def to_toml(self) -> str:
        """The model as the text of a model file."""
    def page(self) -> str:
        """The page of HTML that shows the model in 3D and moves its joints by sliders, as `redysim show` makes it."""
    # The functions.
