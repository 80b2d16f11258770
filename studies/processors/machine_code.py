"""The machine code of a linked library, by function, as objdump shows it."""

import bisect
import re
import subprocess

HEADER = re.compile(r"^([0-9a-f]+) <(.*)>:$")
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\t([^\t]*)")
# A jump or call to an address that stands in the instruction.
GOES_TO = re.compile(r"^(?:\w+ )?(?:call|j[a-z]+)q?\s+([0-9a-f]+) <")
# A call of an address in a register or in memory.
CALLS_INDIRECTLY = re.compile(r"^(?:\w+ )?callq?\s+\*(\S+)")
# An instruction that reads from an address beside it.
READS = re.compile(r"\(%rip\).*# ([0-9a-f]+)")
# An instruction that changes a register, but for `pop`, which gives a caller its own back: what it reads, and the register.
CHANGES = re.compile(r"^(?!cmp|test|bt|push|pop)\w+\s+(?:(.*),)?(%r\w+)(?:\s+#.*)?$")
# An address that the loader writes into memory: where, and the address itself or the name of a function.
RELOCATION = re.compile(r"^([0-9a-f]+) R_\S+\s+(?:\*ABS\*\+0x([0-9a-f]+)|([^\s@+]+))")


class Function:
    """A function: its name, and its instructions as pairs of address and text."""

    def __init__(self, name):
        self.name = name
        self.instructions = []


class MachineCode:
    """All functions of a library."""

    def __init__(self, path, objdump="objdump"):
        command = [objdump, "--disassemble", "--no-show-raw-insn", "--disassembler-options=att", path]
        found = []
        for line in lines_of(command):
            if header := HEADER.match(line):
                found.append((int(header[1], 16), Function(header[2])))
            elif found and (instruction := INSTRUCTION.match(line)):
                found[-1][1].instructions.append((int(instruction[1], 16), instruction[2].strip()))
        found.sort(key=lambda entry: entry[0])
        self.starts = [start for start, _ in found]
        self.functions = [function for _, function in found]
        self.known_starts = set(self.starts)
        # What the loader writes: the address of a function by its place, `None` if it is one of another library.
        by_name = {function.name: start for start, function in found}
        relocations = filter(None, map(RELOCATION.match, lines_of([objdump, "--dynamic-reloc", path])))
        self.pointers = {int(place, 16): int(address, 16) if address else by_name.get(name)
                         for place, address, name in (relocation.groups() for relocation in relocations)}

    def named(self, prefix):
        """The functions whose names begin with `prefix`, in the order of their names."""
        return sorted((f for f in self.functions if f.name.startswith(prefix)), key=lambda f: f.name)

    def at(self, address):
        """The function that holds an address."""
        return self.functions[max(bisect.bisect_right(self.starts, address) - 1, 0)]

    def targets(self, function):
        """The functions that a function calls or jumps to, and the text of every call whose target is not known.

        A call of a function that is compiled in another unit reads its address from a table: in the call itself, or
        earlier into a register. What lies in other libraries (memcpy) is left out."""
        targets, unknown, loaded = [], [], set()
        for _, text in function.instructions:
            if goes := GOES_TO.match(text):
                targets.append(self.at(int(goes[1], 16)))
            reads = READS.search(text)
            place = int(reads[1], 16) if reads else None
            if self.pointers.get(place) in self.known_starts:
                targets.append(self.at(self.pointers[place]))
            if changes := CHANGES.match(text):
                is_pointer = place in self.pointers or changes[1] in loaded
                (loaded.add if is_pointer else loaded.discard)(changes[2])
            if (call := CALLS_INDIRECTLY.match(text)) and place not in self.pointers and call[1] not in loaded:
                unknown.append(text)
        return [target for target in targets if not target.name.endswith("@plt")], unknown

    def reached(self, function):
        """The function and all that it calls or jumps to, and so on, and every call whose target is not known, each with
        the function that has it."""
        seen, waiting, unknown = {function.name: function}, [function], []
        while waiting:
            caller = waiting.pop()
            targets, calls = self.targets(caller)
            unknown.extend((caller, call) for call in calls)
            for target in targets:
                if target.name not in seen:
                    seen[target.name] = target
                    waiting.append(target)
        return list(seen.values()), unknown


def lines_of(command):
    """The lines that a command prints."""
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
