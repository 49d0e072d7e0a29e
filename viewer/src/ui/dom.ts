/** The little that the page needs to write HTML and SVG from TypeScript. */
export type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

function fill(element: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value as (event: Event) => void);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
}

/** An HTML element; attributes that start with `on` are listeners. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  fill(element, attributes, children);
  return element;
}

/** Choices of which one is taken, as buttons in a row. */
export function segments<T extends string>(
  label: string,
  choices: readonly { value: T; text: string; title?: string }[],
  onChoose: (value: T) => void,
): { element: HTMLElement; set: (value: T) => void } {
  const buttons = choices.map(({ value, text, title }) =>
    h("button", { type: "button", title: title ?? null, "data-value": value, onclick: () => onChoose(value) }, text),
  );
  const element = h("div", { class: "segments", role: "group", "aria-label": label }, ...buttons);
  const set = (value: T) => {
    for (const b of buttons) b.setAttribute("aria-pressed", String(b.dataset["value"] === value));
  };
  return { element, set };
}
