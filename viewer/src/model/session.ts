/** The run that the page shows, with what is derived from it. */
import { MapHistory, type MapState } from "../data/history.ts";
import type { Plan, Run } from "../data/run.ts";
import type { Quantity, Store } from "./state.ts";

export class Session {
  private history: MapHistory;
  private fresh = false;
  /** Another object for another run; the same while one run grows. */
  runId: unknown = {};

  constructor(
    public run: Run,
    readonly store: Store,
  ) {
    this.history = new MapHistory(run);
  }

  /** Shows another run or the same one read again. The slider follows if it stood at the end. */
  replace(run: Run, sameRun: boolean): void {
    const followed = this.store.state.step >= this.run.scans.length - 1;
    this.run = run;
    this.history = new MapHistory(run);
    if (!sameRun) this.runId = {};
    this.fresh = true;
    const last = Math.max(0, run.scans.length - 1);
    const step = followed || !sameRun ? last : Math.min(this.store.state.step, last);
    const selection = sameRun ? this.store.state.selection : null;
    this.store.state = { ...this.store.state, step, selection };
    this.store.refresh();
  }

  /** The run has grown in place (live). */
  grown(): void {
    const last = Math.max(0, this.run.scans.length - 1);
    if (this.store.state.step === last - 1 && !this.store.state.playing) this.store.state = { ...this.store.state, step: last };
    this.store.refresh();
  }

  /** True once after the run was replaced: layers that belong to it must be built again. */
  takeNewRun(): boolean {
    const was = this.fresh;
    this.fresh = false;
    return was;
  }

  /** The map after scan `step`. */
  map(step: number): MapState {
    return this.history.at(step);
  }

  /**
   * The evaluation to show at scan `step`: the one made after it, which chose the next view (`made` = "after"). After
   * the last scan of a run there is none any more; then the one that chose the last scan stays ("before").
   */
  planAt(step: number): { plan: Plan; made: "after" | "before" } | null {
    const { scans, next } = this.run;
    const after = step + 1 < scans.length ? scans[step + 1].plan : next;
    if (after) return { plan: after, made: "after" };
    const before = step === scans.length - 1 ? (scans[step]?.plan ?? null) : null;
    return before && { plan: before, made: "before" };
  }

  quantityOf(plan: Plan, quantity: Quantity): ArrayLike<number> {
    return plan[quantity];
  }

  /** The highest value among the feasible candidates, 0 where there is none. */
  highest(values: ArrayLike<number>, plan: Plan): number {
    let highest = 0;
    for (let i = 0; i < values.length; ++i) if (!plan.infeasible[i] && values[i] > highest) highest = values[i];
    return highest;
  }

  /** Feasible candidates from the highest to the lowest value; equal values by index. */
  ranking(plan: Plan, values: ArrayLike<number> = plan.convolved ?? plan.utility): number[] {
    return Array.from({ length: values.length }, (_, i) => i)
      .filter((i) => !plan.infeasible[i] && !Number.isNaN(values[i]))
      .sort((a, b) => values[b] - values[a] || a - b);
  }
}
