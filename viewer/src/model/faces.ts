/** The faces of voxels that can be seen, so that a block of voxels costs only its surface. */
import type { Vec3 } from "../data/run.ts";

/** Faces of one direction: 0..5 = -x +x -y +y -z +z. */
export interface FaceList {
  direction: number;
  /** Voxel of each face. Faces come plane by plane, those that a camera far out on their side sees first. */
  voxels: Uint32Array;
  /** `starts[k]`: number of faces that lie on the first k planes. */
  starts: Uint32Array;
}

/**
 * A face is drawn where a shown voxel meets one that is not shown. Where a solid voxel meets a faded one the face is the
 * solid one's; where two faded ones of different labels meet, that of the larger label. `mode` per label: 0 hidden,
 * 1 faded, 2 solid; `want` says which of the two lists. Voxels for which `cut` is true are hidden.
 */
export function visibleFaces(
  labels: Uint8Array,
  size: Vec3,
  mode: readonly number[],
  want: 1 | 2,
  cut: (x: number, y: number, z: number) => boolean = () => false,
): FaceList[] {
  const [nx, ny, nz] = size;
  const shown = new Uint8Array(labels.length);
  for (let z = 0, v = 0; z < nz; ++z) {
    for (let y = 0; y < ny; ++y) {
      for (let x = 0; x < nx; ++x, ++v) shown[v] = mode[labels[v]] === 0 || cut(x, y, z) ? 0 : mode[labels[v]];
    }
  }
  return [0, 1, 2, 3, 4, 5].map((direction) => facesOf(direction, labels, shown, size, want));
}

function facesOf(direction: number, labels: Uint8Array, shown: Uint8Array, size: Vec3, want: 1 | 2): FaceList {
  const axis = direction >> 1;
  const positive = (direction & 1) === 1;
  const strides = [1, size[0], size[0] * size[1]];
  const [u, w] = [(axis + 1) % 3, (axis + 2) % 3];
  const step = positive ? strides[axis] : -strides[axis];
  const planes = size[axis];
  const found: number[] = [];
  const starts = new Uint32Array(planes + 1);
  for (let k = 0; k < planes; ++k) {
    // A camera at coordinate c sees +x faces on planes below c: those planes first. Likewise -x from above.
    const plane = positive ? k : planes - 1 - k;
    const atBorder = plane === (positive ? planes - 1 : 0);
    for (let j = 0; j < size[w]; ++j) {
      let v = plane * strides[axis] + j * strides[w];
      for (let i = 0; i < size[u]; ++i, v += strides[u]) {
        if (shown[v] !== want) continue;
        const next = atBorder ? 0 : shown[v + step];
        if (next === 0 || (want === 2 && next === 1) || (want === 1 && next === 1 && labels[v + step] < labels[v])) {
          found.push(v);
        }
      }
    }
    starts[k + 1] = found.length;
  }
  return { direction, voxels: Uint32Array.from(found), starts };
}

/** How many of a list's faces can face a camera at `coordinate`, in voxels along the face's axis from the block. */
export function facingCount(list: FaceList, coordinate: number): number {
  const planes = list.starts.length - 1;
  const positive = (list.direction & 1) === 1;
  // Plane k of a positive list is at coordinate k + 1, of a negative one at planes - 1 - k.
  const visible = positive ? Math.ceil(coordinate) - 1 : planes - 1 - Math.floor(coordinate);
  return list.starts[Math.min(planes, Math.max(0, visible))];
}

/** A map of half the resolution, for drawing while the scene moves. */
export interface CoarseMap {
  size: Vec3;
  labels: Uint8Array;
  /** A voxel of the fine map that stands for each coarse one. */
  voxelOf: Uint32Array;
}

/** Eight voxels become one, that of the most solid among them; `mode` and `cut` as in visibleFaces. */
export function coarsen(
  labels: Uint8Array,
  size: Vec3,
  mode: readonly number[],
  cut: (x: number, y: number, z: number) => boolean = () => false,
): CoarseMap {
  const half = size.map((n) => Math.ceil(n / 2)) as Vec3;
  const count = half[0] * half[1] * half[2];
  // A cut voxel must stay hidden: it takes a label that is hidden, or one of its own beyond the last.
  const coarse: CoarseMap = { size: half, labels: new Uint8Array(count).fill(mode.length), voxelOf: new Uint32Array(count) };
  const best = new Uint8Array(count);
  for (let z = 0, v = 0; z < size[2]; ++z) {
    for (let y = 0; y < size[1]; ++y) {
      const row = half[0] * ((y >> 1) + half[1] * (z >> 1));
      for (let x = 0; x < size[0]; ++x, ++v) {
        const solidity = mode[labels[v]];
        const c = row + (x >> 1);
        if (solidity <= best[c] || cut(x, y, z)) continue;
        best[c] = solidity;
        coarse.labels[c] = labels[v];
        coarse.voxelOf[c] = v;
      }
    }
  }
  return coarse;
}

/**
 * The first shown voxel that a ray hits (Amanatides and Woo), in coordinates where voxel i covers [i, i+1), or null.
 */
export function pickVoxel(
  labels: Uint8Array,
  size: Vec3,
  isShown: (label: number, x: number, y: number, z: number) => boolean,
  origin: Vec3,
  direction: Vec3,
): { voxel: number; t: number } | null {
  let enter = 0;
  let leave = Infinity;
  for (let a = 0; a < 3; ++a) {
    if (direction[a] === 0) {
      if (origin[a] < 0 || origin[a] >= size[a]) return null;
      continue;
    }
    const t1 = -origin[a] / direction[a];
    const t2 = (size[a] - origin[a]) / direction[a];
    enter = Math.max(enter, Math.min(t1, t2));
    leave = Math.min(leave, Math.max(t1, t2));
  }
  if (enter >= leave) return null;
  const i = origin.map((o, a) => Math.min(size[a] - 1, Math.max(0, Math.floor(o + direction[a] * enter)))) as Vec3;
  const step = direction.map((d) => (d > 0 ? 1 : -1));
  const next = i.map((c, a) => (direction[a] === 0 ? Infinity : (c + (step[a] > 0 ? 1 : 0) - origin[a]) / direction[a]));
  for (let t = enter; ; ) {
    const voxel = i[0] + size[0] * (i[1] + size[1] * i[2]);
    if (isShown(labels[voxel], ...i)) return { voxel, t };
    const a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : next[1] < next[2] ? 1 : 2;
    t = next[a];
    i[a] += step[a];
    if (i[a] < 0 || i[a] >= size[a]) return null;
    next[a] += Math.abs(1 / direction[a]);
  }
}
