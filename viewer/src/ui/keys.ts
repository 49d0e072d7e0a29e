/** The keyboard, wherever the focus is not in a field of its own. */
import type { Session } from "../model/session.ts";
import { COLORINGS, type LabelMode, type Layer } from "../model/state.ts";
import { theme } from "./theme.ts";
import type { Player } from "./timeline.ts";

const NEXT_MODE: Record<LabelMode, LabelMode> = { hide: "fade", fade: "show", show: "hide" };
const LAYER_KEYS = new Map<string, Layer>(
  Object.entries({ v: "candidates", p: "path", f: "frustum", s: "seen", n: "normals", k: "cloud", m: "mesh", g: "truth" }),
);

/** What a key does, or null where it does nothing here. */
export function keyAction(key: string, session: Session, player: Player, help: () => void): (() => void) | null {
  const { store } = session;
  const { state } = store;
  if (/^[1-5]$/.test(key)) {
    const label = Number(key) - 1;
    return () => store.setLabel(label, NEXT_MODE[state.labels[label]]);
  }
  const layer = LAYER_KEYS.get(key);
  if (layer) return () => store.setLayer(layer, !state.layers[layer]);
  const axis = "xyz".indexOf(key);
  if (key.length === 1 && axis >= 0) {
    const size = session.run.grid.enclosureSize[axis];
    const on = state.slice?.axis !== axis;
    return () => store.set({ slice: on ? { axis: axis as 0 | 1 | 2, index: size >> 1 } : null });
  }
  if ((key === "[" || key === "]") && state.slice) {
    const { axis: a, index } = state.slice;
    const moved = Math.min(session.run.grid.enclosureSize[a] - 1, Math.max(0, index + (key === "]" ? 1 : -1)));
    return () => store.set({ slice: { axis: a, index: moved } });
  }
  const actions: Record<string, () => void> = {
    " ": () => player.toggle(),
    ArrowLeft: () => player.go(state.step - 1),
    ArrowRight: () => player.go(state.step + 1),
    Home: () => player.go(0),
    End: () => player.go(player.last),
    c: () => store.set({ coloring: COLORINGS[(COLORINGS.indexOf(state.coloring) + 1) % COLORINGS.length] }),
    t: () => theme.toggle(),
    "?": help,
    Escape: () => store.set({ selection: null }),
  };
  return Object.hasOwn(actions, key) ? actions[key] : null;
}

export function listenForKeys(session: Session, player: Player, help: () => void): void {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const target = event.target as HTMLElement;
    if (target.closest("input, select, textarea, dialog")) return;
    if (target.closest("button, summary") && (event.key === " " || event.key === "Enter")) return;
    const action = keyAction(event.key, session, player, help);
    if (!action) return;
    event.preventDefault();
    action();
  });
}
