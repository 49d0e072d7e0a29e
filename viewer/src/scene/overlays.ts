/** What is around and inside the voxels: path, frustum, normals, slice, cloud and surfaces. Built again when they change. */
import * as THREE from "three";
import { OCCUPIED, type Camera, type Cloud, type Grid, type Mesh, type Pose, type Scan, type Vec3 } from "../data/run.ts";
import type { MapState } from "../data/history.ts";
import { LABEL_COLORS, normalColor, parseHex, scanColor, type Rgb } from "../model/colors.ts";
import { arc, imageCorners, matrixOf, positionOf, tube } from "./geometry.ts";

export interface PathColors {
  commanded: string;
  registered: string;
}

/** Poses of the scans up to `step`: where the robot was sent (line) and where registration found it (balls, joined). */
export function buildPath(
  scans: Scan[],
  step: number,
  center: Vec3,
  onSphere: boolean,
  size: number,
  colors: PathColors,
): THREE.Group {
  const group = new THREE.Group();
  const middle = new THREE.Vector3(...center);
  const line = new THREE.MeshBasicMaterial({ color: colors.commanded });
  const found = new THREE.MeshBasicMaterial({ color: colors.registered });
  const failed = new THREE.MeshBasicMaterial({ color: "#808080" });
  for (let k = 0; k <= step; ++k) {
    const commanded = positionOf(scans[k].commanded);
    if (k > 0) {
      const points = arc(positionOf(scans[k - 1].commanded), commanded, middle, onSphere);
      if (points[0].distanceTo(points[points.length - 1]) > 1e-6) group.add(tube(points, 0.07 * size, line));
    }
    const registered = scans[k].registered;
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.3 * size, 14, 10), registered ? found : failed);
    ball.position.copy(registered ? positionOf(registered) : commanded);
    group.add(ball);
    if (registered && ball.position.distanceTo(commanded) > 1e-4) {
      group.add(tube([commanded, ball.position], 0.06 * size, found));
    }
  }
  return group;
}

/** The frustum of a view, from its tip to `depth` along the axis. */
export function buildFrustum(camera: Camera, pose: Pose, depth: number, color: string): THREE.Group {
  const far = imageCorners(camera, depth);
  const tip = new THREE.Vector3();
  const lines = [0, 1, 2, 3].flatMap((k) => [tip, far[k], far[k], far[(k + 1) % 4]]);
  const group = new THREE.Group();
  group.add(
    new THREE.LineSegments(
      new THREE.BufferGeometry().setFromPoints(lines),
      new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.9 }),
    ),
  );
  const sides = [0, 1, 2, 3].flatMap((k) => [tip, far[k], far[(k + 1) % 4]]);
  const glass = new THREE.MeshBasicMaterial({
    color,
    transparent: true,
    opacity: 0.05,
    side: THREE.DoubleSide,
    depthWrite: false,
  });
  const mesh = new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(sides), glass);
  mesh.renderOrder = 6;
  group.add(mesh);
  group.applyMatrix4(matrixOf(pose));
  return group;
}

/** A stroke along the normal of every occupied voxel that has one. */
export function buildNormals(map: MapState, grid: Grid, isCut: (x: number, y: number, z: number) => boolean): THREE.LineSegments {
  const [nx, ny] = grid.enclosureSize;
  const points: number[] = [];
  const colors: number[] = [];
  for (let v = 0; v < map.labels.length; ++v) {
    if (map.labels[v] !== OCCUPIED) continue;
    const index = [v % nx, Math.floor(v / nx) % ny, Math.floor(v / (nx * ny))];
    const n = [0, 1, 2].map((a) => map.normals[3 * v + a] / 127);
    if ((n[0] === 0 && n[1] === 0 && n[2] === 0) || isCut(index[0], index[1], index[2])) continue;
    const from = index.map((i, a) => grid.origin[a] + (grid.enclosureMin[a] + i + 0.5) * grid.voxel);
    points.push(...from, ...from.map((c, a) => c + 1.8 * grid.voxel * n[a]));
    const rgb = normalColor(n[0], n[1], n[2]).map((c) => (0.85 * c) / 255);
    colors.push(...rgb, ...rgb);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
}

/** The labels of one plane of voxels as a picture in its place. */
export function buildSlice(map: MapState, grid: Grid, axis: 0 | 1 | 2, index: number): THREE.Mesh {
  const size = grid.enclosureSize;
  const [u, w] = [(axis + 1) % 3, (axis + 2) % 3];
  const strides = [1, size[0], size[0] * size[1]];
  const pixels = new Uint8Array(4 * size[u] * size[w]);
  const palette = LABEL_COLORS.map(parseHex);
  for (let j = 0, p = 0; j < size[w]; ++j) {
    for (let i = 0; i < size[u]; ++i, p += 4) {
      const label = map.labels[index * strides[axis] + i * strides[u] + j * strides[w]];
      pixels.set([...palette[label], label === 2 ? 70 : 255], p);
    }
  }
  const texture = new THREE.DataTexture(pixels, size[u], size[w]);
  texture.magFilter = texture.minFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  const corner = (i: number, j: number) => {
    const at: Vec3 = [0, 0, 0];
    at[axis] = index + 1.002; // just above the voxels that are cut open
    at[u] = i * size[u];
    at[w] = j * size[w];
    return at.map((c, a) => grid.origin[a] + (grid.enclosureMin[a] + c) * grid.voxel);
  };
  const geometry = new THREE.BufferGeometry();
  const corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners.flat(), 3));
  geometry.setAttribute("uv", new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const material = new THREE.MeshBasicMaterial({ map: texture, transparent: true, side: THREE.DoubleSide });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = 4;
  return mesh;
}

/** The fused cloud, its points in the order of their scans, so that an earlier moment is a shorter draw. */
export class CloudLayer {
  readonly points: THREE.Points;
  private readonly ends: number[] = [];

  constructor(cloud: Cloud, scans: number) {
    const count = cloud.points.length / 3;
    const order = Uint32Array.from({ length: count }, (_, i) => i);
    const scanOf = cloud.scanOfPoint;
    if (scanOf) order.sort((a, b) => scanOf[a] - scanOf[b] || a - b);
    const positions = new Float32Array(3 * count);
    const colors = new Uint8Array(3 * count);
    order.forEach((from, to) => {
      for (let a = 0; a < 3; ++a) positions[3 * to + a] = cloud.points[3 * from + a];
      const base: Rgb = scanOf ? scanColor(scanOf[from], scans) : [120, 160, 200];
      const n = cloud.normals ? [0, 1, 2].map((a) => cloud.normals![3 * from + a] / 127) : null;
      const light = n ? 0.62 + 0.38 * Math.max(0, -0.35 * n[0] - 0.55 * n[1] + 0.75 * n[2]) : 1;
      for (let c = 0; c < 3; ++c) colors[3 * to + c] = base[c] * light;
    });
    for (let k = 0, end = 0; k < scans; ++k) {
      if (scanOf) while (end < count && scanOf[order[end]] <= k) ++end;
      this.ends.push(scanOf ? end : count);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3, true));
    const material = new THREE.PointsMaterial({ vertexColors: true, size: 2, sizeAttenuation: false });
    this.points = new THREE.Points(geometry, material);
  }

  setStep(step: number): void {
    this.points.geometry.setDrawRange(0, this.ends[step] ?? 0);
  }
}

function meshGeometry(mesh: Mesh): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.vertices, 3));
  geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
  geometry.computeVertexNormals();
  return geometry;
}

export function buildSurface(mesh: Mesh): THREE.Mesh {
  return new THREE.Mesh(
    meshGeometry(mesh),
    new THREE.MeshLambertMaterial({ color: "#d9a066", side: THREE.DoubleSide }),
  );
}

/** The true surface as a ghost: clear where it faces the eye, visible along its outline. */
export function buildGhost(mesh: Mesh, color: string): THREE.Mesh {
  const material = new THREE.ShaderMaterial({
    uniforms: { color: { value: new THREE.Color(color) } },
    vertexShader: /* glsl */ `
      varying vec3 n;
      varying vec3 eye;
      void main() {
        vec4 p = modelViewMatrix * vec4(position, 1.0);
        n = normalMatrix * normal;
        eye = -p.xyz;
        gl_Position = projectionMatrix * p;
      }`,
    fragmentShader: /* glsl */ `
      uniform vec3 color;
      varying vec3 n;
      varying vec3 eye;
      void main() {
        float rim = 1.0 - abs(dot(normalize(n), normalize(eye)));
        gl_FragColor = vec4(color, 0.06 + 0.6 * rim * rim);
      }`,
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
  const ghost = new THREE.Mesh(meshGeometry(mesh), material);
  ghost.renderOrder = 7;
  return ghost;
}
