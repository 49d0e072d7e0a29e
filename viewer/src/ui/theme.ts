/** Light and dark: as the system says unless the reader chose. */
type Mode = "light" | "dark";

const COLORS = {
  light: {
    scene: "#eef1f5",
    line: "#5b6470",
    chosen: "#d5006d",
    select: "#000000",
    commanded: "#8a94a3",
    registered: "#111827",
    ghost: "#7a5c3a",
  },
  dark: {
    scene: "#0f1319",
    line: "#8c97a6",
    chosen: "#ff4fa3",
    select: "#ffffff",
    commanded: "#6d7889",
    registered: "#e7ecf3",
    ghost: "#f3dfc0",
  },
} as const;
export type ThemeColor = keyof (typeof COLORS)["light"];

class Theme {
  private listeners: (() => void)[] = [];
  private chosen: Mode | null = null;
  private readonly dark = window.matchMedia("(prefers-color-scheme: dark)");

  constructor() {
    this.dark.addEventListener("change", () => this.apply());
    this.apply();
  }

  get mode(): Mode {
    return this.chosen ?? (this.dark.matches ? "dark" : "light");
  }

  color(name: ThemeColor): string {
    return COLORS[this.mode][name];
  }

  toggle(): void {
    this.chosen = this.mode === "dark" ? "light" : "dark";
    this.apply();
  }

  subscribe(listener: () => void): void {
    this.listeners.push(listener);
  }

  private apply(): void {
    document.documentElement.dataset["theme"] = this.mode;
    for (const listener of this.listeners) listener();
  }
}

export const theme = new Theme();
