"""What llvm-mca says of the hot code of functions."""

import json
import subprocess
import sys

from assembly import AARCH64, X86, Assembly
from tools import BUILT, compile_for

# Where LLVM has no model of its own for a processor, it takes another's; resources begin with the model's name.
MODELS = {
    "SB": "Sandy Bridge", "HW": "Haswell", "SKX": "Skylake-X", "SKL": "Skylake", "ICX": "Ice Lake",
    "ADLP": "Alder Lake P", "SPR": "Sapphire Rapids", "Zn": "Zen 1", "Zn2": "Zen 2", "Zn3": "Zen 3", "Zn4": "Zen 4",
    "Zn5": "Zen 5", "Cy": "Cyclone", "N1": "Neoverse N1", "A57": "Cortex-A57", "V1": "Neoverse V1", "V2": "Neoverse V2",
}
# What stands in for processors that an older llvm-mca does not know.
NEAREST = {
    "sapphirerapids": "alderlake", "alderlake": "skylake-avx512", "znver5": "znver4", "znver4": "znver3",
    "neoverse-n1": "cortex-a72",
}


def assembly_for(processor, triple):
    """The assembly of this folder's crate for a processor."""
    file = BUILT / f"{processor}.s"
    behind = ["--", "--emit", f"asm={file}"]
    compile_for(processor, triple, "--lib", "--crate-type", "rlib", command="rustc", behind=behind)
    return Assembly(file.read_text(), AARCH64 if triple.startswith("aarch64") else X86)


def predicted(mca, assembly, triple, processor, functions):
    """The model's name, and for each function, given with its number of angles, the cycles of a call."""
    regions = []
    for name, angles in functions.items():
        way = assembly.way(name, angles)
        if way is None:
            raise SystemExit(f"{processor}: no way through {name} was found")
        lines, elsewhere = way
        if elsewhere:
            names = ", ".join(sorted(set(elsewhere)))
            print(f"{processor}: {name} calls {names}: not in the prediction", file=sys.stderr)
        comment = assembly.dialect.comment
        begin, end = f"{comment} LLVM-MCA-BEGIN {name}", f"{comment} LLVM-MCA-END {name}"
        regions.append("\n".join([begin, *assembly.dialect.arguments, *lines, end]))
    text = "\n".join(regions) + "\n"
    stand_in = ""
    while True:
        command = [mca, f"--mtriple={triple}", f"--mcpu={processor}", "--json", "--skip-unsupported-instructions=any"]
        result = subprocess.run(command, input=text, capture_output=True, text=True)
        if "not a recognized processor" in result.stderr:
            processor = NEAREST[processor]
            stand_in = f", as {processor}"
            continue
        break
    if result.returncode != 0:
        raise SystemExit(f"{processor}: {result.stderr[:2000]}")
    report = json.loads(result.stdout)
    resource = report["TargetInfo"]["Resources"][0]
    prefix = max((p for p in MODELS if resource.startswith(p)), key=len, default=None)
    cycles = {}
    for region in report["CodeRegions"]:
        summary = region["SummaryView"]
        cycles[region["Name"]] = summary["TotalCycles"] / summary["Iterations"]
    return MODELS.get(prefix, resource) + stand_in, cycles
