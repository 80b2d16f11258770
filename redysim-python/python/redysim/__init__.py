"""Dynamics of serial, tree-type and closed-loop mechanisms.

`load` reads a model file or a URDF; a `Mechanism` has the functions of its dynamics over arrays of
NumPy, and `compile` makes them fast. `scenario` reads a scenario file, which `run` computes, and
`sweep` runs one for many samples of its values.
"""

from ._core import Mechanism, ModelWarning, RedysimError, __version__, load
from ._results import Event, Motion, Recording, Results, Scenario, Table, results, scenario
from ._sweep import Sweep, sweep

__all__ = [
    "Event",
    "Mechanism",
    "ModelWarning",
    "Motion",
    "Recording",
    "RedysimError",
    "Results",
    "Scenario",
    "Sweep",
    "Table",
    "load",
    "results",
    "scenario",
    "sweep",
]
