/** What the tests of the page share: reports on disk, pages that note every request and error, and pictures. */
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { fillPage } from "../fixtures/pack.ts";

const folder = mkdtempSync(join(tmpdir(), "vantage-viewer-"));

export const template = (): string => readFileSync(new URL("../dist/report.html", import.meta.url), "utf8");

/** Writes a report and gives its path. */
export function writeReport(name: string, html: string): string {
  const path = join(folder, name);
  writeFileSync(path, html);
  return path;
}

export const reportOf = (name: string, document: unknown): string => writeReport(name, fillPage(template(), document));

export interface Watched {
  page: Page;
  /** Requests for anything but the page itself. */
  requests: string[];
  problems: string[];
}

export interface PageOptions {
  width?: number;
  height?: number;
  scheme?: "light" | "dark";
  offline?: boolean;
  javaScript?: boolean;
  touch?: boolean;
  scaleFactor?: number;
}

/**
 * The page reads one pixel back to know how long a moving frame took (viewport.ts), on purpose. After enough of them the
 * driver remarks that reading waits for drawing; whether that many frames move depends on how fast the machine draws.
 */
const isFrameTimed = (text: string) => text.includes("GL Driver Message (OpenGL, Performance") && text.includes("ReadPixels");

export async function openPage(browser: Browser, url: string, options: PageOptions = {}): Promise<Watched> {
  const { width = 960, height = 600, scheme = "light", offline = true, javaScript = true, touch = false } = options;
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme: scheme,
    javaScriptEnabled: javaScript,
    hasTouch: touch,
    deviceScaleFactor: options.scaleFactor ?? 1,
  });
  await context.setOffline(offline);
  const page = await context.newPage();
  page.setDefaultTimeout(180_000);
  const watched: Watched = { page, requests: [], problems: [] };
  page.on("request", (request) => {
    if (request.url() !== url && !request.url().startsWith("data:")) watched.requests.push(request.url());
  });
  page.on("pageerror", (error) => watched.problems.push(String(error)));
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !isFrameTimed(message.text())) watched.problems.push(message.text());
  });
  await page.goto(url);
  if (javaScript) await page.waitForSelector("html[data-ready]", { state: "attached" });
  return watched;
}

export const openReport = (browser: Browser, path: string, options?: PageOptions) =>
  openPage(browser, `file://${path}`, options);

/** The scene without the panel that lies over it. */
export async function scenePicture(page: Page): Promise<Buffer> {
  const box = (await page.locator(".stage canvas").boundingBox())!;
  const panel = (await page.locator(".layers").boundingBox())!;
  const left = panel.height > 60 ? panel.x + panel.width + 4 : box.x;
  const top = panel.height > 60 ? box.y : panel.y + panel.height + 4;
  const clip = { x: left, y: top, width: box.x + box.width - left, height: box.y + box.height - top };
  return page.screenshot({ clip });
}

/** Shares of the scene's pixels: blue of occupied voxels, orange of occplane ones, and anything but the background. */
export async function sceneColors(page: Page): Promise<{ blue: number; orange: number; drawn: number }> {
  const picture = await scenePicture(page);
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d")!;
    context.drawImage(image, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const count = { blue: 0, orange: 0, drawn: 0 };
    const corner = pixels.slice(pixels.length - 4);
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = [pixels[i], pixels[i + 1], pixels[i + 2]];
      if (b > 70 && r < 0.45 * b && g > 0.35 * b && g < 0.8 * b) ++count.blue;
      if (r > 120 && g > 0.45 * r && g < 0.85 * r && b < 0.62 * r) ++count.orange;
      if (Math.abs(r - corner[0]) + Math.abs(g - corner[1]) + Math.abs(b - corner[2]) > 24) ++count.drawn;
    }
    const all = pixels.length / 4;
    return { blue: count.blue / all, orange: count.orange / all, drawn: count.drawn / all };
  }, picture.toString("base64"));
}

/** Waits until the scene has been drawn with what was set before. */
export async function settle(page: Page): Promise<void> {
  await page.evaluate(() => new Promise<void>((done) => requestAnimationFrame(() => done())));
  await page.waitForFunction(() => window.vantage?.scene?.viewport.resting ?? true);
}

/** What opening a report took: milliseconds by the clock until it could be used, and of the page's own processor time. */
export interface Opening {
  clock: number;
  processor: number;
}

/** Opens a report `times` times, each in a browser context of its own; the openings from the fastest to the slowest. */
export async function timeOpening(browser: Browser, path: string, times = 5): Promise<Opening[]> {
  const openings: Opening[] = [];
  for (let i = 0; i < times; ++i) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    const page = await context.newPage();
    page.setDefaultTimeout(180_000);
    const cdp = await context.newCDPSession(page);
    await cdp.send("Performance.enable");
    await page.goto(`file://${path}`);
    await page.waitForSelector("html[data-ready=run]", { state: "attached" });
    const clock = await page.evaluate(() => performance.getEntriesByName("vantage-interactive")[0].startTime);
    const { metrics } = await cdp.send("Performance.getMetrics");
    openings.push({ clock, processor: 1000 * metrics.find((m) => m.name === "ThreadTime")!.value });
    await page.locator("input.time").fill("0");
    await page.waitForFunction(() => window.vantage!.session.store.state.step === 0);
    await context.close();
  }
  return openings.sort((a, b) => a.clock - b.clock);
}

/** Turns the scene as a drag does, until `until` says so; gives the milliseconds between frames that reached the screen. */
export function turnScene(page: Page, until: { seconds: number } | { frames: number }): Promise<number[]> {
  return page.evaluate(async (end) => {
    const frame = () => new Promise<number>((done) => requestAnimationFrame(done));
    const { viewport } = window.vantage!.scene!;
    const times: number[] = [];
    const start = performance.now();
    let last = await frame();
    while ("frames" in end ? times.length < end.frames : performance.now() < start + 1000 * end.seconds) {
      viewport.orbit(0.04, 0);
      const now = await frame();
      times.push(now - last);
      last = now;
    }
    return times;
  }, until);
}

export const median = (values: number[]): number => [...values].sort((a, b) => a - b)[values.length >> 1];

/**
 * Turns the scene until the view of candidate `index` is free, clicks it and gives what the card says: the exact
 * number behind each line. Null where the view stays hidden.
 */
export async function clickView(page: Page, index: number): Promise<Record<string, number> | null> {
  for (let turn = 0; turn < 12; ++turn) {
    const at = await page.evaluate((i) => {
      const { scene } = window.vantage!;
      const p = scene!.screenOfView(i);
      const box = scene!.viewport.canvas.getBoundingClientRect();
      if (!p || document.elementFromPoint(box.left + p.x, box.top + p.y) !== scene!.viewport.canvas) return null;
      const found = scene!.pick(p.x, p.y);
      return found?.kind === "view" && found.index === i ? { x: box.left + p.x, y: box.top + p.y } : null;
    }, index);
    if (!at) {
      await page.evaluate(() => window.vantage!.scene!.viewport.orbit(0.55, 0));
      continue;
    }
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction((i) => document.querySelector(".details-card h3")?.textContent === `View ${i}`, index);
    return page.$$eval(".details-card dt", (terms) =>
      Object.fromEntries(terms.map((t) => [t.textContent, Number(t.nextElementSibling!.getAttribute("data-exact"))])),
    );
  }
  return null;
}

/** The lines of the card and the keys of summary.json that must say the same. */
export const FACTORS = [
  ["utility", "utility"],
  ["f area", "f_area"],
  ["f navigation", "f_navigation"],
  ["f quality", "f_quality"],
  ["f occlusion", "f_occlusion"],
  ["occplane seen", "n_op"],
  ["occupied seen", "n_oc"],
] as const;
