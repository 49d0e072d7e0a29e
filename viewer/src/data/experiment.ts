/** Experiment documents of docs/report-data.md. */
import { asObject, fail } from "./packed.ts";
import { checkVersion } from "./run.ts";

export type Cell = number | string | null;

export interface Figure {
  title: string;
  x_label: string;
  y_label: string;
  y_min?: number;
  y_max?: number;
  /** Of which figure this plot is a part, and what there is to know about it. */
  figure: string;
  note: string;
  /** A finished picture instead of series. */
  svg: string;
  series: { name: string; x: number[]; y: (number | null)[]; low?: (number | null)[]; high?: (number | null)[]; paper: boolean }[];
}

export interface Table {
  title: string;
  columns: string[];
  rows: Cell[][];
  paper_columns: number[];
  verdict_column: number | null;
  note: string;
  /** Its numbers with their spread, rows by measures; null where a cell holds none. Null for plain tables. */
  estimates: (Estimate | null)[][] | null;
  measures: Measure[];
}

/** A column of estimates. A difference is read with its sign and interval. */
export interface Measure {
  title: string;
  decimals: number;
  difference: boolean;
}

export interface Estimate {
  mean: number;
  sd: number | null;
  runs: number;
  low: number | null;
  high: number | null;
  paper: number | null;
  in_band: boolean | null;
}

export interface Experiment {
  title: string;
  text: string[];
  figures: Figure[];
  tables: Table[];
  /** Style sheet of the finished pictures. */
  svg_style: string;
}

function list(value: unknown, field: string): unknown[] {
  if (!Array.isArray(value)) fail(field, "must be a list");
  return value;
}

function text(value: unknown, field: string): string {
  if (typeof value !== "string") fail(field, "must be text");
  return value;
}

function numbers(value: unknown, field: string, length?: number): number[] {
  const values = list(value, field);
  if (length !== undefined && values.length !== length) fail(field, `has ${values.length} numbers, must have ${length}`);
  if (!values.every((v) => typeof v === "number" && Number.isFinite(v))) fail(field, "must hold numbers only");
  return values as number[];
}

/** As `numbers`, but a missing one may be null. */
function gappy(value: unknown, field: string, length: number): (number | null)[] {
  const values = list(value, field).map((v) => v ?? NaN);
  if (values.length !== length) fail(field, `has ${values.length} numbers, must have ${length}`);
  if (!values.every((v) => typeof v === "number")) fail(field, "must hold numbers or null");
  return (values as number[]).map((v) => (Number.isFinite(v) ? v : null));
}

function decodeFigure(value: unknown, field: string): Figure {
  const raw = asObject(value, field);
  const words = (key: string) => (raw[key] === undefined ? "" : text(raw[key], `${field}.${key}`));
  const svg = words("svg");
  const series = (svg ? [] : list(raw["series"], `${field}.series`)).map((item, i) => {
    const at = `${field}.series[${i}]`;
    const s = asObject(item, at);
    const x = numbers(s["x"], `${at}.x`);
    return {
      name: text(s["name"], `${at}.name`),
      x,
      y: gappy(s["y"], `${at}.y`, x.length),
      ...(s["low"] && s["high"]
        ? { low: gappy(s["low"], `${at}.low`, x.length), high: gappy(s["high"], `${at}.high`, x.length) }
        : {}),
      paper: s["paper"] === true,
    };
  });
  const optional = (key: string) => (typeof raw[key] === "number" ? { [key]: raw[key] as number } : {});
  return {
    title: text(raw["title"], `${field}.title`),
    x_label: svg ? "" : text(raw["x_label"], `${field}.x_label`),
    y_label: svg ? "" : text(raw["y_label"], `${field}.y_label`),
    figure: words("figure"),
    note: words("note"),
    svg,
    ...optional("y_min"),
    ...optional("y_max"),
    series,
  };
}

function decodeMeasure(value: unknown, field: string): Measure {
  const raw = asObject(value, field);
  const decimals = raw["decimals"];
  if (!Number.isInteger(decimals) || (decimals as number) < 0 || (decimals as number) > 12) fail(`${field}.decimals`, "must be 0 to 12");
  return { title: text(raw["title"], `${field}.title`), decimals: decimals as number, difference: raw["difference"] === true };
}

function decodeEstimate(value: unknown, field: string): Estimate | null {
  if (value === null) return null;
  const raw = asObject(value, field);
  const number = (key: string) => (typeof raw[key] === "number" ? raw[key] : null);
  const mean = number("mean");
  if (mean === null) return null;
  const band = raw["in_band"];
  return {
    mean, sd: number("sd"), runs: number("runs") ?? 1, low: number("low"), high: number("high"), paper: number("paper"),
    in_band: typeof band === "boolean" ? band : null,
  }; // prettier-ignore
}

function decodeEstimates(raw: Record<string, unknown>, rows: number, field: string): Pick<Table, "estimates" | "measures"> {
  if (raw["measures"] === undefined) return { estimates: null, measures: [] };
  const measures = list(raw["measures"], `${field}.measures`).map((m, i) => decodeMeasure(m, `${field}.measures[${i}]`));
  const estimates = list(raw["estimates"], `${field}.estimates`).map((row, r) => {
    const at = `${field}.estimates[${r}]`;
    const cells = list(row, at).map((cell, k) => decodeEstimate(cell, `${at}[${k}]`));
    if (cells.length !== measures.length) fail(at, `has ${cells.length} cells for ${measures.length} measures`);
    return cells;
  });
  if (estimates.length !== rows) fail(`${field}.estimates`, `has ${estimates.length} rows, must have ${rows}`);
  return { estimates, measures };
}

function decodeTable(value: unknown, field: string): Table {
  const raw = asObject(value, field);
  const columns = list(raw["columns"], `${field}.columns`).map((c, i) => text(c, `${field}.columns[${i}]`));
  const rows = list(raw["rows"], `${field}.rows`).map((row, i) => {
    const cells = list(row, `${field}.rows[${i}]`);
    if (cells.length !== columns.length) fail(`${field}.rows[${i}]`, `has ${cells.length} cells for ${columns.length} columns`);
    return cells.map((c) => (typeof c === "number" || c === null ? c : String(c)));
  });
  return {
    title: text(raw["title"], `${field}.title`),
    columns,
    rows,
    paper_columns: raw["paper_columns"] ? numbers(raw["paper_columns"], `${field}.paper_columns`) : [],
    verdict_column: typeof raw["verdict_column"] === "number" ? raw["verdict_column"] : null,
    note: typeof raw["note"] === "string" ? raw["note"] : "",
    ...decodeEstimates(raw, rows.length, field),
  };
}

/** Throws DataError naming the field where the document is not as documented. */
export function decodeExperiment(value: unknown): Experiment {
  const raw = asObject(value, "the document");
  checkVersion(raw);
  const paragraphs = raw["text"] === undefined ? [] : typeof raw["text"] === "string" ? [raw["text"]] : list(raw["text"], "text");
  return {
    title: text(raw["title"], "title"),
    text: paragraphs.map((p, i) => text(p, `text[${i}]`)),
    figures: list(raw["figures"] ?? [], "figures").map((f, i) => decodeFigure(f, `figures[${i}]`)),
    svg_style: typeof raw["svg_style"] === "string" ? raw["svg_style"] : "",
    tables: list(raw["tables"] ?? [], "tables").map((t, i) => decodeTable(t, `tables[${i}]`)),
  };
}
