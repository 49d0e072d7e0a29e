/** Counts of labels over the scans. */
import type { Run } from "../data/run.ts";

/** Label counts after every scan, from the labels themselves. */
export function labelCounts(run: Run): number[][] {
  const [x, y, z] = run.grid.enclosureSize;
  const counts = [x * y * z, 0, 0, 0, 0];
  const labels = new Uint8Array(x * y * z);
  return run.scans.map((scan) => {
    for (let v = 0; v < labels.length; ++v) {
      const change = scan.labels[v];
      if (change === 0) continue;
      --counts[labels[v]];
      labels[v] = change - 1;
      ++counts[labels[v]];
    }
    return counts.slice();
  });
}
