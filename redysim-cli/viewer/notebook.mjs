// Looks in headless Chromium at pages as a notebook shows them, each in a frame of the page `model.html` or `motion.html` of
// a folder: the sliders move the links: node notebook.mjs FOLDER.

import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { drag, GL, inBrowser } from "./browser.mjs";

const folder = resolve(process.argv[2] ?? ".");
const VIEWPORT = { width: 1000, height: 700 };

await inBrowser(join(folder, "model.html"), GL, VIEWPORT, (frame) =>
  theLinksMove(frame, "#sliders label:nth-of-type(2) input", 0.5));
await inBrowser(join(folder, "motion.html"), GL, VIEWPORT, (frame) => theLinksMove(frame, "#time", 0.5));
console.log(`${folder}: the pages do in frames what they must`);

async function theLinksMove(frame, slider, value) {
  const links = () => frame.evaluate(() => redysim.links().map(({ com }) => com));
  const before = await links();
  await drag(frame, slider, value);
  const after = await links();
  assert.ok(before.length > 0 && after.flat().every(Number.isFinite), `links at ${after}`);
  const moved = Math.max(...after.flat().map((x, index) => Math.abs(x - before.flat()[index])));
  assert.ok(moved > 1e-3, `${slider} dragged to ${value} moves nothing`);
}
