/** The faces of voxels that can be seen, so that a block of voxels costs only its surface. */
import type { Vec3 } from "../data/run.ts";

/** Faces of one direction: 0..5 = -x +x -y +y -z +z. */
export interface FaceList {
  direction: number;
  /** Voxel of each face. Faces come plane by plane, those that a camera far out on their side sees first. */
  voxels: Uint32Array;
  /** `starts[k]`: number of faces that lie on the first k planes. */
  starts: Uint32Array;
  /** Of each face how free its corners are, 0 (in a nook) to 3: two bits per corner, corner 0 lowest. */
  free: Uint8Array;
}

export interface Faces {
  solid: FaceList[];
  faded: FaceList[];
}

/** The axes of a face's corners: corner k lies at k & 1 along the first and k >> 1 along the second. */
export function faceAxes(direction: number): [number, number] {
  const axis = direction >> 1;
  return direction & 1 ? [(axis + 1) % 3, (axis + 2) % 3] : [(axis + 2) % 3, (axis + 1) % 3];
}

// What a cell holds. The voxels have two cells around them: an open one, then a wall that ends every walk.
const [HIDDEN, FADED, SOLID, WALL] = [0, 1, 2, 3];
const KIND = 3;
/** Added where light from outside gets in. */
const OPEN = 4;

interface Cells {
  kinds: Uint8Array;
  strides: Vec3;
  first: number;
}

function cellsOf(
  labels: Uint8Array,
  size: Vec3,
  mode: readonly number[],
  cut: (x: number, y: number, z: number) => boolean,
): Cells {
  const [nx, ny, nz] = size.map((n) => n + 4);
  const strides: Vec3 = [1, nx, nx * ny];
  const kinds = new Uint8Array(nx * ny * nz).fill(WALL);
  const first = 2 * (strides[0] + strides[1] + strides[2]);
  for (let z = -1; z <= size[2]; ++z) {
    for (let y = -1; y <= size[1]; ++y) {
      const row = first + y * strides[1] + z * strides[2];
      kinds.fill(HIDDEN, row - 1, row + size[0] + 1);
    }
  }
  for (let z = 0, v = 0; z < size[2]; ++z) {
    for (let y = 0; y < size[1]; ++y) {
      const row = first + y * strides[1] + z * strides[2];
      for (let x = 0; x < size[0]; ++x, ++v) {
        const kind = mode[labels[v]];
        if (kind !== HIDDEN && !cut(x, y, z)) kinds[row + x] = kind;
      }
    }
  }
  const cells = { kinds, strides, first };
  letLightIn(cells);
  return cells;
}

/** Marks every cell that can be reached from outside without passing a solid one; nobody sees into the others. */
function letLightIn({ kinds, strides, first }: Cells): void {
  const steps = strides.flatMap((s) => [-s, s]);
  const corner = first - strides[0] - strides[1] - strides[2];
  const todo = new Uint32Array(kinds.length);
  let count = 0;
  kinds[corner] |= OPEN;
  todo[count++] = corner;
  while (count > 0) {
    const cell = todo[--count];
    for (let k = 0; k < 6; ++k) {
      const next = cell + steps[k];
      if (kinds[next] >= SOLID) continue; // solid, a wall, or marked before
      kinds[next] |= OPEN;
      todo[count++] = next;
    }
  }
}

/**
 * The faces that can be seen from outside. A face is drawn where a shown voxel meets one that is not shown. Where a solid
 * voxel meets a faded one the face is the solid one's; where two faded ones of different labels meet, that of the larger
 * label. `mode` per label: 0 hidden, 1 faded, 2 solid. Voxels for which `cut` is true are hidden.
 */
export function visibleFaces(
  labels: Uint8Array,
  size: Vec3,
  mode: readonly number[],
  cut: (x: number, y: number, z: number) => boolean = () => false,
): Faces {
  const cells = cellsOf(labels, size, mode, cut);
  const directions = [0, 1, 2, 3, 4, 5];
  return {
    solid: directions.map((direction) => facesOf(direction, labels, size, cells, SOLID)),
    faded: directions.map((direction) => facesOf(direction, labels, size, cells, FADED)),
  };
}

function facesOf(direction: number, labels: Uint8Array, size: Vec3, cells: Cells, want: number): FaceList {
  const axis = direction >> 1;
  const positive = (direction & 1) === 1;
  const { kinds, first } = cells;
  const steps = [1, size[0], size[0] * size[1]];
  const [u, w] = [(axis + 1) % 3, (axis + 2) % 3];
  const ahead = positive ? 1 : -1;
  const wanted = want === SOLID ? SOLID : FADED | OPEN;
  const planes = size[axis];
  const found: number[] = [];
  const free: number[] = [];
  const starts = new Uint32Array(planes + 1);
  for (let k = 0; k < planes; ++k) {
    // A camera at coordinate c sees +x faces on planes below c: those planes first. Likewise -x from above.
    const plane = positive ? k : planes - 1 - k;
    for (let j = 0; j < size[w]; ++j) {
      let v = plane * steps[axis] + j * steps[w];
      let cell = first + plane * cells.strides[axis] + j * cells.strides[w];
      for (let i = 0; i < size[u]; ++i, v += steps[u], cell += cells.strides[u]) {
        if (kinds[cell] !== wanted) continue;
        const next = kinds[cell + ahead * cells.strides[axis]];
        if (want === SOLID) {
          if (next < OPEN) continue;
          found.push(v);
          free.push(cornersFree(cells, cell + ahead * cells.strides[axis], direction));
        } else {
          const kind = next & KIND;
          if (kind === HIDDEN || (kind === FADED && labels[v + ahead * steps[axis]] < labels[v])) found.push(v);
        }
      }
    }
    starts[k + 1] = found.length;
  }
  const all = want === SOLID ? Uint8Array.from(free) : new Uint8Array(found.length).fill(255);
  return { direction, voxels: Uint32Array.from(found), starts, free: all };
}

/** How many of the three cells that meet a corner of a face in front of it are not solid, for all four corners. */
function cornersFree({ kinds, strides }: Cells, front: number, direction: number): number {
  const [u, w] = faceAxes(direction);
  const [right, above] = [strides[u], strides[w]];
  const solid = (cell: number) => ((kinds[cell] & KIND) === SOLID ? 1 : 0);
  let packed = 0;
  for (let k = 0; k < 4; ++k) {
    const across = k & 1 ? right : -right;
    const along = k >> 1 ? above : -above;
    const beside = solid(front + across) + solid(front + along);
    // A corner between two walls is a nook, whatever stands behind it.
    packed |= (beside === 2 ? 0 : 3 - beside - solid(front + across + along)) << (2 * k);
  }
  return packed;
}

/** Blocks of voxels that have faces. */
export interface Blocks {
  /** Of each block its place among the blocks, three numbers. */
  places: Uint16Array;
  /** Directions of its faces as bits. */
  sides: Uint8Array;
  /** A voxel in it that has a face. */
  voxels: Uint32Array;
}

/** The blocks, `block` voxels per side, that have faces; with 1 the voxels themselves. Each block once. */
export function blocksWithFaces(lists: readonly FaceList[], size: Vec3, block: number): Blocks {
  const [nx, ny, nz] = size.map((n) => Math.ceil(n / block));
  const sidesOf = new Uint8Array(nx * ny * nz);
  const found: number[] = [];
  const places: number[] = [];
  const voxels: number[] = [];
  for (const list of lists) {
    for (const v of list.voxels) {
      const x = Math.floor((v % size[0]) / block);
      const y = Math.floor((Math.floor(v / size[0]) % size[1]) / block);
      const z = Math.floor(Math.floor(v / (size[0] * size[1])) / block);
      const b = x + nx * (y + ny * z);
      if (sidesOf[b] === 0) {
        found.push(b);
        places.push(x, y, z);
        voxels.push(v);
      }
      sidesOf[b] |= 1 << list.direction;
    }
  }
  return { places: Uint16Array.from(places), sides: Uint8Array.from(found, (b) => sidesOf[b]), voxels: Uint32Array.from(voxels) };
}

/** How many of a list's faces can face a camera at `coordinate`, in voxels along the face's axis from the block. */
export function facingCount(list: FaceList, coordinate: number): number {
  const planes = list.starts.length - 1;
  const positive = (list.direction & 1) === 1;
  // Plane k of a positive list is at coordinate k + 1, of a negative one at planes - 1 - k.
  const visible = positive ? Math.ceil(coordinate) - 1 : planes - 1 - Math.floor(coordinate);
  return list.starts[Math.min(planes, Math.max(0, visible))];
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
