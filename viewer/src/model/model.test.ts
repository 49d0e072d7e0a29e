import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { mugRun } from "../../fixtures/mug_run.ts";
import { decodeRun, type Run } from "../data/run.ts";
import { Player } from "../ui/timeline.ts";
import { parseHex, scanColor, shareColor, shareHex, viridis } from "./colors.ts";
import { fromMap, nearestMap, toMap } from "./projection.ts";
import { Session } from "./session.ts";
import { initialState, Store } from "./state.ts";

vi.mock("../ui/theme.ts", () => ({ theme: { toggle: vi.fn() } }));
const { keyAction } = await import("../ui/keys.ts");

let run: Run;
const document = JSON.stringify(mugRun({ scans: 3, rays: 40, meshes: false }));
beforeEach(() => {
  run = decodeRun(JSON.parse(document));
});

describe("colours", () => {
  it("go from dark to light, clamp, and take NaN for 0", () => {
    const lightness = [0, 0.25, 0.5, 0.75, 1].map((t) => viridis(t).reduce((a, b) => a + b));
    expect([...lightness].sort((a, b) => a - b)).toEqual(lightness);
    expect(viridis(-3)).toEqual(viridis(0));
    expect(viridis(7)).toEqual(viridis(1));
    expect(viridis(NaN)).toEqual(viridis(0));
    expect(shareHex(1)).toBe("#fde725");
    expect(shareColor(NaN)).toEqual(shareColor(-2));
    expect(parseHex("#0a10ff")).toEqual([10, 16, 255]);
    expect(scanColor(0, 1)).toEqual(viridis(0.5));
  });
});

describe("the map of the sphere", () => {
  it("is its own inverse", () => {
    for (const [x, y, z] of [[1, 0, 0], [0, -1, 0], [0.6, 0, 0.8], [-0.48, 0.6, -0.64], [0, 0, 1]]) {
      const { u, v } = toMap(x, y, z);
      const back = fromMap(u, v)!;
      expect(Math.hypot(back[0] - x, back[1] - y, back[2] - z)).toBeLessThan(1e-4);
    } // prettier-ignore
    expect(fromMap(1.9, 0.9)).toBeNull();
  });

  it("gives equal areas equal room: half of the pixels above 30 degrees on either side", () => {
    // The caps beyond 30 degrees hold half of the sphere's area.
    let inside = 0;
    let caps = 0;
    for (let row = 0; row < 200; ++row) {
      for (let column = 0; column < 400; ++column) {
        const d = fromMap((column + 0.5) / 100 - 2, 1 - (row + 0.5) / 100);
        if (!d) continue;
        ++inside;
        if (Math.abs(d[2]) > 0.5) ++caps;
      }
    }
    expect(inside / 80000).toBeCloseTo(Math.PI / 4, 2);
    expect(caps / inside).toBeCloseTo(0.5, 2);
  });

  it("gives every direction the pixels that are nearest to it", () => {
    const nearest = nearestMap(Float32Array.of(0, 0, 1, 0, 0, -1), 40, 20);
    expect(nearest[2 * 40 + 20]).toBe(0);
    expect(nearest[17 * 40 + 20]).toBe(1);
    expect(nearest[0]).toBe(-1);
  });
});

describe("Store", () => {
  it("tells only what changed", () => {
    const store = new Store();
    const heard: string[][] = [];
    store.subscribe((_state, changed) => heard.push([...changed]));
    store.set({ step: 0 });
    store.set({ step: 2, playing: false });
    store.setLayer("cloud", true);
    store.setLabel(0, "show");
    expect(heard).toEqual([["step"], ["layers"], ["labels"]]);
    expect(store.state.labels[0]).toBe("show");
  });
});

describe("Session", () => {
  it("shows at every scan the plan that was made after it", () => {
    const session = new Session(run, new Store());
    expect(session.planAt(0)).toEqual({ plan: run.scans[1].plan, made: "after" });
    expect(session.planAt(2)).toEqual({ plan: run.next, made: "after" });
    run.next = null;
    expect(session.planAt(2)).toEqual({ plan: run.scans[2].plan, made: "before" });
  });

  it("ranks feasible views by expected utility, ties by index", () => {
    const session = new Session(run, new Store());
    const plan = run.scans[1].plan!;
    const ranking = session.ranking(plan);
    expect(ranking.some((i) => plan.infeasible[i])).toBe(false);
    expect(ranking).toHaveLength(plan.infeasible.filter((r) => r === 0).length);
    for (let i = 1; i < ranking.length; ++i) {
      const [a, b] = [plan.convolved![ranking[i - 1]], plan.convolved![ranking[i]]];
      expect(a > b || (a === b && ranking[i - 1] < ranking[i])).toBe(true);
    }
  });

  it("follows a growing run from its end, and stays where somebody looks back", () => {
    const session = new Session(run, new Store({ ...initialState(), step: 2 }));
    run.scans.push({ ...run.scans[2], scan: 3 });
    session.grown();
    expect(session.store.state.step).toBe(3);
    session.store.set({ step: 1 });
    run.scans.push({ ...run.scans[2], scan: 4 });
    session.grown();
    expect(session.store.state.step).toBe(1);
  });

  it("keeps place and selection when the same run is read again, not for another run", () => {
    const session = new Session(run, new Store({ ...initialState(), step: 1, selection: { kind: "view", index: 5 } }));
    const id = session.runId;
    session.replace(run, true);
    expect(session.store.state.step).toBe(1);
    expect(session.store.state.selection).toEqual({ kind: "view", index: 5 });
    expect(session.runId).toBe(id);
    session.replace(run, false);
    expect(session.store.state.step).toBe(2);
    expect(session.store.state.selection).toBeNull();
    expect(session.runId).not.toBe(id);
  });
});

describe("Player", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("goes through the scans and stops at the last", () => {
    const session = new Session(run, new Store({ ...initialState(), step: 2 }));
    const steps: number[] = [];
    session.store.subscribe((state, changed) => changed.has("step") && steps.push(state.step));
    new Player(session, 100).start();
    vi.advanceTimersByTime(1000);
    expect(steps).toEqual([0, 1, 2]);
    expect(session.store.state.playing).toBe(false);
  });

  it("pauses", () => {
    const session = new Session(run, new Store());
    const player = new Player(session, 100);
    player.toggle();
    vi.advanceTimersByTime(150);
    player.toggle();
    vi.advanceTimersByTime(1000);
    expect(session.store.state.step).toBe(1);
  });

  it("keeps the place within the scans", () => {
    const session = new Session(run, new Store());
    const player = new Player(session);
    player.go(99);
    expect(session.store.state.step).toBe(2);
    player.go(-4);
    expect(session.store.state.step).toBe(0);
  });
});

describe("keys", () => {
  const press = (session: Session, key: string) => keyAction(key, session, new Player(session), () => {})?.();

  it("turn labels, layers, slices and scans", () => {
    const session = new Session(run, new Store());
    const { store } = session;
    for (const key of ["1", "v", "c", "z", "]", "ArrowRight"]) press(session, key);
    expect(store.state.labels[0]).toBe("fade");
    expect(store.state.layers.candidates).toBe(false);
    expect(store.state.coloring).toBe("quality");
    expect(store.state.slice).toEqual({ axis: 2, index: 28 });
    expect(store.state.step).toBe(1);
    press(session, "z");
    press(session, "End");
    expect(store.state.slice).toBeNull();
    expect(store.state.step).toBe(2);
  });

  it("leave other keys alone", () => {
    const session = new Session(run, new Store());
    for (const key of ["q", "F5", "Tab", "[", "xy", "constructor"]) expect(keyAction(key, session, new Player(session), () => {})).toBeNull();
  });
});
