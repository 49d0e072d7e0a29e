import { deflateSync } from "node:zlib";
import { describe, expect, it } from "vitest";
import { pack } from "../../fixtures/pack.ts";
import { DataError, unpack } from "./packed.ts";

const stored = (type: string, shape: number[], bytes: number[], delta = false) => ({
  type,
  shape,
  delta,
  data: deflateSync(Uint8Array.from(bytes)).toString("base64"),
});

describe("unpack", () => {
  it("reads plain little-endian numbers", () => {
    const values = unpack(stored("u16", [2, 2], [1, 0, 0x34, 0x12, 0xff, 0xff, 0, 0]), "u16", "f", 2);
    expect([...values]).toEqual([1, 0x1234, 0xffff, 0]);
  });

  it("reads differences from byte planes, the example of the C++ test", () => {
    const bytes = [10, 2, 249, 0, 0, 255, 44, 255, 0, 1, 255, 0];
    expect([...unpack(stored("u16", [3, 2], bytes, true), "u16", "f", 2)]).toEqual([10, 300, 12, 299, 5, 299]);
  });

  it("gives back what was packed, for every type", () => {
    const arrays = [
      Uint8Array.of(0, 255, 7, 3), Int8Array.of(-128, 127, 0, -1), Uint16Array.of(65535, 0, 1, 40000),
      Int16Array.of(-32768, 32767, 0, -5), Uint32Array.of(4294967295, 0, 70000, 1), Int32Array.of(-2147483648, 2147483647, 0, -9),
    ] as const; // prettier-ignore
    const types = ["u8", "i8", "u16", "i16", "u32", "i32"] as const;
    arrays.forEach((array, i) => {
      for (const delta of [false, true]) expect(unpack(pack(array, 2, delta), types[i], "f", 2)).toEqual(array);
    });
    const floats = Float32Array.of(0.25, NaN, -1e30, Infinity);
    expect(unpack(pack(floats), "f32", "f")).toEqual(floats);
  });

  const bad: [string, unknown, RegExp][] = [
    ["no object", 7, /labels: must be an object/],
    ["another type", stored("i8", [1], [1]), /labels: type is "i8", must be "u8"/],
    ["negative shape", stored("u8", [-1], []), /labels: shape/],
    ["too few bytes", stored("u8", [3], [1, 2]), /labels: holds 2 bytes, its shape needs 3/],
    ["other rows than wanted", stored("u8", [2], [1, 2]), /labels: has 2 rows, must have 3/],
    ["no base64", { type: "u8", shape: [3], data: "%%%" }, /labels: is not base64/],
    ["no zlib", { type: "u8", shape: [3], data: "AAAA" }, /labels: data is not a whole zlib stream/],
    ["no text", { type: "u8", shape: [3], data: 5 }, /labels: data must be text/],
    ["giant", stored("u8", [2 ** 40], []), /labels: has|too many/],
  ];
  it.each(bad)("names the field: %s", (_name, value, message) => {
    expect(() => unpack(value, "u8", "labels", 1, 3)).toThrow(DataError);
    expect(() => unpack(value, "u8", "labels", 1, 3)).toThrow(message);
  });

  it("refuses a cut off stream", () => {
    const whole = pack(new Uint8Array(1000).map((_, i) => i * 7));
    const cut = { ...whole, data: whole.data.slice(0, whole.data.length / 2 - ((whole.data.length / 2) % 4)) };
    expect(() => unpack(cut, "u8", "labels")).toThrow(DataError);
  });
});
