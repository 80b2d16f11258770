"""The tables of a run of redysim."""

import csv
from pathlib import Path

import numpy


class Run:
    """A folder of results."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.tables: dict[str, tuple[list[str], numpy.ndarray]] = {}

    def columns(self, table: str, start: str) -> numpy.ndarray:
        """The columns of a table whose headers start so, side by side."""
        if table not in self.tables:
            with open(self.folder / f"{table}.csv", newline="") as file:
                headers, *rows = csv.reader(file)
            self.tables[table] = (headers, numpy.array(rows, dtype=float))
        headers, values = self.tables[table]
        chosen = [index for index, header in enumerate(headers) if header.startswith(start)]
        assert chosen, f"{self.folder}/{table}.csv has no column {start}"
        return values[:, chosen]
