import { describe, expect, it } from "vitest";
import { decodeExperiment } from "../data/experiment.ts";
import { readable } from "./estimates.ts";

const estimate = (mean: number, more: object = {}) => ({ mean, sd: 0.25, runs: 4, low: mean - 1, high: mean + 1, paper: null, in_band: null, ...more });

function tableOf(more: object = {}) {
  const table = {
    title: "views", columns: ["utility", "views", "± sd", "paper", "more", "± sd", "paper", "why"], paper_columns: [3, 6],
    rows: [["combined", 7.25, 0.25, 7, null, null, null, "first"], ["gain", 6, 0.25, null, -1.25, 0.25, null, null]],
    measures: [{ title: "views", decimals: 1, difference: false }, { title: "more", decimals: 2, difference: true }, { title: "why", decimals: 2, difference: false }],
    estimates: [[estimate(7.25, { paper: 7, in_band: true }), null, null], [estimate(6, { runs: 1, in_band: false }), estimate(-1.25), null]],
    ...more,
  }; // prettier-ignore
  return { format: "vantage-experiment", version: 1, title: "t", tables: [table] };
}

describe("a table of estimates", () => {
  it("has mean and spread in one cell, the paper's number beside, and whether it is in its band", () => {
    const { columns, rows } = readable(decodeExperiment(tableOf()).tables[0])!;
    expect(columns.map((c) => c.title)).toEqual(["utility", "views", "paper", "more", "why"]);
    expect(rows.map((row) => row.map((c) => c.text))).toEqual([
      ["combined", "7.3 ± 0.3 ✓", "7.0", "–", "first"],
      ["gain", "6.0 ✗", "", "−1.25 [−2.25, −0.25]", "–"],
    ]);
    expect(rows[0].map((c) => c.kind)).toEqual(["text", "good", "paper", "number", "text"]);
    expect(rows[1][1].kind).toBe("bad");
  });

  it.each([
    [{ estimates: [] }, /^tables\[0\]\.estimates: has 0 rows, must have 2/],
    [{ estimates: [[null], [null]] }, /^tables\[0\]\.estimates\[0\]: has 1 cells for 3 measures/],
    [{ measures: [{ title: "a", decimals: 99 }] }, /^tables\[0\]\.measures\[0\]\.decimals: must be 0 to 12/],
  ])("is refused where its parts do not fit (%#)", (more, message) => {
    expect(() => decodeExperiment(tableOf(more))).toThrow(message);
  });
});
