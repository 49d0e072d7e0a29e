import { describe, expect, it } from "vitest";
import { random } from "../../fixtures/vec.ts";
import type { Vec3 } from "../data/run.ts";
import { coarsen, facingCount, pickVoxel, visibleFaces } from "./faces.ts";

const size: Vec3 = [5, 4, 6];
const STEPS: Vec3[] = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]]; // prettier-ignore
const rng = random(3);
const labels = Uint8Array.from({ length: 120 }, () => Math.floor(5 * rng()));
const place = (v: number): Vec3 => [v % 5, Math.floor(v / 5) % 4, Math.floor(v / 20)];
const at = ([x, y, z]: Vec3) => x + 5 * (y + 4 * z);
const inside = (i: Vec3) => i.every((c, a) => c >= 0 && c < size[a]);

describe("visibleFaces", () => {
  it("has exactly the faces between solid and not solid voxels", () => {
    const mode = [0, 2, 0, 2, 1];
    const lists = visibleFaces(labels, size, mode, 2);
    let faces = 0;
    for (const { direction, voxels } of lists) {
      const expected = [...labels.keys()].filter((v) => {
        const next = place(v).map((c, a) => c + STEPS[direction][a]) as Vec3;
        return mode[labels[v]] === 2 && !(inside(next) && mode[labels[at(next)]] === 2);
      });
      expect([...voxels].sort((a, b) => a - b)).toEqual(expected);
      faces += voxels.length;
    }
    expect(faces).toBeGreaterThan(50);
  });

  it("draws one face between two faded voxels of different labels, none between equal ones", () => {
    const [, right] = visibleFaces(Uint8Array.of(0, 0, 3), [3, 1, 1], [1, 2, 0, 1, 0], 1);
    const [left] = visibleFaces(Uint8Array.of(0, 0, 3), [3, 1, 1], [1, 2, 0, 1, 0], 1);
    expect([...right.voxels]).toEqual([2]);
    expect([...left.voxels].sort()).toEqual([0, 2]);
  });

  it("opens the block where it is cut", () => {
    const full = new Uint8Array(120).fill(1);
    const up = visibleFaces(full, size, [0, 2, 0, 0, 0], 2, (_x, _y, z) => z > 2)[5];
    expect([...up.voxels].sort((a, b) => a - b)).toEqual(Array.from({ length: 20 }, (_, i) => 40 + i));
  });
});

describe("facingCount", () => {
  it("keeps every face that looks at the camera and drops every one that looks away", () => {
    const lists = visibleFaces(labels, size, [0, 2, 0, 2, 2], 2);
    for (const list of lists) {
      const axis = list.direction >> 1;
      const positive = list.direction & 1;
      for (const camera of [-3, 0.5, 1.999, 2, 2.5, 3, 9]) {
        const faces = [...list.voxels].map((v) => {
          const plane = place(v)[axis] + positive;
          return positive ? camera > plane : camera < plane;
        });
        const count = facingCount(list, camera);
        expect(faces.slice(0, count).every(Boolean)).toBe(true);
        expect(faces.slice(count).some(Boolean)).toBe(false);
      }
    }
  });
});

describe("coarsen", () => {
  it("shows a block where and only where one of its eight voxels is shown", () => {
    const mode = [0, 2, 0, 1, 0];
    const cut = (x: number) => x > 3;
    const coarse = coarsen(labels, size, mode, cut);
    expect(coarse.size).toEqual([3, 2, 3]);
    for (let c = 0; c < 18; ++c) {
      const block = [c % 3, Math.floor(c / 3) % 2, Math.floor(c / 6)];
      const members = [...labels.keys()].filter((v) => place(v).every((k, a) => k >> 1 === block[a]) && !cut(place(v)[0]));
      const best = Math.max(0, ...members.map((v) => mode[labels[v]]));
      expect([...mode, 0][coarse.labels[c]]).toBe(best);
      if (best > 0) {
        expect(members).toContain(coarse.voxelOf[c]);
        expect(labels[coarse.voxelOf[c]]).toBe(coarse.labels[c]);
      }
    }
  });
});

describe("pickVoxel", () => {
  it("finds the first shown voxel along a ray, as small steps do", () => {
    let hits = 0;
    for (let i = 0; i < 300; ++i) {
      const origin: Vec3 = [12 * rng() - 3, 12 * rng() - 3, -4];
      const direction: Vec3 = [rng() - 0.5, rng() - 0.5, 1];
      const found = pickVoxel(labels, size, (label) => label === 1 || label === 3, origin, direction);
      let naive = -1;
      let graze = false;
      for (let t = 0; t < 12 && naive < 0; t += 1e-3) {
        const p = origin.map((o, a) => o + t * direction[a]) as Vec3;
        const index = p.map(Math.floor) as Vec3;
        if (inside(index) && [1, 3].includes(labels[at(index)])) {
          naive = at(index);
          // Small steps may jump over a corner; then the exact voxel lies just before.
          graze = found !== null && found.t < t - 2e-3;
        }
      }
      if (graze) continue;
      expect(found?.voxel ?? -1).toBe(naive);
      if (naive >= 0) ++hits;
    }
    expect(hits).toBeGreaterThan(50);
  });

  it("finds nothing where nothing is shown or the ray passes by", () => {
    expect(pickVoxel(labels, size, () => false, [2, 2, -1], [0, 0, 1])).toBeNull();
    expect(pickVoxel(labels, size, () => true, [9, 9, -1], [0, 0, 1])).toBeNull();
    expect(pickVoxel(labels, size, () => true, [2.5, 2.5, -1], [0, 0, -1])).toBeNull();
  });
});
