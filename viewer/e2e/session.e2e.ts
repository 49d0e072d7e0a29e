/** The page of a session with the real program behind it: a robot sends scans, a person presses the buttons. */
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { launch } from "./browser.ts";
import { openPage, settle, type Watched } from "./pages.ts";
import { Program, PROGRAM } from "./program.ts";

type Json = Record<string, any>;
const folder = mkdtempSync(join(tmpdir(), "vantage-session-"));
const scans = join(folder, "mug", "scans");
const session = join(folder, "session");
const token = "a-token-for-the-test";
let browser: Browser;
let program: Program;
let origin = "";
let watched: Watched;

const frames = () => readdirSync(scans).filter((name) => name.endsWith(".depth.png")).sort(); // prettier-ignore
const bearer = { Authorization: `Bearer ${token}` };

/** What a robot does. */
async function addScan(index: number): Promise<Json> {
  const name = frames()[index].replace(".depth.png", "");
  const form = new FormData();
  form.set("depth", new Blob([readFileSync(join(scans, `${name}.depth.png`))]), `${name}.depth.png`);
  form.set("pose", readFileSync(join(scans, `${name}.pose.txt`), "utf8"));
  form.set("intrinsics", readFileSync(join(scans, "camera-intrinsics.txt"), "utf8"));
  const answer = await fetch(`${origin}/api/session/scans`, { method: "POST", body: form, headers: bearer });
  const body = (await answer.json()) as Json;
  expect(answer.status, JSON.stringify(body)).toBe(201);
  return body;
}

async function get(path: string): Promise<Json> {
  return (await (await fetch(`${origin}/api/session${path}`, { headers: bearer })).json()) as Json;
}

const planned = (page: Page, scans: number) =>
  page.waitForFunction((n) => window.vantage!.session?.run.scans.length === n && window.vantage!.session.run.next, scans);
const chosen = (page: Page) => page.evaluate(() => window.vantage!.session.run.next!.chosen);
const message = (page: Page, text: string) =>
  page.waitForFunction((t) => document.querySelector(".message")!.textContent!.includes(t), text);

beforeAll(async () => {
  const small = ["--voxel", "0.04", "--enclosure", "26,26,26", "--candidates", "sphere:80:2", "--max-views", "4"];
  execFileSync(PROGRAM, ["reconstruct", "mug", "--out", join(folder, "mug"), "--no-report", "--quiet", ...small]);
  execFileSync(PROGRAM, ["session", "new", session, "--box=0,0,0,1.04,1.04,1.04", "--config", join(scans, "scans.yaml"), "--voxel", "0.04"]);
  browser = await launch();
  program = Program.start("serve", session, "--port", "0", "--token", token);
  const url = await program.url();
  origin = new URL(url).origin;
  watched = await openPage(browser, url, { offline: false, width: 1200, height: 800 });
});
afterAll(async () => {
  await browser?.close();
  expect(await program?.interrupt()).toBe(0);
});

describe("the page of a session", () => {
  it("waits for the first scan, and says that it cannot finish before", async () => {
    const { page } = watched;
    await page.waitForSelector('.connection[data-state="live"]');
    await page.waitForSelector(".session-buttons", { state: "visible" });
    expect(await page.isDisabled(".session-buttons .primary")).toBe(true);
    await page.click("text=Finish");
    await message(page, "there is no scan yet");
  });

  it("shows each scan as it comes with the plan made on it", async () => {
    const { page } = watched;
    for (const index of [0, 1]) {
      const added = await addScan(index);
      await planned(page, index + 1);
      await message(page, `scan ${index + 1}: ${added["verdict"]}`);
      expect(await chosen(page)).toBe((await get("/next"))["next"]["index"]);
    }
    expect(await page.evaluate(() => window.vantage!.session.run.candidates.count)).toBe(80);
    await settle(page);
  });

  it("takes the planned view, and the scan that comes belongs to it", async () => {
    const { page } = watched;
    const view = await chosen(page);
    await page.click(`text=Take view ${view}`);
    await message(page, `view ${view} is being taken`);
    expect((await get(""))["taken"]["candidate"]).toBe(view);
    await addScan(2);
    await planned(page, 3);
    expect((await get(""))["taken"]).toBeNull();
  });

  it("skips a view with a reason and shows the next in rank", async () => {
    const { page } = watched;
    const ranking = (await get("/next"))["ranking"] as Json[];
    await page.fill('.session-buttons input[type="text"]', "a cable is in the way");
    await page.click("text=Skip this view");
    await page.waitForFunction((n) => window.vantage!.session.run.next!.chosen === n, ranking[1]["index"]);
    expect((await get(""))["skipped"]).toEqual([{ index: ranking[0]["index"], reason: "a cable is in the way" }]);
    await page.waitForSelector(`text=Take view ${ranking[1]["index"]}`);
    if (process.env["PICTURE"]) await page.screenshot({ path: process.env["PICTURE"] });
  });

  it("finishes, and goes on where another scan comes", async () => {
    const { page, problems, requests } = watched;
    await page.click("text=Finish");
    await page.waitForSelector('.connection[data-state="ended"]', { timeout: 120_000 });
    expect(await page.isVisible(".session-buttons")).toBe(false);
    for (const name of ["map.nrrd", "model.ply", "mesh.ply", "report.html"]) expect(existsSync(join(session, name)), name).toBe(true);
    await page.waitForFunction(() => window.vantage!.session.run.mesh !== null);
    await addScan(3);
    await planned(page, 4);
    await page.waitForSelector(".session-buttons", { state: "visible" });
    expect(problems.filter((text) => !text.includes("409"))).toEqual([]); // the browser notes refused requests
    expect(requests.filter((r) => !r.startsWith(`${origin}/api/`))).toEqual([]);
  });
});
