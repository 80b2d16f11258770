"""The compiler's assembly by function, and the shortest way through a function, which is the hot one.

The functions of a mechanism are straight code; the only branches lead to the reduction of hard angles, which is longer
than the way past it, and back. So the hot code of a function is its shortest way from the first instruction to a return.
Functions that are called stand in it in place of the call.
"""

import heapq
import re

LABEL = re.compile(r'^("[^"]+"|[\w.$]+):')
# Names in jumps and calls: `.LBB3_1`, `sym`, `*sym@GOTPCREL(%rip)`, `x0, .LBB3_1`, `w8, #3, .LBB3_1`.
TARGET = re.compile(r'("[^"]+"|[\w.$]+)(?:@\w+)?(?:\(%rip\))?$')


# What a call of a function that is not in the file, or goes through a register, counts as: it is taken only if
# every path has one.
UNKNOWN = 100_000


class Dialect:
    """What instructions do to the flow of control."""

    def __init__(self, call, jump, branch, end, comment, arguments):
        self.call, self.jump, self.branch, self.end = (re.compile(f"(?:{p})$") for p in (call, jump, branch, end))
        self.comment = comment
        # Instructions that give the registers of arguments new values, so that a call does not wait for the last one.
        self.arguments = arguments


X86 = Dialect(
    call="callq?", jump="jmpq?", branch="j[a-z]+", end="retq?|ud2", comment="#",
    arguments=[f"movabsq $4096, %{register}" for register in ("rdi", "rsi", "rdx", "rcx")],
)
AARCH64 = Dialect(
    call="blr?", jump="br?", branch=r"b\.\w+|cbn?z|tbn?z", end="ret|brk|udf", comment="//",
    arguments=[f"mov {register}, #4096" for register in ("x0", "x1", "x2", "x3", "x8")],
)


class Block:
    """Instructions between labels and jumps, and where they lead: names of blocks, or `None` for a return."""

    def __init__(self):
        self.code, self.next = [], []


class Assembly:
    """A file of assembly."""

    def __init__(self, text, dialect):
        self.dialect = dialect
        self.functions = {}
        lines, label = [], None
        for line in text.splitlines():
            if (match := LABEL.match(line)) and not line.startswith(".L"):
                label = match[1]
                lines = self.functions[label] = []
            elif label:
                lines.append(line)
        self.ways = {}

    def way(self, name, repeats=1):
        """Instructions of the shortest way through a function, whose loop is gone through `repeats` times, and the names
        of what is called elsewhere; `None` if no path reaches a return."""
        key = name, repeats
        if key not in self.ways:
            self.ways[key] = None  # while it is looked for: a recursive call has no path
            blocks = self.blocks(name)
            code = {label: self.inlined(block, repeats) for label, block in blocks.items()}
            if labels := shortest(blocks, code):
                labels = with_loops(blocks, labels, repeats)
                lines = [line for label in labels for line in code[label][0]]
                self.ways[key] = lines, [call for label in labels for call in code[label][1]]
        return self.ways[key]

    def blocks(self, name):
        """The blocks of a function by label; the first is ''."""
        dialect, blocks, label, fresh = self.dialect, {"": Block()}, "", 0
        for line in self.functions[name]:
            text = line.split(dialect.comment)[0].strip()
            if match := LABEL.match(text):
                if match[1].startswith(".Lfunc_end"):
                    break
                if blocks[label].next == [] and label is not None:
                    blocks[label].next.append(match[1])
                label = match[1]
                blocks[label] = Block()
                continue
            if not text or text.startswith("."):
                continue
            operation, _, operands = text.partition("\t") if "\t" in text else text.partition(" ")
            target = TARGET.search(operands)
            block, ends = blocks[label], True
            if dialect.end.match(operation):
                block.next = [None] if operation.startswith("ret") else ["nowhere"]
            elif dialect.jump.match(operation) or dialect.branch.match(operation):
                always = dialect.jump.match(operation)
                if target[1].startswith(".L"):
                    block.next.append(target[1])
                else:  # another function takes over
                    block.code.append(("call", target[1]))
                    block.next.append(None)
                if not always:
                    fresh += 1
                    block.code.append(("code", text.replace(target[1], ".Lout")))
                    block.next.append(f"after {fresh}")
            elif dialect.call.match(operation):
                block.code.append(("call", target[1] if target else operands))
                ends = False
            else:
                block.code.append(("code", text))
                ends = False
            if ends:
                label = f"after {fresh}" if block.next[-1:] == [f"after {fresh}"] else f"behind {len(blocks)}"
                blocks[label] = Block()
        return blocks

    def inlined(self, block, repeats):
        """The code of a block with that of the functions it calls."""
        lines, calls = [], []
        for kind, text in block.code:
            if kind == "code":
                lines.append(text)
            elif text in self.functions:
                if (way := self.way(text, repeats)) is None:
                    return None
                lines += way[0]
                calls += way[1]
            else:
                calls.append(text)
        return lines, calls


def shortest(blocks, code):
    """The labels of the shortest way from the first block to a return (Dijkstra); `None` if no path exists."""
    waiting, seen, count = [(0, 0, "", [])], set(), 0
    while waiting:
        length, _, label, way = heapq.heappop(waiting)
        if label is None:
            return way
        if label in seen or code.get(label) is None:
            continue
        seen.add(label)
        lines, calls = code[label]
        for following in blocks[label].next:
            count += 1
            heapq.heappush(waiting, (length + len(lines) + UNKNOWN * len(calls), count, following, way + [label]))
    return None


def with_loops(blocks, way, repeats):
    """A way on which loops (those over a robot's angles) are gone through `repeats` times, not once."""
    place = {label: index for index, label in enumerate(way)}
    for index, label in enumerate(way):
        waiting, seen = list(blocks[label].next), set()
        while waiting:
            following = waiting.pop()
            if place.get(following, len(way)) <= index:
                loop = way[place[following]:index + 1]
                return way[:index + 1] + loop * (repeats - 1) + with_loops(blocks, way[index + 1:], repeats)
            if following in blocks and following not in place and following not in seen:
                seen.add(following)
                waiting += blocks[following].next
    return way
