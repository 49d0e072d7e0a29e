import { describe, expect, it } from "vitest";
import { random } from "../../fixtures/vec.ts";
import type { Vec3 } from "../data/run.ts";
import { blocksWithFaces, faceAxes, facingCount, pickVoxel, visibleFaces } from "./faces.ts";

const size: Vec3 = [5, 4, 6];
const STEPS: Vec3[] = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]]; // prettier-ignore
const rng = random(3);
const labels = Uint8Array.from({ length: 120 }, () => Math.floor(5 * rng()));
const place = (v: number): Vec3 => [v % 5, Math.floor(v / 5) % 4, Math.floor(v / 20)];
const at = ([x, y, z]: Vec3) => x + 5 * (y + 4 * z);
const inside = (i: Vec3) => i.every((c, a) => c >= 0 && c < size[a]);

/** Places of the lattice and one around it that a walk from outside reaches over what is not solid. */
function reached(solid: (i: Vec3) => boolean): Set<string> {
  const within = (i: Vec3) => i.every((c, a) => c >= -1 && c <= size[a]);
  const found = new Set(["-1,-1,-1"]);
  for (const text of found) {
    for (const step of STEPS) {
      const next = text.split(",").map((c, a) => Number(c) + step[a]) as Vec3;
      if (within(next) && !(inside(next) && solid(next))) found.add(next.join());
    }
  }
  return found;
}

describe("visibleFaces", () => {
  it("has exactly the faces between solid voxels and others that light reaches", () => {
    let faces = 0;
    let hidden = 0;
    for (let round = 0; round < 40; ++round) {
      // From sparse to nearly full, so that there are closed hollows too.
      const some = Uint8Array.from({ length: 120 }, () => (rng() < 0.2 + 0.018 * round ? [1, 3][Math.floor(2 * rng())] : [0, 2, 4][Math.floor(3 * rng())]));
      const mode = [0, 2, 0, 2, 1];
      const solid = (i: Vec3) => mode[some[at(i)]] === 2;
      const light = reached(solid);
      for (const { direction, voxels } of visibleFaces(some, size, mode).solid) {
        const bare = [...some.keys()].filter((v) => {
          const next = place(v).map((c, a) => c + STEPS[direction][a]) as Vec3;
          return solid(place(v)) && !(inside(next) && solid(next));
        });
        const expected = bare.filter((v) => light.has(place(v).map((c, a) => c + STEPS[direction][a]).join()));
        expect([...voxels].sort((a, b) => a - b)).toEqual(expected);
        faces += expected.length;
        hidden += bare.length - expected.length;
      }
    }
    expect(faces).toBeGreaterThan(2000);
    expect(hidden).toBeGreaterThan(100);
  });

  it("leaves out what is inside a closed box, and shows it where the box is cut open", () => {
    // A faded voxel in the middle of a solid box of three.
    const box = new Uint8Array(27).fill(1);
    box[13] = 4;
    const count = (cut: (x: number, y: number, z: number) => boolean) => {
      const { solid, faded } = visibleFaces(box, [3, 3, 3], [0, 2, 0, 0, 1], cut);
      return [solid, faded].map((lists) => lists.reduce((n, list) => n + list.voxels.length, 0));
    };
    expect(count(() => false)).toEqual([54, 0]);
    // Open above: 9 below, 4 times 6 at the sides, 8 on top, and the five walls around the faded one, which is seen from above.
    expect(count((_x, _y, z) => z > 1)).toEqual([9 + 24 + 8 + 5, 1]);
  });

  it("says of every corner how many of the three cells before it are free, none between two walls", () => {
    let nooks = 0;
    const mode = [0, 2, 0, 2, 0];
    const solid = (i: Vec3) => inside(i) && mode[labels[at(i)]] === 2;
    for (const { direction, voxels, free } of visibleFaces(labels, size, mode).solid) {
      const axes = faceAxes(direction);
      voxels.forEach((v, f) => {
        const front = place(v).map((c, a) => c + STEPS[direction][a]) as Vec3;
        for (let k = 0; k < 4; ++k) {
          const sides = [k & 1 ? 1 : -1, k >> 1 ? 1 : -1];
          const beside = (which: number[]) =>
            solid(front.map((c, a) => c + which.reduce((n, i) => n + (axes[i] === a ? sides[i] : 0), 0)) as Vec3);
          const walls = [beside([0]), beside([1]), beside([0, 1])].filter(Boolean).length;
          const level = beside([0]) && beside([1]) ? 0 : 3 - walls;
          expect((free[f] >> (2 * k)) & 3).toBe(level);
          if (level === 0) ++nooks;
        }
      });
    }
    expect(nooks).toBeGreaterThan(5);
  });

  it("draws one face between two faded voxels of different labels, none between equal ones", () => {
    const faces = (mode: number[]) => visibleFaces(Uint8Array.of(0, 0, 3), [3, 1, 1], mode).faded;
    const [left, right] = faces([1, 2, 0, 1, 0]);
    expect([...right.voxels]).toEqual([2]);
    expect([...left.voxels].sort()).toEqual([0, 2]);
  });

  it("opens the block where it is cut", () => {
    const full = new Uint8Array(120).fill(1);
    const up = visibleFaces(full, size, [0, 2, 0, 0, 0], (_x, _y, z) => z > 2).solid[5];
    expect([...up.voxels].sort((a, b) => a - b)).toEqual(Array.from({ length: 20 }, (_, i) => 40 + i));
  });
});

describe("blocksWithFaces", () => {
  it.each([1, 2, 3])("has each block of %i voxels per side once, with the sides that have a face", (block) => {
    const { solid } = visibleFaces(labels, size, [0, 2, 0, 2, 1]);
    const { places, sides, voxels } = blocksWithFaces(solid, size, block);
    const key = (v: number) => place(v).map((c) => Math.floor(c / block)).join();
    const expected: Record<string, number> = {};
    for (const list of solid) for (const v of list.voxels) expected[key(v)] = (expected[key(v)] ?? 0) | (2 ** list.direction);
    const found = Object.fromEntries([...sides].map((s, i) => [places.slice(3 * i, 3 * i + 3).join(), s]));
    expect(found).toEqual(expected);
    expect(Object.keys(found)).toHaveLength(sides.length);
    expect([...voxels].map(key)).toEqual([...sides].map((_, i) => places.slice(3 * i, 3 * i + 3).join()));
    expect(sides.length).toBeGreaterThan(block === 1 ? 30 : 3);
  });
});

describe("facingCount", () => {
  it("keeps every face that looks at the camera and drops every one that looks away", () => {
    const lists = visibleFaces(labels, size, [0, 2, 0, 2, 2]).solid;
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
