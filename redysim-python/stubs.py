#!/usr/bin/env python3
"""Writes the stubs of the package, python/redysim/_core.pyi: what is in stubs.pyi by hand, and the
functions of the installed package with their docstrings."""

import re
import textwrap
from pathlib import Path

from redysim import _core

HERE = Path(__file__).parent
PLACE = "    # The functions.\n"
RECORDS = "# The records.\n"
TARGET = HERE / "python/redysim/_core.pyi"


def class_name(record: str) -> str:
    return "".join(word.capitalize() for word in record.split("_"))


def records() -> str:
    """A class for each record that a function returns, with its parts."""
    robot = _core.Mechanism
    text = ""
    for function, _, record in _core.table_of_functions():
        if record is not None:
            lines = getattr(robot, function).__doc__.splitlines()
            parts = [line.split("`")[1] for line in lines if line.strip().startswith("- `")]
            text += f"@type_check_only\nclass {class_name(record)}(np.recarray):\n"
            text += "".join(f"    {part}: _Array\n" for part in parts) + "\n"
    return text


def documented(method: str) -> str:
    """The docstring of a method."""
    text = textwrap.indent(getattr(_core.Mechanism, method).__doc__, " " * 8)
    return f'        """{text.lstrip()}\n        """\n'


def functions() -> str:
    text = ""
    for function, arguments, record in _core.table_of_functions():
        result = class_name(record) if record else "_Array"
        parameters = "".join(f", {argument}: ArrayLike" for argument in arguments)
        text += f"    def {function}(self{parameters}, *, out: _Out | None = None) -> {result}:\n"
        text += documented(function) + "\n"
    return text


def stubs() -> str:
    by_hand = (HERE / "stubs.pyi").read_text(encoding="utf-8")
    by_hand = re.sub(" +# The documentation of (\\w+)\\.\n", lambda found: documented(found[1]), by_hand)
    return by_hand.replace(RECORDS, records()).replace(PLACE, functions())


if __name__ == "__main__":
    TARGET.write_text(stubs(), encoding="utf-8")
