import { beforeAll, describe, expect, it } from "vitest";
import { mugRun } from "../../fixtures/mug_run.ts";
import { pack } from "../../fixtures/pack.ts";
import { countLabels, MapHistory, NEVER } from "./history.ts";
import { DataError } from "./packed.ts";
import { decodeRun, OCCUPIED } from "./run.ts";

type Json = Record<string, any>;
let document: Json;
const copy = () => structuredClone(document);

beforeAll(() => {
  document = JSON.parse(JSON.stringify(mugRun({ scans: 4, rays: 60, meshes: false }))) as Json;
});

describe("decodeRun", () => {
  it("reads scans with their numbers", () => {
    const run = decodeRun(copy());
    expect(run.scans).toHaveLength(4);
    expect(run.scans[2].utility).toBe(document["scans"][2].utility);
    expect(run.scans[0].utility).toBeNull();
    expect(run.scans[0].plan).toBeNull();
    expect(run.candidates.count).toBe(80);
    expect(run.grid.enclosureSize).toEqual([55, 55, 55]);
    expect(run.mesh).toBeNull();
  });

  it("gives the factors of the chosen view the same in the plan as in the record", () => {
    const scan = decodeRun(copy()).scans[3];
    expect(scan.plan!.chosen).toBe(scan.candidate);
    for (const key of ["utility", "f_area", "f_navigation", "f_quality", "f_occlusion", "n_op"] as const) {
      expect(scan.plan![key][scan.candidate!]).toBeCloseTo(scan[key]!, 6);
    }
  });

  it("ignores keys that it does not know", () => {
    const more = copy();
    more["from_the_future"] = { a: 1 };
    more["scans"][0].weather = "rain";
    expect(decodeRun(more).scans).toHaveLength(4);
  });

  const broken: [string, (d: Json) => void, RegExp][] = [
    ["format", (d) => (d["format"] = "something"), /^format: is "something"/],
    ["version", (d) => (d["version"] = 2), /^version: is 2, this page reads version 1/],
    ["meta", (d) => delete d["meta"], /^meta: must be an object/],
    ["state", (d) => (d["meta"].state = "asleep"), /^meta\.state: is "asleep", must be one of running, waiting, finished/],
    ["voxel", (d) => (d["grid"].voxel = 0), /^grid\.voxel: is 0, must be positive/],
    ["enclosure", (d) => (d["grid"].enclosure = [9, 9, 9, 0, 0, 0]), /^grid\.enclosure/],
    ["NaN as null", (d) => (d["camera"].left = null), /^camera\.left: is null, must be a number/],
    ["scans", (d) => (d["scans"] = {}), /^scans: must be a list/],
    ["order", (d) => d["scans"].reverse(), /^scans\[0\]\.scan: is 3, must be 0/],
    ["candidate", (d) => (d["scans"][1].candidate = 80), /^scans\[1\]\.candidate: is 80, but there are 80 candidates/],
    ["quaternion", (d) => (d["scans"][1].believed[6] = 9), /^scans\[1\]\.believed: its quaternion has length/],
    ["labels of another size", (d) => (d["scans"][1].labels = pack(new Uint8Array(8))), /^scans\[1\]\.labels: has 8 rows/],
    ["unknown label", (d) => (d["scans"][1].labels = pack(new Uint8Array(55 ** 3).fill(9))), /^scans\[1\]\.labels: holds a label above 4/],
    ["voxel outside", (d) => (d["scans"][0].surface.voxels = pack(Uint32Array.of(55 ** 3))), /^scans\[0\]\.surface\.voxels/],
    ["chosen", (d) => (d["scans"][1].plan.chosen = -1), /^scans\[1\]\.plan\.chosen: is -1/],
    ["reason", (d) => (d["scans"][1].plan.reasons = []), /^scans\[1\]\.plan\.infeasible: names a reason/],
    ["cloud", (d) => (d["cloud"].step = "wide"), /^cloud\.step: is "wide", must be a number/],
    ["mesh", (d) => (d["mesh"] = { origin: [0, 0, 0], step: 1, vertices: pack(new Uint16Array(3), 3, true), triangles: pack(Uint32Array.of(0, 0, 1), 3, true) }), /^mesh\.triangles: names a vertex/],
  ]; // prettier-ignore
  it.each(broken)("says what is wrong: %s", (_name, damage, message) => {
    const damaged = copy();
    damage(damaged);
    expect(() => decodeRun(damaged)).toThrow(DataError);
    expect(() => decodeRun(damaged)).toThrow(message);
  });

  it.each([null, 3, "text", []])("refuses %j as a whole", (value) => {
    expect(() => decodeRun(value)).toThrow(DataError);
  });
});

describe("MapHistory", () => {
  it("counts as many occupied voxels as the records say, in any order of steps", () => {
    const run = decodeRun(copy());
    const history = new MapHistory(run, 2);
    for (const step of [3, 0, 2, 1, 3, 1]) {
      expect(countLabels(history.at(step).labels)[OCCUPIED]).toBe(run.scans[step].occupied);
    }
    expect(countLabels(history.at(-1).labels)).toEqual([55 ** 3, 0, 0, 0, 0]);
    expect(() => history.at(4)).toThrow(RangeError);
  });

  it("knows the first scan of every occupied voxel and of no other", () => {
    const run = decodeRun(copy());
    const history = new MapHistory(run);
    const occupiedAfter = run.scans.map((_, k) => history.at(k).labels.slice());
    const last = history.at(3);
    const wrong = [...last.labels.keys()].filter((v) => {
      const first = occupiedAfter.findIndex((labels) => labels[v] === OCCUPIED);
      return last.firstScan[v] !== (first < 0 ? NEVER : first);
    });
    expect(wrong).toEqual([]);
    expect(new Set(last.firstScan)).toEqual(new Set([0, 1, 2, 3, NEVER]));
  });
});
