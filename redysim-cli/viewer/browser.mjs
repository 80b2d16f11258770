// Pages in headless Chromium, as the tests look at them.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const BROWSER = process.env.CHROMIUM ?? "/usr/bin/chromium";
const FLAGS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync",
];
/** With and without WebGL. */
export const GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
export const NO_GL = ["--disable-gpu", "--disable-3d-apis"];

/**
 * The page at `path` in a fresh browser, or the one that it has in a frame; fails on console errors (but `expected` ones) and
 * on any request but for the page.
 */
export async function inBrowser(path, flags, viewport, look, expected) {
  const profile = await mkdtemp(join(tmpdir(), "redysim-viewer-"));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: BROWSER, headless: true, args: [...FLAGS, ...flags], viewport,
  });
  try {
    const page = await browser.newPage();
    const faults = [];
    const url = pathToFileURL(path).href;
    page.on("pageerror", (error) => faults.push(String(error)));
    page.on("console", (line) => line.type() === "error" && !expected?.test(line.text()) && faults.push(line.text()));
    page.on("request", (request) => {
      if (request.url() !== url && !/^(data|blob):/.test(request.url())) faults.push(`it asked for ${request.url()}`);
    });
    await page.goto(url);
    const shown = (await (await page.$("iframe"))?.contentFrame()) ?? page;
    await shown.waitForFunction(() => window.redysim);
    await look(shown);
    assert.deepEqual(faults, []);
  } finally {
    await browser.close();
    await rm(profile, { recursive: true, force: true });
  }
}

/** Drags a slider to a value. */
export async function drag(page, selector, value) {
  await page.locator(selector).evaluate((slider, value) => {
    slider.value = value;
    slider.dispatchEvent(new Event("input"));
  }, value);
}

/** Makes the window as narrow as a telephone, looks whether the page fits, and leaves a screenshot at `path`. */
export async function aNarrowPageFits(page, path) {
  await page.setViewportSize({ width: 390, height: 844 });
  const [width, wide] = await page.evaluate(() => [innerWidth, document.documentElement.scrollWidth]);
  assert.ok(wide <= width, `a narrow page must not scroll sideways, but is ${wide} wide in ${width}`);
  await page.screenshot({ path });
}
