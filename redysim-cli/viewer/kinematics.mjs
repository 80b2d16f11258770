// The places of the links in `kinematics.csv` of a results folder.

import { table } from "./table.mjs";

/** The table at a path: its instants, the names of the links, and their points. */
export async function kinematics(path) {
  const { headers, rows, t, column } = await table(path);
  return {
    t,
    links: headers.filter((header) => header.startsWith("com_x ")).map((header) => header.slice(6, -4)),
    point: (row, prefix, link) => ["x", "y", "z"].map((axis) => rows[row][column(`${prefix}${axis} ${link} [m]`)]),
  };
}
