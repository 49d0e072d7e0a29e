/** A run as the page uses it: RunData of docs/report-data.md, checked and decoded. */
import { asObject, DataError, fail, unpack } from "./packed.ts";

export const LABELS = ["unmarked", "occupied", "empty", "occluded", "occplane"] as const;
export type LabelName = (typeof LABELS)[number];
export const UNMARKED = 0;
export const OCCUPIED = 1;
export const EMPTY = 2;

export type Vec3 = [number, number, number];
/** x, y, z, qx, qy, qz, qw; world from sensor. */
export type Pose = [number, number, number, number, number, number, number];

export interface Meta {
  command: string;
  object: string;
  program: string;
  options: [string, string][];
  seed: number | null;
  state: "running" | "waiting" | "finished";
  simulated: boolean;
}

export interface Grid {
  origin: Vec3;
  voxel: number;
  size: Vec3;
  /** Lowest index of the enclosure and its number of voxels per axis. */
  enclosureMin: Vec3;
  enclosureSize: Vec3;
}

export interface Camera {
  columns: number;
  rows: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  min_depth: number;
  max_depth: number;
}

export interface Candidates {
  kind: "sphere" | "grid" | "list";
  text: string;
  center: Vec3;
  count: number;
  poses: Float32Array;
  grid: { cellsPerSide: number; spacing: Vec3; cells: Uint16Array } | null;
}

export interface Plan {
  chosen: number | null;
  utility: Float32Array;
  convolved: Float32Array | null;
  n_oc: Uint32Array;
  n_op: Uint32Array;
  n_um: Uint32Array;
  f_area: Float32Array;
  f_navigation: Float32Array;
  f_quality: Float32Array;
  f_occlusion: Float32Array;
  infeasible: Uint8Array;
  reasons: string[];
}

/** The numeric columns of views.csv; null where a number does not exist. */
export const SCAN_NUMBERS = [
  "n_oc", "n_op", "n_um", "f_area", "f_navigation", "f_quality", "f_occlusion", "utility",
  "occupied", "occplane", "unmarked", "new_occupied", "mean_quality", "distance", "coverage",
  "coverage_all", "overlap", "residual",
] as const; // prettier-ignore
export type ScanNumber = (typeof SCAN_NUMBERS)[number];

export interface Scan extends Record<ScanNumber, number | null> {
  scan: number;
  candidate: number | null;
  commanded: Pose;
  believed: Pose;
  registered: Pose | null;
  true_pose: Pose | null;
  verdict: string;
  reason: string;
  plan: Plan | null;
  /** Per voxel of the enclosure 0 = as before, otherwise 1 + new label. */
  labels: Uint8Array;
  surface: { voxels: Uint32Array; normals: Int8Array; quality: Uint8Array };
  milliseconds: [string, number][];
}

export interface Cloud {
  points: Float32Array;
  normals: Int8Array | null;
  scanOfPoint: Uint16Array | null;
  total: number;
}

export interface Mesh {
  vertices: Float32Array;
  triangles: Uint32Array;
  total: number;
}

export interface Summary {
  views: number | null;
  occupied: number | null;
  mean_quality: number | null;
  distance: number | null;
  coverage: number | null;
  coverage_all: number | null;
}

export interface Run {
  meta: Meta;
  grid: Grid;
  camera: Camera;
  candidates: Candidates;
  scans: Scan[];
  next: Plan | null;
  stop_reason: string;
  summary: Summary | null;
  cloud: Cloud | null;
  mesh: Mesh | null;
  truth: Mesh | null;
  revision: number;
}

function text(value: unknown, field: string, fallback?: string): string {
  if (typeof value === "string") return value;
  if (fallback !== undefined && (value === undefined || value === null)) return fallback;
  return fail(field, "must be text");
}

function number(value: unknown, field: string): number {
  if (typeof value !== "number" || !Number.isFinite(value)) fail(field, `is ${JSON.stringify(value)}, must be a number`);
  return value;
}

const numberOrNull = (value: unknown, field: string) =>
  value === undefined || value === null ? null : number(value, field);

function numbers<T extends number[]>(value: unknown, count: number, field: string): T {
  if (!Array.isArray(value) || value.length !== count) fail(field, `must be ${count} numbers`);
  return value.map((x, i) => number(x, `${field}[${i}]`)) as T;
}

function pose(value: unknown, field: string): Pose {
  const p = numbers<Pose>(value, 7, field);
  const norm = Math.hypot(p[3], p[4], p[5], p[6]);
  if (Math.abs(norm - 1) > 1e-3) fail(field, `its quaternion has length ${norm}, must be 1`);
  return p;
}

const poseOrNull = (value: unknown, field: string) =>
  value === undefined || value === null ? null : pose(value, field);

function oneOf<T extends string>(value: unknown, choices: readonly T[], field: string): T {
  if (!choices.includes(value as T)) fail(field, `is ${JSON.stringify(value)}, must be one of ${choices.join(", ")}`);
  return value as T;
}

export const decodeState = (value: unknown, field: string): Meta["state"] =>
  oneOf(value, ["running", "waiting", "finished"] as const, field);

function decodeMeta(value: unknown): Meta {
  const meta = asObject(value, "meta");
  return {
    command: text(meta["command"], "meta.command"),
    object: text(meta["object"], "meta.object"),
    program: text(meta["program"], "meta.program", ""),
    options: Object.entries(asObject(meta["options"] ?? {}, "meta.options")).map(([k, v]) => [k, String(v)]),
    seed: numberOrNull(meta["seed"], "meta.seed"),
    state: decodeState(meta["state"], "meta.state"),
    simulated: meta["simulated"] === true,
  };
}

/** More voxels in the enclosure than this are no scene that a browser could hold. */
const MAX_VOXELS = 2 ** 28;

function decodeGrid(value: unknown): Grid {
  const grid = asObject(value, "grid");
  const voxel = number(grid["voxel"], "grid.voxel");
  if (voxel <= 0) fail("grid.voxel", `is ${voxel}, must be positive`);
  const box = numbers<number[]>(grid["enclosure"], 6, "grid.enclosure");
  const min = box.slice(0, 3) as Vec3;
  const size = [0, 1, 2].map((a) => box[3 + a] - box[a] + 1) as Vec3;
  if (size.some((n) => !Number.isInteger(n) || n < 1)) fail("grid.enclosure", `is [${box}], must be x0 y0 z0 x1 y1 z1`);
  if (size[0] * size[1] * size[2] > MAX_VOXELS) fail("grid.enclosure", `has ${size.join(" x ")} voxels, too many to show`);
  return {
    origin: numbers<Vec3>(grid["origin"], 3, "grid.origin"),
    voxel,
    size: numbers<Vec3>(grid["size"], 3, "grid.size"),
    enclosureMin: min,
    enclosureSize: size,
  };
}

export function decodeCamera(value: unknown): Camera {
  const camera = asObject(value, "camera");
  const read = (key: keyof Camera) => number(camera[key], `camera.${key}`);
  return {
    columns: read("columns"),
    rows: read("rows"),
    left: read("left"),
    right: read("right"),
    top: read("top"),
    bottom: read("bottom"),
    min_depth: read("min_depth"),
    max_depth: read("max_depth"),
  };
}

export function decodeCandidates(value: unknown): Candidates {
  const raw = asObject(value, "candidates");
  const poses = unpack(raw["poses"], "f32", "candidates.poses", 7);
  const count = poses.length / 7;
  const kind = oneOf(raw["kind"], ["sphere", "grid", "list"] as const, "candidates.kind");
  const grid =
    kind === "grid"
      ? {
          cellsPerSide: number(raw["cells_per_side"], "candidates.cells_per_side"),
          spacing: numbers<Vec3>(raw["spacing"], 3, "candidates.spacing"),
          cells: unpack(raw["cells"], "u16", "candidates.cells", 3, count),
        }
      : null;
  const center = numbers<Vec3>(raw["center"], 3, "candidates.center");
  return { kind, text: text(raw["text"], "candidates.text", ""), center, count, poses, grid };
}

export function decodePlan(value: unknown, count: number, field: string): Plan {
  const plan = asObject(value, field);
  const floats = (key: string) => unpack(plan[key], "f32", `${field}.${key}`, 1, count);
  const counts = (key: string) => unpack(plan[key], "u32", `${field}.${key}`, 1, count);
  const chosen = numberOrNull(plan["chosen"], `${field}.chosen`);
  if (chosen !== null && !(Number.isInteger(chosen) && chosen >= 0 && chosen < count)) {
    fail(`${field}.chosen`, `is ${chosen}, but there are ${count} candidates`);
  }
  const reasons = plan["reasons"] ?? [];
  if (!Array.isArray(reasons)) fail(`${field}.reasons`, "must be a list of texts");
  const infeasible = unpack(plan["infeasible"], "u8", `${field}.infeasible`, 1, count);
  if (infeasible.some((r) => r > reasons.length)) fail(`${field}.infeasible`, "names a reason that is not there");
  return {
    chosen,
    utility: floats("utility"),
    convolved: plan["convolved"] ? floats("convolved") : null,
    n_oc: counts("n_oc"),
    n_op: counts("n_op"),
    n_um: counts("n_um"),
    f_area: floats("f_area"),
    f_navigation: floats("f_navigation"),
    f_quality: floats("f_quality"),
    f_occlusion: floats("f_occlusion"),
    infeasible,
    reasons: reasons.map(String),
  };
}

/** One scan record; `index` is the place it must have among the scans. */
export function decodeScan(value: unknown, index: number, grid: Grid, candidates: number): Scan {
  const field = `scans[${index}]`;
  const raw = asObject(value, field);
  const scan = number(raw["scan"], `${field}.scan`);
  if (scan !== index) fail(`${field}.scan`, `is ${scan}, must be ${index}`);
  const candidate = numberOrNull(raw["candidate"], `${field}.candidate`);
  if (candidate !== null && !(candidate >= 0 && candidate < candidates)) {
    fail(`${field}.candidate`, `is ${candidate}, but there are ${candidates} candidates`);
  }
  const voxels = grid.enclosureSize[0] * grid.enclosureSize[1] * grid.enclosureSize[2];
  const labels = unpack(raw["labels"], "u8", `${field}.labels`, 1, voxels);
  if (labels.some((l) => l > LABELS.length)) fail(`${field}.labels`, "holds a label above 4");
  const surface = asObject(raw["surface"], `${field}.surface`);
  const seen = unpack(surface["voxels"], "u32", `${field}.surface.voxels`);
  if (seen.some((v) => v >= voxels)) fail(`${field}.surface.voxels`, "names a voxel outside of the enclosure");
  const values = Object.fromEntries(SCAN_NUMBERS.map((k) => [k, numberOrNull(raw[k], `${field}.${k}`)]));
  return {
    ...(values as Record<ScanNumber, number | null>),
    scan,
    candidate,
    commanded: pose(raw["commanded"], `${field}.commanded`),
    believed: pose(raw["believed"], `${field}.believed`),
    registered: poseOrNull(raw["registered"], `${field}.registered`),
    true_pose: poseOrNull(raw["true_pose"], `${field}.true_pose`),
    verdict: text(raw["verdict"], `${field}.verdict`, ""),
    reason: text(raw["reason"], `${field}.reason`, ""),
    plan: raw["plan"] ? decodePlan(raw["plan"], candidates, `${field}.plan`) : null,
    labels,
    surface: {
      voxels: seen,
      normals: unpack(surface["normals"], "i8", `${field}.surface.normals`, 3, seen.length),
      quality: unpack(surface["quality"], "u8", `${field}.surface.quality`, 1, seen.length),
    },
    milliseconds: Object.entries(asObject(raw["milliseconds"] ?? {}, `${field}.milliseconds`)).map(([k, v]) => [
      k,
      number(v, `${field}.milliseconds.${k}`),
    ]),
  };
}

function positions(raw: Record<string, unknown>, key: string, field: string): Float32Array {
  const origin = numbers<Vec3>(raw["origin"], 3, `${field}.origin`);
  const step = number(raw["step"], `${field}.step`);
  const quantised = unpack(raw[key], "u16", `${field}.${key}`, 3);
  return Float32Array.from(quantised, (q, i) => origin[i % 3] + step * q);
}

export function decodeCloud(value: unknown): Cloud {
  const raw = asObject(value, "cloud");
  const points = positions(raw, "points", "cloud");
  const count = points.length / 3;
  return {
    points,
    normals: raw["normals"] ? unpack(raw["normals"], "i8", "cloud.normals", 3, count) : null,
    scanOfPoint: raw["scan_of_point"] ? unpack(raw["scan_of_point"], "u16", "cloud.scan_of_point", 1, count) : null,
    total: numberOrNull(raw["total"], "cloud.total") ?? count,
  };
}

export function decodeMesh(value: unknown, field: string): Mesh {
  const raw = asObject(value, field);
  const vertices = positions(raw, "vertices", field);
  const triangles = unpack(raw["triangles"], "u32", `${field}.triangles`, 3);
  if (triangles.some((v) => v >= vertices.length / 3)) fail(`${field}.triangles`, "names a vertex that is not there");
  return { vertices, triangles, total: numberOrNull(raw["total"], `${field}.total`) ?? triangles.length / 3 };
}

export function decodeSummary(value: unknown): Summary | null {
  if (value === undefined || value === null) return null;
  const raw = asObject(value, "summary");
  const read = (key: keyof Summary) => numberOrNull(raw[key], `summary.${key}`);
  return {
    views: read("views"),
    occupied: read("occupied"),
    mean_quality: read("mean_quality"),
    distance: read("distance"),
    coverage: read("coverage"),
    coverage_all: read("coverage_all"),
  };
}

export function checkVersion(document: Record<string, unknown>): void {
  const version = number(document["version"], "version");
  if (version > 1) throw new DataError(`version: is ${version}, this page reads version 1; use a newer page`);
}

/** RunData from its JSON value. Throws DataError naming the field where it is not as docs/report-data.md says. */
export function decodeRun(value: unknown): Run {
  const raw = asObject(value, "the document");
  if (raw["format"] !== "vantage-run") fail("format", `is ${JSON.stringify(raw["format"])}, must be "vantage-run"`);
  checkVersion(raw);
  const grid = decodeGrid(raw["grid"]);
  const candidates = decodeCandidates(raw["candidates"]);
  if (!Array.isArray(raw["scans"])) fail("scans", "must be a list");
  return {
    meta: decodeMeta(raw["meta"]),
    grid,
    camera: decodeCamera(raw["camera"]),
    candidates,
    scans: raw["scans"].map((scan, i) => decodeScan(scan, i, grid, candidates.count)),
    next: raw["next"] ? decodePlan(raw["next"], candidates.count, "next") : null,
    stop_reason: text(raw["stop_reason"], "stop_reason", ""),
    summary: decodeSummary(raw["summary"]),
    cloud: raw["cloud"] ? decodeCloud(raw["cloud"]) : null,
    mesh: raw["mesh"] ? decodeMesh(raw["mesh"], "mesh") : null,
    truth: raw["truth"] ? decodeMesh(raw["truth"], "truth") : null,
    revision: numberOrNull(raw["revision"], "revision") ?? 0,
  };
}
