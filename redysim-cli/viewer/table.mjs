// A table of a results folder.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

/** The table at a path: its headers, its rows, its instants, and the index of the column of a header. */
export async function table(path) {
  const [head, ...lines] = (await readFile(path, "utf8")).trim().split("\n");
  const headers = head.split(",");
  const rows = lines.map((line) => line.split(",").map(Number));
  const column = (header) => {
    const index = headers.indexOf(header);
    assert.ok(index > 0, `${path} has no column ${header}`);
    return index;
  };
  return { headers, rows, t: rows.map((row) => row[0]), column };
}
