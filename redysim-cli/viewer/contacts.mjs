// Plays the page `animation.html` of a results folder in headless Chromium, and holds the arrows of the forces of the ground
// against `contacts.csv` and the footprints against the events in `touch_downs.csv`, of which `run.toml` has the number: node
// contacts.mjs FOLDER PLANE .., where a PLANE is that of a contact, or that of all: its outward normal and where it crosses that
// axis, as z, y or -x=2. The table `points.csv` of the folder has the places of the frames in contact, which have their names.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { drag, GL, inBrowser } from "./browser.mjs";
import { table } from "./table.mjs";

/** Positions are sums of a few numbers of some metres. */
const TOLERANCE = 1e-9;
/** The page has forces in single precision. */
const SINGLE = 1e-6;
/** An arrow of three.js that is so close to y is drawn along it. */
const ALONG_Y = 0.99999;

const folder = resolve(process.argv[2]);
const planes = process.argv.slice(3).map((plane) => {
  const [, minus, name, at] = plane.match(/^(-?)([xyz])=?(.*)$/);
  return { axis: "xyz".indexOf(name), sign: minus ? -1 : 1, at: Number(at) };
});
const tables = ["contacts", "points", "touch_downs"].map((name) => table(join(folder, `${name}.csv`)));
const [contacts, points, events] = await Promise.all(tables);
const names = contacts.headers.filter((header) => header.startsWith("force_x ")).map((header) => header.slice(8, -4));
const vector = ({ rows, column }, row, prefix, name, unit) =>
  ["x", "y", "z"].map((axis) => rows[row][column(`${prefix}${axis} ${name} [${unit}]`)]);
const force = (row, name) => vector(contacts, row, "force_", name, "N");
const point = (row, name) => vector(points, row, "", name, "m");
const touching = (row, name) => contacts.rows[row][contacts.column(`touching ${name} [1]`)] === 1;
const last = contacts.t.length - 1;
const rows = [...Array(41).keys()].map((part) => Math.round((part / 40) * last));
/** When and where a contact stands at the start and touches down. */
const touchDowns = (name, contact) => {
  const standing = touching(0, name) ? [{ t: contacts.t[0], place: point(0, name) }] : [];
  const own = events.rows.filter((row) => row[events.column("contact [1]")] === contact);
  return [...standing, ...own.map(([t, , ...place]) => ({ t, place }))];
};
const [, count] = (await readFile(join(folder, "run.toml"), "utf8")).match(/^touch_downs = (\d+)$/m);
assert.equal(events.rows.length, Number(count), "the record has every touch-down");

await inBrowser(join(folder, "animation.html"), GL, { width: 1280, height: 800 }, async (page) => {
  const scales = [];
  const prints = [];
  for (const row of rows) {
    await drag(page, "#time", contacts.t[row]);
    const { arrows, footprints } = await page.evaluate(() => redysim.contacts());
    assert.equal(arrows.length, names.length);
    names.forEach((name, place) => scales.push(...arrowIsThatOfTheForce(arrows[place], row, name)));
    footprintsAreThoseOfTouchDowns(footprints, row);
    prints.push(footprints.length);
  }
  assert.ok(scales.length > rows.length / 2, "a mechanism that is in the air shows nothing");
  // The longest are cut: arrows are of one scale but for these.
  const scale = Math.max(...scales);
  const cut = scales.filter((other) => other < scale * (1 - 10 * SINGLE)).length;
  assert.ok(cut < scales.length / 4, `${cut} of ${scales.length} arrows are shorter than their forces`);
  assert.ok(new Set(prints).size > 1, "footprints must become visible on the way");
  for (const plane of planes.length > 1 ? planes : []) {
    const own = names.filter((name, contact) => planes[contact].axis === plane.axis);
    const events = own.flatMap((name) => touchDowns(name, names.indexOf(name)));
    assert.ok(events.length > 0, `a contact touches the plane across ${"xyz"[plane.axis]}`);
  }
  await theLayerHidesThem(page);
});
console.log(`${folder}: forces and footprints are those of the contacts`);

/** m/N, of an arrow that is shown. */
function arrowIsThatOfTheForce(arrow, row, name) {
  const acting = force(row, name);
  const size = Math.hypot(...acting);
  const what = `the arrow of ${name} at ${contacts.t[row]} s`;
  assert.equal(arrow !== null, size > 0, `${what} is shown where there is a force`);
  if (!arrow) return [];
  near(arrow.start, point(row, name), TOLERANCE, what);
  const along = difference(arrow.tip, arrow.start);
  const length = Math.hypot(...along);
  const [drawn, expected] = [along.map((value) => value / length), acting.map((value) => value / size)];
  const upright = Math.abs(expected[1]) > ALONG_Y;
  near(drawn, upright ? [0, Math.sign(expected[1]), 0] : expected, SINGLE, `the direction of ${what}`);
  return [length / size];
}

/** A footprint lies a little above the ground, so that it is seen. */
function footprintsAreThoseOfTouchDowns(footprints, row) {
  const ofContact = (name, contact) =>
    touchDowns(name, contact).map((event) => ({ ...event, plane: planes[planes.length > 1 ? contact : 0] }));
  const begun = names.flatMap(ofContact).filter(({ t }) => t <= contacts.t[row]);
  const what = `footprints at ${contacts.t[row]} s`;
  assert.equal(footprints.length, begun.length, what);
  begun.forEach(({ place, plane }, index) => {
    const print = footprints[index];
    const onPlane = (at) => at.map((value, axis) => (axis === plane.axis ? 0 : value));
    near(onPlane(print), onPlane(place), TOLERANCE, what);
    const height = plane.sign * (print[plane.axis] - plane.at);
    assert.ok(height > 0 && height < 0.02, `${what}: ${print} is on its plane`);
  });
}

async function theLayerHidesThem(page) {
  const drawn = () => page.evaluate(() => redysim.picture()[0]);
  const shown = await drawn();
  await page.setChecked("[data-layer=contacts]", false);
  assert.notEqual(await drawn(), shown, "forces and footprints are drawn");
  const { arrows, footprints } = await page.evaluate(() => redysim.contacts());
  assert.ok(arrows.every((arrow) => arrow === null) && footprints.length === 0, "the layer hides all of them");
  await page.setChecked("[data-layer=contacts]", true);
  await page.screenshot({ path: join(folder, "contacts.png") });
}

function near(found, expected, most, what) {
  assert.ok(Math.hypot(...difference(found, expected)) <= most, `${what}: ${found}, not ${expected}`);
}

function difference(a, b) {
  return a.map((value, axis) => value - b[axis]);
}
