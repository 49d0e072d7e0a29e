import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from "vitest";
import { mugRun } from "../fixtures/mug_run.ts";
import { launch } from "./browser.ts";
import { MockServer } from "./mock_server.ts";
import { openPage, template, type Watched } from "./pages.ts";

let browser: Browser;
let server: MockServer;
const run = JSON.parse(JSON.stringify(mugRun({ scans: 4, rays: 60, meshes: false }))) as Record<string, any>;

beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());
beforeEach(async () => {
  server = new MockServer(template(), run);
  await server.start();
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  await server.stop();
});

const open = (): Promise<Watched> => openPage(browser, server.url, { offline: false, width: 800, height: 560 });
const scans = (page: Page, count: number) =>
  page.waitForFunction((n) => window.vantage?.session?.run.scans.length === n, count);
const own = (requests: string[]) => requests.every((r) => r.startsWith(`${server.url}api/`));

describe("the live page", () => {
  it("shows scans as they come, in several browsers at once", async () => {
    server.scan();
    const [a, b] = [await open(), await open()];
    await Promise.all([scans(a.page, 1), scans(b.page, 1)]);
    expect(server.browsers).toBe(2);
    server.scan();
    await Promise.all([scans(a.page, 2), scans(b.page, 2)]);
    for (const { page } of [a, b]) {
      expect(await page.textContent(".time-text")).toContain("scan 2 of 2");
      expect(await page.textContent(".connection")).toBe("live");
      expect(await page.locator("#table tbody tr").count()).toBe(2);
    }
    server.scan();
    server.scan();
    server.finish();
    await scans(a.page, 4);
    await a.page.waitForFunction(() => window.vantage!.session.run.cloud !== null);
    expect(await a.page.textContent(".connection")).toBe("finished");
    expect(await a.page.textContent("#table .stop")).toContain(run["stop_reason"]);
    expect(own([...a.requests, ...b.requests])).toBe(true);
    expect([...a.problems, ...b.problems]).toEqual([]);
  });

  it("starts before the first scan", async () => {
    const { page, problems } = await open();
    expect(await page.textContent(".time-text")).toBe("no scan yet");
    server.scan();
    await scans(page, 1);
    expect(await page.textContent("h1")).toContain("mug");
    expect(problems).toEqual([]);
  });

  it("finds back after the server was restarted, with what it missed", async () => {
    server.scan();
    const { page } = await open();
    await scans(page, 1);
    await server.stop();
    await page.waitForSelector('.connection[data-state="lost"]');
    server.scan();
    server.scan();
    await server.start();
    await page.waitForSelector('.connection[data-state="live"]');
    await scans(page, 3);
    expect(await page.textContent(".time-text")).toContain("scan 3 of 3");
    server.scan();
    await scans(page, 4);
  });

  it("finds back after it was offline", async () => {
    server.scan();
    const { page } = await open();
    await scans(page, 1);
    await page.context().setOffline(true);
    // The browser keeps open connections when it goes offline; a sleeping computer does not.
    await page.evaluate(() => window.vantage!.live!.wake());
    await page.waitForSelector('.connection[data-state="lost"]');
    server.scan();
    await page.context().setOffline(false);
    await page.waitForSelector('.connection[data-state="live"]');
    await scans(page, 2);
  });

  it.each([
    ["<html>", "/api/run: is not JSON"],
    ['{"format": "vantage-run", "version": 1}', "grid: must be an object"],
  ])("says what is wrong with what the server sends, and shows the run when it is right again: %s", async (broken, problem) => {
    server.scan();
    server.broken = broken;
    const page = await (await browser.newContext()).newPage();
    page.setDefaultTimeout(180_000);
    await page.goto(server.url);
    await page.waitForFunction((text) => document.body.textContent!.includes(text), `No run to show yet: ${problem}`);
    server.broken = null;
    await scans(page, 1);
    expect(await page.textContent(".connection")).toBe("live");
    // Later on what was shown stays, with the reason beside it.
    server.broken = broken;
    await page.evaluate(() => window.vantage!.live!.wake());
    await server.stop();
    await server.start();
    server.scan();
    await page.waitForFunction((text) => document.querySelector(".connection")!.textContent!.includes(text), problem);
    expect(await page.locator("#table tbody tr").count()).toBe(1);
    server.broken = null;
    await scans(page, 2);
  });

  it("has the buttons of a session", async () => {
    server.scan();
    const { page } = await open();
    await scans(page, 1);
    expect(await page.isVisible(".session-buttons")).toBe(false);
    server.wait("move the scanner");
    await page.waitForSelector(".session-buttons", { state: "visible" });
    expect(await page.textContent(".message")).toBe("move the scanner");
    const chosen = run["scans"][1].candidate as number;
    await page.click(`text=Take view ${chosen}`);
    await page.fill('.session-buttons input[type="text"]', "the table is in the way");
    await page.click("text=Skip this view");
    server.refusal = "the scanner is busy";
    await page.waitForFunction(() => !document.querySelector<HTMLButtonElement>(".session-buttons .primary")!.disabled);
    await page.click("text=Finish");
    await page.waitForFunction(() => document.querySelector(".message")!.textContent === "the scanner is busy");
    expect(server.posts).toEqual([
      { action: "next", body: {} },
      { action: "skip", body: { candidate: chosen, reason: "the table is in the way" } },
      { action: "finish", body: {} },
    ]);
  });
});
