import { describe, expect, it } from "vitest";
import { DetailChooser, SLOW_MS } from "./detail.ts";

const frames = (chooser: DetailChooser, count: number, ms: number) => Array.from({ length: count }, () => chooser.frame(ms));

describe("DetailChooser", () => {
  it("draws in full as long as that is fast, and takes no single slow frame for slowness", () => {
    const chooser = new DetailChooser();
    for (let i = 0; i < 50; ++i) chooser.frame(i % 3 === 0 ? 200 : 5);
    expect(chooser.detail).toEqual({ block: 0, pixels: 1 });
  });

  it("goes down step by step while frames are slow, and no further than the last step", () => {
    const chooser = new DetailChooser();
    const seen = [chooser.detail];
    for (let i = 0; i < 100; ++i) if (chooser.frame(SLOW_MS + 1)) seen.push(chooser.detail);
    expect(seen.map((d) => d.block)).toEqual([0, 1, 2, 2, 3]);
    expect(seen.map((d) => d.pixels)).toEqual([1, 1, 1, 0.7, 0.5]);
    expect(frames(chooser, 20, 500)).not.toContain(true);
  });

  it("goes up again after a movement with time to spare, but not after one that was just fast enough", () => {
    const chooser = new DetailChooser();
    frames(chooser, 3, 100);
    expect(chooser.detail.block).toBe(1);
    frames(chooser, 20, 20);
    chooser.rest();
    expect(chooser.detail.block).toBe(1);
    frames(chooser, 4, 2); // too few to tell
    chooser.rest();
    expect(chooser.detail.block).toBe(1);
    frames(chooser, 20, 2);
    chooser.rest();
    expect(chooser.detail.block).toBe(0);
  });

  it("stays where it is held", () => {
    const chooser = new DetailChooser();
    chooser.hold(2);
    frames(chooser, 50, 500);
    chooser.rest();
    expect(chooser.detail).toEqual({ block: 2, pixels: 1 });
  });
});
