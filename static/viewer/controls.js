// The controls: what is moved, typed and chosen goes to the server; what it answers is shown.
import { lock } from "./lock.js";
import { stepped, tellValue, text } from "./numbers.js";
import { column, sim } from "./page.js";
import { explain } from "./words.js";

const PAUSE = 900; // milliseconds without a key after which what was typed is finished
const ANSWERED = 3000; // milliseconds after which a choice that the server said nothing about isn't so
const TREMBLE = 3; // pixels that a finger goes without meaning it

export class Controls {
  constructor(channel, pace) {
    this.channel = channel;
    this.pace = pace;
    this.known = {}; // what the server says that each input shows
    this.typing = 0;
    this.asked = ""; // what was chosen last, until the server has answered
    this.held = this.touched = null; // the slider under a hand, and where a finger came down that may be on its way past
    column.addEventListener("input", (event) => this.input(event.target));
    column.addEventListener("change", (event) => this.change(event.target));
    column.addEventListener("keydown", (event) => this.key(event));
    column.addEventListener("mousedown", (event) => selectWhole(event));
    column.addEventListener("focusin", ({ target }) => target.dataset.box && target.type === "text" && this.begin(target));
    column.addEventListener("focusout", ({ target }) => target.dataset.box && this.finish(target));
    column.addEventListener("dblclick", ({ target }) => target.dataset.default && this.slide(target, Number(target.dataset.default)));
    column.addEventListener("pointerdown", (event) => this.hold(event));
    column.addEventListener("pointermove", (event) => this.lead(event));
    for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, () => this.letGo(kind));
    column.addEventListener("click", (event) => this.click(event.target));
    column.addEventListener("paste", (event) => this.paste(event));
    column.addEventListener("toggle", ({ target }) => target.dataset.fold && this.fold(target), true);
  }

  // ---- sliders

  input(input) {
    if (input.dataset.slide && this.touched) return;
    if (input.dataset.slide) this.slide(input, stepped(input));
    else if (input.dataset.box) {
      clearTimeout(this.typing);
      this.typing = setTimeout(() => this.finish(input), PAUSE);
    }
  }

  slide(input, value) {
    const within = Math.min(Math.max(value, Number(input.min)), Number(input.max));
    input.value = within;
    const { slide: name } = input.dataset;
    const box = inputs("box", name)[0];
    if (box && box !== document.activeElement) box.value = text(within);
    tellValue(input, within);
    this.pace.put(name, { type: "slide", name, value: within });
  }

  // A browser moves a slider to where a finger comes down. Nothing is meant by it before that goes along it, or is lifted.
  hold({ target, pointerType, clientX, clientY }) {
    this.held = target.dataset.slide ? target : null;
    this.touched = this.held && pointerType === "touch" ? [clientX, clientY] : null;
  }

  lead({ clientX, clientY }) {
    const [x, y] = this.touched ?? [clientX, clientY];
    if (Math.abs(clientX - x) > Math.max(Math.abs(clientY - y), TREMBLE)) this.touched = null;
  }

  letGo(kind) {
    const { held, touched } = this;
    if (!held) return;
    this.held = this.touched = null;
    if (touched && kind === "pointerup") this.slide(held, stepped(held));
    if (this.pace.idle) this.settle();
  }

  // ---- boxes, lists, switches

  begin(box) {
    box.dataset.before = box.value;
    box.select();
  }

  // What was typed is taken as it stands; what can't be meant stays in the box, with the reason below it.
  finish(box) {
    clearTimeout(this.typing);
    if (box.value === box.dataset.before) return;
    box.dataset.before = box.value;
    const whole = box.closest(".s3-vector");
    const several = whole && /[\d.)]\s*[;,\s]\s*[-+−(.\d]+.*[;,\s]/.test(box.value.trim());
    this.enter(several ? whole.dataset.vector : box.dataset.box, box.value);
  }

  enter(name, value) {
    this.channel.send({ type: "enter", name, text: value });
  }

  change(input) {
    const { choice, switch: name = choice } = input.dataset;
    if (!name) return;
    setTimeout(() => this.answer([name]), ANSWERED);
    this.asked = name;
    this.enter(name, choice ? input.value : input.checked ? "1" : "0");
  }

  answer(names) {
    if (names.includes(this.asked)) this.asked = "";
    if (this.pace.idle) this.settle();
  }

  // A fold that is a choice of the state was opened or closed: by a hand, unless it shows what is so.
  fold({ open, dataset }) {
    const known = this.known[dataset.fold];
    if (known === undefined || open === (known === dataset.open) || sim.watching) return;
    this.enter(dataset.fold, open ? dataset.open : dataset.closed);
  }

  paste({ target }) {
    if (target.dataset?.box) setTimeout(() => this.finish(target));
  }

  nudge(box, steps) {
    const before = Number.parseFloat(box.value.replace("−", "-").replace(",", "."));
    if (Number.isNaN(before)) return;
    const step = Number(box.dataset.step);
    box.value = text(Number((before + steps * step).toPrecision(12)));
    this.finish(box);
  }

  // ---- keys and presses

  key(event) {
    const { target } = event;
    if (target.dataset.slide) this.slideKey(event);
    else if (target.dataset.box) this.boxKey(event);
  }

  slideKey(event) {
    const { target, key } = event;
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[key];
    const end = { Home: target.min, End: target.max }[key];
    if ((by === undefined && end === undefined) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const step = Number(target.dataset.step);
    const times = event.shiftKey && Math.abs(by) === 1 ? 10 : 1;
    this.slide(target, end === undefined ? Number((Number(target.value) + by * times * step).toPrecision(12)) : Number(end));
  }

  boxKey(event) {
    const { target, key } = event;
    if (key === "Enter") {
      event.preventDefault();
      this.finish(target);
      target.select();
    } else if (key === "Escape") {
      target.value = target.dataset.before = text(this.known[target.dataset.box]);
      right(control(target.dataset.box));
    } else if (key === "ArrowUp" || key === "ArrowDown") {
      event.preventDefault();
      this.nudge(target, (key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1));
    }
  }

  click(node) {
    const nudge = node.closest?.("[data-nudge]");
    const ask = node.closest?.(".s3-ask");
    const act = node.closest?.("[data-act]");
    if (nudge) this.nudge(nudge.parentElement.querySelector("input"), Number(nudge.dataset.nudge));
    else if (ask) explain(ask);
    else if (act) this.channel.send({ type: "action", name: act.dataset.act });
  }

  // ---- what the server says

  show(values) {
    Object.assign(this.known, values);
    for (const name of Object.keys(values)) for (const fold of inputs("fold", name)) fold.open = values[name] === fold.dataset.open;
    this.answer(Object.keys(values));
  }

  // Every input shows what is so, but for the one under a hand, being typed into, or waiting for its answer.
  settle() {
    for (const [name, value] of Object.entries(this.known)) {
      for (const input of inputs("slide", name)) {
        if (input === this.held) continue;
        if (Number(input.value) !== value) input.value = value;
        tellValue(input, value);
      }
      for (const box of inputs("box", name)) this.fill(box, text(value));
      if (name === this.asked) continue;
      for (const input of inputs("switch", name)) input.checked = value;
      for (const input of inputs("choice", name)) choose(input, value);
    }
    lock();
  }

  fill(box, shown) {
    const editing = box === document.activeElement && box.value !== box.dataset.before;
    if (editing || box.getAttribute("aria-invalid") || box.value === shown) return;
    const all = box === document.activeElement;
    box.value = box.dataset.before = shown;
    if (all) box.select();
  }

  // Something was entered that can't be taken: it stays, and the reason stands below.
  refuse(name, words) {
    const line = control(name)?.querySelector(".s3-wrong");
    if (!line) return false;
    line.textContent = words;
    line.hidden = false;
    for (const box of inputs("box", name)) box.setAttribute("aria-invalid", "true");
    this.asked = "";
    this.settle();
    line.scrollIntoView({ block: "nearest" });
    return true;
  }

  // What was refused is past: each box shows what is so again, but for the one that was corrected.
  forgive(name) {
    for (const line of column.querySelectorAll(".s3-wrong:not([hidden])")) {
      const boxes = [...line.parentElement.querySelectorAll("[data-box][aria-invalid]")];
      right(line.parentElement);
      for (const box of boxes) if (box.dataset.box !== name) this.fill(box, text(this.known[box.dataset.box]));
    }
  }
}

// The first click into a box selects what is in it, as the Tab key does.
function selectWhole(event) {
  if (!event.target.dataset.box || event.target === document.activeElement) return;
  event.preventDefault();
  event.target.focus();
}

function inputs(kind, name) {
  return column.querySelectorAll(`[data-${kind}="${CSS.escape(name)}"]`);
}

function control(name) {
  const field = name.split(":")[0];
  return column.querySelector(`[data-control="${CSS.escape(field)}"]`)
    ?? column.querySelector(`[data-control="${CSS.escape(field.split(".")[0])}"]`);
}

function right(place) {
  place?.querySelector(".s3-wrong")?.setAttribute("hidden", "");
  for (const box of place?.querySelectorAll("[aria-invalid]") ?? []) box.removeAttribute("aria-invalid");
}

function choose(input, value) {
  if (input.type === "radio") input.checked = input.value === String(value ?? "");
  else if (input.value !== String(value ?? "")) input.value = String(value ?? "");
}
