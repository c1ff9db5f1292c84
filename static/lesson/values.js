// Numbers in the text that are those of the sim: shown, and dragged, stepped with keys or typed.
const DRAGGED = 4; // pixels of the pointer for one step

export class Values {
  constructor(sim) {
    this.sim = sim;
    this.held = null; // the number that is dragged
  }

  begin() {
    this.sim.on("values", (state) => this.show(state));
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
      if (value !== undefined && input !== this.held && !input.matches(":focus:not([data-stepped])")) put(input, value);
    }
    for (const link of document.querySelectorAll("[data-href]")) link.setAttribute("href", filled(link.dataset.href, state));
  }

  // ---- a number that is held

  hold(input) {
    put(input, Number(input.value));
    let from = null;
    input.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX, value: numberOf(input) };
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
    input.addEventListener("keydown", (event) => this.step(input, event));
    input.addEventListener("input", () => delete input.dataset.stepped);
    input.addEventListener("change", () => this.move(input, numberOf(input)));
  }

  step(input, event) {
    const by = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (by && !event.altKey && !event.ctrlKey && !event.metaKey) {
      event.preventDefault();
      input.dataset.stepped = "1"; // nothing is being typed that the sim's answer would overwrite
      this.move(input, numberOf(input) + by * (event.shiftKey ? 10 : 1) * Number(input.dataset.step));
    } else if (event.key === "Enter") this.move(input, numberOf(input));
  }

  move(input, wanted) {
    const [low, high] = [Number(input.ariaValueMin), Number(input.ariaValueMax)];
    const name = input.dataset.drag;
    const now = (this.sim.state && valueAt(this.sim.state, name)) ?? Number(input.ariaValueNow);
    const value = Number.isFinite(wanted) ? Math.min(Math.max(Number(wanted.toPrecision(12)), low), high) : now;
    put(input, value);
    if (value !== now && this.sim.state) this.sim.set({ params: changed(this.sim.state.params, name, value) });
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
  return { [list]: k === undefined ? value : params[list].with(Number(k), value) };
}

function put(input, value) {
  input.value = figure(value, null);
  input.ariaValueNow = value;
  input.style.width = `${input.value.length + 0.5}ch`;
}

function numberOf(input) {
  return Number(input.value.trim().replace("−", "-").replace(",", ".").replace(/°$/, "") || NaN);
}

// The value of a path such as pitch, R.0.2 or solution.selected.
export function valueAt({ params, solution }, path) {
  const names = path.split(".");
  if (names[0] === "solution") names.shift();
  const from = path.startsWith("solution.") || !(names[0] in params) ? solution : params;
  return names.reduce((at, name) => at?.[name], from);
}

export function figure(value, digits) {
  const text = digits === null ? String(Number(value.toPrecision(6))) : value.toFixed(digits);
  return (/[1-9]/.test(text) ? text : text.replace("-", "")).replace("-", "−");
}

// As app/lessons/state.py spells them.
export function spelled(value, { digits, unit = "" }) {
  const number = (each) => figure(each, digits === undefined ? (Number.isInteger(each) ? 0 : 3) : Number(digits));
  if (value === null || value === undefined) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return `(${value.map(number).join(", ")})`;
  if (typeof value !== "number") return String(value);
  return number(value) + (["", "°", "%"].includes(unit) ? "" : "\u2009") + unit;
}

function filled(href, state) {
  return href.replace(/\{value:([^{}:]+)(?::(\d+))?\}/g, (_, path, digits) =>
    [valueAt(state, path)].flat().map((each) => Number(Number(each).toPrecision(Number(digits ?? 6)))).join(","));
}
