/** The curves over the scans. */
import { LABELS, type Run } from "../data/run.ts";
import { LABEL_COLORS } from "../model/colors.ts";
import { labelCounts } from "../model/labels.ts";
import type { Session } from "../model/session.ts";
import { lineChart, type Chart, type Series } from "./charts.ts";
import { h } from "./dom.ts";
import { theme } from "./theme.ts";

const INK = { a: "#0072b2", b: "#d55e00", c: "#009e73", d: "#cc79a7", e: "#e69f00", f: "#56b4e9" };
const STAGE_COLORS = Object.values(INK);

function milliseconds(run: Run): Series[] {
  const stages = [...new Set(run.scans.flatMap((s) => s.milliseconds.map(([name]) => name)))];
  return stages.map((name, i) => ({
    name,
    color: STAGE_COLORS[i % STAGE_COLORS.length],
    values: run.scans.map((s) => s.milliseconds.find(([n]) => n === name)?.[1] ?? 0),
  }));
}

function build(session: Session, onPick: (scan: number) => void): Chart[] {
  const { run } = session;
  const { scans } = run;
  const values = (key: "coverage" | "coverage_all" | "mean_quality" | "distance" | "overlap") => scans.map((s) => s[key]);
  const charts: Chart[] = [];
  const percentText = (v: number) => `${Number((100 * v).toFixed(1))}`;
  if (values("coverage").some((v) => v !== null)) {
    const series: Series[] = [
      { name: "of what can be seen", color: INK.a, values: values("coverage") },
      { name: "of all", color: INK.b, values: values("coverage_all"), dash: "5 3" },
    ];
    charts.push(lineChart(series, { title: "Coverage", unit: "%", min: 0, max: 1, format: percentText }, onPick));
  }
  charts.push(lineChart([{ name: "quality", color: INK.a, values: values("mean_quality") }], { title: "Mean quality", min: 0, max: 1, format: (v) => String(Number(v.toFixed(3))) }, onPick));
  charts.push(lineChart([{ name: "distance", color: INK.a, values: values("distance") }], { title: "Distance travelled", unit: "m", min: 0, format: (v) => String(Number(v.toFixed(2))) }, onPick));
  const counts = labelCounts(run);
  const dashes = ["2 2", undefined, "7 2", "7 2 2 2", "4 2"];
  const shown = [1, 4, 3, 0]; // the empty ones are nearly all and would flatten the others
  const labels = shown.map((l): Series => ({ name: LABELS[l], color: LABEL_COLORS[l], dash: dashes[l], values: counts.map((c) => c[l]) }));
  charts.push(lineChart(labels, { title: "Labels", unit: "voxels of the enclosure", min: 0 }, onPick));
  if (values("overlap").some((v, i) => i > 0 && v !== null)) {
    const overlap = values("overlap").map((v, i) => (i === 0 ? null : v));
    charts.push(lineChart([{ name: "overlap", color: INK.a, values: overlap }], { title: "Overlap with the model", unit: "%", min: 0, max: 1, format: percentText }, onPick));
  }
  const times = milliseconds(run);
  if (times.length) charts.push(lineChart(times, { title: "Time", unit: "ms", stacked: true, format: (v) => String(Number(v.toPrecision(3))) }, onPick));
  return charts;
}

export function curves(session: Session, onPick: (scan: number) => void): HTMLElement {
  const { store } = session;
  const grid = h("div", { class: "charts" });
  let charts: Chart[] = [];
  let built: [unknown, number] = [null, -1];
  const update = () => {
    const { run } = session;
    if (built[0] !== run || built[1] !== run.scans.length) {
      built = [run, run.scans.length];
      charts = run.scans.length ? build(session, onPick) : [];
      grid.replaceChildren(...charts.map((c) => c.element));
    }
    for (const chart of charts) chart.mark(store.state.step);
  };
  store.subscribe(update);
  theme.subscribe(update);
  update();
  return h("section", { class: "card", id: "curves" }, h("h2", {}, "Over the scans"), grid);
}

