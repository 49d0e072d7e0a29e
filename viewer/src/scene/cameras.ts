/** The candidate views as small cameras coloured by utility. */
import * as THREE from "three";
import type { Camera, Candidates } from "../data/run.ts";
import type { Rgb } from "../model/colors.ts";
import { imageCorners, matrixOf } from "./geometry.ts";

const VERTICES = 5; // the tip and the corners of the image

/** All candidates in one geometry: pyramids with the tip at the sensor. */
export class CameraLayer {
  readonly group = new THREE.Group();
  readonly positions: THREE.Vector3[] = [];
  private readonly colors: THREE.BufferAttribute;
  private readonly outline: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;

  constructor(
    readonly candidates: Candidates,
    camera: Camera,
    length: number,
  ) {
    const corners = imageCorners(camera, 1).map((p) => p.setZ(0).normalize().multiplyScalar(0.62 * length).setZ(length));
    const tip = new THREE.Vector3();
    const local = [tip, ...corners];
    const vertices = new Float32Array(3 * VERTICES * candidates.count);
    const moved = new THREE.Vector3();
    for (let i = 0; i < candidates.count; ++i) {
      const matrix = matrixOf(candidates.poses, 7 * i);
      this.positions.push(new THREE.Vector3().setFromMatrixPosition(matrix));
      local.forEach((p, k) => moved.copy(p).applyMatrix4(matrix).toArray(vertices, 3 * (VERTICES * i + k)));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
    this.colors = new THREE.BufferAttribute(new Uint8Array(4 * VERTICES * candidates.count), 4, true);
    geometry.setAttribute("color", this.colors);
    const sides = [0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 1, 2, 3, 1, 3, 4];
    const index = Uint32Array.from({ length: sides.length * candidates.count }, (_, i) => VERTICES * Math.floor(i / sides.length) + sides[i % sides.length]);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, transparent: true });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.renderOrder = 3;
    this.outline = new THREE.LineSegments(
      this.edges([0, 1, 2, 3].flatMap((k) => [tip, corners[k], corners[k], corners[(k + 1) % 4]])),
      new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }),
    );
    this.outline.renderOrder = 3;
    this.group.add(mesh, this.outline);
    for (const child of this.group.children) child.frustumCulled = false;
  }

  showOutlines(on: boolean): void {
    this.outline.visible = on;
  }

  setOutline(color: string): void {
    this.outline.material.color.set(color);
  }

  private edges(local: THREE.Vector3[]): THREE.BufferGeometry {
    const lines = new Float32Array(3 * local.length * this.candidates.count);
    const moved = new THREE.Vector3();
    for (let i = 0, at = 0; i < this.candidates.count; ++i) {
      const matrix = matrixOf(this.candidates.poses, 7 * i);
      for (const p of local) moved.copy(p).applyMatrix4(matrix).toArray(lines, 3 * at++);
    }
    return new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(lines, 3));
  }

  /** `color` and opacity (0 to 1) per candidate. */
  paint(color: (index: number) => { rgb: Rgb; alpha: number }): void {
    const shades = [1.15, 0.62, 0.72, 0.95, 0.85]; // enough to look solid
    const array = this.colors.array as Uint8Array;
    for (let i = 0; i < this.candidates.count; ++i) {
      const { rgb, alpha } = color(i);
      for (let k = 0; k < VERTICES; ++k) {
        const shade = shades[k];
        const at = 4 * (VERTICES * i + k);
        for (let c = 0; c < 3; ++c) array[at + c] = Math.min(255, rgb[c] * shade);
        array[at + 3] = 255 * alpha;
      }
    }
    this.colors.needsUpdate = true;
  }
}
