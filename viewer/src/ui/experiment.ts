/** The page of an experiment: figures and tables against the paper's values. */
import { decodeExperiment, type Cell, type Experiment, type Figure, type Table } from "../data/experiment.ts";
import { readable, type ReadableTable } from "../model/estimates.ts";
import { lineChart, type Series } from "./charts.ts";
import { h } from "./dom.ts";
import { significant } from "./format.ts";
import { theme } from "./theme.ts";

const COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const DASHES = [undefined, "8 3", "2 3", "10 3 2 3", "5 5", "1 4"];

/** A picture that the program drew. It comes from the same file as this script; scripts in it are dropped all the same. */
function picture(f: Figure): HTMLElement {
  const host = h("div", { class: "svg-plot" });
  host.innerHTML = f.svg;
  for (const element of host.querySelectorAll("*")) {
    if (element.localName === "script") element.remove();
    for (const { name } of [...element.attributes]) if (/^on/i.test(name)) element.removeAttribute(name);
  }
  return h("figure", { class: "card" }, host, caption(f));
}

function caption(f: Figure): HTMLElement | null {
  const words = [f.figure, f.note].filter((text) => text && text !== f.title).map((text) => text.replace(/\.?$/, "."));
  return words.length ? h("figcaption", { class: "note" }, words.join(" ")) : null;
}

function figure(f: Figure): HTMLElement {
  if (f.svg) return picture(f);
  const x = [...new Set(f.series.flatMap((s) => s.x))].sort((a, b) => a - b);
  const spread = (xs: number[], ys: (number | null)[] | undefined) =>
    ys && x.map((value) => { const i = xs.indexOf(value); return i < 0 ? null : ys[i]; }); // prettier-ignore
  let own = 0;
  const series = f.series.map((s): Series => {
    const i = s.paper ? 0 : own++ % COLORS.length;
    return {
      name: s.paper ? (s.name === "paper" ? "paper" : `${s.name} (paper)`) : s.name,
      color: s.paper ? "var(--ink)" : COLORS[i],
      dash: s.paper ? undefined : DASHES[i],
      marks: s.paper,
      values: spread(s.x, s.y)!,
      low: spread(s.x, s.low),
      high: spread(s.x, s.high),
    };
  });
  const shares = /%/.test(f.y_label) && f.series.every((one) => one.y.every((y) => y === null || (y >= 0 && y <= 100)));
  const options = { title: f.title, unit: f.y_label, x, xLabel: f.x_label, min: f.y_min, max: f.y_max ?? (shares ? 100 : undefined), width: 560, height: 300, format: (v: number) => significant(v, 4) };
  const chart = lineChart(series, options, (i) => chart.mark(i));
  return h("div", { class: "card" }, chart.element, caption(f));
}

/** Without the columns that hold nothing, for example the paper's where it has no such number. */
function withoutEmpty(t: Table): Table {
  const kept = t.columns.map((_, i) => i).filter((i) => t.rows.some((row) => row[i] !== null && row[i] !== ""));
  return {
    ...t,
    columns: kept.map((i) => t.columns[i]),
    rows: t.rows.map((row) => kept.map((i) => row[i])),
    paper_columns: t.paper_columns.map((i) => kept.indexOf(i)).filter((i) => i >= 0),
    verdict_column: t.verdict_column === null ? null : kept.indexOf(t.verdict_column),
  };
}

const VERDICT = { good: "inside of the band that counts as reproducing the paper", bad: "outside of that band" };

function tableOf(t: Table): ReadableTable {
  const joined = readable(t);
  if (joined) return joined;
  const full = withoutEmpty(t);
  const kind = (i: number) => (full.paper_columns.includes(i) ? "paper" : full.rows.some((row) => typeof row[i] === "number") ? "number" : "text");
  const verdict = (cell: Cell) => (/^(ok|yes|pass|in band)/i.test(String(cell)) ? "good" : "bad");
  return {
    columns: full.columns.map((title, i) => ({ title, kind: kind(i) })),
    rows: full.rows.map((row) =>
      row.map((cell, i) => ({
        text: typeof cell === "number" ? significant(cell, 4) : cell === null ? "–" : cell,
        kind: full.verdict_column === i ? verdict(cell) : kind(i),
      })),
    ),
  };
}

function table(t: Table): HTMLElement {
  const { columns, rows } = tableOf(t);
  const head = columns.map((c) => h("th", { scope: "col", class: c.kind }, c.title));
  const body = rows.map((row) =>
    h("tr", {}, ...row.map((c, i) => (i === 0 ? h("th", { scope: "row", class: "text" }, c.text) : h("td", { class: c.kind, title: VERDICT[c.kind as keyof typeof VERDICT] ?? null }, c.text)))),
  );
  return h(
    "section",
    { class: "card" },
    h("h2", {}, t.title),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": t.title }, h("table", {}, h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...body))),
    t.note ? h("p", { class: "note" }, t.note) : null,
  );
}

export function showExperiment(app: HTMLElement, document_: unknown): Experiment {
  const experiment = decodeExperiment(document_);
  document.title = `${experiment.title} · Vantage`;
  const toggle = h("button", { type: "button", class: "icon", "aria-label": "light or dark", onclick: () => theme.toggle() }, "◐");
  app.className = "experiment";
  app.replaceChildren(
    h("header", {}, h("span", { class: "mark", "aria-hidden": "true" }), h("div", { class: "titles" }, h("h1", {}, experiment.title), h("p", {}, "Vantage experiment")), toggle),
    h("style", {}, experiment.svg_style),
    h("main", {},
      ...experiment.text.map((t) => h("p", { class: "lead" }, t)),
      h("div", { class: "figures" }, ...experiment.figures.map((f, i, all) => figure(all[i - 1]?.note === f.note && all[i - 1]?.figure === f.figure ? { ...f, note: "", figure: "" } : f))),
      ...experiment.tables.map(table),
    ),
  ); // prettier-ignore
  return experiment;
}
