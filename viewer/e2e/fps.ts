/**
 * How fast the page is without a graphics card, in Debian's Chromium with software rendering:
 *
 *     npm run fps [-- REPORT]
 *
 * Frames per second while a scene of 100,000 occupied voxels and 2,000 views turns, for the first steps of detail, and with REPORT (the report.html of a
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
const STEPS = ["every face drawn", "a point per voxel", "a point per 8 voxels"];
console.log(`turning ${big.scans[0].occupied} occupied voxels and 2000 views:`);
for (const [step, name] of STEPS.entries()) {
  await page.evaluate((s) => window.vantage!.scene!.viewport.chooser.hold(s), step);
  await turnScene(page, { seconds: 1 });
  const rounds: number[] = [];
  for (let i = 0; i < ROUNDS; ++i) {
    const times = await turnScene(page, { seconds: 2 });
    rounds.push((1000 * times.length) / times.reduce((sum, t) => sum + t, 0));
  }
  const [low, high] = [Math.min(...rounds), Math.max(...rounds)].map((r) => r.toFixed(1));
  console.log(`  ${name}: ${median(rounds).toFixed(1)} frames/s (${low} to ${high} in ${ROUNDS} rounds)`);
}
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
