"""The machine code of a linked library, by function, as objdump shows it."""

import bisect
import re
import subprocess

HEADER = re.compile(r"^([0-9a-f]+) <(.*)>:$")
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\t([^\t]*)")
# A jump or call to an address that is known; what goes through a register or a table has a `*`.
GOES_TO = re.compile(r"^(?:\w+ )?(call|j[a-z]+)q?\s+([0-9a-f]+) <")


class Function:
    """A function: its name, and its instructions as pairs of address and text."""

    def __init__(self, name):
        self.name = name
        self.instructions = []


class MachineCode:
    """All functions of a library."""

    def __init__(self, path, objdump="objdump"):
        command = [objdump, "--disassemble", "--no-show-raw-insn", "--disassembler-options=att", path]
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        found = []
        for line in text.splitlines():
            if header := HEADER.match(line):
                found.append((int(header[1], 16), Function(header[2])))
            elif found and (instruction := INSTRUCTION.match(line)):
                found[-1][1].instructions.append((int(instruction[1], 16), instruction[2].strip()))
        found.sort(key=lambda entry: entry[0])
        self.starts = [start for start, _ in found]
        self.functions = [function for _, function in found]

    def named(self, prefix):
        """The functions whose names begin with `prefix`, in the order of their names."""
        return sorted((f for f in self.functions if f.name.startswith(prefix)), key=lambda f: f.name)

    def at(self, address):
        """The function that holds an address."""
        return self.functions[max(bisect.bisect_right(self.starts, address) - 1, 0)]

    def reached(self, function):
        """The function and all that it calls or jumps to directly, and so on. What lies in other libraries (memcpy)
        is left out."""
        seen, waiting = {function.name: function}, [function]
        while waiting:
            for _, text in waiting.pop().instructions:
                if goes := GOES_TO.match(text):
                    target = self.at(int(goes[2], 16))
                    if target.name not in seen and not target.name.endswith("@plt"):
                        seen[target.name] = target
                        waiting.append(target)
        return list(seen.values())

