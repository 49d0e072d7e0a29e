/** Voxels as faces, shaded and outlined by a small shader of their own: fast even without a graphics card. */
import * as THREE from "three";
import { facingCount, visibleFaces, type FaceList } from "../model/faces.ts";
import type { Grid, Vec3 } from "../data/run.ts";
import type { Rgb } from "../model/colors.ts";

const vertexShader = /* glsl */ `
  attribute vec4 cell;  // lattice corner x y z, number of the corner 0..3
  attribute vec4 tint;
  varying vec2 corner;
  varying vec4 color;
  void main() {
    corner = vec2(mod(cell.w, 2.0), floor(cell.w * 0.5));
    color = tint;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(cell.xyz, 1.0);
  }`;

// The outline fades out where a voxel covers only a few pixels.
const fragmentShader = /* glsl */ `
  varying vec2 corner;
  varying vec4 color;
  void main() {
    vec2 edge = min(corner, 1.0 - corner);
    float width = max(fwidth(corner.x), fwidth(corner.y));
    float line = 1.0 - smoothstep(0.5 * width, 1.5 * width, min(edge.x, edge.y));
    gl_FragColor = vec4(color.rgb * (1.0 - 0.3 * line * (1.0 - smoothstep(0.08, 0.3, width))), color.a);
  }`;

/** Corner k of a face in direction d as offsets in the voxel; counter-clockwise seen from outside as 0 1 3 2. */
const CORNERS: Vec3[][] = [0, 1, 2, 3, 4, 5].map((direction) => {
  const [axis, positive] = [direction >> 1, direction & 1];
  const [u, w] = positive ? [(axis + 1) % 3, (axis + 2) % 3] : [(axis + 2) % 3, (axis + 1) % 3];
  return [0, 1, 2, 3].map((k) => {
    const offset: Vec3 = [0, 0, 0];
    offset[axis] = positive;
    offset[u] = k & 1;
    offset[w] = k >> 1;
    return offset;
  });
});

/** Opacity of faded voxels, of 255. */
const FADED = 84;

/** How light a face is: as if the sun stood to the upper left in front. */
const SHADE = [0.74, 0.86, 0.9, 0.7, 0.6, 1];

/** Colour of a voxel, 0 to 255 per channel, and its own shading where the surface's normal is known. */
export type VoxelColor = (voxel: number) => { rgb: Rgb; shade: number | null };

class FaceMesh {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.BufferGeometry();
  private list: FaceList | null = null;

  constructor(material: THREE.Material) {
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
  }

  fill(list: FaceList, size: Vec3, color: VoxelColor, alpha: number, index: THREE.BufferAttribute): void {
    this.list = list;
    const faces = list.voxels.length;
    const cells = new Uint16Array(16 * faces);
    const corners = CORNERS[list.direction];
    for (let f = 0; f < faces; ++f) {
      const v = list.voxels[f];
      const x = v % size[0];
      const y = Math.floor(v / size[0]) % size[1];
      const z = Math.floor(v / (size[0] * size[1]));
      for (let k = 0; k < 4; ++k) {
        const at = 16 * f + 4 * k;
        cells[at] = x + corners[k][0];
        cells[at + 1] = y + corners[k][1];
        cells[at + 2] = z + corners[k][2];
        cells[at + 3] = k;
      }
    }
    this.geometry.setAttribute("cell", new THREE.BufferAttribute(cells, 4));
    this.geometry.setIndex(index);
    this.paint(color, alpha);
  }

  paint(color: VoxelColor, alpha: number): void {
    if (!this.list) return;
    const { voxels, direction } = this.list;
    const tints = new Uint8Array(16 * voxels.length);
    for (let f = 0; f < voxels.length; ++f) {
      const { rgb, shade } = color(voxels[f]);
      const light = shade === null ? SHADE[direction] : 0.75 * shade + 0.25 * SHADE[direction];
      for (let k = 0; k < 4; ++k) {
        for (let c = 0; c < 3; ++c) tints[16 * f + 4 * k + c] = rgb[c] * light;
        tints[16 * f + 4 * k + 3] = alpha;
      }
    }
    this.geometry.setAttribute("tint", new THREE.BufferAttribute(tints, 4, true));
  }

  /** Leaves out the faces that look away from a camera at `position`, in voxels. */
  cull(position: THREE.Vector3): void {
    const count = this.list ? facingCount(this.list, position.getComponent(this.list.direction >> 1)) : 0;
    this.mesh.visible = count > 0;
    this.geometry.setDrawRange(0, 6 * count);
  }

  dispose(): void {
    this.geometry.dispose();
  }
}

/** The enclosure's voxels. Scaled so that one unit is one voxel and the enclosure's lowest corner is the origin. */
export class VoxelLayer {
  readonly group = new THREE.Group();
  /** Faces of the solid and of the faded voxels together. */
  faceCount = 0;
  private readonly solid: FaceMesh[];
  private readonly faded: FaceMesh[];
  private index = new THREE.BufferAttribute(new Uint32Array(0), 1);
  private readonly size: Vec3;

  /** `scale`: how many of the grid's voxels one of the layer's is wide. */
  constructor(grid: Grid, scale = 1) {
    this.size = grid.enclosureSize.map((n) => Math.ceil(n / scale)) as Vec3;
    const min = grid.enclosureMin.map((i, a) => grid.origin[a] + i * grid.voxel);
    this.group.position.fromArray(min);
    this.group.scale.setScalar(grid.voxel * scale);
    const opaque = new THREE.ShaderMaterial({ vertexShader, fragmentShader });
    const glass = new THREE.ShaderMaterial({ vertexShader, fragmentShader, transparent: true, depthWrite: false });
    this.solid = SHADE.map(() => new FaceMesh(opaque));
    this.faded = SHADE.map(() => new FaceMesh(glass));
    for (const face of [...this.solid, ...this.faded]) this.group.add(face.mesh);
    for (const face of this.faded) face.mesh.renderOrder = 5;
  }

  /** Rebuilds the faces after labels, modes or the cut changed. */
  build(
    labels: Uint8Array,
    mode: readonly number[],
    cut: (x: number, y: number, z: number) => boolean,
    color: VoxelColor,
  ): void {
    const solid = visibleFaces(labels, this.size, mode, 2, cut);
    const faded = visibleFaces(labels, this.size, mode, 1, cut);
    this.faceCount = [...solid, ...faded].reduce((n, list) => n + list.voxels.length, 0);
    this.growIndex(Math.max(...[...solid, ...faded].map((list) => list.voxels.length)));
    solid.forEach((list, d) => this.solid[d].fill(list, this.size, color, 255, this.index));
    faded.forEach((list, d) => this.faded[d].fill(list, this.size, color, FADED, this.index));
  }

  /** Colours anew, same faces. */
  paint(color: VoxelColor): void {
    for (const mesh of this.solid) mesh.paint(color, 255);
    for (const mesh of this.faded) mesh.paint(color, FADED);
  }

  cull(camera: THREE.Camera): void {
    const position = this.group.worldToLocal(camera.position.clone());
    for (const mesh of [...this.solid, ...this.faded]) mesh.cull(position);
  }

  dispose(): void {
    for (const mesh of [...this.solid, ...this.faded]) mesh.dispose();
  }

  private growIndex(faces: number): void {
    if (this.index.count >= 6 * faces) return;
    const index = new Uint32Array(6 * Math.ceil(faces * 1.3));
    for (let f = 0; 6 * f < index.length; ++f) index.set([0, 1, 3, 0, 3, 2].map((k) => 4 * f + k), 6 * f);
    this.index = new THREE.BufferAttribute(index, 1);
  }
}
