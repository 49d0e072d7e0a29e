import { loadavg } from "node:os";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { bigRun } from "../fixtures/big_run.ts";
import { experimentFixture } from "../fixtures/experiment.ts";
import { mugRun } from "../fixtures/mug_run.ts";
import { pack } from "../fixtures/pack.ts";
import { launch } from "./browser.ts";
import {
  clickView, FACTORS, median, openReport, reportOf, sceneColors, scenePicture, settle, template, turnScene, writeReport, type Watched,
} from "./pages.ts"; // prettier-ignore

type Json = Record<string, any>;
let browser: Browser;
let run: Json;
let report: string;

beforeAll(async () => {
  browser = await launch();
  run = JSON.parse(JSON.stringify(mugRun({ scans: 5, rays: 110 }))) as Json;
  report = reportOf("report.html", run);
});
afterAll(() => browser?.close());

const step = (page: Page) => page.evaluate(() => window.vantage!.session.store.state.step);
const setState = (page: Page, state: Json) => page.evaluate((s) => window.vantage!.session.store.set(s), state);

async function expectQuiet({ page, requests, problems }: Watched): Promise<void> {
  expect(problems).toEqual([]);
  expect(requests).toEqual([]);
  await page.context().close();
}

describe("a report from disk, without a network", () => {
  it("shows the mug, and shows and hides labels", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    await setState(page, { layers: { candidates: false, path: false, frustum: false } });
    await settle(page);
    const mug = await sceneColors(page);
    expect(mug.blue).toBeGreaterThan(0.01);
    await page.click('[data-label="occupied"] button[title="hide"]');
    await page.click('[data-label="occplane"] button[title="hide"]');
    await settle(page);
    const hidden = await sceneColors(page);
    expect(hidden.blue).toBeLessThan(0.002);
    expect(hidden.drawn).toBeLessThan(mug.drawn / 2);
    await page.click('[data-label="occluded"] button[title="show"]');
    await settle(page);
    expect((await sceneColors(page)).drawn).toBeGreaterThan(2 * hidden.drawn);
    await page.click('[data-label="occupied"] button[title="fade"]');
    await settle(page);
    await page.keyboard.press("2");
    expect(await page.getAttribute('[data-label="occupied"] button[title="show"]', "aria-pressed")).toBe("true");
    await expectQuiet(watched);
  });

  it("colours, cuts, and shows every layer", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    await setState(page, { layers: { candidates: false, path: false, frustum: false } });
    await settle(page);
    const pictures = new Set<string>();
    const look = async () => {
      await settle(page);
      pictures.add((await scenePicture(page)).toString("base64"));
    };
    await look();
    for (const coloring of ["quality", "normal", "scan"]) {
      await page.click(`.layers button[data-value="${coloring}"]`);
      await look();
    }
    for (const axis of ["x", "y", "z"]) {
      await page.click(`.layers button[data-value="${axis}"]`);
      await look();
    }
    for (const layer of ["normals", "cloud", "truth", "seen", "candidates", "path", "frustum", "mesh"]) {
      await page.check(`[data-layer="${layer}"]`);
      await look();
    }
    expect(pictures.size).toBe(1 + 3 + 3 + 8);
    await expectQuiet(watched);
  });

  it("plays through the scans, everything following", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    const blues: number[] = [];
    for (let k = 0; k < run["scans"].length; ++k) {
      await page.locator("input.time").fill(String(k));
      await settle(page);
      expect(await step(page)).toBe(k);
      blues.push((await sceneColors(page)).blue);
      expect(await page.textContent(".time-text")).toContain(`scan ${k + 1} of ${run["scans"].length}`);
      expect(await page.locator('#table tr[aria-current="true"]').count()).toBe(1);
      expect(await page.getAttribute(`#table tbody tr:nth-child(${k + 1})`, "aria-current")).toBe("true");
      const coverage = Number((100 * run["scans"][k].coverage).toFixed(1));
      expect(await page.textContent("#curves .chart:first-child .legend")).toContain(String(coverage));
    }
    expect(blues.at(-1)!).toBeGreaterThan(1.5 * blues[0]);
    const last = run["scans"].length - 1;
    const played = page.evaluate(() => new Promise<number[]>((done) => {
      const { store } = window.vantage!.session;
      const seen: number[] = [];
      store.subscribe((state, changed) => {
        if (changed.has("step")) seen.push(state.step);
        if (changed.has("playing") && !state.playing) done(seen);
      });
    })); // prettier-ignore
    await page.click("button.play");
    expect(await played).toEqual(Array.from({ length: last + 1 }, (_, i) => i));
    await expectQuiet(watched);
  });

  it("gives the factors of a view that is clicked, the same as in the data", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    let clicked = 0;
    for (let k = 1; k < run["scans"].length; ++k) {
      const record = run["scans"][k];
      await setState(page, { step: k - 1, selection: null, layers: { candidates: true } });
      await settle(page);
      const shown = await clickView(page, record.candidate);
      if (!shown) continue;
      ++clicked;
      expect(await page.textContent(".details-card")).toContain("Chosen after scan");
      for (const [name, key] of FACTORS) {
        expect(Math.abs(shown[name] - record[key])).toBeLessThanOrEqual(1e-6 * Math.abs(record[key]));
      }
    }
    expect(clicked).toBe(run["scans"].length - 1);
    const cells = await page.$$eval("#table tbody tr:nth-child(3) td", (tds) =>
      Object.fromEntries(tds.map((td) => [td.getAttribute("data-key"), td.getAttribute("data-exact")])),
    );
    for (const key of ["utility", "f_area", "n_op", "distance", "coverage"]) expect(Number(cells[key])).toBe(run["scans"][2][key]);
    await expectQuiet(watched);
  });

  it("tells why a view is infeasible and what a voxel is", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    const infeasible = await page.evaluate(() => window.vantage!.session.planAt(2)!.plan.infeasible.findIndex((r) => r > 0));
    await setState(page, { step: 2, selection: { kind: "view", index: infeasible } });
    expect(await page.textContent(".details-card")).toContain("Infeasible: below the table");
    await setState(page, { layers: { candidates: false, path: false, frustum: false }, selection: null });
    await settle(page);
    const center = await page.evaluate(() => {
      const { scene, session } = window.vantage!;
      const { labels } = session.map(2);
      const box = scene!.viewport.canvas.getBoundingClientRect();
      for (let y = 0; y < box.height; y += 7) {
        for (let x = 260; x < box.width; x += 7) {
          const found = scene!.pick(x, y);
          if (found?.kind === "voxel" && labels[found.index] === 1) return { x: box.left + x, y: box.top + y };
        }
      }
      return null;
    });
    await page.mouse.click(center!.x, center!.y);
    const text = await page.textContent(".details-card");
    for (const word of ["Voxel", "occupied", "index in the scene", "normal", "quality", "first occupied"]) expect(text).toContain(word);
    await page.keyboard.press("Escape");
    expect(await page.isVisible(".details-card")).toBe(false);
    await expectQuiet(watched);
  });

  it("works from the keyboard alone, and every control has a name", async () => {
    const watched = await openReport(browser, report);
    const { page } = watched;
    await page.keyboard.press("Home");
    expect(await step(page)).toBe(0);
    await page.keyboard.press("ArrowRight");
    expect(await step(page)).toBe(1);
    await page.keyboard.press("?");
    expect(await page.isVisible("dialog")).toBe(true);
    await page.keyboard.press("Escape");
    await page.locator(".map canvas").first().focus();
    await page.keyboard.press("ArrowRight");
    const best = await page.evaluate(() => { const s = window.vantage!.session; return s.ranking(s.planAt(1)!.plan)[0]; }); // prettier-ignore
    expect(await page.textContent(".details-card h3")).toBe(`View ${best}`);
    const reached = new Set<string>();
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => { const e = document.activeElement!; return e.className || e.getAttribute("data-layer") || e.tagName; })); // prettier-ignore
    }
    for (const name of ["play", "time", "truth", "scroll", "CANVAS"]) expect([...reached].join(" ")).toContain(name);
    const nameless = await page.$$eval("button, input, select, canvas, svg[role=img]", (elements) =>
      elements.filter((e) => !(e.getAttribute("aria-label") || e.textContent?.trim() || e.closest("label")?.textContent?.trim())).map((e) => e.outerHTML),
    );
    expect(nameless).toEqual([]);
    await expectQuiet(watched);
  });

  it.each([
    ["phone", 390, 844],
    ["small phone", 320, 640],
    ["notebook", 1280, 720],
  ])("fits a %s", async (_name, width, height) => {
    const watched = await openReport(browser, report, { width, height, touch: width < 500 });
    const { page } = watched;
    const wide = await page.evaluate(() => document.scrollingElement!.scrollWidth);
    expect(wide).toBeLessThanOrEqual(width);
    expect((await sceneColors(page)).blue).toBeGreaterThan(0.004);
    await page.locator("#table").scrollIntoViewIfNeeded();
    expect(await page.locator("#table tbody tr").count()).toBe(run["scans"].length);
    await expectQuiet(watched);
  });

  it("shows convolved utilities beside plain ones, and a slice of a cube of candidates", async () => {
    const cube = structuredClone(run);
    const cells = Array.from({ length: 80 }, (_, i) => [i % 5, Math.floor(i / 5) % 4, Math.floor(i / 20)]).flat();
    Object.assign(cube["candidates"], { kind: "grid", cells_per_side: 5, spacing: [0.8, 0.8, 0.8], cells: pack(Uint16Array.from(cells), 3) });
    for (const [name, document, maps] of [["sphere.html", run, 2], ["cube.html", cube, 2]] as const) {
      const watched = await openReport(browser, reportOf(name, document));
      expect(await watched.page.locator(".map:visible").count()).toBe(maps);
      expect(await watched.page.locator("#utilities input[type=range]").isVisible()).toBe(name === "cube.html");
      await expectQuiet(watched);
    }
  });

  it("shows an experiment with the paper's values", async () => {
    const watched = await openReport(browser, reportOf("experiment.html", experimentFixture()));
    const { page } = watched;
    expect(await page.locator(".chart").count()).toBe(2);
    expect(await page.textContent(".chart .legend")).toContain("(paper)");
    expect(await page.locator("td.bad").count()).toBe(1);
    await expectQuiet(watched);
  });
});

describe("what cannot be shown", () => {
  const fill = (text: string) => template().replace('id="vantage-data"></script>', () => `id="vantage-data">${text}</script>`);
  const cases: [string, () => string, string][] = [
    ["cut off", () => fill(JSON.stringify(run).slice(0, 5000)), "they are not JSON"],
    ["empty", () => template(), "This file is the empty page"],
    ["of another kind", () => fill('{"format": "holiday"}'), 'format: is "holiday"'],
    ["from a newer program", () => fill(JSON.stringify({ ...run, version: 7 })), "use a newer page"],
    ["with a broken array", () => fill(JSON.stringify({ ...run, scans: [{ ...run["scans"][0], labels: { type: "u8", shape: [5], data: "xx" } }] })), "scans[0].labels"],
  ]; // prettier-ignore
  it.each(cases)("is reported in words: data %s", async (name, html, message) => {
    const watched = await openReport(browser, writeReport(`${name.replaceAll(" ", "-")}.html`, html()));
    expect(await watched.page.textContent("[role=alert]")).toContain(message);
    await expectQuiet(watched);
  });

  it("keeps curves and table where there is no WebGL", async () => {
    const plain = await launch(["--disable-3d-apis"]);
    const { page, requests } = await openReport(plain, report);
    expect(await page.textContent(".no-scene")).toContain("WebGL");
    expect(await page.locator("#table tbody tr").count()).toBe(run["scans"].length);
    expect(await page.locator(".chart").count()).toBeGreaterThan(4);
    expect(requests).toEqual([]);
    await plain.close();
  });

  it("leaves the pictures where there is no JavaScript", async () => {
    const html = template().replace("<!--vantage-static-->", '<p id="picture">a picture</p>');
    const watched = await openReport(browser, writeReport("static.html", html), { javaScript: false });
    expect(await watched.page.textContent("#picture")).toBe("a picture");
    expect(await watched.page.isVisible("#app")).toBe(false);
    await expectQuiet(watched);
  });
});

it("turns a large scene smoothly without a graphics card", async () => {
  const big = bigRun();
  const watched = await openReport(browser, reportOf("big.html", big), { width: 1280, height: 720 });
  const { page } = watched;
  await settle(page);
  const times = await turnScene(page, { frames: 30 });
  const { occupied } = big.scans[0];
  console.log(`${occupied} occupied voxels, 2000 views: ${(1000 / median(times)).toFixed(0)} frames/s, load ${loadavg()[0]}`);
  expect(occupied).toBeGreaterThan(100_000);
  // How fast it is depends on what else the machine does; `npm run fps` measures it.
  await settle(page);
  // At rest everything is drawn in full again.
  expect((await sceneColors(page)).drawn).toBeGreaterThan(0.1);
  await expectQuiet(watched);
});
