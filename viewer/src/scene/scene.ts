/** Ties a run and the page's state to what the viewport draws. */
import * as THREE from "three";
import { NEVER, type MapState } from "../data/history.ts";
import { OCCUPIED, type Plan, type Pose, type Vec3 } from "../data/run.ts";
import { LABEL_COLORS, normalColor, parseHex, scanColor, shareColor, viridis, type Rgb } from "../model/colors.ts";
import { pickVoxel } from "../model/faces.ts";
import type { Session } from "../model/session.ts";
import type { State } from "../model/state.ts";
import { theme } from "../ui/theme.ts";
import { CameraLayer } from "./cameras.ts";
import { disposeTree } from "./geometry.ts";
import { buildFrustum, buildGhost, buildNormals, buildPath, buildSlice, buildSurface, CloudLayer } from "./overlays.ts";
import { Viewport } from "./viewport.ts";
import { sunlight } from "./voxel_light.ts";
import { VoxelLayer } from "./voxels.ts";

const MODES = { hide: 0, fade: 1, show: 2 } as const;
const LABEL_RGB = LABEL_COLORS.map(parseHex);
const GREY: Rgb = [120, 124, 130];
const PICK_RADIUS = 14; // CSS pixels
const MIN_FACES = 20_000; // fewer are always drawn in full

export class SceneView {
  readonly viewport: Viewport;
  private voxels!: VoxelLayer;
  private cameras!: CameraLayer;
  private cloud: CloudLayer | null = null;
  /** The data that cloud and surface were built from: a live run may bring others. */
  private builtFrom: { cloud: unknown; mesh: unknown } = { cloud: null, mesh: null };
  private built: Partial<Record<"path" | "frustum" | "normals" | "slice" | "mesh" | "truth", THREE.Object3D>> = {};
  private readonly root = new THREE.Group();
  private readonly marker: THREE.LineSegments;
  private seen = new Uint8Array(0);
  private runId: unknown = null;
  /** Whether there were candidates to make room for. */
  private framedFor = "";

  constructor(
    element: HTMLElement,
    private readonly session: Session,
  ) {
    this.viewport = new Viewport(element);
    this.viewport.scene.add(this.root);
    this.viewport.beforeFrame = () => this.chooseDetail();
    const cube = new THREE.EdgesGeometry(new THREE.BoxGeometry(1.04, 1.04, 1.04));
    this.marker = new THREE.LineSegments(cube, new THREE.LineBasicMaterial({ depthTest: false }));
    this.marker.renderOrder = 10;
    this.marker.visible = false;
    this.setRun();
    this.listen();
    session.store.subscribe((state, changed) => this.update(state, changed));
    theme.subscribe(() => this.update(session.store.state, new Set(Object.keys(session.store.state) as never[])));
  }

  /** Where candidate `index` is on the canvas. */
  screenOfView(index: number): { x: number; y: number } | null {
    return this.viewport.project(this.cameras.positions[index]);
  }

  get faceCount(): number {
    return this.voxels.faceCount;
  }

  private get run() {
    return this.session.run;
  }

  /** Layers that belong to the run as a whole. */
  private setRun(): void {
    for (const child of [...this.root.children]) if (child !== this.marker) disposeTree(child);
    this.built = {};
    this.cloud = null;
    const { grid, candidates, camera } = this.run;
    this.voxels = new VoxelLayer(grid);
    this.cameras = new CameraLayer(candidates, camera, this.glyphSize());
    this.root.add(this.voxels.group, this.cameras.group, this.marker, this.enclosureBox());
    const framedFor = `${candidates.count > 0}`;
    if (this.runId !== this.session.runId || this.framedFor !== framedFor) {
      this.runId = this.session.runId;
      this.framedFor = framedFor;
      const target = new THREE.Vector3(...this.enclosureCenter());
      const reach = Math.max(...this.cameras.positions.map((p) => p.distanceTo(target)), this.enclosureRadius());
      this.viewport.frame(target, Math.min(reach * 1.04, 6 * this.enclosureRadius()));
    }
  }

  private enclosureCenter(): Vec3 {
    const { origin, voxel, enclosureMin, enclosureSize } = this.run.grid;
    return [0, 1, 2].map((a) => origin[a] + (enclosureMin[a] + enclosureSize[a] / 2) * voxel) as Vec3;
  }

  private enclosureRadius(): number {
    return (Math.hypot(...this.run.grid.enclosureSize) * this.run.grid.voxel) / 2;
  }

  private glyphSize(): number {
    const { count, center, poses } = this.run.candidates;
    if (count === 0) return 0.1;
    const radius = Math.hypot(poses[0] - center[0], poses[1] - center[1], poses[2] - center[2]);
    return Math.min(0.085, 0.55 / Math.sqrt(count)) * Math.max(radius, this.enclosureRadius());
  }

  private enclosureBox(): THREE.Object3D {
    const { enclosureSize, voxel } = this.run.grid;
    const box = new THREE.BoxGeometry(...(enclosureSize.map((n) => n * voxel) as Vec3));
    const material = new THREE.LineBasicMaterial({ color: theme.color("line"), transparent: true, opacity: 0.55 });
    const lines = new THREE.LineSegments(new THREE.EdgesGeometry(box), material);
    lines.position.set(...this.enclosureCenter());
    return lines;
  }

  private chooseDetail(): void {
    const { camera, rows, block } = this.viewport;
    const quick = block > 0 && this.faceCount > MIN_FACES;
    if (quick) this.voxels.showPoints(camera, rows, block);
    else this.voxels.showFaces(camera);
    this.cameras.showOutlines(!quick);
  }

  private update(state: State, changed: ReadonlySet<keyof State>): void {
    const has = (...keys: (keyof State)[]) => keys.some((k) => changed.has(k));
    if (this.session.takeNewRun() || this.cameras.candidates !== this.run.candidates) this.setRun();
    this.viewport.setBackground(theme.color("scene"));
    if (this.run.scans.length === 0) return;
    const map = this.session.map(state.step);
    if (has("step", "layers")) this.markSeen(state);
    if (has("step", "labels", "slice")) {
      this.voxels.build(map.labels, state.labels.map((m) => MODES[m]), this.cut(state), this.colorOf(state, map));
    } else if (has("coloring", "layers")) {
      this.voxels.paint(this.colorOf(state, map));
    }
    if (has("step", "quantity", "layers", "selection")) this.paintCameras(state);
    if (has("step", "layers", "slice")) this.rebuildOverlays(state, map);
    this.showSelection(state);
    this.viewport.requestFrame();
  }

  private cut(state: State): (x: number, y: number, z: number) => boolean {
    const { slice } = state;
    if (!slice) return () => false;
    return (x, y, z) => (slice.axis === 0 ? x : slice.axis === 1 ? y : z) > slice.index;
  }

  private markSeen(state: State): void {
    const [x, y, z] = this.run.grid.enclosureSize;
    this.seen = new Uint8Array(x * y * z);
    for (const v of this.run.scans[state.step].surface.voxels) this.seen[v] = 1;
  }

  private colorOf(state: State, map: MapState): (voxel: number) => { rgb: Rgb; shade: number | null } {
    const scans = this.run.scans.length;
    const { normals, quality, firstScan, labels } = map;
    return (v) => {
      const label = labels[v];
      if (label !== OCCUPIED) return { rgb: LABEL_RGB[label], shade: null };
      const [nx, ny, nz] = [normals[3 * v] / 127, normals[3 * v + 1] / 127, normals[3 * v + 2] / 127];
      const known = nx !== 0 || ny !== 0 || nz !== 0;
      let rgb = LABEL_RGB[OCCUPIED];
      if (state.coloring === "quality") rgb = viridis(quality[v] / 255);
      else if (state.coloring === "normal") rgb = known ? normalColor(nx, ny, nz) : GREY;
      else if (state.coloring === "scan") rgb = firstScan[v] === NEVER ? GREY : scanColor(firstScan[v], scans);
      if (state.layers.seen && !this.seen[v]) rgb = GREY;
      // Where colours are numbers, the sun must not bleach them.
      const light = Math.min(state.coloring === "label" ? Infinity : 1, sunlight(nx, ny, nz));
      return { rgb, shade: known ? light : null };
    };
  }

  private paintCameras(state: State): void {
    this.cameras.group.visible = state.layers.candidates;
    const plan = this.session.planAt(state.step)?.plan ?? null;
    const values = plan ? this.session.quantityOf(plan, state.quantity) : null;
    const highest = values ? this.session.highest(values, plan!) : 0;
    const selected = state.selection?.kind === "view" ? state.selection.index : -1;
    this.cameras.setOutline(theme.color("line"));
    this.cameras.paint((i) => {
      if (i === selected) return { rgb: parseHex(theme.color("select")), alpha: 1 };
      if (plan?.chosen === i) return { rgb: parseHex(theme.color("chosen")), alpha: 1 };
      if (!plan || !values || Number.isNaN(values[i])) return { rgb: GREY, alpha: 0.75 };
      if (plan.infeasible[i]) return { rgb: GREY, alpha: 0.3 };
      const share = highest > 0 ? values[i] / highest : 0;
      return { rgb: shareColor(share), alpha: 0.72 + 0.28 * share };
    });
  }

  private replace(key: keyof SceneView["built"], object: THREE.Object3D | null): void {
    const old = this.built[key];
    if (old) disposeTree(old);
    delete this.built[key];
    if (!object) return;
    this.built[key] = object;
    this.root.add(object);
  }

  private rebuildOverlays(state: State, map: MapState): void {
    const { run } = this;
    const { layers, step, slice } = state;
    const colors = { commanded: theme.color("commanded"), registered: theme.color("registered") };
    const onSphere = run.candidates.kind === "sphere";
    const { center } = run.candidates;
    this.replace("path", layers.path ? buildPath(run.scans, step, center, onSphere, this.glyphSize(), colors) : null);
    const pose = run.scans[step].registered ?? run.scans[step].believed;
    const depth = Math.min(run.camera.max_depth, this.distanceToCenter(pose));
    this.replace("frustum", layers.frustum ? buildFrustum(run.camera, pose, depth, theme.color("chosen")) : null);
    this.replace("normals", layers.normals ? buildNormals(map, run.grid, this.cut(state)) : null);
    this.replace("slice", slice ? buildSlice(map, run.grid, slice.axis, slice.index) : null);
    if (layers.mesh !== !!this.built.mesh || run.mesh !== this.builtFrom.mesh) {
      this.builtFrom.mesh = run.mesh;
      this.replace("mesh", layers.mesh && run.mesh ? buildSurface(run.mesh) : null);
    }
    this.replace("truth", layers.truth && run.truth ? buildGhost(run.truth, theme.color("ghost")) : null);
    if (this.cloud && run.cloud !== this.builtFrom.cloud) {
      disposeTree(this.cloud.points);
      this.cloud = null;
    }
    if (layers.cloud && run.cloud && !this.cloud) {
      this.builtFrom.cloud = run.cloud;
      this.cloud = new CloudLayer(run.cloud, run.scans.length);
      this.root.add(this.cloud.points);
    }
    if (this.cloud) {
      this.cloud.points.visible = layers.cloud;
      this.cloud.setStep(step);
    }
  }

  private distanceToCenter(pose: Pose): number {
    const c = this.enclosureCenter();
    return Math.hypot(pose[0] - c[0], pose[1] - c[1], pose[2] - c[2]);
  }

  private showSelection(state: State): void {
    const { selection } = state;
    this.marker.visible = selection?.kind === "voxel";
    if (selection?.kind !== "voxel") return;
    const { grid } = this.run;
    const [nx, ny] = grid.enclosureSize;
    const v = selection.index;
    const index = [v % nx, Math.floor(v / nx) % ny, Math.floor(v / (nx * ny))];
    this.marker.position.fromArray(index.map((i, a) => grid.origin[a] + (grid.enclosureMin[a] + i + 0.5) * grid.voxel));
    this.marker.scale.setScalar(grid.voxel);
    (this.marker.material as THREE.LineBasicMaterial).color.set(theme.color("select"));
  }

  /** What lies under a point of the canvas: the nearest view within a few pixels, or the first voxel. */
  pick(x: number, y: number): State["selection"] {
    const { state } = this.session.store;
    const voxel = this.pickVoxel(x, y, state);
    let view: { index: number; distance: number; depth: number } | null = null;
    if (state.layers.candidates) {
      this.cameras.positions.forEach((position, index) => {
        const p = this.viewport.project(position);
        if (!p) return;
        const distance = Math.hypot(p.x - x, p.y - y);
        if (distance > PICK_RADIUS || (voxel && voxel.depth < p.depth)) return;
        const closer = !view || distance < view.distance - 4 || (distance < view.distance + 4 && p.depth < view.depth);
        if (closer) view = { index, distance, depth: p.depth };
      });
    }
    if (view) return { kind: "view", index: (view as { index: number }).index };
    return voxel ? { kind: "voxel", index: voxel.index } : null;
  }

  private pickVoxel(x: number, y: number, state: State): { index: number; depth: number } | null {
    if (this.run.scans.length === 0) return null;
    const { grid } = this.run;
    const ray = this.viewport.ray(x, y);
    const origin = this.voxels.group.worldToLocal(ray.origin.clone()).toArray() as Vec3;
    const direction = ray.direction.toArray() as Vec3;
    const cut = this.cut(state);
    const shown = (label: number, i: number, j: number, k: number) => state.labels[label] !== "hide" && !cut(i, j, k);
    const hit = pickVoxel(this.session.map(state.step).labels, grid.enclosureSize, shown, origin, direction);
    return hit && { index: hit.voxel, depth: hit.t * grid.voxel };
  }

  private listen(): void {
    const { canvas } = this.viewport;
    let down: { x: number; y: number } | null = null;
    canvas.addEventListener("pointerdown", (e) => (down = { x: e.offsetX, y: e.offsetY }));
    canvas.addEventListener("pointerup", (e) => {
      if (!down || Math.hypot(e.offsetX - down.x, e.offsetY - down.y) > 4) return;
      this.session.store.set({ selection: this.pick(e.offsetX, e.offsetY) });
    });
    canvas.addEventListener("dblclick", () => this.viewport.goHome());
  }
}

export type { Plan };
