/** What a click on a view or a voxel shows. */
import { LABELS, OCCUPIED, SCAN_NUMBERS, type Plan } from "../data/run.ts";
import { NEVER } from "../data/history.ts";
import type { Session } from "../model/session.ts";
import { h } from "./dom.ts";
import { fixed, percent, significant, whole } from "./format.ts";

type Row = [name: string, text: string, exact?: number | null];

export const FACTOR_KEYS = ["utility", "f_area", "f_navigation", "f_quality", "f_occlusion", "n_oc", "n_op", "n_um"] as const;

const TEXT: Record<string, string> = {
  utility: "utility",
  f_area: "f area",
  f_navigation: "f navigation",
  f_quality: "f quality",
  f_occlusion: "f occlusion",
  n_oc: "occupied seen",
  n_op: "occplane seen",
  n_um: "unmarked seen",
};

function list(rows: Row[]): HTMLElement {
  return h(
    "dl",
    {},
    ...rows.flatMap(([name, text, exact]) => [h("dt", {}, name), h("dd", { "data-exact": exact ?? null }, text)]),
  );
}

function planRows(plan: Plan, index: number): Row[] {
  const rows = FACTOR_KEYS.map((key): Row => {
    const value = plan[key][index];
    return [TEXT[key], key.startsWith("n_") ? whole(value) : significant(value), value];
  });
  if (plan.convolved) rows.splice(1, 0, ["expected utility", significant(plan.convolved[index]), plan.convolved[index]]);
  return rows;
}

export function viewDetails(session: Session, index: number): HTMLElement {
  const { run, store } = session;
  const { step } = store.state;
  const planned = session.planAt(step);
  const plan = planned?.plan;
  const poses = run.candidates.poses;
  const position = [0, 1, 2].map((a) => fixed(poses[7 * index + a], 3)).join(", ");
  const taken = run.scans.filter((s) => s.candidate === index);
  const parts: (HTMLElement | null)[] = [h("h3", {}, `View ${index}`)];
  if (plan?.infeasible[index]) {
    parts.push(h("p", { class: "bad" }, `Infeasible: ${plan.reasons[plan.infeasible[index] - 1]}`));
  } else if (plan) {
    const place = session.ranking(plan).indexOf(index);
    const when = `${planned!.made} scan ${step + 1}`;
    if (plan.chosen === index) parts.push(h("p", { class: "good" }, `Chosen ${when}.`));
    else if (place >= 0) parts.push(h("p", {}, `Rank ${place + 1} of ${session.ranking(plan).length} ${when}.`));
    else parts.push(h("p", {}, `Not evaluated to the end ${when}.`));
  } else parts.push(h("p", {}, "No view was planned after this scan."));
  const rows: Row[] = plan ? planRows(plan, index) : [];
  rows.push(["position", `${position} m`]);
  if (taken.length) rows.push(["taken as scan", taken.map((s) => s.scan + 1).join(", ")]);
  parts.push(list(rows));
  return h("div", {}, ...parts);
}

export function voxelDetails(session: Session, voxel: number): HTMLElement {
  const { grid } = session.run;
  const map = session.map(session.store.state.step);
  const [nx, ny] = grid.enclosureSize;
  const local = [voxel % nx, Math.floor(voxel / nx) % ny, Math.floor(voxel / (nx * ny))];
  const index = local.map((i, a) => i + grid.enclosureMin[a]);
  const center = index.map((i, a) => fixed(grid.origin[a] + (i + 0.5) * grid.voxel, 3));
  const label = map.labels[voxel];
  const rows: Row[] = [
    ["label", LABELS[label]],
    ["index in the scene", index.join(", ")],
    ["centre", `${center.join(", ")} m`],
  ];
  if (label === OCCUPIED) {
    const normal = [0, 1, 2].map((a) => map.normals[3 * voxel + a] / 127);
    const known = normal.some((c) => c !== 0);
    rows.push(["normal", known ? normal.map((c) => fixed(c, 2)).join(", ") : "unknown"]);
    rows.push(["quality", known ? fixed(map.quality[voxel] / 255, 2) : "0 (no normal)"]);
    const first = map.firstScan[voxel];
    rows.push(["first occupied", first === NEVER ? "–" : `scan ${first + 1}`]);
  }
  return h("div", {}, h("h3", {}, "Voxel"), list(rows));
}

/** The card over the scene that shows the selection; empty where nothing is selected. */
export function detailsCard(session: Session): HTMLElement {
  const { store } = session;
  const close = h("button", { type: "button", class: "close", "aria-label": "close", onclick: () => store.set({ selection: null }) }, "×");
  const body = h("div", { "aria-live": "polite" });
  const card = h("aside", { class: "details-card", "aria-label": "selection" }, close, body);
  const update = () => {
    const { selection } = store.state;
    card.hidden = !selection || session.run.scans.length === 0;
    if (card.hidden || !selection) return;
    body.replaceChildren(
      selection.kind === "view" ? viewDetails(session, selection.index) : voxelDetails(session, selection.index),
    );
  };
  store.subscribe(update);
  update();
  return card;
}

const COLUMNS: { key: (typeof SCAN_NUMBERS)[number] | "candidate" | "verdict"; text: string; format: (v: number | null) => string }[] = [
  { key: "candidate", text: "view", format: whole },
  { key: "utility", text: "utility", format: (v) => significant(v, 4) },
  { key: "f_area", text: "f area", format: (v) => significant(v, 3) },
  { key: "f_navigation", text: "f nav.", format: (v) => significant(v, 3) },
  { key: "f_quality", text: "f quality", format: (v) => significant(v, 3) },
  { key: "f_occlusion", text: "f occl.", format: (v) => significant(v, 3) },
  { key: "n_oc", text: "n oc", format: whole },
  { key: "n_op", text: "n op", format: whole },
  { key: "n_um", text: "n um", format: whole },
  { key: "new_occupied", text: "new", format: whole },
  { key: "distance", text: "distance", format: (v) => fixed(v, 2) },
  { key: "coverage", text: "coverage", format: (v) => percent(v, 2) },
  { key: "overlap", text: "overlap", format: (v) => percent(v, 0) },
];

/** One row per scan: the view with what was expected of it and what it brought. */
export function scansTable(session: Session, onPick: (scan: number) => void): HTMLElement {
  const { store } = session;
  const head = h("tr", {}, h("th", { scope: "col" }, "scan"), ...COLUMNS.map((c) => h("th", { scope: "col" }, c.text)), h("th", { scope: "col" }, "verdict"));
  const body = h("tbody", {});
  const table = h("table", {}, h("thead", {}, head), body);
  const stop = h("p", { class: "stop" });
  let rowsOf: unknown = null;
  let count = -1;
  const update = () => {
    const { run } = session;
    if (rowsOf !== run || count !== run.scans.length) {
      rowsOf = run;
      count = run.scans.length;
      body.replaceChildren(
        ...run.scans.map((scan) =>
          h(
            "tr",
            { onclick: () => onPick(scan.scan), class: scan.registered ? null : "failed", title: scan.reason },
            h("th", { scope: "row" }, h("button", { type: "button" }, String(scan.scan + 1))),
            ...COLUMNS.map((c) => {
              const value = scan[c.key] as number | null;
              return h("td", { "data-key": c.key, "data-exact": value }, c.format(value));
            }),
            h("td", { class: "text" }, scan.verdict),
          ),
        ),
      );
    }
    [...body.children].forEach((row, i) => row.setAttribute("aria-current", String(i === store.state.step)));
    stop.textContent = run.stop_reason ? `Stopped: ${run.stop_reason}` : "";
  };
  store.subscribe(update);
  update();
  return h("section", { class: "card", id: "table" }, h("h2", {}, "Chosen views"), stop, h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "table of chosen views" }, table));
}
