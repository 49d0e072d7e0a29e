/** Values of all candidates as a map over the sphere, or as a slice of the cube; before and after convolution. */
import type { Candidates, Plan } from "../data/run.ts";
import { parseHex, shareColor, shareHex, type Rgb } from "../model/colors.ts";
import { nearestMap, toMap } from "../model/projection.ts";
import type { Session } from "../model/session.ts";
import { QUANTITIES, type Quantity } from "../model/state.ts";
import { h, svg } from "./dom.ts";
import { significant } from "./format.ts";
import { theme } from "./theme.ts";

const QUANTITY_TEXT: Record<Quantity, string> = {
  utility: "utility",
  f_area: "f area",
  f_navigation: "f navigation",
  f_quality: "f quality",
  f_occlusion: "f occlusion",
  n_op: "occplane voxels seen",
};

/** Which candidate each pixel shows, and where each candidate's middle is in a box of 1 x `aspect`. */
interface Layout {
  width: number;
  height: number;
  owner: Int32Array;
  centers: { x: number; y: number }[];
}

function sphereLayout({ poses, center, count }: Candidates): Layout {
  const [width, height] = [360, 180];
  const directions = new Float32Array(3 * count);
  const centers = Array.from({ length: count }, (_, i) => {
    const d = [0, 1, 2].map((a) => poses[7 * i + a] - center[a]);
    const length = Math.hypot(...d) || 1;
    d.forEach((c, a) => (directions[3 * i + a] = c / length));
    const { u, v } = toMap(d[0] / length, d[1] / length, d[2] / length);
    return { x: ((u + 2) / 4) * width, y: ((1 - v) / 2) * height };
  });
  return { width, height, owner: nearestMap(directions, width, height), centers };
}

function gridLayout(candidates: Candidates, layer: number): Layout {
  const { cellsPerSide: n, cells } = candidates.grid!;
  const scale = Math.max(4, Math.floor(240 / n));
  const size = n * scale;
  const owner = new Int32Array(size * size).fill(-1);
  const centers = Array.from({ length: candidates.count }, () => ({ x: -1, y: -1 }));
  for (let i = 0; i < candidates.count; ++i) {
    const [cx, cy, cz] = cells.subarray(3 * i, 3 * i + 3);
    if (cz !== layer) continue;
    const [left, top] = [cx * scale, (n - 1 - cy) * scale];
    for (let y = 0; y < scale - 1; ++y) owner.fill(i, (top + y) * size + left, (top + y) * size + left + scale - 1);
    centers[i] = { x: left + scale / 2, y: top + scale / 2 };
  }
  return { width: size, height: size, owner, centers };
}

class MapPicture {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", {});
  private readonly marks = svg("svg", { class: "marks", "aria-hidden": "true" });
  private readonly caption = h("span", {});

  constructor(onPick: (candidate: number) => void, onKey: (event: KeyboardEvent) => void) {
    const stage = h("div", { class: "map-stage" }, this.canvas, this.marks as unknown as HTMLElement);
    this.element = h("figure", { class: "map" }, h("figcaption", {}, this.caption), stage);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.addEventListener("keydown", onKey);
    this.canvas.addEventListener("click", (event) => {
      const box = this.canvas.getBoundingClientRect();
      const x = Math.floor(((event.clientX - box.left) * this.canvas.width) / box.width);
      const y = Math.floor(((event.clientY - box.top) * this.canvas.height) / box.height);
      const owner = this.layout?.owner[y * this.canvas.width + x] ?? -1;
      if (owner >= 0) onPick(owner);
    });
  }

  private layout: Layout | null = null;

  draw(name: string, layout: Layout, plan: Plan, values: ArrayLike<number>, highest: number, marks: Marks): void {
    this.layout = layout;
    this.caption.textContent = `${name}, highest ${significant(highest, 3)}`;
    this.canvas.setAttribute("aria-label", `${name} of all candidate views; left and right arrows go through the ranking`);
    this.canvas.width = layout.width;
    this.canvas.height = layout.height;
    const context = this.canvas.getContext("2d")!;
    const image = context.createImageData(layout.width, layout.height);
    const [grey, stripe] = theme.mode === "dark" ? ["#3a414c", "#2b313a"] : ["#cdd3da", "#b7bfc9"];
    const greys = [parseHex(grey), parseHex(stripe)];
    layout.owner.forEach((owner, p) => {
      if (owner < 0) return;
      const [x, y] = [p % layout.width, Math.floor(p / layout.width)];
      let rgb: Rgb;
      if (plan.infeasible[owner] || Number.isNaN(values[owner])) rgb = greys[(x + y) % 6 < 2 ? 1 : 0];
      else rgb = shareColor(highest > 0 ? values[owner] / highest : 0);
      image.data.set([...rgb, 255], 4 * p);
    });
    context.putImageData(image, 0, 0);
    this.drawMarks(layout, marks);
  }

  private drawMarks(layout: Layout, { path, chosen, selected }: Marks): void {
    this.marks.setAttribute("viewBox", `0 0 ${layout.width} ${layout.height}`);
    const parts: SVGElement[] = [];
    for (const i of path) {
      const { x, y } = layout.centers[i];
      if (x >= 0) parts.push(svg("circle", { cx: x, cy: y, r: 2.6, class: "mark-path" }));
    }
    for (const [i, kind] of [[chosen, "mark-chosen"], [selected, "mark-selected"]] as const) {
      if (i === null || (layout.centers[i]?.x ?? -1) < 0) continue;
      const { x, y } = layout.centers[i];
      parts.push(svg("circle", { cx: x, cy: y, r: kind === "mark-chosen" ? 6 : 8, class: kind }));
    } // prettier-ignore
    this.marks.replaceChildren(...parts);
  }
}

interface Marks {
  path: number[];
  chosen: number | null;
  selected: number | null;
}

export function utilityMap(session: Session): HTMLElement {
  const { store } = session;
  const pick = (index: number) => store.set({ selection: { kind: "view", index } });
  const key = (event: KeyboardEvent) => {
    const plan = session.planAt(store.state.step)?.plan;
    const move = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!plan || !move) return;
    event.preventDefault();
    event.stopPropagation();
    const ranking = session.ranking(plan);
    if (ranking.length === 0) return;
    const selected = store.state.selection?.kind === "view" ? ranking.indexOf(store.state.selection.index) : -1;
    pick(ranking[(selected + move + ranking.length) % ranking.length]);
  };
  const before = new MapPicture(pick, key);
  const after = new MapPicture(pick, key);
  const choice = h("select", {
    "aria-label": "quantity",
    onchange: (e: Event) => store.set({ quantity: (e.target as HTMLSelectElement).value as Quantity }),
  }, ...QUANTITIES.map((q) => h("option", { value: q }, QUANTITY_TEXT[q]))); // prettier-ignore
  const layerInput = h("input", { type: "range", min: 0, "aria-label": "height of the slice through the cube" });
  layerInput.addEventListener("input", () => update());
  const layerRow = h("label", { class: "inline" }, "height ", layerInput);
  const note = h("p", { class: "note" });
  const colors = [0, 0.25, 0.5, 0.75, 1].map(shareHex).join(", ");
  const legend = h("div", { class: "scale" }, "0", h("span", { style: `background: linear-gradient(90deg, ${colors})` }), "highest");
  const maps = h("div", { class: "maps" }, before.element, after.element);
  const element = h("section", { class: "card", id: "utilities" },
    h("h2", {}, "Where to look next"), h("div", { class: "bar" }, choice, layerRow, legend), note, maps); // prettier-ignore

  let layouts: { run: unknown; layer: number; layout: Layout } | null = null;
  const layoutFor = (layer: number): Layout => {
    const { candidates } = session.run;
    if (layouts?.run !== candidates || layouts.layer !== layer) {
      layouts = { run: candidates, layer, layout: candidates.grid ? gridLayout(candidates, layer) : sphereLayout(candidates) };
    }
    return layouts.layout;
  };
  let shownStep = -1;
  const update = () => {
    const { state } = store;
    const { candidates, scans } = session.run;
    const planned = session.planAt(state.step);
    const plan = planned?.plan;
    choice.value = state.quantity;
    layerRow.hidden = !candidates.grid;
    maps.hidden = !plan;
    if (!plan) {
      note.textContent = scans.length ? "No view was planned after this scan." : "Nothing has been planned yet.";
      return;
    }
    if (candidates.grid && shownStep !== state.step) {
      shownStep = state.step;
      layerInput.max = String(candidates.grid.cellsPerSide - 1);
      const best = plan.chosen ?? session.ranking(plan)[0];
      layerInput.value = String(best === undefined ? candidates.grid.cellsPerSide >> 1 : candidates.grid.cells[3 * best + 2]);
    }
    const layout = layoutFor(candidates.grid ? Number(layerInput.value) : 0);
    const marks: Marks = {
      path: scans.slice(0, state.step + 1).flatMap((s) => (s.candidate === null ? [] : [s.candidate])),
      chosen: plan.chosen,
      selected: state.selection?.kind === "view" ? state.selection.index : null,
    };
    const values = session.quantityOf(plan, state.quantity);
    before.draw(QUANTITY_TEXT[state.quantity], layout, plan, values, session.highest(values, plan), marks);
    after.element.hidden = !plan.convolved;
    if (plan.convolved) {
      const convolved = plan.convolved;
      after.draw("convolved", layout, plan, convolved, session.highest(convolved, plan), marks);
    }
    const out = plan.infeasible.reduce((n, r) => n + (r ? 1 : 0), 0);
    const unknown = plan.utility.reduce((n, u, i) => n + (Number.isNaN(u) && !plan.infeasible[i] ? 1 : 0), 0);
    const striped = [out ? "infeasible" : "", unknown ? "not evaluated" : ""].filter(Boolean).join(" or ");
    const feasible = `${candidates.count - out} of ${candidates.count} candidates feasible`;
    const choiceText = plan.chosen === null ? "no view chosen" : `view ${plan.chosen} ${planned!.made === "after" ? "is next" : "was the last"}`;
    note.textContent = `${planned!.made === "after" ? "After" : "Before"} scan ${state.step + 1}: ${choiceText}. ${feasible}${striped ? `; striped: ${striped}` : ""}.`;
  };
  store.subscribe(update);
  theme.subscribe(update);
  update();
  return element;
}
