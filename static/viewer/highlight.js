// What stands for the same thing in controls, pictures, formulas and tables is highlighted together, in the scene too; a
// click on a point or its row selects it.
import { column, scene, sim } from "./page.js";

const SELECTS = ".s3-point, tr:has(button), [data-handle]";

function linked(name) {
  return `[data-link~="${CSS.escape(name)}"]`;
}

export class Highlight {
  constructor(channel) {
    this.channel = channel;
    this.mine = ""; // what the pointer or the focus is on
    this.theirs = ""; // what somebody else in the room hovers over
    this.grips = false; // whether something may be dragged in the scene
  }

  // `held()` says that a handle is dragged: it stays highlighted, wherever the pointer is.
  listen(held) {
    document.addEventListener("pointerover", (event) => held() || this.grips || this.hover(event.target));
    scene.addEventListener("pointerdown", () => (this.grips = true), true);
    for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, () => this.letGo(), true);
    document.addEventListener("focusin", (event) => this.hover(event.target));
    // A finger has left when it is lifted; what it touched stays highlighted until it touches something else.
    document.documentElement.addEventListener("pointerleave", (event) => event.pointerType === "touch" || this.hover(null));
    document.addEventListener("click", (event) => {
      const node = event.target.closest?.("[data-link]");
      if (node?.matches(SELECTS)) this.select(node.dataset.link);
    });
  }

  // A control that has the focus stays highlighted while the pointer is on nothing.
  hover(node) {
    const at = node?.closest?.("[data-link]") ?? document.activeElement?.closest?.("[data-link]");
    const name = at?.dataset.link.split(" ")[0] ?? "";
    if (name === this.mine) return;
    this.mine = name;
    this.show();
    this.channel.send({ type: "point", name });
  }

  // What is dragged in the scene moves a control: it is highlighted until the hand lets go.
  moved(inputs) {
    const [name] = this.grips ? inputs : [];
    if (name) this.hover(column.querySelector(`[data-control="${CSS.escape(name.replace(/\.\d+$/, ""))}"]`));
  }

  // What the page around the sim points at.
  point(name) {
    clearTimeout(this.brief);
    this.mine = name;
    this.show();
    this.channel.send({ type: "point", name });
  }

  // A control that is moved from outside, while it moves.
  briefly(control, seconds) {
    const node = column.querySelector(`[data-control="${CSS.escape(control)}"]`);
    if (!node) return;
    this.hover(node);
    clearTimeout(this.brief);
    this.brief = setTimeout(() => this.mine === node.dataset.link?.split(" ")[0] && this.hover(null), seconds * 1000 + 800);
  }

  letGo() {
    if (this.grips) this.hover(null);
    this.grips = false;
  }

  others(name) {
    this.theirs = name;
    this.show();
  }

  show() {
    const all = [this.mine, this.theirs].filter(Boolean).map(linked).join();
    for (const node of document.querySelectorAll(".s3-highlighted")) if (!all || !node.matches(all)) node.classList.remove("s3-highlighted");
    if (all) for (const node of document.querySelectorAll(all)) node.classList.add("s3-highlighted");
  }

  select(name) {
    if (!sim.watching) this.channel.send({ type: "select", name });
  }
}
