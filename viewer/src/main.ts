/** Entry of the page: finds the data, shows them, and says so where that is not possible. */
import { asObject, DataError } from "./data/packed.ts";
import { decodeRun, type Run } from "./data/run.ts";
import { LiveClient } from "./data/live.ts";
import { Session } from "./model/session.ts";
import { initialState, Store } from "./model/state.ts";
import { SceneView } from "./scene/scene.ts";
import { curves } from "./ui/curves.ts";
import { detailsCard, scansTable } from "./ui/details.ts";
import { h } from "./ui/dom.ts";
import { showExperiment } from "./ui/experiment.ts";
import { header, helpDialog, optionsCard } from "./ui/header.ts";
import { listenForKeys } from "./ui/keys.ts";
import { layersPanel } from "./ui/layers.ts";
import { sessionBar, type SessionBar } from "./ui/sessionbar.ts";
import { Player, timelineBar } from "./ui/timeline.ts";
import { utilityMap } from "./ui/utilitymap.ts";

declare global {
  interface Window {
    /** For scripts and tests: the session and the scene of this page. */
    vantage?: { session: Session; scene: SceneView | null; live: LiveClient | null };
  }
}

const app = document.getElementById("app")!;

/** A problem in words instead of a blank page. */
function showProblem(title: string, text: string): void {
  app.className = "problem";
  app.replaceChildren(h("div", { class: "card", role: "alert" }, h("h1", {}, title), h("p", {}, text)));
  document.documentElement.dataset["ready"] = "problem";
}

function explain(error: unknown): string {
  return error instanceof DataError ? error.message : `unexpected: ${error instanceof Error ? error.message : String(error)}`;
}

function buildScene(session: Session, stage: HTMLElement): SceneView | null {
  try {
    return new SceneView(stage, session);
  } catch (error) {
    const text = `The 3D scene needs WebGL, which this browser does not offer (${explain(error)}). Curves, map and table work.`;
    stage.replaceChildren(h("p", { class: "no-scene", role: "alert" }, text));
    return null;
  }
}

function showRun(run: Run, bar: ((session: Session) => SessionBar) | null): { session: Session; bar: SessionBar | null } {
  const step = Math.max(0, run.scans.length - 1);
  const session = new Session(run, new Store({ ...initialState(), step }));
  const player = new Player(session);
  const help = helpDialog();
  const showHelp = () => help.showModal();
  const stage = h("div", { class: "stage" });
  const layers = layersPanel(session);
  const live = bar?.(session) ?? null;
  app.className = "run";
  app.replaceChildren(
    header(session, showHelp),
    h(
      "main",
      {},
      h(
        "section",
        { class: "scene", "aria-label": "scene" },
        stage,
        layers,
        detailsCard(session),
        live?.element,
        timelineBar(session, player),
      ),
      h(
        "div",
        { class: "side", tabindex: -1 },
        utilityMap(session),
        curves(session, (scan) => player.go(scan)),
        scansTable(session, (scan) => {
          player.go(scan);
          const { candidate } = session.run.scans[scan];
          if (candidate !== null) session.store.set({ selection: { kind: "view", index: candidate } });
        }),
        optionsCard(session),
      ),
    ),
    help,
  );
  const scene = buildScene(session, stage);
  const cover = () => scene?.viewport.setCover(layers.open && window.innerWidth > 900 ? layers.offsetWidth + 10 : 0);
  layers.addEventListener("toggle", cover);
  window.addEventListener("resize", cover);
  cover();
  scene?.viewport.goHome();
  listenForKeys(session, player, showHelp);
  session.store.refresh();
  window.vantage = { session, scene, live: window.vantage?.live ?? null };
  scene?.viewport.drawFirst();
  // The pixels are there and every control works.
  performance.mark("vantage-interactive");
  document.documentElement.dataset["ready"] = "run";
  return { session, bar: live };
}

/** An error that nobody caught: said, so that a page that stopped following is not taken for the truth. */
function sayWhatBroke(error: unknown): void {
  if (document.documentElement.dataset["ready"] === undefined) return showProblem("This page cannot be shown", explain(error));
  document.querySelector(".broken")?.remove();
  const close = h("button", { type: "button", "aria-label": "close" }, "×");
  const bar = h("div", { class: "broken", role: "alert" }, `Something went wrong, what you see may be incomplete. ${explain(error)}`, close);
  close.addEventListener("click", () => bar.remove());
  document.body.append(bar);
}

function goLive(): void {
  let shown: { session: Session; bar: SessionBar | null } | null = null;
  app.className = "problem";
  const status = h("p", { role: "status" }, "Connecting …");
  app.replaceChildren(h("div", { class: "card" }, h("h1", {}, "Vantage"), status));
  const client = new LiveClient(
    {
      onRun: (run, sameRun) => {
        if (shown) shown.session.replace(run, sameRun);
        else shown = showRun(run, (session) => sessionBar(session, (action, body) => client.post(action, body)));
      },
      onExperiment: (document_) => {
        shown = null;
        showExperiment(app, document_);
        document.documentElement.dataset["ready"] = "experiment";
      },
      onChange: () => shown?.session.grown(),
      onConnection: (connection, problem) => {
        if (shown) shown.bar?.setConnection(connection, problem);
        else if (connection === "lost") status.textContent = `No run to show yet: ${problem}. Trying again …`;
      },
      onMessage: (text) => shown?.bar?.say(text),
    },
    {
      fetch: (...request) => fetch(...request),
      openEvents: (url) => new EventSource(url),
      setTimer: (callback, ms) => window.setTimeout(callback, ms),
      clearTimer: (timer) => window.clearTimeout(timer),
    },
  );
  let hiddenSince = 0;
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) hiddenSince = Date.now();
    else if (Date.now() - hiddenSince > 30_000) client.wake();
  });
  window.addEventListener("online", () => client.wake());
  client.start();
  window.vantage = { session: null as never, scene: null, live: client };
}

function start(): void {
  window.addEventListener("error", (event) => {
    // The browser's note that it resizes in two steps is no error.
    if (!event.message.startsWith("ResizeObserver")) sayWhatBroke(event.error ?? event.message);
  });
  window.addEventListener("unhandledrejection", (event) => sayWhatBroke(event.reason));
  const text = document.getElementById("vantage-data")?.textContent?.trim() ?? "";
  if (text === "") {
    if (/^https?:$/.test(location.protocol)) goLive();
    else showProblem("No data", "This file is the empty page; open the report.html that a reconstruction wrote.");
    return;
  }
  let data: unknown;
  try {
    data = JSON.parse(text);
  } catch {
    showProblem("This report cannot be shown", "Its data are not complete: they are not JSON. Perhaps the file was cut off.");
    return;
  }
  try {
    const { format } = asObject(data, "the document");
    if (format === "vantage-experiment") {
      showExperiment(app, data);
      document.documentElement.dataset["ready"] = "experiment";
    } else {
      showRun(decodeRun(data), null);
    }
  } catch (error) {
    showProblem("This report cannot be shown", explain(error));
  }
}

start();
