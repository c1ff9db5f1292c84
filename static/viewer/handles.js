// Handles in image panes, dragged by pointer, finger or keys. Pictures may be drawn anew at any time, so everything
// listens at the document.
import { sim } from "./page.js";

const AGAIN = 400; // milliseconds within which a key goes on from where the last one led
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Handles {
  constructor(pace, highlight) {
    this.pace = pace;
    this.highlight = highlight;
    this.held = null;
    this.keyed = null;
    document.addEventListener("pointerdown", (event) => this.grab(event), true);
    document.addEventListener("pointermove", (event) => this.drag(event), true);
    for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, (event) => this.letGo(event), true);
    // While a handle is held, neither fingers nor a wheel scroll the column.
    for (const kind of ["touchmove", "wheel"])
      document.addEventListener(kind, (event) => this.held && event.preventDefault(), { passive: false, capture: true });
    document.addEventListener("click", (event) => this.click(event));
    document.addEventListener("keydown", (event) => this.key(event), true);
  }

  moveTo(name, at, pane) {
    const svg = pictured(pane);
    const box = svg.viewBox.baseVal;
    const x = Math.round(within(at.x, 0, box.width - 1) * 100) / 100;
    const y = Math.round(within(at.y, 0, box.height - 1) * 100) / 100;
    const [x0, dx, y0, dy] = (svg.dataset.axes ?? "0 1 0 1").split(" ").map(Number); // a plot's values, or pixels
    this.pace.put(`handle ${name}`, { type: "handle", name, x: x0 + dx * x, y: y0 + dy * y });
    return { x, y };
  }

  grab(event) {
    const grip = event.target.closest?.("[data-handle]");
    if (!grip || sim.watching || event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    const svg = grip.closest("svg");
    grip.focus({ preventScroll: true });
    document.documentElement.setPointerCapture(event.pointerId);
    this.held = {
      pointer: event.pointerId, from: [event.clientX, event.clientY], x: Number(grip.dataset.x), y: Number(grip.dataset.y),
      scale: svg.getScreenCTM().a, name: grip.dataset.handle, pane: svg.dataset.pane, link: grip.dataset.link, moved: false,
    };
    document.documentElement.classList.add("s3-holding");
  }

  drag(event) {
    const { held } = this;
    if (held?.pointer !== event.pointerId) return;
    event.preventDefault();
    if (!pictured(held.pane)) return;
    // By the way that the pointer went, not by where the picture is: text above it may get another line meanwhile.
    const [x, y] = held.from;
    const at = { x: held.x + (event.clientX - x) / held.scale, y: held.y + (event.clientY - y) / held.scale };
    this.moveTo(held.name, at, held.pane);
    held.moved = true;
  }

  letGo(event) {
    const { held } = this;
    if (held?.pointer !== event.pointerId) return;
    if (event.type === "pointerup" && held.link && !held.moved) this.highlight.select(held.link);
    this.held = null;
    document.documentElement.classList.remove("s3-holding");
  }

  // A click anywhere in a picture that says so, or Enter on it, puts its handle there; the handle then takes the focus.
  // A click on a point means the very pixel of that point.
  click(event) {
    const svg = event.target.closest?.("svg[data-pane]");
    const ground = svg?.querySelector("[data-pick]");
    if (!ground || event.target.closest("[data-handle]")) return;
    const spot = event.target.closest(".s3-point:has(.s3-reach)")?.transform.baseVal[0].matrix;
    this.pick(ground, spot ? { x: spot.e, y: spot.f } : place(event, svg));
  }

  pick(ground, at) {
    if (sim.watching) return;
    this.wanted = ground.dataset.pick; // the handle takes the focus when it is there
    this.moveTo(ground.dataset.pick, at, ground.closest("svg").dataset.pane);
  }

  // A picture was drawn: the handle that was put into it gets the focus.
  drawn() {
    const handle = this.wanted && document.querySelector(`[data-handle="${CSS.escape(this.wanted)}"]`);
    if (!handle) return;
    this.wanted = null;
    handle.focus({ preventScroll: true });
  }

  key(event) {
    const grip = event.target.closest?.("[data-handle]");
    if (grip && ARROWS[event.key] && !sim.watching) {
      event.preventDefault();
      this.step(grip, event);
    } else if (event.target.matches?.("[data-pick]") && ["Enter", " "].includes(event.key)) {
      event.preventDefault();
      const { width, height } = event.target.closest("svg").viewBox.baseVal;
      this.pick(event.target, { x: (width - 1) / 2, y: (height - 1) / 2 });
    }
  }

  step(grip, event) {
    const [dx, dy] = ARROWS[event.key];
    const step = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
    const name = grip.dataset.handle;
    const last = this.keyed?.name === name && performance.now() - this.keyed.at < AGAIN ? this.keyed : null;
    const x = (last ? last.x : Number(grip.dataset.x)) + dx * step;
    const y = (last ? last.y : Number(grip.dataset.y)) + dy * step;
    this.keyed = { name, at: performance.now(), ...this.moveTo(name, { x, y }, grip.closest("svg").dataset.pane) };
  }
}

function pictured(pane) {
  return document.querySelector(`svg[data-pane="${pane}"]`);
}

function place(event, svg) {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  return { x: point.x, y: point.y };
}

function within(value, low, high) {
  return Math.min(Math.max(value, low), high);
}
