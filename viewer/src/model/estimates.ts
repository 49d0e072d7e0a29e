/** Tables of estimates as people read them: mean and spread in one cell, the paper's number beside. */
import type { Estimate, Measure, Table } from "../data/experiment.ts";
import { fixed } from "../ui/format.ts";

export interface ReadableCell {
  text: string;
  kind: "text" | "number" | "paper" | "good" | "bad";
}

export interface ReadableTable {
  columns: { title: string; kind: "text" | "number" | "paper" }[];
  rows: ReadableCell[][];
}

const number = (value: number | null, decimals: number) => fixed(value, decimals).replace("-", "−");

function spread(e: Estimate, { decimals, difference }: Measure): string {
  const mean = number(e.mean, decimals);
  if (difference) {
    const signed = e.mean > 0 ? `+${mean}` : mean;
    return e.low === null || e.high === null ? signed : `${signed} [${number(e.low, decimals)}, ${number(e.high, decimals)}]`;
  }
  return e.runs > 1 && e.sd !== null ? `${mean} ± ${number(e.sd, decimals)}` : mean;
}

/** Null for a table without estimates. */
export function readable(table: Table): ReadableTable | null {
  const { estimates, measures } = table;
  if (!estimates) return null;
  const columns: ReadableTable["columns"] = [{ title: table.columns[0], kind: "text" }];
  const rows: ReadableCell[][] = table.rows.map((row) => [{ text: String(row[0] ?? ""), kind: "text" }]);
  let plain = 1; // the column of `table` that belongs to a measure
  measures.forEach((measure, k) => {
    const any = estimates.some((row) => row[k]);
    const published = estimates.some((row) => row[k] && row[k].paper !== null);
    const numeric = any || table.rows.every((row) => Number.isFinite(Number(row[plain] ?? 0)));
    columns.push({ title: measure.title, kind: numeric ? "number" : "text" });
    if (published) columns.push({ title: "paper", kind: "paper" });
    rows.forEach((cells, r) => {
      const e = estimates[r][k];
      const kind = e?.in_band === true ? "good" : e?.in_band === false ? "bad" : numeric ? "number" : "text";
      const mark = e?.in_band === true ? " ✓" : e?.in_band === false ? " ✗" : "";
      cells.push({ text: e ? spread(e, measure) + mark : String(table.rows[r][plain] ?? "–"), kind });
      if (published) cells.push({ text: e && e.paper !== null ? number(e.paper, measure.decimals) : "", kind: "paper" });
    });
    plain += any ? 3 : 1;
  });
  return { columns, rows };
}
