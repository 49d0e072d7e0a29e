/** Colours of the page. Label colours are Okabe and Ito's, told apart by colour-blind people; scales are viridis. */
export type Rgb = [number, number, number];

/** Per label: unmarked, occupied, empty, occluded, occplane; the same as in the program's pictures. */
export const LABEL_COLORS: readonly string[] = ["#8c8c8c", "#0072b2", "#f4f6f8", "#cc79a7", "#e69f00"];

export function parseHex(hex: string): Rgb {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) & 255, (n >> 8) & 255, n & 255];
}

const toHex = (rgb: Rgb) => "#" + rgb.map((c) => Math.round(c).toString(16).padStart(2, "0")).join("");

const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"].map(parseHex); // prettier-ignore

function ramp(stops: readonly Rgb[], t: number): Rgb {
  const x = Math.min(1, Math.max(0, Number.isFinite(t) ? t : 0)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(x));
  return [0, 1, 2].map((c) => stops[i][c] + (stops[i + 1][c] - stops[i][c]) * (x - i)) as Rgb;
}

/** Dark blue for 0 to yellow for 1; values outside are clamped, NaN counts as 0. */
export const viridis = (t: number): Rgb => ramp(VIRIDIS, t);

/** Colour of a value as a share of the highest: leaves out the darkest end, which a dark background would swallow. */
export const shareColor = (share: number): Rgb => viridis(0.12 + 0.88 * Math.min(1, Math.max(0, share || 0)));
export const shareHex = (share: number): string => toHex(shareColor(share));

/** Colour of scan `index` among `count`: apart for few scans, in order for many. */
export function scanColor(index: number, count: number): Rgb {
  return viridis(count < 2 ? 0.5 : 0.08 + (0.92 * index) / (count - 1));
}

/** A unit normal as a colour, the usual (n+1)/2. */
export const normalColor = (x: number, y: number, z: number): Rgb => [127.5 * (x + 1), 127.5 * (y + 1), 127.5 * (z + 1)];
