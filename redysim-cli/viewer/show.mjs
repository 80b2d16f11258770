// Drags the sliders of the page `show.html` of a folder in headless Chromium, holds what it draws against the positions in
// `expected.json`, and leaves screenshots beside it: node show.mjs FOLDER.
//
// `expected.json` has `drags`, each with a `coordinate`, the `value` to which its slider is dragged, and what must then be
// so: `q`, coordinates with numbers or null where nothing is known; `links`, the origin and the centre of mass of each;
// `meshes`, body and corners of the box around each; and `stops`, a part of what the page reports, or null. `notes` is a
// part of what it notes, and `layers` has names of what it can hide.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { aNarrowPageFits, drag, GL, inBrowser, NO_GL } from "./browser.mjs";

/** The page computes the links from the joints as the command does, but for rounding. */
const TOLERANCE = 1e-9;
/** Points of meshes are in single precision. */
const SINGLE = 1e-6;
/** The step at which the page gives up to move a coordinate whose loops do not close. */
const STOP = 1e-5;

const folder = resolve(process.argv[2] ?? ".");
const show = join(folder, "show.html");
const expected = JSON.parse(await readFile(join(folder, "expected.json"), "utf8"));

await inBrowser(show, GL, { width: 1280, height: 800 }, async (page) => {
  await page.screenshot({ path: join(folder, "start.png") });
  await slidersMoveTheLinks(page, true);
  const notes = await page.textContent("#notes");
  assert.ok(notes.includes(expected.notes), `the notes are: ${notes}`);
  await page.screenshot({ path: join(folder, "dragged.png") });
  await everyLayerCanBeHidden(page);
  await theButtonLeadsBackToTheStart(page);
  await aNarrowPageFits(page, join(folder, "narrow.png"));
});
await inBrowser(show, NO_GL, { width: 1280, height: 800 }, (page) => slidersMoveTheLinks(page, false), /WebGL/);
console.log(`${folder}: the page does what it must`);

async function slidersMoveTheLinks(page, drawn) {
  for (const { coordinate, value, q, links, meshes, stops } of expected.drags) {
    const before = await page.evaluate(() => redysim.q);
    await drag(page, `#sliders label:nth-of-type(${coordinate + 1}) input`, value);
    const found = await page.evaluate(() => ({ q: redysim.q, gap: redysim.gap, links: redysim.links() }));
    const boxes = await page.evaluate(() => redysim.meshes());
    const what = `${coordinate} dragged to ${value}`;
    assert.notDeepEqual(found.q, before, `${what}: nothing moves`);
    assert.ok(found.gap < TOLERANCE, `${what}: the loops are open by ${found.gap}`);
    const status = await page.textContent("#sliders [role=status]");
    if (stops) assert.ok(status.includes(stops), `${what}: the page must report ${stops}, reports ${status}`);
    else assert.equal(status, "", what);
    near(found.q, q, stops ? STOP : TOLERANCE, `${what}: coordinate`);
    for (const [index, { name, origin, com }] of (links ?? []).entries()) {
      assert.equal(found.links[index].name, name);
      near(found.links[index].origin, origin, TOLERANCE, `${what}: origin of ${name}`);
      if (found.links[index].com) near(found.links[index].com, com, TOLERANCE, `${what}: centre of ${name}`);
    }
    if (drawn) assert.equal(boxes.length, meshes?.length ?? 0, "meshes that are drawn");
    for (const [index, box] of boxes.entries()) {
      assert.equal(box.body, meshes[index].body);
      near(box.min, meshes[index].min, SINGLE, `${what}: least corner of mesh ${index}`);
      near(box.max, meshes[index].max, SINGLE, `${what}: largest corner of mesh ${index}`);
    }
  }
}

function near(found, expected, tolerance, what) {
  expected?.forEach((value, index) => {
    const apart = value === null ? 0 : Math.abs(found[index] - value);
    assert.ok(apart <= tolerance * Math.max(1, Math.abs(value)), `${what} ${index}: ${found[index]} instead of ${value}`);
  });
}

async function everyLayerCanBeHidden(page) {
  const boxes = page.locator("#layers label:not([hidden]) input");
  const names = await boxes.evaluateAll((boxes) => boxes.map((box) => box.dataset.layer));
  for (const layer of expected.layers) assert.ok(names.includes(layer), `no box for ${layer} among ${names}`);
  for (const name of names) {
    const box = page.locator(`[data-layer=${name}]`);
    const picture = async (shown) => {
      await box.setChecked(shown);
      return page.evaluate(() => redysim.picture());
    };
    const hidden = await picture(false);
    const shown = await picture(true);
    assert.notDeepEqual(shown, hidden, `showing ${name} changes nothing`);
    assert.deepEqual(await picture(false), hidden, `hiding ${name} must lead back`);
    await box.setChecked(true);
  }
  await page.screenshot({ path: join(folder, "all.png") });
}

async function theButtonLeadsBackToTheStart(page) {
  await page.click("#sliders button");
  near(await page.evaluate(() => redysim.q), expected.start, 1e-15, "start: coordinate");
}
