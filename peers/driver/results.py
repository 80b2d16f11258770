"""The data of runs: one file for each processor, which a later run on the same processor replaces."""

import json
from pathlib import Path
from statistics import median

import processor

# Of runs on all robots, a part of the repository.
FOLDER = Path(__file__).parent.parent / "results"


class Times:
    """ns per state: of each program at each function, the median of the repetitions."""

    def __init__(self, results: dict):
        self.all = {tuple(key.split()): times for key, times in results["times"].items()}

    def of(self, program: str, robot: str, function: str) -> float | None:
        times = self.all.get((program, robot, function))
        return median(times) if times else None

    def spread(self, program: str, robot: str, function: str) -> float:
        """How much longer the slowest repetition took than the fastest, as a share."""
        times = self.all[program, robot, function]
        return max(times) / min(times) - 1

    def ratio(self, peers: list[str], ours: str, robot: str, function: str) -> float | None:
        """How many times as fast `ours` is as the fastest of the peers."""
        mine = self.of(ours, robot, function)
        theirs = [time for peer in peers if (time := self.of(peer, robot, function)) is not None]
        return min(theirs) / mine if mine and theirs else None

    def programs(self) -> set[str]:
        return {key[0] for key in self.all}

    def robots(self) -> set[str]:
        return {key[1] for key in self.all}


def steadiness(times: dict, calibrations: list[float], disturbed: int) -> dict:
    """How steady the machine was."""
    spreads = [max(repeated) / min(repeated) - 1 for repeated in times.values()]
    return {
        "repetitions": len(next(iter(times.values()))),
        "spread": {"median": _short(median(spreads)), "largest": _short(max(spreads))},
        "calibration_ns": {
            "fastest": _short(min(calibrations)),
            "median": _short(median(calibrations)),
            "slowest": _short(max(calibrations)),
        },
        "measurements": len(calibrations),
        "disturbed": disturbed,
    }


def recorded(times: dict) -> dict[str, list[float]]:
    """The repetitions by `program robot function`, as the data of a run have them."""
    return {" ".join(key): [_short(time) for time in repeated] for key, repeated in times.items()}


def subject(results: dict) -> str:
    """What the run is of: its processor, and the part that it is, if that is kept beside a run on all robots."""
    name = results["processor"]["name"]
    return f"{name}, {results['part']}" if "part" in results else name


def path_in(folder: Path, results: dict) -> Path:
    return folder / (processor.slug(subject(results)) + ".json")


def save(results: dict, folder: Path) -> Path:
    """Adds the run to the folder, in place of the one on the same processor; one on all robots replaces parts, too."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.glob("*.json"):
        kept = json.loads(path.read_text())
        same_processor = kept["processor"]["name"] == results["processor"]["name"]
        if same_processor and "part" in kept and not results["partial"]:
            path.unlink()
    path = path_in(folder, results)
    path.write_text(_written(results))
    return path


def load(folder: Path) -> list[dict]:
    """All runs: the newest first, parts of runs last."""
    runs = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    newest_first = sorted(runs, key=lambda run: run["date"], reverse=True)
    return sorted(newest_first, key=lambda run: run["partial"])


def _short(number: float) -> float:
    """To five digits: more do not repeat."""
    return float(f"{number:.5g}")


def _written(results: dict) -> str:
    """JSON with a line for each entry, so that a difference can be read."""
    parts = []
    for key, value in results.items():
        if isinstance(value, dict) and value:
            entries = ",\n".join(f"  {_json(inner)}: {_json(entry)}" for inner, entry in value.items())
            parts.append(f" {_json(key)}: {{\n{entries}\n }}")
        else:
            parts.append(f" {_json(key)}: {_json(value)}")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _json(value) -> str:
    return json.dumps(value, ensure_ascii=False)
