"""Ten thousand four-bars whose links are made with tolerances: the spread of the torque that turns the crank.

    python examples/python/monte_carlo.py                     # processes on all cores; a picture
    python examples/python/monte_carlo.py --cluster tcp://scheduler:8786

The same call goes on with what was interrupted. Beside the Monte Carlo stands what a linearisation predicts from the
derivatives of the torque with respect to each length.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import redysim

SCENARIO = Path(__file__).parents[2] / "scenarios/fourbar.toml"
TOLERANCE = 0.05e-3  # m: the standard deviation of each length
LENGTHS = {  # m, where each stands in the model
    "crank": ("model.loop.crank-coupler.point_a.0", 0.038),
    "coupler": ("model.loop.crank-coupler.point_b.0", 0.1152),
    "rocker": ("model.link.coupler.dh.a", 0.1152),
    "ground": ("model.link.rocker.dh.a", -0.0895),
}
PEAK, RMS = "peak tau crank [N m]", "rms tau crank [N m]"
OUTCOMES = {"peak": ["tau crank"], "rms": ["tau crank"]}


def linearised(outcome: str, found: redysim.Sweep) -> dict[str, float]:
    """What each length adds to the standard deviation of an outcome, N m, by central differences of the rows of
    `differences`."""
    rows = found[outcome].reshape(len(LENGTHS), 2)
    return dict(zip(LENGTHS, np.abs(rows[:, 1] - rows[:, 0]) / 2))


def differences() -> redysim.Sweep:
    """The four-bar with each length a standard deviation shorter and longer."""
    nominal = np.array([length for _, length in LENGTHS.values()])
    offsets = TOLERANCE * np.repeat(np.eye(len(LENGTHS)), 2, axis=0)
    offsets[::2] *= -1
    samples = {path: nominal[k] + offsets[:, k] for k, (path, _) in enumerate(LENGTHS.values())}
    return redysim.sweep(SCENARIO, run="inverse", samples=samples, outcomes=OUTCOMES, jobs=1)


def draw(found: redysim.Sweep, expected: dict[str, float], target: Path) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 3.2), layout="constrained")
    for axis, outcome, title in zip(figure.subplots(1, 2), (PEAK, RMS), ("largest torque", "root mean square")):
        torque = found[outcome][found["status"] == "complete"]
        axis.hist(torque, bins=60, density=True, color="#9db8d2")
        at = np.linspace(torque.min(), torque.max(), 200)
        bell = np.exp(-0.5 * ((at - torque.mean()) / expected[outcome]) ** 2) / expected[outcome] / np.sqrt(2 * np.pi)
        axis.plot(at, bell, color="#1f4e79", label="linearised")
        axis.set_xlabel(f"{title} of the crank [N m]")
        axis.set_ylabel("density [1/(N m)]")
        axis.legend(fontsize="small")
    figure.savefig(target)


def show(done: int, total: int) -> None:
    print(f"\r{done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000, help="how many four-bars")
    parser.add_argument("--jobs", type=int, help="processes; by default one for each core")
    parser.add_argument("--cluster", help="the address of the scheduler of a dask cluster")
    parser.add_argument("--folder", type=Path, default=Path("results/monte_carlo"), help="of the rows")
    parser.add_argument("--picture", type=Path, default=Path("results/monte_carlo.svg"))
    options = parser.parse_args()

    client = None
    if options.cluster:
        from distributed import Client

        client = Client(options.cluster)
    samples = {path: {"normal": [length, TOLERANCE]} for path, length in LENGTHS.values()}
    begun = time.perf_counter()
    found = redysim.sweep(
        SCENARIO,
        run="inverse",
        samples={"count": options.count, "seed": 1, **samples},
        outcomes=OUTCOMES,
        executor=client,
        jobs=options.jobs,
        folder=options.folder,
        progress=show if sys.stderr.isatty() else None,
    )
    print(f"{len(found)} four-bars in {time.perf_counter() - begun:.1f} s, {len(found.failures)} failed")

    expected, derivatives = {}, differences()
    for outcome in (PEAK, RMS):
        parts = linearised(outcome, derivatives)
        expected[outcome] = np.sqrt(sum(part**2 for part in parts.values()))
        torque = found[outcome][found["status"] == "complete"]
        print(f"{outcome}: mean {torque.mean():.5f}, standard deviation {torque.std():.5f}, "
              f"linearised {expected[outcome]:.5f}")
        print("  of it " + ", ".join(f"{name} {part:.5f}" for name, part in parts.items()))
    options.picture.parent.mkdir(parents=True, exist_ok=True)
    draw(found, expected, options.picture)
    print(f"picture: {options.picture}")


if __name__ == "__main__":
    main()
