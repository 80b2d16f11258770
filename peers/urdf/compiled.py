"""Compiles models by `redysim!`: each is a program of its own that answers to states as `redysim-evaluate` does."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent

# The generator checks its own passes where it has debug assertions, as it has in a program built without --release.
MANIFEST = """\
[workspace]

[package]
name = "robots"
version = "0.0.0"
edition = "2024"
publish = false

[dependencies]
redysim = {{ path = {redysim} }}
redysim-evaluate = {{ path = {evaluate} }}

[profile.release.build-override]
debug-assertions = true
"""

PROGRAM = """\
redysim::redysim! {{ struct Robot("{model}"); }}

fn main() -> Result<(), Box<dyn std::error::Error>> {{
    redysim_evaluate::answer(&Robot)
}}
"""


class Compiled:
    """What the compiler makes of the robots: `programs` that run, or the first line of its `errors`."""

    def __init__(self) -> None:
        self.programs: dict[str, Path] = {}
        self.errors: dict[str, str] = {}

    def take(self, message: dict) -> None:
        """Takes in a message of cargo's."""
        name = message.get("target", {}).get("name", "")
        if message["reason"] == "compiler-artifact" and message["executable"]:
            self.programs[name] = Path(message["executable"])
        elif message["reason"] == "compiler-message" and message["message"]["level"].startswith("error"):
            sys.stderr.write(message["message"]["rendered"])
            self.errors.setdefault(name, message["message"]["message"].splitlines()[0])


def compiled(crate: Path, names: list[str], target: Path) -> Compiled:
    """Compiles the models `models/NAME.toml` of the folder `crate`, and goes on past those that do not compile."""
    paths = {"redysim": HERE.parent.parent, "evaluate": HERE}
    quoted = {name: json.dumps(str(path), ensure_ascii=False) for name, path in paths.items()}
    write_changed(crate / "Cargo.toml", MANIFEST.format(**quoted))
    # With the same versions of everything else as `redysim-evaluate`.
    shutil.copy(HERE / "Cargo.lock", crate / "Cargo.lock")
    for name in names:
        write_changed(crate / f"src/bin/{name}.rs", PROGRAM.format(model=f"models/{name}.toml"))
    command = ["nice", "cargo", "build", "--release", "--keep-going", "--message-format=json"]
    command += ["--manifest-path", crate / "Cargo.toml", "--target-dir", target]
    command += [word for name in names for word in ["--bin", name]]
    found = Compiled()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as cargo:
        for line in cargo.stdout:
            found.take(json.loads(line))
    for name in set(names) - set(found.programs):
        found.errors.setdefault(name, "the compiler does not say why")
    return found


def write_changed(path: Path, text: str) -> None:
    """Leaves a file that says this already alone: cargo compiles what is newer."""
    if not path.is_file() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
