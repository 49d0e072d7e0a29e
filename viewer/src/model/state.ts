/** What the page shows, and who wants to know when that changes. */
import { LABELS } from "../data/run.ts";

export type LabelMode = "hide" | "fade" | "show";
export const COLORINGS = ["label", "quality", "normal", "scan"] as const;
export type Coloring = (typeof COLORINGS)[number];
export const QUANTITIES = ["utility", "f_area", "f_navigation", "f_quality", "f_occlusion", "n_op"] as const;
export type Quantity = (typeof QUANTITIES)[number];
export const LAYERS = ["normals", "cloud", "mesh", "truth", "candidates", "path", "frustum", "seen"] as const;
export type Layer = (typeof LAYERS)[number];

export type Selection = { kind: "view"; index: number } | { kind: "voxel"; index: number } | null;

export interface State {
  /** Scan after which the map is shown. */
  step: number;
  playing: boolean;
  labels: LabelMode[];
  coloring: Coloring;
  /** Slice through all labels; voxels beyond it are cut away. */
  slice: { axis: 0 | 1 | 2; index: number } | null;
  layers: Record<Layer, boolean>;
  quantity: Quantity;
  selection: Selection;
}

export function initialState(): State {
  return {
    step: 0,
    playing: false,
    labels: LABELS.map((label): LabelMode => (label === "occupied" ? "show" : label === "occplane" ? "fade" : "hide")),
    coloring: "label",
    slice: null,
    layers: {
      normals: false,
      cloud: false,
      mesh: false,
      truth: false,
      candidates: true,
      path: true,
      frustum: true,
      seen: false,
    },
    quantity: "utility",
    selection: null,
  };
}

export type Listener = (state: State, changed: ReadonlySet<keyof State>) => void;

/** Holds the state; listeners hear of changes once per change, in the order they came. */
export class Store {
  private listeners: Listener[] = [];
  constructor(public state: State = initialState()) {}

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
  }

  set(change: Partial<State>): void {
    const changed = new Set<keyof State>();
    for (const key of Object.keys(change) as (keyof State)[]) {
      if (this.state[key] !== change[key]) changed.add(key);
    }
    if (changed.size === 0) return;
    this.state = { ...this.state, ...change };
    for (const listener of this.listeners) listener(this.state, changed);
  }

  /** Tells every listener that everything may be different: the run itself changed. */
  refresh(): void {
    const all = new Set(Object.keys(this.state) as (keyof State)[]);
    for (const listener of this.listeners) listener(this.state, all);
  }

  setLayer(layer: Layer, on: boolean): void {
    this.set({ layers: { ...this.state.layers, [layer]: on } });
  }

  setLabel(label: number, mode: LabelMode): void {
    this.set({ labels: this.state.labels.map((m, i) => (i === label ? mode : m)) });
  }
}
