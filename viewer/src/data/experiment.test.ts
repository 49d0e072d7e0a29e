import { describe, expect, it } from "vitest";
import { experimentFixture } from "../../fixtures/experiment.ts";
import { decodeExperiment } from "./experiment.ts";
import { DataError } from "./packed.ts";

describe("decodeExperiment", () => {
  it("reads figures and tables", () => {
    const experiment = decodeExperiment(experimentFixture());
    expect(experiment.figures[0].series.filter((s) => s.paper)).toHaveLength(1);
    expect(experiment.tables[0].rows.length).toBeGreaterThan(3);
    expect(experiment.tables[0].paper_columns).toEqual([2, 4]);
  });

  const broken: [string, (d: any) => void, RegExp][] = [
    ["title", (d) => (d.title = 7), /^title: must be text/],
    ["length", (d) => d.figures[0].series[0].y.pop(), /^figures\[0\]\.series\[0\]\.y: has/],
    ["x", (d) => (d.figures[0].series[0].x[0] = "a"), /^figures\[0\]\.series\[0\]\.x: must hold numbers only/],
    ["cells", (d) => d.tables[0].rows[1].pop(), /^tables\[0\]\.rows\[1\]: has/],
    ["version", (d) => (d.version = 9), /^version: is 9/],
  ];
  it.each(broken)("says what is wrong: %s", (_name, damage, message) => {
    const document = experimentFixture();
    damage(document);
    expect(() => decodeExperiment(document)).toThrow(DataError);
    expect(() => decodeExperiment(document)).toThrow(message);
  });
});
