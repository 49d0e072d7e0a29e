/** Slider and play button through the scans. */
import type { Session } from "../model/session.ts";
import { h } from "./dom.ts";
import { fixed, percent } from "./format.ts";

const STEP_MS = 900;

/** Plays one scan after the other; starts from the beginning where it stood at the end. */
export class Player {
  private timer = 0;

  constructor(
    private readonly session: Session,
    private readonly stepMs = STEP_MS,
  ) {}

  get last(): number {
    return Math.max(0, this.session.run.scans.length - 1);
  }

  toggle(): void {
    if (this.session.store.state.playing) this.stop();
    else this.start();
  }

  start(): void {
    const { store } = this.session;
    const step = store.state.step >= this.last ? 0 : store.state.step;
    store.set({ playing: true, step });
    clearTimeout(this.timer);
    this.timer = Number(setTimeout(() => this.tick(), this.stepMs));
  }

  stop(): void {
    clearTimeout(this.timer);
    this.session.store.set({ playing: false });
  }

  /** Goes to a scan, kept within those there are. */
  go(step: number): void {
    this.stop();
    this.session.store.set({ step: Math.min(this.last, Math.max(0, step)) });
  }

  private tick(): void {
    const { store } = this.session;
    if (!store.state.playing) return;
    if (store.state.step >= this.last) return this.stop();
    store.set({ step: store.state.step + 1 });
    if (store.state.step >= this.last) return this.stop();
    this.timer = Number(setTimeout(() => this.tick(), this.stepMs));
  }
}

export function timelineBar(session: Session, player: Player): HTMLElement {
  const { store } = session;
  const play = h("button", { type: "button", class: "play", onclick: () => player.toggle() });
  const slider = h("input", {
    type: "range",
    min: 0,
    class: "time",
    "aria-label": "scan",
    oninput: (e: Event) => player.go(Number((e.target as HTMLInputElement).value)),
  });
  const ticks = h("div", { class: "time-ticks", "aria-hidden": "true" });
  const text = h("output", { class: "time-text" });
  const update = () => {
    const { scans } = session.run;
    const { step, playing } = store.state;
    play.textContent = playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", playing ? "pause" : "play");
    slider.max = String(player.last);
    slider.value = String(step);
    const scan = scans[step];
    if (!scan) {
      text.textContent = "no scan yet";
      return;
    }
    const view = scan.candidate === null ? "" : ` · view ${scan.candidate}`;
    const coverage = scan.coverage === null ? "" : ` · coverage ${percent(scan.coverage)}`;
    text.textContent = `scan ${step + 1} of ${scans.length}${view} · ${fixed(scan.distance, 2)} m${coverage}`;
    slider.setAttribute("aria-valuetext", text.textContent);
    if (ticks.childElementCount !== scans.length) {
      ticks.replaceChildren(...scans.map((s) => h("span", { class: s.registered ? "" : "failed" })));
    }
    [...ticks.children].forEach((t, i) => t.classList.toggle("past", i <= step));
  };
  store.subscribe(update);
  update();
  return h("div", { class: "timeline" }, play, h("div", { class: "time-track" }, slider, ticks), text);
}
