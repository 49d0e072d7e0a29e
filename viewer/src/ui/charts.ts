/** Line charts over the scans, drawn as SVG. */
import { h, svg } from "./dom.ts";
import { ticks, tickText } from "./format.ts";

export interface Series {
  name: string;
  color: string;
  /** One value per x; null leaves a gap. */
  values: readonly (number | null)[];
  /** Drawn dashed, to be told apart without colours. */
  dash?: string;
  /** Single published values: open diamonds without a line. */
  marks?: boolean;
  /** A band around the line. */
  low?: readonly (number | null)[];
  high?: readonly (number | null)[];
}

export interface ChartOptions {
  title: string;
  unit?: string;
  /** x of each value; 1, 2, 3, … by default. */
  x?: readonly number[];
  xLabel?: string;
  min?: number;
  max?: number;
  width?: number;
  height?: number;
  /** Series drawn on top of each other as areas. */
  stacked?: boolean;
  format?: (value: number) => string;
}

const M = { left: 34, right: 8, top: 8, bottom: 18 };

export interface Chart {
  element: HTMLElement;
  /** Marks the place of scan `index` and writes its values into the legend. */
  mark: (index: number) => void;
}

function range(series: Series[], options: ChartOptions): [number, number] {
  const all = series.flatMap((s) => [...s.values, ...(s.low ?? []), ...(s.high ?? [])]).filter((v): v is number => v !== null && Number.isFinite(v));
  if (options.stacked) {
    const count = Math.max(...series.map((s) => s.values.length));
    const sums = Array.from({ length: count }, (_, i) => series.reduce((n, s) => n + (s.values[i] ?? 0), 0));
    return [0, Math.max(1e-9, ...sums)];
  }
  const low = options.min ?? Math.min(...all, Infinity);
  const high = options.max ?? Math.max(...all, -Infinity);
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  return high > low ? [low, high] : [low - 0.5, high + 0.5];
}

/** Chart of several series; a click calls `onPick` with the index of the nearest x. */
export function lineChart(series: Series[], options: ChartOptions, onPick: (index: number) => void = () => {}): Chart {
  const { width = 212, height = 112, format = tickText } = options;
  const count = Math.max(1, ...series.map((s) => s.values.length));
  const xs = options.x ?? Array.from({ length: count }, (_, i) => i + 1);
  const [low, high] = range(series, options);
  const [first, last] = [Math.min(...xs), Math.max(...xs)];
  const bottom = M.bottom + (options.xLabel ? 18 : 0);
  const px = (x: number) => M.left + ((width - M.left - M.right) * (x - first)) / Math.max(1e-9, last - first);
  const py = (y: number) => height - bottom - ((height - M.top - bottom) * (y - low)) / (high - low);
  const parts: SVGElement[] = [];
  for (const y of ticks(low, high, Math.max(3, Math.round(height / 50)))) {
    parts.push(svg("line", { x1: M.left, x2: width - M.right, y1: py(y), y2: py(y), class: "grid" }));
    parts.push(svg("text", { x: M.left - 6, y: py(y) + 3.5, class: "tick", "text-anchor": "end" }, format(y)));
  }
  const every = xs.every(Number.isInteger);
  for (const x of ticks(first, last, Math.min(8, Math.max(1, count - 1))).filter((t) => !every || Number.isInteger(t))) {
    parts.push(svg("text", { x: px(x), y: height - bottom + 13, class: "tick", "text-anchor": "middle" }, tickText(x)));
  }
  if (options.xLabel) parts.push(svg("text", { x: (M.left + width - M.right) / 2, y: height - 4, class: "axis", "text-anchor": "middle" }, options.xLabel));
  const below = new Array<number>(count).fill(0);
  for (const s of series) parts.push(...drawSeries(s, options, xs, px, py, below));
  const cursor = svg("line", { y1: M.top, y2: height - bottom, class: "cursor", visibility: "hidden" });
  const dots = series.map((s) => svg("circle", { r: 3.5, fill: s.color, class: "dot", visibility: "hidden" }));
  const picture = svg(
    "svg",
    { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": describe(series, options) },
    ...parts,
    cursor,
    ...dots,
  );
  picture.addEventListener("click", (event) => {
    const box = picture.getBoundingClientRect();
    const x = ((event.clientX - box.left) * width) / box.width;
    let best = 0;
    xs.forEach((value, i) => {
      if (Math.abs(px(value) - x) < Math.abs(px(xs[best]) - x)) best = i;
    });
    onPick(best);
  });
  const values = series.map(() => h("b", {}));
  const legend = h(
    "div",
    { class: "legend" },
    ...series.map((s, i) => h("span", {}, swatch(s), series.length > 1 ? `${s.name} ` : "", values[i])),
  );
  const title = h("figcaption", {}, h("span", {}, options.title), h("span", { class: "unit" }, options.unit ?? ""));
  const element = h("figure", { class: "chart" }, title, picture as unknown as HTMLElement, legend);
  const mark = (index: number) => {
    cursor.setAttribute("visibility", index < count ? "visible" : "hidden");
    cursor.setAttribute("x1", String(px(xs[index] ?? 0)));
    cursor.setAttribute("x2", String(px(xs[index] ?? 0)));
    series.forEach((s, i) => {
      const value = s.values[index] ?? null;
      values[i].textContent = value === null ? "–" : format(value);
      dots[i].setAttribute("visibility", value === null || options.stacked ? "hidden" : "visible");
      if (value !== null) {
        dots[i].setAttribute("cx", String(px(xs[index])));
        dots[i].setAttribute("cy", String(py(value)));
      }
    });
  };
  return { element, mark };
}

function swatch(s: Series): SVGElement {
  if (s.marks) return svg("svg", { width: 16, height: 10, class: "key", "aria-hidden": "true" }, diamond(8, 5, s.color));
  const line = svg("line", { x1: 0, x2: 16, y1: 5, y2: 5, stroke: s.color, "stroke-width": 3, "stroke-dasharray": s.dash ?? null });
  return svg("svg", { width: 16, height: 10, class: "key", "aria-hidden": "true" }, line);
}

function diamond(x: number, y: number, color: string): SVGElement {
  const d = `M${x - 5},${y}L${x},${y - 5}L${x + 5},${y}L${x},${y + 5}Z`;
  return svg("path", { d, fill: "none", stroke: color, "stroke-width": 1.6 });
}

function drawSeries(
  s: Series,
  options: ChartOptions,
  xs: readonly number[],
  px: (x: number) => number,
  py: (y: number) => number,
  below: number[],
): SVGElement[] {
  const parts: SVGElement[] = [];
  if (options.stacked) {
    const top = s.values.map((v, i) => below[i] + (v ?? 0));
    const upper = top.map((v, i) => `${px(xs[i])},${py(v)}`);
    const lower = below.slice(0, top.length).map((v, i) => `${px(xs[i])},${py(v)}`);
    top.forEach((v, i) => (below[i] = v));
    return [svg("polygon", { points: [...upper, ...lower.reverse()].join(" "), fill: s.color, class: "area" })];
  }
  if (s.low && s.high) {
    // A band may reach beyond what can be, for example beyond 100 %.
    const inside = (v: number) => Math.min(options.max ?? v, Math.max(options.min ?? v, v));
    const upper = s.high.map((v, i) => (v === null ? null : `${px(xs[i])},${py(inside(v))}`));
    const lower = s.low.map((v, i) => (v === null ? null : `${px(xs[i])},${py(inside(v))}`)).reverse();
    const points = [...upper, ...lower].filter((p) => p !== null).join(" ");
    parts.push(svg("polygon", { points, fill: s.color, class: "band" }));
  }
  if (s.marks) {
    s.values.forEach((v, i) => {
      if (v !== null && Number.isFinite(v)) parts.push(diamond(px(xs[i]), py(v), s.color));
    });
    return parts;
  }
  let path = "";
  let pen = "M";
  s.values.forEach((v, i) => {
    if (v === null || !Number.isFinite(v)) pen = "M";
    else {
      path += `${pen}${px(xs[i]).toFixed(2)},${py(v).toFixed(2)}`;
      pen = "L";
    }
  });
  parts.push(svg("path", { d: path, stroke: s.color, class: "line", "stroke-dasharray": s.dash ?? null }));
  if (s.values.length <= 14) {
    s.values.forEach((v, i) => {
      if (v !== null && Number.isFinite(v)) parts.push(svg("circle", { cx: px(xs[i]), cy: py(v), r: 2, fill: s.color }));
    });
  }
  return parts;
}

function describe(series: Series[], { title, unit, format = tickText }: ChartOptions): string {
  const ends = series.map((s) => {
    const known = s.values.filter((v): v is number => v !== null);
    return known.length ? `${s.name} from ${format(known[0])} to ${format(known[known.length - 1])}` : `${s.name} unknown`;
  });
  return `${title}${unit ? ` in ${unit}` : ""}: ${ends.join("; ")}`;
}
