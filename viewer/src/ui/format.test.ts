import { describe, expect, it } from "vitest";
import { percent, significant, ticks, tickText, whole } from "./format.ts";

describe("numbers for people", () => {
  it("shows significant digits and missing values", () => {
    expect(significant(0.123456)).toBe("0.1235");
    expect(significant(1234.56)).toBe("1235");
    expect(significant(3.2e-9, 3)).toBe("3.20e-9");
    expect([significant(null), significant(NaN), significant(0)]).toEqual(["–", "–", "0"]);
    expect(percent(0.98765)).toBe("98.8 %");
    expect(whole(1234567)).toBe("1\u2009234\u2009567");
  });

  it("puts round ticks on an axis", () => {
    expect(ticks(0, 1, 4)).toEqual([0, 0.5, 1]);
    expect(ticks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
    expect(ticks(3, 27, 4)).toEqual([10, 20]);
    expect(ticks(5, 5)).toEqual([5]);
    expect([tickText(0.2), tickText(12000), tickText(2.5e6)]).toEqual(["0.2", "12k", "2.5M"]);
  });
});
