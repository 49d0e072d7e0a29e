/** Small shapes shared by the layers of the scene. */
import * as THREE from "three";
import type { Camera, Pose } from "../data/run.ts";

export function matrixOf(pose: ArrayLike<number>, offset = 0): THREE.Matrix4 {
  return new THREE.Matrix4().compose(
    new THREE.Vector3(pose[offset], pose[offset + 1], pose[offset + 2]),
    new THREE.Quaternion(pose[offset + 3], pose[offset + 4], pose[offset + 5], pose[offset + 6]),
    new THREE.Vector3(1, 1, 1),
  );
}

export const positionOf = (pose: Pose) => new THREE.Vector3(pose[0], pose[1], pose[2]);

/** Corners of the image at depth `z` in the sensor's frame, clockwise from the upper left. */
export function imageCorners(camera: Camera, z: number): THREE.Vector3[] {
  return [
    [camera.left, camera.top],
    [camera.right, camera.top],
    [camera.right, camera.bottom],
    [camera.left, camera.bottom],
  ].map(([x, y]) => new THREE.Vector3(x * z, y * z, z));
}

/** Points from a to b: along the great circle about `center` where both are about as far from it, otherwise straight. */
export function arc(a: THREE.Vector3, b: THREE.Vector3, center: THREE.Vector3, onSphere: boolean): THREE.Vector3[] {
  const [u, v] = [a.clone().sub(center), b.clone().sub(center)];
  const [ru, rv] = [u.length(), v.length()];
  const angle = u.angleTo(v);
  if (!onSphere || angle < 1e-3 || angle > Math.PI - 1e-3 || Math.min(ru, rv) === 0) return [a, b];
  const steps = Math.max(2, Math.ceil(angle / 0.06));
  return Array.from({ length: steps + 1 }, (_, i) => {
    const t = i / steps;
    const p = u.clone().multiplyScalar(Math.sin((1 - t) * angle) / ru);
    p.addScaledVector(v, Math.sin(t * angle) / rv);
    return p.multiplyScalar((ru + (rv - ru) * t) / Math.sin(angle)).add(center);
  });
}

export function disposeTree(root: THREE.Object3D): void {
  root.traverse((object) => {
    if (object instanceof THREE.Mesh || object instanceof THREE.Line || object instanceof THREE.Points) {
      object.geometry.dispose();
      (object.material as THREE.Material).dispose();
    }
  });
  root.removeFromParent();
}

/** A tube along points: lines are one pixel wide in WebGL, too thin for a path. */
export function tube(points: THREE.Vector3[], radius: number, material: THREE.Material): THREE.Mesh {
  const curve = new THREE.CurvePath<THREE.Vector3>();
  for (let i = 1; i < points.length; ++i) curve.add(new THREE.LineCurve3(points[i - 1], points[i]));
  return new THREE.Mesh(new THREE.TubeGeometry(curve, Math.max(2, points.length - 1) * 2, radius, 5), material);
}
