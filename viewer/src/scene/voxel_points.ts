/** Voxels as points, for scenes that are slow to draw as faces. */
import * as THREE from "three";
import { blocksWithFaces, type FaceList } from "../model/faces.ts";
import type { Vec3 } from "../data/run.ts";
import { lightOf, lit, SHADE, type VoxelColor } from "./voxel_light.ts";

// A point is as wide as a voxel seen across its edges, so that no gaps open between neighbours. Those of which no face
// looks at the eye are put where nothing is drawn.
const vertexShader = /* glsl */ `
  attribute float sides;  // with a face, as bits
  attribute vec4 tint;
  uniform vec3 eye;
  uniform float pixels;
  varying vec4 color;
  bool looks(float bits, float along) {
    return (mod(bits, 2.0) >= 1.0 && along < -0.5) || (bits >= 2.0 && along > 0.5);
  }
  void main() {
    color = tint;
    vec3 middle = position + 0.5;
    vec3 to = eye - middle;
    float x = mod(sides, 4.0);
    float y = mod(floor(sides / 4.0), 4.0);
    float z = floor(sides / 16.0);
    vec4 place = modelViewMatrix * vec4(middle, 1.0);
    gl_PointSize = max(1.0, 1.42 * pixels / -place.z);
    gl_Position = looks(x, to.x) || looks(y, to.y) || looks(z, to.z) ? projectionMatrix * place : vec4(2.0, 2.0, 2.0, 1.0);
  }`;

const fragmentShader = /* glsl */ `
  varying vec4 color;
  void main() { gl_FragColor = color; }`;

/** A point for every block of voxels: from afar nearly the same picture as their faces, and less to draw. */
export class VoxelPoints {
  readonly points: THREE.Points<THREE.BufferGeometry, THREE.ShaderMaterial>;
  constructor(
    lists: readonly FaceList[],
    size: Vec3,
    readonly block: number,
    color: VoxelColor,
    alpha: number,
  ) {
    const { places, sides, voxels } = blocksWithFaces(lists, size, block);
    const tints = new Uint8Array(4 * voxels.length);
    voxels.forEach((v, i) => {
      const { rgb, shade } = color(v);
      const shown = SHADE.filter((_, d) => sides[i] & (1 << d));
      const light = lightOf(shade, shown.reduce((sum, s) => sum + s, 0) / shown.length);
      for (let c = 0; c < 3; ++c) tints[4 * i + c] = lit(rgb[c], light);
      tints[4 * i + 3] = alpha;
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    geometry.setAttribute("sides", new THREE.BufferAttribute(sides, 1));
    geometry.setAttribute("tint", new THREE.BufferAttribute(tints, 4, true));
    const material = new THREE.ShaderMaterial({
      vertexShader: vertexShader,
      fragmentShader: fragmentShader,
      uniforms: { eye: { value: new THREE.Vector3() }, pixels: { value: 1 } },
      transparent: alpha < 255,
      depthWrite: alpha === 255,
    });
    this.points = new THREE.Points(geometry, material);
    this.points.frustumCulled = false;
    if (alpha < 255) this.points.renderOrder = 5;
    this.points.scale.setScalar(block);
  }

  /** `eye` in voxels; `pixels`: of a voxel at distance 1 in the camera's units. */
  aim(eye: THREE.Vector3, pixels: number): void {
    const { uniforms } = this.points.material;
    (uniforms["eye"].value as THREE.Vector3).copy(eye).divideScalar(this.block);
    uniforms["pixels"].value = pixels * this.block;
  }

  dispose(): void {
    this.points.geometry.dispose();
    this.points.material.dispose();
    this.points.removeFromParent();
  }
}
