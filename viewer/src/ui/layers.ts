/** The panel over the scene: what is shown and how. */
import { LABELS } from "../data/run.ts";
import { LABEL_COLORS } from "../model/colors.ts";
import type { Session } from "../model/session.ts";
import { COLORINGS, type Coloring, type LabelMode, type Layer } from "../model/state.ts";
import { h, segments } from "./dom.ts";

const MODES: { value: LabelMode; text: string; title: string }[] = [
  { value: "hide", text: "–", title: "hide" },
  { value: "fade", text: "◌", title: "fade" },
  { value: "show", text: "●", title: "show" },
];

const LAYER_TEXT: Record<Layer, [string, string]> = {
  candidates: ["Candidate views", "small cameras coloured by utility; grey: infeasible"],
  path: ["Path", "line: commanded; balls: registered poses"],
  frustum: ["Current frustum", "what the current scan could see"],
  seen: ["Only what it saw", "greys out what this scan did not touch"],
  normals: ["Normals", "strokes along the normals of occupied voxels"],
  cloud: ["Point cloud", "the fused cloud, coloured by scan"],
  mesh: ["Surface", "the reconstructed mesh, after the last scan"],
  truth: ["Ground truth", "the true surface as a ghost"],
};

const AXES = ["x", "y", "z"] as const;

export function layersPanel(session: Session): HTMLDetailsElement {
  const { store } = session;
  const labelRows = LABELS.map((label, i) => {
    const choice = segments(`${label} voxels`, MODES, (mode) => store.setLabel(i, mode));
    const swatch = h("span", { class: "swatch", style: `background:${LABEL_COLORS[i]}` });
    const row = h("div", { class: "row", "data-label": label }, swatch, h("span", { class: "grow" }, label), choice.element);
    return { row, choice };
  });
  const coloring = segments<Coloring>(
    "Colour occupied voxels by",
    COLORINGS.map((value) => ({ value, text: value })),
    (value) => store.set({ coloring: value }),
  );
  const boxes = (Object.keys(LAYER_TEXT) as Layer[]).map((layer) => {
    const [text, title] = LAYER_TEXT[layer];
    const input = h("input", {
      type: "checkbox",
      "data-layer": layer,
      onchange: (e: Event) => store.setLayer(layer, (e.target as HTMLInputElement).checked),
    });
    const row = h("label", { class: "check", title }, input, text);
    return { layer, input, row };
  });
  const slice = slicePanel(session);
  const body = h(
    "div",
    { class: "layers-body" },
    h("h3", {}, "Voxels"),
    ...labelRows.map((r) => r.row),
    h("h3", {}, "Colour of occupied"),
    coloring.element,
    h("h3", {}, "Slice"),
    slice.element,
    h("h3", {}, "Layers"),
    h("div", { class: "checks" }, ...boxes.map((b) => b.row)),
  );
  const panel = h("details", { class: "layers", open: window.innerWidth > 760 }, h("summary", {}, "Scene"), body);

  const update = () => {
    const { state, run } = { state: store.state, run: session.run };
    labelRows.forEach(({ choice }, i) => choice.set(state.labels[i]));
    coloring.set(state.coloring);
    for (const { layer, input, row } of boxes) {
      const missing =
        (layer === "cloud" && !run.cloud) || (layer === "mesh" && !run.mesh) || (layer === "truth" && !run.truth);
      row.hidden = missing;
      input.checked = state.layers[layer];
    }
    slice.update();
  };
  store.subscribe(update);
  update();
  return panel;
}

function slicePanel(session: Session): { element: HTMLElement; update: () => void } {
  const { store } = session;
  const size = () => session.run.grid.enclosureSize;
  const axis = segments<"off" | "x" | "y" | "z">(
    "Slice across",
    (["off", ...AXES] as const).map((value) => ({ value, text: value })),
    (value) => {
      if (value === "off") return store.set({ slice: null });
      const a = AXES.indexOf(value) as 0 | 1 | 2;
      store.set({ slice: { axis: a, index: Math.floor(size()[a] / 2) } });
    },
  );
  const place = h("input", {
    type: "range",
    min: 0,
    "aria-label": "place of the slice",
    oninput: (e: Event) => {
      const { slice } = store.state;
      if (slice) store.set({ slice: { ...slice, index: Number((e.target as HTMLInputElement).value) } });
    },
  });
  const update = () => {
    const { slice } = store.state;
    axis.set(slice ? AXES[slice.axis] : "off");
    place.hidden = !slice;
    if (!slice) return;
    place.max = String(size()[slice.axis] - 1);
    place.value = String(slice.index);
  };
  return { element: h("div", {}, axis.element, place), update };
}
