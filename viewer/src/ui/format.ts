/** Numbers as people read them. */
export const MISSING = "–";

/** `digits` significant digits, no exponent for everyday sizes. */
export function significant(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return MISSING;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-5) return value.toExponential(digits - 1);
  return String(Number(value.toPrecision(digits)));
}

export const fixed = (value: number | null | undefined, decimals: number): string =>
  value === null || value === undefined || Number.isNaN(value) ? MISSING : value.toFixed(decimals);

export const percent = (share: number | null | undefined, decimals = 1): string =>
  share === null || share === undefined ? MISSING : `${(100 * share).toFixed(decimals)} %`;

/** Whole numbers with thin spaces between thousands. */
export const whole = (value: number | null | undefined): string =>
  value === null || value === undefined ? MISSING : String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, "\u2009");

/** Round values for an axis from `low` to `high`, about `count` of them. */
export function ticks(low: number, high: number, count = 4): number[] {
  const raw = (high - low) / count;
  if (!(raw > 0) || !Number.isFinite(raw)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * (1 - 1e-9))!;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/** A tick's text: thousands as k, so that it stays short. */
export function tickText(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e6) return `${Number((value / 1e6).toPrecision(3))}M`;
  if (size >= 1e4) return `${Number((value / 1e3).toPrecision(3))}k`;
  return String(Number(value.toPrecision(6)));
}
