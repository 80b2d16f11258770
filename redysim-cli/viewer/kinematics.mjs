// The places of the links in `kinematics.csv` of a results folder.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

/** The table at a path: its instants, the names of the links, and their points. */
export async function kinematics(path) {
  const [head, ...lines] = (await readFile(path, "utf8")).trim().split("\n");
  const headers = head.split(",");
  const rows = lines.map((line) => line.split(",").map(Number));
  const column = (label) => {
    const index = headers.indexOf(`${label} [m]`);
    assert.ok(index > 0, `${path} has no column ${label} [m]`);
    return index;
  };
  return {
    t: rows.map((row) => row[0]),
    links: headers.filter((header) => header.startsWith("com_x ")).map((header) => header.slice(6, -4)),
    point: (row, prefix, link) => ["x", "y", "z"].map((axis) => rows[row][column(`${prefix}${axis} ${link}`)]),
  };
}
