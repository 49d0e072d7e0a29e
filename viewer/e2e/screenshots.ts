/**
 * The pictures in docs/, made from runs of the program itself, which must be built:
 *
 *     npm run screenshots [-- REPORT [EXPERIMENT]]
 *
 * REPORT is the report.html of a reconstruction, EXPERIMENT that of an experiment; without them the mug is scanned and
 * figure 11 repeated with few seeds first.
 */
import { execFileSync } from "node:child_process";
import { mkdtempSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import type { Page } from "playwright-core";
import { launch } from "./browser.ts";
import { openReport, settle, type PageOptions } from "./pages.ts";
import { PROGRAM } from "./program.ts";

const root = fileURLToPath(new URL("../..", import.meta.url)).replace(/\/$/, "");
const MAX_BYTES = 300_000;

/** Runs the program with an output folder of its own and gives the report it leaves there. */
function reportOf(...words: string[]): string {
  const folder = mkdtempSync(join(tmpdir(), "vantage-screenshots-"));
  execFileSync(PROGRAM, [...words, "--out", folder], { stdio: "inherit" });
  return join(folder, "report.html");
}

const scanMug = () =>
  reportOf("reconstruct", "mug", "--positioning-error", "0.05,0.05,0.05", "--convolve", "normalised", "--registration", "icp", "--seed", "3");

type Set = (page: Page) => Promise<unknown>;
const middle = (page: Page) => page.evaluate(() => Math.floor((window.vantage!.session.run.scans.length - 1) / 2));

const goTo = (page: Page, step: number) => page.evaluate((k) => window.vantage!.session.store.set({ step: k }), step);

/** The first screen as it opens, but at a moment when there is still something to plan. */
const first: Set = async (page) => {
  await goTo(page, Math.min(3, await middle(page)));
};

/** In the middle: cut open, the slice through all labels, quality as colour. */
const inside: Set = async (page) => {
  await goTo(page, await middle(page));
  await page.evaluate(() => {
    const { session, scene } = window.vantage!;
    const { store } = session;
    const [, y] = session.run.grid.enclosureSize;
    store.set({ slice: { axis: 1, index: y >> 1 }, coloring: "quality" });
    store.set({ layers: { ...store.state.layers, candidates: false, path: false, frustum: false, normals: true } });
    scene!.viewport.orbit(Math.PI - 0.1, 0.12, 0.45);
  });
};

/** A picked view: the one that comes next. */
const picked: Set = async (page) => {
  await goTo(page, await middle(page));
  await page.evaluate(() => {
    const { session, scene } = window.vantage!;
    const index = session.planAt(session.store.state.step)!.plan.chosen!;
    session.store.set({ selection: { kind: "view", index } });
    session.store.setLayer("seen", true);
    scene!.viewport.orbit(0.5, 0.15);
    // Turned until nothing lies over the view: neither the panel at the left nor the card at the right.
    const { canvas } = scene!.viewport;
    const free = () => {
      const p = scene!.screenOfView(index);
      const box = canvas.getBoundingClientRect();
      return p !== null && document.elementFromPoint(box.left + p.x, box.top + p.y) === canvas;
    };
    for (let turn = 0; turn < 24 && !free(); ++turn) scene!.viewport.orbit(0.26, 0);
  });
};

/** What came out: the fused cloud, with the truth as a ghost. */
const result: Set = async (page) => {
  await page.evaluate(() => {
    const { session, scene } = window.vantage!;
    const { store } = session;
    for (const label of [0, 1, 2, 3, 4]) store.setLabel(label, "hide");
    const layers = { ...store.state.layers, cloud: true, truth: true, frustum: false, candidates: false, path: false };
    store.set({ layers });
    scene!.viewport.orbit(0, 0, 0.4);
  });
};

const reportPath = resolve(process.argv[2] ?? scanMug());
const experimentPath = resolve(process.argv[3] ?? reportOf("experiment", "figure11", "--seeds", "5"));
const shots: [string, string, PageOptions, Set][] = [
  ["viewer.png", reportPath, { scheme: "dark" }, first],
  ["viewer-slice.png", reportPath, { scheme: "light" }, inside],
  ["viewer-view.png", reportPath, { scheme: "light" }, picked],
  ["viewer-result.png", reportPath, { scheme: "dark" }, result],
  ["viewer-phone.png", reportPath, { width: 390, height: 844, touch: true, scheme: "light" }, first],
  ["viewer-experiment.png", experimentPath, { scheme: "light", height: 720 }, async () => {}],
];

const browser = await launch();
for (const [name, path, options, prepare] of shots) {
  const { page, problems } = await openReport(browser, path, { width: 1280, height: 720, ...options });
  await prepare(page);
  await settle(page);
  const file = join(root, "docs", name);
  await page.screenshot({ path: file });
  if (problems.length) throw new Error(`${name}: ${problems.join("; ")}`);
  const { size } = statSync(file);
  console.log(`docs/${name}: ${Math.round(size / 1000)} kB`);
  if (size > MAX_BYTES) throw new Error(`docs/${name} is larger than ${MAX_BYTES / 1000} kB`);
  await page.context().close();
}
await browser.close();
