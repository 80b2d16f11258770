// Plays the page `animation.html` of a results folder in headless Chromium, holds what it draws against
// `kinematics.csv`, and leaves screenshots beside it: node test.mjs FOLDER [FINER], where FINER is a folder with the same
// motion at more instants, for what the page shows between those that it has.

import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { aNarrowPageFits, drag, GL, inBrowser, NO_GL } from "./browser.mjs";
import { kinematics } from "./kinematics.mjs";

/** The page computes the links from the joints as the command does, but for rounding. */
const TOLERANCE = 1e-9;
/** Between instants: a twentieth of a pixel where a metre has five hundred. */
const BETWEEN = 1e-4;

const folder = resolve(process.argv[2] ?? ".");
const table = await kinematics(join(folder, "kinematics.csv"));
const animation = join(folder, "animation.html");
const finer = process.argv[3] && (await kinematics(join(resolve(process.argv[3]), "kinematics.csv")));

await inBrowser(animation, GL, { width: 1280, height: 800 }, async (page) => {
  await page.screenshot({ path: join(folder, "start.png") });
  await theSliderMovesTheLinks(page);
  await everyMeshIsDrawn(page);
  if (finer) await linksAreWhereTheyAre(page, finer, finer.t.keys(), BETWEEN);
  await theSpaceBarPlaysAndPauses(page);
  await theKeysStepAndJump(page);
  await aCurveGoesToTheTimePointedAt(page);
  await noLabelIsCut(page);
  await theViewTurnsByMouseAndKeys(page);
  await aRunEndsOrRepeats(page);
  assert.notEqual(await page.title(), "harm");
  await slide(page, table.t[Math.floor(table.t.length * 0.4)]);
  await page.check("[data-layer=names]");
  await page.screenshot({ path: join(folder, "middle.png") });
  await aNarrowPageFits(page, join(folder, "narrow.png"));
});
await inBrowser(animation, NO_GL, { width: 1280, height: 800 }, async (page) => {
  assert.ok(await page.isVisible("#no-webgl"), "without WebGL the page must say so");
  await theSliderMovesTheLinks(page);
  await page.screenshot({ path: join(folder, "no_webgl.png") });
}, /WebGL/);
console.log(`${folder}: the page does what it must`);

function slide(page, time) {
  return drag(page, "#time", time);
}

async function theSliderMovesTheLinks(page) {
  const rows = [0, 0.13, 0.5, 0.77, 1].map((part) => Math.round(part * (table.t.length - 1)));
  await linksAreWhereTheyAre(page, table, rows, TOLERANCE);
  const moved = rows.map((row) => table.point(row, "com_", table.links.at(-1)).join());
  assert.ok(new Set(moved).size > 1, "a mechanism that does not move shows nothing");
}

async function everyMeshIsDrawn(page) {
  const bodies = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).meshes);
  const drawn = await page.evaluate(() => redysim.meshes());
  assert.deepEqual(drawn.map(({ body }) => body), bodies.map(({ body }) => body));
}

async function linksAreWhereTheyAre(page, table, rows, tolerance) {
  for (const row of rows) {
    await slide(page, table.t[row]);
    const { time, links } = await page.evaluate(() => ({ time: redysim.time, links: redysim.links() }));
    assert.ok(Math.abs(time - table.t[row]) < 1e-9, `the slider is at ${table.t[row]} s, the page at ${time} s`);
    const near = (shown, prefix, name) => {
      const recorded = table.point(row, prefix, name);
      const most = tolerance * Math.max(1, ...recorded.map(Math.abs));
      const apart = Math.hypot(...shown.map((value, axis) => value - recorded[axis]));
      assert.ok(apart <= most, `${prefix}${name} at ${time} s: drawn at ${shown}, recorded at ${recorded}`);
    };
    for (const { name, origin, com } of links) {
      near(origin, "", name);
      if (com) near(com, "com_", name);
    }
  }
}

async function theSpaceBarPlaysAndPauses(page) {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Home");
  const start = await time(page);
  await page.keyboard.press("Space");
  await page.waitForFunction((start) => redysim.time > start, start);
  assert.equal(await page.getAttribute("#play", "aria-label"), "Pause");
  await page.keyboard.press("Space");
  const paused = await time(page);
  await page.waitForTimeout(200);
  assert.equal(await time(page), paused, "what is paused must stay");
}

async function theKeysStepAndJump(page) {
  await page.keyboard.press("End");
  assert.equal(await time(page), table.t.at(-1));
  await page.keyboard.press("ArrowLeft");
  assert.equal(await time(page), table.t.at(-2));
  await page.keyboard.press("Shift+ArrowLeft");
  assert.equal(await time(page), table.t.at(-12));
  await page.keyboard.press("ArrowRight");
  assert.equal(await time(page), table.t.at(-11));
  await page.keyboard.press("Home");
  assert.equal(await time(page), table.t[0]);
}

async function aCurveGoesToTheTimePointedAt(page) {
  const box = await page.locator(".u-over").first().boundingBox();
  const value = await page.locator(".u-legend .u-value").nth(1).textContent();
  assert.match(value, /\d/, "the legend must show the present value");
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  const middle = (table.t[0] + table.t.at(-1)) / 2;
  const off = Math.abs((await time(page)) - middle) / (table.t.at(-1) - table.t[0]);
  assert.ok(off < 0.2, `a click into the middle of a curve went to ${await time(page)} s`);
  const line = await page.locator(".now").first().boundingBox();
  assert.ok(Math.abs(line.x - (box.x + box.width / 2)) < 3, "the line of the present time must be at the click");
}

/** Makes the window narrower, so that the curves are drawn again, and looks where their labels begin and end. */
async function noLabelIsCut(page) {
  await page.evaluate(() => {
    const { fillText } = CanvasRenderingContext2D.prototype;
    window.labels = [];
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
      const { actualBoundingBoxLeft: left, actualBoundingBoxRight: right } = this.measureText(text);
      const start = this.getTransform().transformPoint({ x: x - left, y }).x;
      labels.push({ text, start, end: start + left + right, width: this.canvas.width });
      return fillText.call(this, text, x, y);
    };
  });
  await page.setViewportSize({ width: 1200, height: 800 });
  await page.waitForFunction(() => labels.length > 0);
  const labels = await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => done(labels))));
  await page.setViewportSize({ width: 1280, height: 800 });
  for (const { text, start, end, width } of labels) {
    assert.ok(start >= 0 && end <= width, `the label ${text} goes from ${start} to ${end} on ${width} pixels`);
  }
}

async function theViewTurnsByMouseAndKeys(page) {
  const canvas = page.locator("#canvas");
  const camera = () => page.evaluate(() => redysim.camera());
  const first = await camera();
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 30, { steps: 3 });
  await page.mouse.up();
  assert.ok(distance(await camera(), first) > 0, "dragging must turn the view");
  await page.mouse.wheel(0, 300);
  for (const key of ["d", "w", "+"]) {
    const last = await camera();
    await canvas.press(key);
    assert.ok(distance(await camera(), last) > 0, `the key ${key} must change the view`);
  }
  await canvas.press("0");
  const apart = distance(await camera(), first) / Math.hypot(...first);
  assert.ok(apart < 1e-9, "0 must lead back to the first view");
  await page.evaluate(() => document.activeElement.blur());
}

function distance(a, b) {
  return Math.hypot(...a.map((value, axis) => value - b[axis]));
}

async function aRunEndsOrRepeats(page) {
  const nearEnd = table.t.at(-2);
  await page.uncheck("#repeat");
  await slide(page, nearEnd);
  await page.evaluate(() => redysim.play());
  await page.waitForFunction(() => !redysim.playing);
  assert.equal(await time(page), table.t.at(-1), "without repetition it must stop at the end");
  await page.check("#repeat");
  await slide(page, nearEnd);
  await page.evaluate(() => redysim.play());
  await page.waitForFunction((time) => redysim.time < time, nearEnd);
  await page.evaluate(() => redysim.pause());
}

function time(page) {
  return page.evaluate(() => redysim.time);
}
