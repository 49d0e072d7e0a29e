/** The page with the real program behind it: reconstruct --serve, serve, and the report that a run leaves behind. */
import { spawn } from "node:child_process";
import { appendFileSync, mkdirSync, mkdtempSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { cpus, loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, describe, expect, it } from "vitest";
import { launch } from "./browser.ts";
import { clickView, FACTORS, median, openPage, openReport, sceneColors, settle, timeOpening, type Watched } from "./pages.ts";
import { Program } from "./program.ts";

type Json = Record<string, any>;
let browser: Browser;
const folder = mkdtempSync(join(tmpdir(), "vantage-program-"));
const mug = join(folder, "mug");
const running: Program[] = [];

function start(...words: string[]): Program {
  const program = Program.start(...words);
  running.push(program);
  return program;
}

const summary = (): Json => JSON.parse(readFileSync(join(mug, "summary.json"), "utf8")) as Json;
const open = (url: string) => openPage(browser, url, { offline: false, width: 900, height: 600 });
const scans = (page: Page, count: number) => page.waitForFunction((n) => window.vantage!.session?.run.scans.length === n, count);
const connection = (page: Page, state: string) => page.waitForSelector(`.connection[data-state="${state}"]`);
const ownOnly = ({ requests }: Watched, url: string) =>
  expect(requests.filter((r) => !r.startsWith(`${new URL(url).origin}/api/`))).toEqual([]);

/** Clicks the views that were chosen and compares what the page says of them with summary.json. */
async function compareFactors(page: Page): Promise<void> {
  const records = summary()["scans"] as Json[];
  let compared = 0;
  for (const k of [1, records.length - 1]) {
    await page.evaluate((step) => window.vantage!.session.store.set({ step, selection: null }), k - 1);
    await settle(page);
    const shown = await clickView(page, records[k]["candidate"]);
    if (!shown) continue; // hidden from every side
    ++compared;
    for (const [name, key] of FACTORS) {
      expect(Math.abs(shown[name] - records[k][key]), `scan ${k + 1}, ${key}`).toBeLessThanOrEqual(1e-6 * Math.abs(records[k][key]));
    }
  }
  expect(compared).toBeGreaterThan(0);
}

beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  for (const program of running.splice(0)) await program.interrupt();
});

describe("vantage reconstruct --serve", () => {
  it("shows the run in two browsers until it has ended, and stays", async () => {
    const program = start("reconstruct", "mug", "--serve=0", "--out", mug);
    const url = await program.url();
    const watched = await Promise.all([open(url), open(url)]);
    for (const { page } of watched) {
      await page.waitForFunction(() => window.vantage!.session?.run.meta.state === "finished" && window.vantage!.session.run.mesh !== null);
      await connection(page, "ended");
      const { scans: records, coverage, stop_reason } = summary();
      const shown = await page.evaluate(() => {
        const { run } = window.vantage!.session;
        return { scans: run.scans.length, coverage: run.summary!.coverage, stop_reason: run.stop_reason, points: run.cloud!.points.length };
      });
      expect(shown).toMatchObject({ scans: records.length, coverage, stop_reason });
      expect(shown.points).toBeGreaterThan(10_000);
    }
    const { page } = watched[0];
    await settle(page);
    expect((await sceneColors(page)).blue).toBeGreaterThan(0.004);
    await compareFactors(page);
    for (const w of watched) {
      expect(w.problems).toEqual([]);
      ownOnly(w, url);
    }
    expect(await program.interrupt()).toBe(0);
    await connection(page, "lost");
  });
});

describe("the report of that run", () => {
  it("is below 5 MB and can be used within 2 s of opening", async () => {
    const report = join(mug, "report.html");
    const { size } = statSync(report);
    expect(size).toBeLessThan(5e6);
    const openings = await timeOpening(browser, report);
    const processor = Math.min(...openings.map((o) => o.processor));
    const clock = median(openings.map((o) => o.clock));
    console.log(`report of ${(size / 1e6).toFixed(2)} MB: usable after ${clock.toFixed(0)} ms, ${processor.toFixed(0)} ms of processor time, load ${loadavg()[0]}`);
    expect(processor).toBeLessThan(2000);
    // Where other work has the processors, the clock says nothing about the page.
    if (loadavg()[0] < cpus().length) expect(clock).toBeLessThan(2000);
  });

  it("opens from disk without a network and says what summary.json says", async () => {
    const report = join(mug, "report.html");
    const watched = await openReport(browser, report, { width: 900, height: 600 });
    const { page } = watched;
    await settle(page);
    const shown = await sceneColors(page);
    expect(shown.blue).toBeGreaterThan(0.004);
    await compareFactors(page);
    await page.evaluate(() => window.vantage!.session.store.set({ layers: { ...window.vantage!.session.store.state.layers, candidates: false, path: false, frustum: false } }));
    await page.click('[data-label="occupied"] button[title="hide"]');
    await settle(page);
    expect((await sceneColors(page)).blue).toBeLessThan(shown.blue / 4);
    expect(watched.problems).toEqual([]);
    expect(watched.requests).toEqual([]);
  });
});

describe("vantage serve", () => {
  it("shows a finished run, and the page finds back after the server was restarted", async () => {
    const first = start("serve", mug, "--port", "0");
    const url = await first.url();
    const watched = await open(url);
    const { page } = watched;
    await connection(page, "ended");
    await scans(page, summary()["scans"].length);
    ownOnly(watched, url);
    expect(watched.problems).toEqual([]);
    expect(await first.interrupt()).toBe(0);
    await connection(page, "lost");
    await start("serve", mug, "--port", new URL(url).port).url();
    await connection(page, "ended");
    await scans(page, summary()["scans"].length);
  });

  it("shows how far an experiment is, then its report", async () => {
    const compare = join(folder, "compare");
    for (const name of ["runs", "times"]) mkdirSync(join(compare, name), { recursive: true });
    const url = await start("serve", compare, "--port", "0").url();
    const watched = await open(url);
    const { page } = watched;
    await page.waitForFunction(() => document.querySelector("main")?.textContent?.includes("0 runs are finished"));
    const words = ["experiment", "compare", "--utilities", "combined,gain", "--shapes", "sphere", "--starts", "2", "--quiet", "--out", compare];
    expect(await Program.start(...words).ended).toBe(0);
    await page.waitForFunction(() => document.querySelector("h1")?.textContent === "compare");
    expect(await page.locator(".chart").count()).toBeGreaterThan(0);
    const { tables } = JSON.parse(readFileSync(join(compare, "report.json"), "utf8")) as Json;
    const shown = await page.locator("table").first().locator("tbody tr").nth(1).locator("td").first().textContent();
    const { mean, sd } = tables[0].estimates[1][0];
    const { decimals } = tables[0].measures[0];
    expect(shown).toBe(`${mean.toFixed(decimals)} ± ${sd.toFixed(decimals)}`);
    ownOnly(watched, url);
    expect(watched.problems).toEqual([]);
  });

  it("lets in only who knows the token", async () => {
    const url = await start("serve", mug, "--port", "0", "--token", "a-token-for-the-test").url();
    const { origin } = new URL(url);
    expect((await fetch(`${origin}/`)).status).toBe(401);
    expect((await fetch(`${origin}/api/run`)).status).toBe(401);
    const { page, problems } = await open(url);
    await scans(page, summary()["scans"].length);
    expect(problems).toEqual([]);
  });

  it("follows a run that another program writes, also over a restart", async () => {
    const html = readFileSync(join(mug, "report.html"), "utf8");
    const document = JSON.parse(/id="vantage-data">(.*?)<\/script>/s.exec(html)![1]) as Json;
    const records = document["scans"] as Json[];
    const growing = join(folder, "growing");
    mkdirSync(join(growing, "scans"), { recursive: true });
    const log = join(growing, "live.jsonl");
    writeFileSync(log, "");
    const writer = spawn("flock", [log, "cat"], { stdio: ["pipe", "ignore", "inherit"] }); // as the program that writes it
    const tell = (event: string, data: Json) => appendFileSync(log, `${JSON.stringify({ event, data })}\n`);
    const program = start("serve", growing, "--port", "0");
    const url = await program.url();
    tell("run", { ...document, meta: { ...document["meta"], state: "running" }, scans: [], next: null, stop_reason: "", summary: null, cloud: null, mesh: null });
    tell("scan", records[0]);
    const watched = await open(url);
    const { page } = watched;
    await scans(page, 1);
    await connection(page, "live");
    tell("plan", records[1]["plan"]);
    await page.waitForFunction(() => window.vantage!.session.run.next !== null);
    tell("scan", records[1]);
    await scans(page, 2);
    expect(await page.textContent(".time-text")).toContain("scan 2 of 2");
    ownOnly(watched, url);
    expect(watched.problems).toEqual([]);
    await program.interrupt();
    await connection(page, "lost");
    tell("scan", records[2]);
    await start("serve", growing, "--port", new URL(url).port).url();
    await connection(page, "live");
    await scans(page, 3);
    writer.stdin.end(); // killed in the middle
    await page.waitForFunction(() => window.vantage!.session.run.stop_reason === "the run was broken off");
    await connection(page, "ended");
  });
});
