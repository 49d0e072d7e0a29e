/** Whatever a document holds: it is read, or refused in words that name the field. */
import { describe, expect, it } from "vitest";
import { experimentFixture } from "../../fixtures/experiment.ts";
import { mugRun } from "../../fixtures/mug_run.ts";
import { random } from "../../fixtures/vec.ts";
import { initialState, Store } from "../model/state.ts";
import { Session } from "../model/session.ts";
import { labelCounts } from "../model/labels.ts";
import { decodeExperiment } from "./experiment.ts";
import { DataError } from "./packed.ts";
import { decodeRun } from "./run.ts";

type Path = (string | number)[];
type Json = Record<string | number, any>;

/** Every place in a document; of lists the last entry stands for all. */
function places(value: unknown, path: Path = []): Path[] {
  if (typeof value !== "object" || value === null) return [path];
  const keys = Array.isArray(value) ? (value.length ? [value.length - 1] : []) : Object.keys(value);
  return [path, ...keys.flatMap((k) => places((value as Json)[k], [...path, k]))];
}

const WRONG: unknown[] = [undefined, null, 7, -1e300, "x", [], {}];

function withWrong(document: Json, path: Path, wrong: unknown): unknown {
  if (path.length === 0) return wrong;
  const copy = structuredClone(document);
  const last = path[path.length - 1];
  const parent = path.slice(0, -1).reduce((at: Json, key) => at[key], copy);
  if (wrong === undefined && Array.isArray(parent)) parent.splice(Number(last), 1);
  else if (wrong === undefined) delete parent[last];
  else parent[last] = wrong;
  return copy;
}

/** Lets the test runner, which wants to hear of its workers every minute, have a turn. */
const pause = () => new Promise((resolve) => setTimeout(resolve, 0));

/** Tries every wrong value at every place; gives how many documents were read and refused. */
async function tryAll(document: Json, show: (value: unknown) => void): Promise<{ read: number; refused: number }> {
  const count = { read: 0, refused: 0 };
  for (const path of places(document)) {
    await pause();
    for (const wrong of WRONG) {
      try {
        show(withWrong(document, path, wrong));
        ++count.read;
      } catch (error) {
        expect(error, `${path.join(".")} = ${JSON.stringify(wrong)}: ${error}`).toBeInstanceOf(DataError);
        expect((error as DataError).message.length).toBeGreaterThan(12);
        ++count.refused;
      }
    }
  }
  return count;
}

/** Reads a run and goes through it as the page does. */
function showRun(value: unknown): void {
  const run = decodeRun(value);
  const session = new Session(run, new Store(initialState()));
  labelCounts(run);
  for (let step = 0; step < run.scans.length; ++step) {
    session.map(step);
    const planned = session.planAt(step);
    if (planned) session.ranking(planned.plan);
  }
}

describe("a document with something wrong in it", () => {
  const run = JSON.parse(JSON.stringify(mugRun({ scans: 2, rays: 30, meshes: false }))) as Json;

  it("is read or refused in words: runs", { timeout: 400_000 }, async () => {
    const { read, refused } = await tryAll(run, showRun);
    expect(refused).toBeGreaterThan(400);
    expect(read).toBeGreaterThan(100);
  });

  it("is read or refused in words: experiments", { timeout: 60_000 }, async () => {
    const { read, refused } = await tryAll(JSON.parse(JSON.stringify(experimentFixture())) as Json, (value) => void decodeExperiment(value));
    expect(refused).toBeGreaterThan(100);
    expect(read).toBeGreaterThan(20);
  });

  it("is read or refused in words: packed arrays with flipped letters", { timeout: 400_000 }, async () => {
    const rng = random(11);
    const packed = places(run).filter((path) => path.at(-1) === "data");
    expect(packed.length).toBeGreaterThan(15);
    let refused = 0;
    for (let i = 0; i < 300; ++i) {
      await pause();
      const copy = structuredClone(run);
      const path = packed[Math.floor(rng() * packed.length)];
      const parent = path.slice(0, -1).reduce((at: Json, key) => at[key], copy);
      const text = parent["data"] as string;
      const at = Math.floor(rng() * text.length);
      parent["data"] = text.slice(0, at) + "AQgw7+/=\u00e9 "[Math.floor(rng() * 10)] + text.slice(at + 1);
      try {
        showRun(copy);
      } catch (error) {
        expect(error, path.join(".")).toBeInstanceOf(DataError);
        ++refused;
      }
    }
    expect(refused).toBeGreaterThan(50);
  });
});
