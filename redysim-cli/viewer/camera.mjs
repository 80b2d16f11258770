// Plays the page `animation.html` of a results folder in headless Chromium, and holds where the camera is against the base
// in `kinematics.csv`: node camera.mjs FOLDER MOTION LINK NORMAL [RADIUS], where MOTION is how the camera moves at first,
// `follow`, `fixed`, or `none` where there is nothing to follow, LINK is the base, NORMAL is x, y or z, the direction in
// which the camera does not follow, or `none`, and RADIUS is that of a sphere, m, within which is all that the base carries,
// seen from it: a camera that follows shows no more.

import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { drag, GL, inBrowser } from "./browser.mjs";
import { kinematics } from "./kinematics.mjs";

/** Positions are sums of a few numbers of some metres. */
const TOLERANCE = 1e-9;

const [motion, link, normal, radius] = process.argv.slice(3);
const folder = resolve(process.argv[2]);
const table = await kinematics(join(folder, "kinematics.csv"));
const base = (row) => table.point(row, "", link).map((value, axis) => ("xyz"[axis] === normal ? 0 : value));
const rows = [0, 0.31, 0.5, 0.83, 1].map((part) => Math.round(part * (table.t.length - 1)));

await inBrowser(join(folder, "animation.html"), GL, { width: 1280, height: 800 }, async (page) => {
  assert.equal(await page.isVisible("#follow"), motion !== "none");
  if (motion === "none") return staysWithEverything(page);
  assert.equal(await page.isChecked("#follow"), motion === "follow");
  for (const follows of [motion === "follow", motion !== "follow", motion === "follow"]) {
    await page.setChecked("#follow", follows);
    await (follows ? staysWithTheBase(page) : staysWithEverything(page));
  }
  await page.setChecked("#follow", true);
  for (const part of [0, 0.5, 1]) {
    await drag(page, "#time", table.t[Math.round(part * (table.t.length - 1))]);
    await page.screenshot({ path: join(folder, `follow_${part}.png`) });
  }
  if (radius) await showsNoMoreThan(Number(radius), page);
  await page.locator("#canvas").press("d");
  await page.locator("#canvas").press("+");
  await staysWithTheBase(page);
  await page.setChecked("#follow", false);
  await page.screenshot({ path: join(folder, "fixed.png") });
});
console.log(`${folder}: the camera is where it must be`);

/** The camera and what it looks at, m, at each of the rows. */
async function views(page) {
  const found = [];
  for (const row of rows) {
    await drag(page, "#time", table.t[row]);
    found.push(await page.evaluate(() => ({ camera: redysim.camera(), target: redysim.target() })));
  }
  return found;
}

async function staysWithTheBase(page) {
  const found = await views(page);
  assert.ok(rows.some((row) => distance(base(row), base(0)) > 1e-4), "a base that stands still shows nothing");
  for (const [k, { camera, target }] of found.entries()) {
    const way = difference(base(rows[k]), base(rows[0]));
    near(difference(camera, found[0].camera), way, `the camera at ${table.t[rows[k]]} s`);
    near(difference(target, found[0].target), way, `what it looks at, at ${table.t[rows[k]]} s`);
  }
}

async function showsNoMoreThan(radius, page) {
  const { camera, target, aspect } = await page.evaluate(() => {
    const { clientWidth, clientHeight } = document.querySelector("#canvas");
    return { camera: redysim.camera(), target: redysim.target(), aspect: clientWidth / clientHeight };
  });
  // The picture is 30° high, and an eighth is left free around the sphere.
  const most = (1.125 * radius) / Math.sin(Math.PI / 12) / Math.min(1, aspect);
  const found = distance(camera, target);
  assert.ok(found <= most, `the camera is ${found} m away, and would see all from ${most} m`);
}

async function staysWithEverything(page) {
  const found = await views(page);
  for (const { camera, target } of found) {
    near(camera, found[0].camera, "the camera");
    near(target, found[0].target, "what it looks at");
  }
}

function near(found, expected, what) {
  assert.ok(distance(found, expected) < TOLERANCE, `${what}: ${found}, not ${expected}`);
}

function distance(a, b) {
  return Math.hypot(...difference(a, b));
}

function difference(a, b) {
  return a.map((value, axis) => value - b[axis]);
}
