/** A small server that speaks the live protocol of docs/report-data.md, for tests of the page. */
import { createServer, type IncomingMessage, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";

type Json = Record<string, any>;

export class MockServer {
  readonly posts: { action: string; body: Json }[] = [];
  /** Answer to the next POST where not 202. */
  refusal: string | null = null;
  /** What `/api/run` answers instead of the run. */
  broken: string | null = null;
  port = 0;
  private readonly scans: Json[];
  private shown = 0;
  private revision = 0;
  private state = "running";
  private listeners = new Set<ServerResponse>();
  private server: Server | null = null;

  /** Shows the scans of `run` one after the other on `page`. */
  constructor(
    private readonly page: string,
    private readonly run: Json,
    private name = "run-1",
  ) {
    this.scans = run["scans"];
  }

  get url(): string {
    return `http://127.0.0.1:${this.port}/`;
  }

  get browsers(): number {
    return this.listeners.size;
  }

  async start(): Promise<void> {
    this.server = createServer((request, response) => this.answer(request, response));
    await new Promise<void>((done) => this.server!.listen(this.port, "127.0.0.1", done));
    this.port = (this.server.address() as AddressInfo).port;
  }

  /** Drops all connections, as a server that ends. */
  async stop(): Promise<void> {
    this.listeners.clear();
    const closed = new Promise<void>((done) => this.server!.close(() => done()));
    this.server!.closeAllConnections();
    await closed;
  }

  /** The next scan was taken: the scan and the plan made after it. */
  scan(): void {
    const scan = this.scans[this.shown++];
    this.push("scan", scan);
    const next = this.plan();
    if (next) this.push("plan", next);
  }

  wait(message: string): void {
    this.state = "waiting";
    this.push("state", { state: "waiting", message });
  }

  finish(): void {
    this.state = "finished";
    this.push("state", { state: "finished", stop_reason: this.run["stop_reason"], summary: this.run["summary"] });
    this.push("result", { cloud: this.run["cloud"], mesh: this.run["mesh"], truth: this.run["truth"] });
  }

  private plan(): Json | null {
    return this.shown < this.scans.length ? this.scans[this.shown].plan : null;
  }

  private push(event: string, data: Json): void {
    ++this.revision;
    for (const listener of this.listeners) listener.write(`id: ${this.revision}\nevent: ${event}\ndata: ${JSON.stringify(data)}\n\n`);
  }

  private document(): Json {
    const finished = this.state === "finished";
    return {
      ...this.run,
      meta: { ...this.run["meta"], state: this.state },
      scans: this.scans.slice(0, this.shown),
      next: this.plan(),
      stop_reason: finished ? this.run["stop_reason"] : "",
      cloud: finished ? this.run["cloud"] : null,
      mesh: finished ? this.run["mesh"] : null,
      truth: finished ? this.run["truth"] : null,
      revision: this.revision,
    };
  }

  private answer(request: IncomingMessage, response: ServerResponse): void {
    const send = (status: number, type: string, body: string) => response.writeHead(status, { "Content-Type": type }).end(body);
    if (request.method === "POST") return this.post(request, response);
    switch (request.url) {
      case "/":
        return void send(200, "text/html", this.page);
      case "/api/run":
        return void send(200, "application/json", this.broken ?? JSON.stringify(this.document()));
      case "/api/events":
        response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-store" });
        response.write(`event: hello\ndata: ${JSON.stringify({ run: this.name, revision: this.revision })}\n\n`);
        this.listeners.add(response);
        request.on("close", () => this.listeners.delete(response));
        return;
      default:
        send(404, "text/plain", "not found");
    }
  }

  private post(request: IncomingMessage, response: ServerResponse): void {
    let text = "";
    request.on("data", (chunk) => (text += chunk));
    request.on("end", () => {
      const json = request.headers["content-type"] === "application/json";
      this.posts.push({ action: request.url!.replace("/api/session/", ""), body: JSON.parse(text) as Json });
      const problem = json ? this.refusal : "Content-Type must be application/json";
      this.refusal = null;
      response.writeHead(problem ? 409 : 202, { "Content-Type": "application/json" });
      response.end(problem ? JSON.stringify({ error: problem }) : "{}");
    });
  }
}
