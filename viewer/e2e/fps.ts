/**
 * How fast the page is without a graphics card, in Debian's Chromium with software rendering:
 *
 *     npm run fps [-- REPORT]
 *
 * Frames per second while a scene of 100,000 occupied voxels and 2,000 views turns, and with REPORT (the report.html of a
 * reconstruction) the time until it can be used. Medians of five rounds; run it where nothing else runs.
 */
import { statSync } from "node:fs";
import { loadavg } from "node:os";
import { resolve } from "node:path";
import { bigRun } from "../fixtures/big_run.ts";
import { launch } from "./browser.ts";
import { median, openReport, reportOf, settle, timeOpening, turnScene } from "./pages.ts";

const ROUNDS = 5;
const browser = await launch();
const big = bigRun();
const { page } = await openReport(browser, reportOf("big.html", big), { width: 1280, height: 720 });
await settle(page);
await turnScene(page, { seconds: 1 }); // finds out how fast it is
const rounds: number[] = [];
for (let i = 0; i < ROUNDS; ++i) {
  const times = await turnScene(page, { seconds: 3 });
  rounds.push((1000 * times.length) / times.reduce((sum, t) => sum + t, 0));
}
const [low, high] = [Math.min(...rounds), Math.max(...rounds)].map((r) => r.toFixed(1));
const voxels = big.scans[0].occupied;
console.log(`turning ${voxels} occupied voxels and 2000 views: ${median(rounds).toFixed(1)} frames/s (${low} to ${high} in ${ROUNDS} rounds)`);
const block = await page.evaluate(() => { const { viewport } = window.vantage!.scene!; viewport.orbit(0.01, 0); return viewport.block; }); // prettier-ignore
console.log(block ? `while it turns a point stands for ${block}³ voxels` : "while it turns every face is drawn");
await page.context().close();

if (process.argv[2]) {
  const report = resolve(process.argv[2]);
  const openings = await timeOpening(browser, report, ROUNDS);
  const clocks = openings.map((o) => o.clock);
  console.log(
    `report of ${(statSync(report).size / 1e6).toFixed(2)} MB: usable after ${median(clocks).toFixed(0)} ms ` +
      `(${clocks[0].toFixed(0)} to ${clocks.at(-1)!.toFixed(0)} in ${ROUNDS} rounds)`,
  );
}
console.log(`load ${loadavg()[0]}`);
await browser.close();
