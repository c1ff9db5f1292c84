// Numbers in the text that are those of the sim: shown, and dragged, stepped with keys or typed.
import { figure, filled, spelled, valueAt } from "./spelling.js";

const DRAGGED = 4; // pixels of the pointer for one step
const KEYS = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 };

export class Values {
  constructor(sim) {
    this.sim = sim;
    this.held = null; // the number that is dragged
    this.entered = null; // the one whose text the sim was told last
  }

  begin() {
    this.sim.on("values", (state) => this.show(state));
    this.sim.on("error", (error) => this.refuse(error));
    for (const node of document.querySelectorAll("[data-value]")) node.dataset.written = node.textContent;
    addEventListener("beforeprint", () => this.showWritten());
    addEventListener("afterprint", () => this.sim.state && this.show(this.sim.state));
    for (const input of document.querySelectorAll("[data-drag]")) this.hold(input);
    for (const node of document.querySelectorAll("[data-point]")) this.point(node);
  }

  show(state) {
    for (const node of document.querySelectorAll("[data-value]")) {
      const words = spelled(valueAt(state, node.dataset.value), node.dataset);
      if (node.textContent !== words) node.textContent = words;
    }
    for (const input of document.querySelectorAll("[data-drag]")) {
      const value = valueAt(state, input.dataset.drag); // none where a list is too short for it
      if (value !== undefined && input !== this.held && !("typing" in input.dataset)) put(input, value);
    }
    for (const link of document.querySelectorAll("[data-href]")) link.setAttribute("href", filled(link.dataset.href, state));
  }

  // On paper each number is that of its step.
  showWritten() {
    for (const node of document.querySelectorAll("[data-value]")) node.textContent = node.dataset.written;
    for (const input of document.querySelectorAll("[data-drag]")) put(input, Number(input.defaultValue));
  }

  value(input) {
    return (this.sim.state && valueAt(this.sim.state, input.dataset.drag)) ?? Number(input.ariaValueNow);
  }

  // ---- a number that is held

  hold(input) {
    put(input, Number(input.ariaValueNow));
    this.letDrag(input);
    input.addEventListener("keydown", (event) => this.key(input, event));
    input.addEventListener("input", () => {
      input.dataset.typing = ""; // what the sim says doesn't overwrite it
      fit(input);
    });
    input.addEventListener("change", () => this.enter(input));
    input.addEventListener("blur", () => this.giveUp(input));
  }

  letDrag(input) {
    let from = null;
    input.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX, value: this.value(input) };
      input.setPointerCapture(event.pointerId);
    });
    input.addEventListener("pointermove", (event) => {
      if (!from) return;
      const steps = Math.round((event.clientX - from.x) / DRAGGED);
      if (steps) this.held = input;
      if (this.held === input) this.move(input, from.value + steps * Number(input.dataset.step));
    });
    for (const kind of ["pointerup", "pointercancel"]) input.addEventListener(kind, () => {
      if (from && this.held !== input) input.select();
      from = this.held = null;
    });
  }

  key(input, event) {
    const end = { Home: input.ariaValueMin, End: input.ariaValueMax }[event.key];
    const typing = "typing" in input.dataset;
    if (event.key === "Enter") this.enter(input);
    else if (event.key === "Escape") this.giveUp(input);
    else if (event.altKey || event.ctrlKey || event.metaKey || (typing && !/Up|Down/.test(event.key))) return;
    else if (KEYS[event.key]) this.move(input, this.value(input) + KEYS[event.key] * (event.shiftKey ? 10 : 1) * Number(input.dataset.step));
    else if (end !== undefined) this.move(input, Number(end));
    else return;
    event.preventDefault();
  }

  // A hand stops at the bounds.
  move(input, wanted) {
    const value = Math.min(Math.max(Number(wanted.toPrecision(12)), Number(input.ariaValueMin)), Number(input.ariaValueMax));
    this.forgive(input);
    if (value === this.value(input) && value === Number(input.ariaValueNow)) return;
    put(input, value);
    const params = this.sim.state?.params ?? {}; // before the sim has said a word, a number alone can be moved all the same
    const changes = changed(params, input.dataset.drag, value);
    if (!changes) return;
    Object.assign(params, changes); // the next step goes on from here
    this.sim.move(changes);
  }

  // What was typed means what it would mean in the sim's own box, which says what can't be taken.
  enter(input) {
    if (!("typing" in input.dataset)) return;
    this.forgive(input);
    this.entered = input;
    this.sim.enter(input.dataset.drag, input.value);
  }

  refuse({ message, control }) {
    const input = this.entered;
    if (!input || control !== input.dataset.drag) return;
    const words = input.parentElement.querySelector("[role=alert]");
    words.textContent = message;
    if (input !== document.activeElement) return;
    input.dataset.typing = "";
    input.setAttribute("aria-invalid", "true");
  }

  giveUp(input) {
    if (input.hasAttribute("aria-invalid") || "typing" in input.dataset) put(input, this.value(input));
    this.forgive(input);
  }

  forgive(input) {
    delete input.dataset.typing;
    input.removeAttribute("aria-invalid");
    input.parentElement.querySelector("[role=alert]").textContent = "";
  }

  // ---- a symbol that shows what it is in the scene

  point(node) {
    node.tabIndex = 0;
    for (const kind of ["pointerenter", "focus"]) node.addEventListener(kind, () => this.pointAt(node.dataset.point));
    for (const kind of ["pointerleave", "blur"]) node.addEventListener(kind, () => this.pointAt(""));
  }

  pointAt(name) {
    this.sim.post({ type: "sim3:point", name });
  }
}

// What sets a number: its parameter, or the whole list that it stands in.
function changed(params, name, value) {
  const [list, k] = name.split(".");
  if (k === undefined) return { [list]: value };
  return params[list] && { [list]: params[list].with(Number(k), value) };
}

function put(input, value) {
  input.value = figure(value, null);
  input.ariaValueNow = value;
  fit(input);
}

function fit(input) {
  input.style.width = `${Math.max(input.value.length, 1) + 0.5}ch`;
}
