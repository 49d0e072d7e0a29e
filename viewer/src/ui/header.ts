/** The top of the page: what this run is and how far it got. */
import type { Session } from "../model/session.ts";
import { h } from "./dom.ts";
import { fixed, percent, whole } from "./format.ts";
import { theme } from "./theme.ts";

/** Options that tell what kind of run it was; all of them stand at the end of the page. */
const TOLD = ["candidates", "camera", "search", "utility", "registration", "positioning-error", "convolve", "seed"];

/** All options of the run, and what made it. */
export function optionsCard(session: Session): HTMLElement {
  const list = h("dl", {});
  const card = h("details", { class: "card options", id: "options" }, h("summary", {}, "Options of this run"), list);
  const update = () => {
    const { options, program } = session.run.meta;
    card.hidden = options.length === 0;
    const rows: [string, string][] = [...options, ...(program ? [["made by vantage", program] as [string, string]] : [])];
    list.replaceChildren(...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
  };
  session.store.subscribe(update);
  update();
  return card;
}

function stat(name: string, value: string): HTMLElement {
  return h("div", { class: "stat" }, h("b", {}, value), h("span", {}, name));
}

export function header(session: Session, onHelp: () => void): HTMLElement {
  const title = h("h1", {});
  const subtitle = h("p", {});
  const stats = h("div", { class: "stats" });
  const themeButton = h("button", { type: "button", class: "icon", title: "light or dark (t)", "aria-label": "light or dark", onclick: () => theme.toggle() }, "◐");
  const help = h("button", { type: "button", class: "icon", title: "keys (?)", "aria-label": "keys and help", onclick: onHelp }, "?");
  const update = () => {
    const { run, store } = session;
    const scan = run.scans[store.state.step];
    title.textContent = run.meta.object;
    document.title = `${run.meta.object} · Vantage`;
    const known = new Map(run.meta.options.map(([name, value]) => [name.replace(/^--/, ""), value]));
    const shown = TOLD.filter((name) => /[1-9a-z]/i.test(known.get(name) ?? ""));
    subtitle.textContent = [run.meta.command, ...shown.map((name) => `${name.replaceAll("-", " ")} ${known.get(name)}`)].join(" · ");
    subtitle.title = subtitle.textContent;
    stats.replaceChildren();
    if (!scan) return;
    stats.append(stat("scans", `${scan.scan + 1}/${run.scans.length}`));
    if (scan.coverage !== null) stats.append(stat("coverage", percent(scan.coverage)));
    stats.append(stat("occupied", whole(scan.occupied)), stat("quality", fixed(scan.mean_quality, 3)));
    stats.append(stat("distance", `${fixed(scan.distance, 2)} m`));
  };
  session.store.subscribe(update);
  update();
  const mark = h("span", { class: "mark", "aria-hidden": "true" });
  return h("header", {}, mark, h("div", { class: "titles" }, title, subtitle), stats, themeButton, help);
}

export function helpDialog(): HTMLDialogElement {
  const keys: [string, string][] = [
    ["Space", "play or pause"],
    ["← →", "scan before or after"],
    ["Home End", "first or last scan"],
    ["1 – 5", "unmarked, occupied, empty, occluded, occplane: hide, fade, show"],
    ["c", "next colouring of the occupied voxels"],
    ["v p f s", "candidate views, path, frustum, what this scan saw"],
    ["n k m g", "normals, cloud, surface, ground truth"],
    ["x y z", "slice across that axis, again: off"],
    ["[ ]", "move the slice"],
    ["t", "light or dark"],
    ["Esc", "close, select nothing"],
    ["in the scene", "arrow keys orbit, + and − zoom, Home resets; drag, wheel, pinch; click a view or voxel"],
    ["in a map", "← → go through the ranking of the views"],
  ];
  const rows = keys.flatMap(([key, text]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, text)]);
  const dialog = h("dialog", { "aria-label": "keys" }, h("h2", {}, "Keys"), h("dl", {}, ...rows));
  dialog.append(h("form", { method: "dialog" }, h("button", {}, "Close")));
  return dialog;
}
