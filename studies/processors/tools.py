"""Programs that the scripts of this folder need, and the crate that they compile."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILT = Path(os.environ.get("CARGO_TARGET_DIR", HERE / "../../target")).resolve() / "processors"


def output(*command, **options):
    """What a command prints; if it fails, so does the script."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def installed(program, package):
    """Installs a program by the name of its package where this runs as root on Debian; says what to do elsewhere."""
    if shutil.which(program):
        return program
    if os.getuid() == 0 and shutil.which("apt-get"):
        subprocess.run(["apt-get", "install", "-y", package], check=True, stdout=sys.stderr)
        return program
    sys.exit(f"{program} is missing. On Debian and its relatives: sudo apt-get install {package}")


def llvm_mca():
    """The newest llvm-mca, as far as it is not newer than the compiler's LLVM: that one knows its processors."""
    newest = int(re.search(r"LLVM version: (\d+)", output("rustc", "--version", "--verbose"))[1])
    for version in range(newest, 13, -1):
        if shutil.which(f"llvm-mca-{version}"):
            return f"llvm-mca-{version}"
        if shutil.which("apt-cache") and output("apt-cache", "search", "--names-only", f"^llvm-{version}$"):
            return installed(f"llvm-mca-{version}", f"llvm-{version}")
    return installed("llvm-mca", "llvm")


def compile_for(processor, triple, *arguments, command="build", behind=(), folder=BUILT):
    """Compiles this folder's crate, and what it depends on, for a processor, into `folder`."""
    library = Path(output("rustc", "--print", "sysroot").strip()) / "lib/rustlib" / triple / "lib"
    if not library.exists():
        subprocess.run(["rustup", "target", "add", triple], check=True)
    # With `--target` macros and build scripts are compiled for the machine at hand, which must run them.
    line = ["cargo", command, "--release", "--quiet", "--target", triple, "--target-dir", folder, *arguments, *behind]
    environment = os.environ | {"RUSTFLAGS": f"-C target-cpu={processor}"}
    if subprocess.run(line, cwd=HERE, env=environment).returncode != 0:
        sys.exit(f"the crate in studies/processors does not compile for {processor}")
    return folder / triple / "release"
