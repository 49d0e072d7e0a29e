import { beforeEach, describe, expect, it, vi } from "vitest";
import { mugRun } from "../../fixtures/mug_run.ts";
import { LiveClient, type Connection } from "./live.ts";
import type { Run } from "./run.ts";

const whole = JSON.parse(JSON.stringify(mugRun({ scans: 3, rays: 40, meshes: false }))) as Record<string, any>;

/** The document after `scans` scans, at `revision`. */
const document = (scans: number, revision: number) => ({
  ...structuredClone(whole),
  scans: structuredClone(whole["scans"].slice(0, scans)),
  meta: { ...whole["meta"], state: "running" },
  stop_reason: "",
  revision,
});

class FakeEvents {
  listeners = new Map<string, ((event: unknown) => void)[]>();
  closed = false;
  addEventListener(kind: string, listener: (event: unknown) => void) {
    this.listeners.set(kind, [...(this.listeners.get(kind) ?? []), listener]);
  }
  close() {
    this.closed = true;
  }
  send(kind: string, data: unknown, id?: number) {
    for (const l of this.listeners.get(kind) ?? []) l({ data: typeof data === "string" ? data : JSON.stringify(data), lastEventId: String(id ?? "") });
  }
}

function setUp() {
  const opened: FakeEvents[] = [];
  const connections: Connection[] = [];
  const runs: [Run, boolean][] = [];
  const experiments: Record<string, unknown>[] = [];
  const messages: string[] = [];
  const problems: string[] = [];
  let changes = 0;
  const answers: unknown[] = [];
  const fetched: string[] = [];
  const client = new LiveClient(
    {
      onRun: (run, same) => runs.push([run, same]),
      onChange: () => ++changes,
      onExperiment: (document) => experiments.push(document),
      onConnection: (connection, problem) => {
        connections.push(connection);
        problems.push(problem);
      },
      onMessage: (text) => messages.push(text),
    },
    {
      fetch: (async (url: string) => {
        fetched.push(url);
        const answer = answers.shift();
        if (answer instanceof Error) throw answer;
        if (answer instanceof Response) return answer;
        return new Response(JSON.stringify(answer));
      }) as typeof fetch,
      openEvents: () => {
        opened.push(new FakeEvents());
        return opened.at(-1) as unknown as EventSource;
      },
      setTimer: (callback, ms) => setTimeout(callback, ms),
      clearTimer: (timer) => clearTimeout(timer),
    },
  );
  client.start();
  const last = () => opened.at(-1)!;
  const settle = () => vi.advanceTimersByTimeAsync(1);
  return { client, opened, connections, problems, runs, experiments, messages, answers, fetched, last, settle, changes: () => changes };
}

beforeEach(() => void vi.useFakeTimers());

describe("LiveClient", () => {
  it("reads the run and applies what follows", async () => {
    const t = setUp();
    t.answers.push(document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect(t.runs).toHaveLength(1);
    t.last().send("scan", whole["scans"][1], 6);
    t.last().send("plan", whole["scans"][2].plan, 7);
    t.last().send("state", { state: "waiting", message: "take the next view" }, 8);
    const [run] = t.runs[0];
    expect(run.scans).toHaveLength(2);
    expect(run.next!.chosen).toBe(whole["scans"][2].candidate);
    expect(run.meta.state).toBe("waiting");
    expect(run.revision).toBe(8);
    expect(t.messages).toEqual(["take the next view"]);
    expect(t.changes()).toBe(3);
    expect(t.fetched).toEqual(["api/run"]);
    expect(t.connections.at(-1)).toBe("live");
  });

  it("takes the camera and the candidates that a session finds, and says which view is taken", async () => {
    const t = setUp();
    t.answers.push({ ...document(1, 5), meta: { ...whole["meta"], state: "waiting" } });
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    const nearer = { ...whole["candidates"], text: "nearer" };
    t.last().send("setup", { camera: { ...whole["camera"], columns: 11 }, candidates: nearer }, 6);
    expect(t.runs).toHaveLength(2);
    expect(t.runs[1][1]).toBe(true);
    const [run] = t.runs[1];
    expect([run.camera.columns, run.candidates.text]).toEqual([11, "nearer"]);
    t.last().send("take", { candidate: 3, pose: [0, 0, 0, 0, 0, 0, 1] }, 7);
    t.last().send("scan", whole["scans"][1], 8);
    expect(t.messages).toEqual(["view 3 is being taken", `scan 2: ${whole["scans"][1].verdict}`]);
    expect(t.fetched).toEqual(["api/run"]);
  });

  it("ignores what it has and reads all again after a gap", async () => {
    const t = setUp();
    t.answers.push(document(1, 5), document(3, 9));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    t.last().send("scan", whole["scans"][0], 5);
    expect(t.runs[0][0].scans).toHaveLength(1);
    t.last().send("scan", whole["scans"][2], 8);
    await t.settle();
    expect(t.runs).toHaveLength(2);
    expect(t.runs[1][0].scans).toHaveLength(3);
    expect(t.runs[1][1]).toBe(true);
  });

  it("keeps events that come while the run is read", async () => {
    const t = setUp();
    t.answers.push(document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    t.last().send("scan", whole["scans"][0], 5);
    t.last().send("scan", whole["scans"][1], 6);
    await t.settle();
    expect(t.runs[0][0].scans).toHaveLength(2);
    expect(t.runs[0][0].revision).toBe(6);
  });

  it("connects again after a loss, with longer and longer waits, and catches up", async () => {
    const t = setUp();
    t.answers.push(document(1, 5), document(2, 6));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    t.last().send("error", "");
    expect(t.opened[0].closed).toBe(true);
    expect(t.connections.at(-1)).toBe("lost");
    await vi.advanceTimersByTimeAsync(500);
    expect(t.opened).toHaveLength(2);
    t.last().send("error", "");
    await vi.advanceTimersByTimeAsync(500);
    expect(t.opened).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(500);
    expect(t.opened).toHaveLength(3);
    t.last().send("hello", { run: "a", revision: 6 });
    await t.settle();
    expect(t.runs.at(-1)![0].scans).toHaveLength(2);
    expect(t.connections.at(-1)).toBe("live");
  });

  it("reads nothing again where it missed nothing", async () => {
    const t = setUp();
    t.answers.push(document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    t.client.wake();
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect(t.fetched).toHaveLength(1);
    expect(t.connections.at(-1)).toBe("live");
  });

  it("notices another run on the same server", async () => {
    const t = setUp();
    t.answers.push(document(2, 5), document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    t.client.wake();
    t.last().send("hello", { run: "b", revision: 5 });
    await t.settle();
    expect(t.runs.map(([, same]) => same)).toEqual([false, false]);
  });

  it("connects again when nothing is heard for 40 s", async () => {
    const t = setUp();
    t.answers.push(document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    await vi.advanceTimersByTimeAsync(39_000);
    t.last().send("state", { state: "running" }, 6);
    await vi.advanceTimersByTimeAsync(39_000);
    expect(t.opened).toHaveLength(1);
    await vi.advanceTimersByTimeAsync(2_000);
    expect(t.connections.at(-2)).toBe("lost");
    expect(t.opened).toHaveLength(2);
  });

  it.each([
    ["a broken event", (t: ReturnType<typeof setUp>) => t.last().send("scan", "{", 6)],
    ["a scan that does not fit", (t: ReturnType<typeof setUp>) => t.last().send("scan", { scan: 7 }, 6)],
  ])("survives %s by reading all again", async (_name, send) => {
    const t = setUp();
    t.answers.push(document(1, 5), document(2, 6));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    send(t);
    expect(t.connections.at(-1)).toBe("lost");
    await vi.advanceTimersByTimeAsync(500);
    t.last().send("hello", { run: "a", revision: 6 });
    await t.settle();
    expect(t.runs.at(-1)![0].scans).toHaveLength(2);
  });

  it("shows an experiment, and the next one that the server begins", async () => {
    const t = setUp();
    const experiment = (title: string) => ({ format: "vantage-experiment", version: 1, title, revision: 0 });
    t.answers.push(experiment("under way"), experiment("table 1"));
    t.last().send("hello", { run: "a", revision: 0 });
    t.last().send("hello", { run: "b", revision: 0 }); // while the first is still read
    await t.settle();
    expect(t.experiments.map((e) => e["title"])).toEqual(["under way", "table 1"]);
    expect(t.connections.at(-1)).toBe("ended");
    expect(t.fetched).toEqual(["api/run", "api/run"]);
  });

  it.each([
    [new Response('{"error": "there is no scan yet"}', { status: 503 }), "there is no scan yet"],
    [new Response("<html>", { status: 502, statusText: "Bad Gateway" }), "the server answers 502 Bad Gateway"],
    [new Response("<html>"), "/api/run: is not JSON"],
    [new Response("[]"), "/api/run: must be an object"],
    [new Response('{"format": "vantage-run", "version": "1"}'), 'version: is "1", must be a number'],
    [new TypeError("Failed to fetch"), "Failed to fetch"],
  ])("says what is wrong with what the server sent, and tries again (%#)", async (answer, problem) => {
    const t = setUp();
    t.answers.push(answer, document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect([t.connections.at(-1), t.problems.at(-1)]).toEqual(["lost", problem]);
    await vi.advanceTimersByTimeAsync(500);
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect(t.runs).toHaveLength(1);
    expect(t.connections.at(-1)).toBe("live");
  });

  it("reads the run again where an event is not as documented", async () => {
    for (const [kind, data] of [["scan", "{"], ["scan", '{"scan": 7}'], ["state", '{"state": "asleep"}'], ["plan", "[]"], ["result", '{"cloud": 3}']]) {
      const t = setUp();
      t.answers.push(document(1, 5), document(2, 6));
      t.last().send("hello", { run: "a", revision: 5 });
      await t.settle();
      t.last().send(kind, data, 6);
      expect(t.connections.at(-1)).toBe("lost");
      await vi.advanceTimersByTimeAsync(500);
      t.last().send("hello", { run: "a", revision: 6 });
      await t.settle();
      expect(t.runs.at(-1)![0].scans).toHaveLength(2);
      expect(t.connections.at(-1)).toBe("live");
    } // prettier-ignore
  });

  it("tries again where the run cannot be read", async () => {
    const t = setUp();
    t.answers.push(new Response('{"error": "starting"}', { status: 503 }), document(1, 5));
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect(t.connections.at(-1)).toBe("lost");
    await vi.advanceTimersByTimeAsync(500);
    t.last().send("hello", { run: "a", revision: 5 });
    await t.settle();
    expect(t.runs).toHaveLength(1);
  });

  it("passes on why a button was refused", async () => {
    const t = setUp();
    t.answers.push(new Response('{"error": "not waiting for a view"}', { status: 409 }), new Response("", { status: 202 }));
    await expect(t.client.post("next")).rejects.toThrow("not waiting for a view");
    await expect(t.client.post("skip", { candidate: 3, reason: "x" })).resolves.toBeUndefined();
    expect(t.fetched).toEqual(["api/session/next", "api/session/skip"]);
  });
});
