"""Tables and paragraphs of Markdown."""

from textwrap import fill


def paragraph(text: str) -> str:
    return fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def item(text: str) -> str:
    return fill("- " + text, 120, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def table(header: list[str], rows: list[list[str]], left: int = 1) -> str:
    """A table whose first columns stand left and the others right."""
    rule = ["---"] * left + ["--:"] * (len(header) - left)
    return "\n".join([_row(header), _row(rule), *(_row(row) for row in rows)]) + "\n"


def _row(cells: list) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def nanoseconds(time: float | None) -> str:
    if time is None:
        return "–"
    # Times that are known in whole ns only are whole in the data.
    if isinstance(time, int):
        return str(time)
    return f"{time:.1f}" if time < 100 else f"{time:.0f}"
