/** The map after each scan, rebuilt from the changes that the scans brought. */
import { OCCUPIED, type Run } from "./run.ts";

/** The state of the enclosure's voxels after scan `step`. */
export interface MapState {
  step: number;
  /** Label per voxel, x fastest. */
  labels: Uint8Array;
  /** Times 127; three per voxel; (0,0,0) where unknown. */
  normals: Int8Array;
  /** Times 255. */
  quality: Uint8Array;
  /** Scan that first occupied the voxel, 65535 where not occupied. */
  firstScan: Uint16Array;
}

export const NEVER = 65535;

/**
 * Replays the changes of a run. Going forwards costs one scan's changes; going back starts from the nearest keyframe.
 * Step -1 is the map before the first scan.
 */
export class MapHistory {
  private state: MapState;
  private readonly keyframes = new Map<number, MapState>();
  private readonly voxels: number;

  constructor(
    private readonly run: Run,
    private readonly keyframeEvery = 8,
  ) {
    const [x, y, z] = run.grid.enclosureSize;
    this.voxels = x * y * z;
    this.state = this.blank();
  }

  /** The map after scan `step`, -1 for none. Valid until the next call. */
  at(step: number): MapState {
    if (!(step >= -1 && step < this.run.scans.length)) throw new RangeError(`no scan ${step}`);
    if (step < this.state.step) this.state = this.nearestKeyframe(step);
    while (this.state.step < step) this.advance();
    return this.state;
  }

  private blank(): MapState {
    return {
      step: -1,
      labels: new Uint8Array(this.voxels),
      normals: new Int8Array(3 * this.voxels),
      quality: new Uint8Array(this.voxels),
      firstScan: new Uint16Array(this.voxels).fill(NEVER),
    };
  }

  private nearestKeyframe(step: number): MapState {
    let best: MapState | undefined;
    for (const frame of this.keyframes.values()) {
      if (frame.step <= step && frame.step > (best?.step ?? -1)) best = frame;
    }
    return best ? copy(best) : this.blank();
  }

  private advance(): void {
    const state = this.state;
    const scan = this.run.scans[++state.step];
    for (let v = 0; v < this.voxels; ++v) {
      const change = scan.labels[v];
      if (change === 0) continue;
      if (change - 1 === OCCUPIED && state.labels[v] !== OCCUPIED) state.firstScan[v] = state.step;
      state.labels[v] = change - 1;
    }
    const { voxels, normals, quality } = scan.surface;
    for (let i = 0; i < voxels.length; ++i) {
      const v = voxels[i];
      for (let a = 0; a < 3; ++a) state.normals[3 * v + a] = normals[3 * i + a];
      state.quality[v] = quality[i];
    }
    if (state.step % this.keyframeEvery === 0 && !this.keyframes.has(state.step)) {
      this.keyframes.set(state.step, copy(state));
    }
  }
}

function copy(state: MapState): MapState {
  return {
    step: state.step,
    labels: state.labels.slice(),
    normals: state.normals.slice(),
    quality: state.quality.slice(),
    firstScan: state.firstScan.slice(),
  };
}

/** Number of voxels of each label within the enclosure. */
export function countLabels(labels: Uint8Array): [number, number, number, number, number] {
  const counts: [number, number, number, number, number] = [0, 0, 0, 0, 0];
  for (const label of labels) ++counts[label];
  return counts;
}
