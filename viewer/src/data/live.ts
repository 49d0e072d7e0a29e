/** Follows a running reconstruction: events of docs/report-data.md applied to a run, with catching up. */
import { asObject, DataError } from "./packed.ts";
import {
  decodeCamera, decodeCandidates, decodeCloud, decodeMesh, decodePlan, decodeRun, decodeScan, decodeState, decodeSummary, type Run,
} from "./run.ts"; // prettier-ignore

export type Connection = "connecting" | "live" | "lost" | "ended";

export interface LiveHandlers {
  /** The whole run was read; `sameRun` false where it is another one than before. */
  onRun: (run: Run, sameRun: boolean) => void;
  /** The server shows an experiment instead: its document, which no events change. */
  onExperiment: (document: Record<string, unknown>) => void;
  /** The run grew in place. */
  onChange: (run: Run) => void;
  onConnection: (connection: Connection, problem: string) => void;
  onMessage: (text: string) => void;
}

/** What the client needs of a browser; tests bring their own. */
export interface LiveEnvironment {
  fetch: typeof fetch;
  openEvents: (url: string) => EventSource;
  setTimer: (callback: () => void, milliseconds: number) => unknown;
  clearTimer: (timer: never) => void;
}

const EVENTS = ["scan", "plan", "take", "setup", "state", "result"] as const;
const SILENCE_MS = 40_000;
const RETRY_MS = [500, 1000, 2000, 4000, 8000];

/** Changes `run` by one event. Throws DataError where the event is not as documented. */
export function applyEvent(run: Run, event: (typeof EVENTS)[number], value: unknown): string {
  const data = asObject(value, `event ${event}`);
  switch (event) {
    case "scan":
      run.scans.push(decodeScan(data, run.scans.length, run.grid, run.candidates.count));
      run.next = null;
      // Whoever waits for it may hear of a failure.
      return run.meta.state === "waiting" ? `scan ${run.scans.length}: ${run.scans.at(-1)!.verdict}` : "";
    case "plan":
      run.next = decodePlan(data, run.candidates.count, "plan");
      return "";
    case "take":
      return `view ${String(data["candidate"])} is being taken`;
    case "setup":
      run.camera = decodeCamera(data["camera"]);
      run.candidates = decodeCandidates(data["candidates"]);
      return "";
    case "state":
      if (data["state"] !== undefined) run.meta.state = decodeState(data["state"], "event state: state");
      if (data["stop_reason"] !== undefined) run.stop_reason = String(data["stop_reason"]);
      if (data["summary"] !== undefined) run.summary = decodeSummary(data["summary"]);
      return data["message"] === undefined ? "" : String(data["message"]);
    case "result":
      if (data["cloud"]) run.cloud = decodeCloud(data["cloud"]);
      if (data["mesh"]) run.mesh = decodeMesh(data["mesh"], "mesh");
      if (data["truth"]) run.truth = decodeMesh(data["truth"], "truth");
      return "";
  }
}

/** Why the server refused, in its own words where it has some. */
async function refusal(answer: Response): Promise<string> {
  try {
    const { error } = JSON.parse(await answer.text()) as { error?: unknown };
    if (typeof error === "string") return error;
  } catch {
    // not JSON: the status says it
  }
  return `the server answers ${answer.status} ${answer.statusText}`.trim();
}

export class LiveClient {
  private run: Run | null = null;
  private runName: string | null = null;
  private events: EventSource | null = null;
  private silence: unknown = null;
  private retry: unknown = null;
  private failures = 0;
  private reading: Promise<void> | null = null;
  /** While one run is read the server has begun another one. */
  private another = false;
  private waiting: [string, unknown, number][] = [];
  private closed = false;

  constructor(
    private readonly handlers: LiveHandlers,
    private readonly environment: LiveEnvironment,
    private readonly base = "",
  ) {}

  start(): void {
    this.connect();
  }

  stop(): void {
    this.closed = true;
    this.drop();
  }

  /** Connects again at once, for example after the computer slept. */
  wake(): void {
    if (!this.closed) this.connect();
  }

  /** Presses a button of the session; throws Error with the server's text where it refuses. */
  async post(action: "next" | "skip" | "finish", body: object = {}): Promise<void> {
    const answer = await this.environment.fetch(`${this.base}api/session/${action}`, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    if (answer.ok) return;
    throw new Error(await refusal(answer));
  }

  private drop(): void {
    this.events?.close();
    this.events = null;
    this.environment.clearTimer(this.silence as never);
    this.environment.clearTimer(this.retry as never);
  }

  private connect(): void {
    this.drop();
    this.handlers.onConnection("connecting", "");
    const events = this.environment.openEvents(`${this.base}api/events`);
    this.events = events;
    this.listenForSilence();
    events.addEventListener("hello", (e) => this.hear(() => this.hello(JSON.parse((e as MessageEvent).data))));
    for (const kind of EVENTS) {
      events.addEventListener(kind, (e) => {
        const { data, lastEventId } = e as MessageEvent<string>;
        this.hear(() => this.take(kind, JSON.parse(data), Number(lastEventId)));
      });
    }
    events.addEventListener("error", () => this.lose("the connection broke"));
  }

  private hear(action: () => void): void {
    this.listenForSilence();
    try {
      action();
    } catch (error) {
      // A broken event: the whole document is the remedy; if that is broken too, its error is shown.
      this.lose(error instanceof Error ? error.message : String(error));
    }
  }

  private listenForSilence(): void {
    this.environment.clearTimer(this.silence as never);
    this.silence = this.environment.setTimer(() => this.lose("nothing heard for a while"), SILENCE_MS);
  }

  private lose(problem: string): void {
    if (this.closed) return;
    this.drop();
    this.handlers.onConnection("lost", problem);
    const wait = RETRY_MS[Math.min(this.failures++, RETRY_MS.length - 1)];
    this.retry = this.environment.setTimer(() => this.connect(), wait);
  }

  private hello(value: unknown): void {
    const { run, revision } = asObject(value, "hello");
    const same = this.runName === String(run);
    this.runName = String(run);
    if (same && this.run && this.run.revision === revision) this.settle();
    else this.read(same);
  }

  private settle(): void {
    this.failures = 0;
    this.handlers.onConnection(this.run?.meta.state === "finished" ? "ended" : "live", "");
  }

  private read(sameRun: boolean): void {
    if (this.reading) {
      this.another ||= !sameRun;
      return;
    }
    this.another = false;
    this.reading = this.readRun(sameRun)
      .catch((error: unknown) => {
        this.lose(error instanceof Error ? error.message : String(error));
      })
      .finally(() => {
        this.reading = null;
        if (this.another && this.events) this.read(false);
      });
  }

  private async readRun(sameRun: boolean): Promise<void> {
    const answer = await this.environment.fetch(`${this.base}api/run`, { cache: "no-store" });
    if (!answer.ok) throw new Error(await refusal(answer));
    let document: unknown;
    try {
      document = await answer.json();
    } catch {
      throw new DataError("/api/run: is not JSON");
    }
    const { format } = asObject(document, "/api/run");
    if (format === "vantage-experiment") {
      this.run = null;
      this.waiting = [];
      this.handlers.onExperiment(document as Record<string, unknown>);
      this.failures = 0;
      this.handlers.onConnection("ended", "");
      return;
    }
    this.run = decodeRun(document);
    const waiting = this.waiting.filter(([, , revision]) => revision > this.run!.revision);
    this.waiting = [];
    for (const [kind, value, revision] of waiting) this.apply(kind as (typeof EVENTS)[number], value, revision);
    this.handlers.onRun(this.run, sameRun);
    this.settle();
  }

  private take(kind: (typeof EVENTS)[number], value: unknown, revision: number): void {
    if (this.reading || !this.run) {
      this.waiting.push([kind, value, revision]);
      return;
    }
    if (revision <= this.run.revision) return;
    if (revision !== this.run.revision + 1) {
      this.read(true);
      return;
    }
    this.apply(kind, value, revision);
    // Another camera or other candidates change all that is drawn.
    if (kind === "setup") this.handlers.onRun(this.run, true);
    else this.handlers.onChange(this.run);
    this.settle();
  }

  private apply(kind: (typeof EVENTS)[number], value: unknown, revision: number): void {
    const message = applyEvent(this.run!, kind, value);
    this.run!.revision = revision;
    if (message) this.handlers.onMessage(message);
  }
}
