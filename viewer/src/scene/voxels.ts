/** Voxels as faces, shaded and outlined by a small shader of their own: fast even without a graphics card. */
import * as THREE from "three";
import { faceAxes, facingCount, visibleFaces, type FaceList } from "../model/faces.ts";
import type { Grid, Vec3 } from "../data/run.ts";
import { lightOf, lit, NOOK, SHADE, type VoxelColor } from "./voxel_light.ts";
import { VoxelPoints } from "./voxel_points.ts";

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
  const [u, w] = faceAxes(direction);
  return [0, 1, 2, 3].map((k) => {
    const offset: Vec3 = [0, 0, 0];
    offset[direction >> 1] = direction & 1;
    offset[u] = k & 1;
    offset[w] = k >> 1;
    return offset;
  });
});

/** Opacity of faded voxels, of 255. */
const FADED = 84;

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
    const { voxels, direction, free } = this.list;
    const tints = new Uint8Array(16 * voxels.length);
    for (let f = 0; f < voxels.length; ++f) {
      const { rgb, shade } = color(voxels[f]);
      const light = lightOf(shade, SHADE[direction]);
      for (let k = 0; k < 4; ++k) {
        const here = light * NOOK[(free[f] >> (2 * k)) & 3];
        for (let c = 0; c < 3; ++c) tints[16 * f + 4 * k + c] = lit(rgb[c], here);
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
  private readonly faces = new THREE.Group();
  private lists: { solid: FaceList[]; faded: FaceList[] } = { solid: [], faded: [] };
  private points: VoxelPoints[] = [];
  private index = new THREE.BufferAttribute(new Uint32Array(0), 1);
  private color: VoxelColor = () => ({ rgb: [0, 0, 0], shade: null });
  private readonly size: Vec3;

  constructor(private readonly grid: Grid) {
    this.size = grid.enclosureSize;
    const min = grid.enclosureMin.map((i, a) => grid.origin[a] + i * grid.voxel);
    this.group.position.fromArray(min);
    this.group.scale.setScalar(grid.voxel);
    const opaque = new THREE.ShaderMaterial({ vertexShader, fragmentShader });
    const glass = new THREE.ShaderMaterial({ vertexShader, fragmentShader, transparent: true, depthWrite: false });
    this.solid = SHADE.map(() => new FaceMesh(opaque));
    this.faded = SHADE.map(() => new FaceMesh(glass));
    for (const face of [...this.solid, ...this.faded]) this.faces.add(face.mesh);
    for (const face of this.faded) face.mesh.renderOrder = 5;
    this.group.add(this.faces);
  }

  /** Rebuilds the faces after labels, modes or the cut changed. */
  build(
    labels: Uint8Array,
    mode: readonly number[],
    cut: (x: number, y: number, z: number) => boolean,
    color: VoxelColor,
  ): void {
    const { solid, faded } = visibleFaces(labels, this.size, mode, cut);
    this.lists = { solid, faded };
    this.faceCount = [...solid, ...faded].reduce((n, list) => n + list.voxels.length, 0);
    this.growIndex(Math.max(...[...solid, ...faded].map((list) => list.voxels.length)));
    solid.forEach((list, d) => this.solid[d].fill(list, this.size, color, 255, this.index));
    faded.forEach((list, d) => this.faded[d].fill(list, this.size, color, FADED, this.index));
    this.color = color;
    this.dropPoints();
  }

  /** New colours, same faces. */
  paint(color: VoxelColor): void {
    for (const mesh of this.solid) mesh.paint(color, 255);
    for (const mesh of this.faded) mesh.paint(color, FADED);
    this.color = color;
    this.dropPoints();
  }

  /** Faces as they are, without those that look away from the camera. */
  showFaces(camera: THREE.Camera): void {
    this.faces.visible = true;
    for (const { points } of this.points) points.visible = false;
    const position = this.group.worldToLocal(camera.position.clone());
    for (const mesh of [...this.solid, ...this.faded]) mesh.cull(position);
  }

  /** A point for every block of voxels, `block` per side, that has a face; `height`: rows of pixels of the picture. */
  showPoints(camera: THREE.PerspectiveCamera, height: number, block: number): void {
    this.faces.visible = false;
    if (this.points[0]?.block !== block) {
      this.dropPoints();
      const { solid, faded } = this.lists;
      this.points = [
        new VoxelPoints(solid, this.size, block, this.color, 255),
        new VoxelPoints(faded, this.size, block, this.color, FADED),
      ];
      this.group.add(...this.points.map((p) => p.points));
    }
    const position = this.group.worldToLocal(camera.position.clone());
    const pixels = (this.grid.voxel * height) / (2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)));
    for (const p of this.points) {
      p.points.visible = true;
      p.aim(position, pixels);
    }
  }

  dispose(): void {
    for (const mesh of [...this.solid, ...this.faded]) mesh.dispose();
    this.dropPoints();
  }

  private dropPoints(): void {
    for (const p of this.points.splice(0)) p.dispose();
  }

  private growIndex(faces: number): void {
    if (this.index.count >= 6 * faces) return;
    const index = new Uint32Array(6 * Math.ceil(faces * 1.3));
    for (let f = 0; 6 * f < index.length; ++f) index.set([0, 1, 3, 0, 3, 2].map((k) => 4 * f + k), 6 * f);
    this.index = new THREE.BufferAttribute(index, 1);
  }
}
