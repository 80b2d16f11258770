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

@type_check_only
class Energy(np.recarray):
    kinetic: _Array
    potential: _Array

@type_check_only
class CenterOfMass(np.recarray):
    position: _Array
    velocity: _Array

@type_check_only
class Momentum(np.recarray):
    linear: _Array
    angular: _Array

@type_check_only
class HybridMotion(np.recarray):
    a: _Array
    tau: _Array

@type_check_only
class LinkState(np.recarray):
    rotation: _Array
    origin: _Array
    com: _Array
    velocity: _Array
    angular_velocity: _Array

@type_check_only
class FrameState(np.recarray):
    rotation: _Array
    origin: _Array
    velocity: _Array
    angular_velocity: _Array

@type_check_only
class FrameJacobian(np.recarray):
    linear: _Array
    angular: _Array

@type_check_only
class FrameAcceleration(np.recarray):
    linear: _Array
    angular: _Array

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
        """The mechanism with other values of its run-time parameters, compiled if this one is. What depends on them alone is
        computed once.

        Parameters
        ----------
        parameters : float64, (np,) or (k, np), or dict
            Values in the order of `parameter_names`; of k robots, each of which computes one of k states. A dictionary has
            names with values, () or (k,); the other ones stay as they are.

        Returns
        -------
        Mechanism
            Another mechanism: this one stays as it is.

        Raises
        ------
        ValueError
            If no rigid body or joint can have a value: the first one, with its name and the rule.
        """
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
        """Writes functions as C, compiles them by the system's compiler, and has every later call run the compiled code.

        The library is kept in a folder, under a name that depends on the model, the compiler and the processor: the next time
        it is loaded.

        Parameters
        ----------
        functions : sequence of str, optional
            The names of the functions; by default those of the key `functions` of the model file, or all. The run-time path
            computes the others.
        compiler : str, optional
            The compiler; by default the environment variable CC, or cc.

        Returns
        -------
        Mechanism
            The mechanism itself.

        Raises
        ------
        RedysimError
            If the compiler is missing or fails, if the file has changed since it was loaded, or if other functions of the
            mechanism are compiled already.
        """
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
        """The motion from q and v at the first instant of t to the last.

        Parameters
        ----------
        t : float64, (m,)
            The instants at which the motion is returned, s: the start first, the end last.
        q : float64, (nq,), optional
            Coordinates at the start, rad or m; by default the zero position. Loops are closed from there, where possible with
            the joints that have an actuator as they are.
        v : float64, (nv,), optional
            Velocities at the start, rad/s or m/s; by default zero.
        torque : callable or float64, (nv,), optional
            Joint forces, N m or N: constant, or a function of t, q and v; by default zero.
        events : sequence of callables, optional
            Functions of t, q and v whose crossings of zero are found. As for scipy.integrate.solve_ivp, an attribute
            `direction` selects rising (1) or falling (-1) ones, and with `terminal = True` one ends the motion.
        integrator : str
            Steps from tolerances: Ode45, Dop853, and for stiff equations Ode15s, Radau5. Steps of one size:
            SemiImplicitEuler, Ode4, Ode5, Dop8, Gauss4, Gauss6.
        rtol, atol : float
            Relative and absolute tolerance.
        max_step : float, optional
            The largest step from tolerances, s; by default a tenth of the motion.
        step : float, optional
            The size of steps of one size, s.
        stops : float64, (k,), optional
            Times at which a step from tolerances ends, s: where joint forces begin, change or end, so that no step passes over what
            is short compared with the motion.

        Returns
        -------
        Motion
            t, q, v, a, tau, the multipliers of loops, energies and events.

        Raises
        ------
        RedysimError
            If the motion cannot be computed to its end; or what a function of yours raises.
        """
    def to_toml(self) -> str:
        """The model as the text of a model file."""
    def page(self) -> str:
        """The page of HTML that shows the model in 3D and moves its joints by sliders, as `redysim show` makes it."""
    def inverse_dynamics(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, out: _Out | None = None) -> _Array:
        """τ = M(q) a + bias(q, v), N m or N: the joint forces of the tree.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        a : float64, (nv,) or (k, nv)
            Joint accelerations, rad/s² or m/s².
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def forward_dynamics(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike, *, out: _Out | None = None) -> _Array:
        """a = M(q)⁻¹ (τ − bias(q, v)), rad/s² or m/s²: the accelerations of the tree.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        a : float64, (nv,) or (k, nv)
            Joint accelerations, rad/s² or m/s².
        An argument of one state counts for each of k states.
        """

    def mass_matrix(self, q: ArrayLike, *, out: _Out | None = None) -> _Array:
        """M(q), the generalised inertia matrix, symmetric: kg m², kg m or kg.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        matrix : float64, (nv, nv) or (k, nv, nv)
            The matrix by rows, kg m², kg m or kg.
        An argument of one state counts for each of k states.
        """

    def bias_forces(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """C(q, v) v + g(q) and the passive forces, N m or N: the joint forces at zero
        acceleration.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def coriolis_matrix(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """C(q, v) of the Christoffel symbols: C v are the joint forces of the velocities, without
        gravity and passive forces; Ṁ − 2 C is skew-symmetric.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        matrix : float64, (nv, nv) or (k, nv, nv)
            The matrix by rows, kg m²/s, kg m/s or kg/s.
        An argument of one state counts for each of k states.
        """

    def gravity_forces(self, q: ArrayLike, *, out: _Out | None = None) -> _Array:
        """g(q), N m or N: the joint forces of gravity alone, at rest.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def passive_forces(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """The part of the bias that damping, friction and springs take, N m or N.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def energy(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> Energy:
        """Kinetic and potential energy, J, with those of rotors and springs; the potential of
        gravity is zero at the base frame's origin.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        energy : numpy.recarray, () or (k,)
            Energy of the mechanism, as a record array with the parts

            - `kinetic`: ½ vᵀ M v, J.
            - `potential`: −Σ m g·c, zero at the origin of the base frame, and that of springs,
              J.
        An argument of one state counts for each of k states.
        """

    def center_of_mass(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> CenterOfMass:
        """Position (m) and velocity (m/s) of the centre of mass of all links, in the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        center : numpy.recarray, () or (k,)
            The centre of mass, as a record array with the parts

            - `position`, each (3,): m.
            - `velocity`, each (3,): m/s.
        An argument of one state counts for each of k states.
        """

    def momentum(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> Momentum:
        """Linear momentum (N s) and angular momentum about the centre of mass (N m s) of all
        links, in the axes of the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        momentum : numpy.recarray, () or (k,)
            Momentum of the mechanism, as a record array with the parts

            - `linear`, each (3,): N s.
            - `angular`, each (3,): About the centre of mass, N m s.
        An argument of one state counts for each of k states.
        """

    def hybrid_dynamics(self, q: ArrayLike, v: ArrayLike, u: ArrayLike, *, out: _Out | None = None) -> HybridMotion:
        """Accelerations and joint forces where u is given: the acceleration of a velocity whose
        joint has an actuator, else its force.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        u : float64, (nv,) or (k, nv)
            Of each velocity with an actuator its acceleration, of the others the joint force
            (rad/s² or m/s²; of forces N m or N).
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        motion : numpy.recarray, () or (k,)
            Accelerations and joint forces, as a record array with the parts

            - `a`, each (nv,): Joint accelerations, rad/s² or m/s².
            - `tau`, each (nv,): Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def link_kinematics(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> LinkState:
        """Rotation, origin, centre of mass, velocity of the origin (m/s) and angular velocity
        (rad/s) of every link, in the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        links : numpy.recarray, (nl,) or (k, nl)
            Position and velocity of each link, as a record array with the parts

            - `rotation`, each (3, 3): The link's axes as columns: rotation[row][column]
              (dimensionless).
            - `origin`, each (3,): Origin of the link's frame, m.
            - `com`, each (3,): Centre of mass, m.
            - `velocity`, each (3,): Velocity of the origin, m/s.
            - `angular_velocity`, each (3,): rad/s.
        An argument of one state counts for each of k states.
        """

    def frame_kinematics(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> FrameState:
        """Rotation, origin, velocity of the origin (m/s) and angular velocity (rad/s) of every
        frame of interest, in the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        frames : numpy.recarray, (nf,) or (k, nf)
            Position and velocity of each frame of interest, as a record array with the parts

            - `rotation`, each (3, 3): The frame's axes as columns: rotation[row][column]
              (dimensionless).
            - `origin`, each (3,): m.
            - `velocity`, each (3,): Velocity of the origin, m/s.
            - `angular_velocity`, each (3,): rad/s.
        An argument of one state counts for each of k states.
        """

    def frame_jacobians(self, q: ArrayLike, *, out: _Out | None = None) -> FrameJacobian:
        """J(q) of every frame of interest, in the axes of the base frame: the velocity of its
        origin is linear · v, its angular velocity angular · v.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        jacobians : numpy.recarray, (nf,) or (k, nf)
            The Jacobian of each frame of interest, as a record array with the parts

            - `linear`, each (3, nv): linear · v is the velocity of the frame's origin (m/rad,
              or dimensionless for sliding joints).
            - `angular`, each (3, nv): angular · v is its angular velocity (dimensionless, or
              rad/m for sliding joints).
        An argument of one state counts for each of k states.
        """

    def frame_bias(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> FrameAcceleration:
        """J̇ v of every frame of interest: the acceleration of its origin (m/s²) and its angular
        acceleration (rad/s²) at zero joint accelerations, in the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        accelerations : numpy.recarray, (nf,) or (k, nf)
            Accelerations of each frame of interest, as a record array with the parts

            - `linear`, each (3,): Of the origin, m/s².
            - `angular`, each (3,): rad/s².
        An argument of one state counts for each of k states.
        """

    def frame_forces(self, q: ArrayLike, wrenches: ArrayLike, *, out: _Out | None = None) -> _Array:
        """Σ Jᵀ w, N m or N: the joint forces that do the same work as wrenches on the mechanism at
        the origins of its frames, in the axes of the base frame.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        wrenches : float64, (nf, 6) or (k, nf, 6)
            A wrench on each frame, in the axes of the base frame: force (N), then moment about
            the frame's origin (N m).
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        tau : float64, (nv,) or (k, nv)
            Joint forces, N m or N.
        An argument of one state counts for each of k states.
        """

    def loop_residual(self, q: ArrayLike, *, out: _Out | None = None) -> _Array:
        """How far the loops are from closed: of each cut, the point of side b minus the point of
        side a in the base frame, m, then what aligns directions, sines.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        result : float64, (nc,) or (k, nc)
            A number for each row of the loop constraints (m; dimensionless where it aligns
            directions).
        An argument of one state counts for each of k states.
        """

    def loop_jacobian(self, q: ArrayLike, *, out: _Out | None = None) -> _Array:
        """J(q), by rows: the residual of the loops changes at the rates J v.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        jacobian : float64, (nc, nv) or (k, nc, nv)
            The Jacobian by rows (m/rad, or dimensionless for sliding joints; 1/rad or 1/m where
            it aligns directions).
        An argument of one state counts for each of k states.
        """

    def loop_bias(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """J̇ v: the second derivative of the residual of the loops at zero joint accelerations.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        result : float64, (nc,) or (k, nc)
            A number for each row of the loop constraints (m/s²; 1/s² where it aligns
            directions).
        An argument of one state counts for each of k states.
        """

    def coordinate_rates(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """q̇ = N(q) v, rad/s or m/s: the rates of the coordinates.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        result : float64, (nq,) or (k, nq)
            Joint coordinates, or their rates (rad/s or m/s; of components of quaternions 1/s).
        An argument of one state counts for each of k states.
        """

    def integrate(self, q: ArrayLike, dv: ArrayLike, *, out: _Out | None = None) -> _Array:
        """q ⊞ dv, rad or m: the coordinates that the velocities dv, constant over a unit of time,
        lead to from q.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        dv : float64, (nv,) or (k, nv)
            Joint velocities, constant over a unit of time, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        result : float64, (nq,) or (k, nq)
            Joint coordinates, or their rates (rad or m; components of quaternions are
            dimensionless).
        An argument of one state counts for each of k states.
        """

    def difference(self, q0: ArrayLike, q1: ArrayLike, *, out: _Out | None = None) -> _Array:
        """q₁ ⊟ q₀, rad or m: the velocities that lead from q0 to q1 in a unit of time, the inverse
        of `integrate`.

        Parameters
        ----------
        q0 : float64, (nq,) or (k, nq)
            Joint coordinates from which the displacement leads, rad or m.
        q1 : float64, (nq,) or (k, nq)
            Joint coordinates to which the displacement leads, rad or m.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        dv : float64, (nv,) or (k, nv)
            Joint velocities, constant over a unit of time, rad or m.
        An argument of one state counts for each of k states.
        """

    def dissipated_power(self, q: ArrayLike, v: ArrayLike, *, out: _Out | None = None) -> _Array:
        """The power that damping and friction take, W; never negative.

        Parameters
        ----------
        q : float64, (nq,) or (k, nq)
            Joint coordinates, rad or m.
        v : float64, (nv,) or (k, nv)
            Joint velocities, rad/s or m/s.
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        power : float64, () or (k,)
            Power, W.
        An argument of one state counts for each of k states.
        """

    def neutral(self, *, out: _Out | None = None) -> _Array:
        """The coordinates at which every joint is at its zero position, rad or m.

        Parameters
        ----------
        out : numpy.ndarray, optional
            What is returned, to be written to: an array of the dtype and the shape of the
            result, such as an earlier result. It must not overlap an argument.

        Returns
        -------
        result : float64, (nq,) or (k, nq)
            Joint coordinates, or their rates (rad or m; components of quaternions are
            dimensionless).
        """

