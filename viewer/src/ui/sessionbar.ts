/** Connection and the buttons that the person with the scanner needs. */
import type { Connection } from "../data/live.ts";
import type { Session } from "../model/session.ts";
import { h } from "./dom.ts";

const CONNECTION_TEXT: Record<Connection, string> = {
  connecting: "connecting …",
  live: "live",
  lost: "connection lost, trying again",
  ended: "finished",
};

export interface SessionBar {
  element: HTMLElement;
  setConnection: (connection: Connection, problem: string) => void;
  say: (text: string) => void;
}

export type Press = (action: "next" | "skip" | "finish", body?: object) => Promise<void>;

export function sessionBar(session: Session, press: Press): SessionBar {
  const state = h("span", { class: "connection", role: "status" });
  const message = h("span", { class: "message", role: "status" });
  const act = (action: "next" | "skip" | "finish", body: object = {}) => {
    setBusy(true);
    message.textContent = "";
    press(action, body)
      .catch((error: Error) => (message.textContent = error.message))
      .finally(() => {
        setBusy(false);
        update();
      });
  };
  const reason = h("input", { type: "text", placeholder: "reason, e.g. out of reach", "aria-label": "why this view is skipped", maxlength: 200 });
  const chosen = () => session.run.next?.chosen ?? null;
  const next = h("button", { type: "button", class: "primary", onclick: () => act("next") }, "Next view");
  const skipForm = h("form", {
    onsubmit: (event: Event) => {
      event.preventDefault();
      act("skip", { candidate: chosen(), reason: reason.value.trim() || "skipped by hand" });
      reason.value = "";
    },
  }, reason, h("button", {}, "Skip this view")); // prettier-ignore
  const finish = h("button", { type: "button", onclick: () => act("finish") }, "Finish");
  const buttons = h("div", { class: "session-buttons" }, next, skipForm, finish);
  const setBusy = (busy: boolean) => buttons.querySelectorAll("button").forEach((b) => (b.disabled = busy));
  const update = () => {
    const waiting = session.run.meta.state === "waiting";
    buttons.hidden = !waiting;
    next.textContent = chosen() === null ? "Next view" : `Take view ${chosen()}`;
    next.disabled = skipForm.querySelector("button")!.disabled = chosen() === null;
  };
  session.store.subscribe(update);
  update();
  const setConnection = (connection: Connection, problem: string) => {
    state.textContent = problem ? `${CONNECTION_TEXT[connection]} (${problem})` : CONNECTION_TEXT[connection];
    state.dataset["state"] = connection;
  };
  setConnection("connecting", "");
  const element = h("div", { class: "session-bar" }, state, message, buttons);
  return { element, setConnection, say: (text) => (message.textContent = text) };
}
