// What stands for the same thing in pictures and tables is highlighted together; a click selects it.
import { sim } from "./page.js";

export function linked(name) {
  return `[data-link="${CSS.escape(name)}"]`;
}

export class Highlight {
  constructor(channel) {
    this.channel = channel;
    this.mine = ""; // what the pointer or the focus is on
    this.theirs = ""; // what somebody else in the room hovers over
  }

  // `held()` says that a handle is dragged: it stays highlighted, wherever the pointer is. Focus that is given back to a
  // table drawn anew (`focus.returning`) is on nothing new.
  listen(held, focus) {
    document.addEventListener("pointerover", (event) => held() || this.hover(event.target));
    document.addEventListener("focusin", (event) => focus.returning || this.hover(event.target));
    // A finger has left when it is lifted; what it touched stays highlighted until it touches something else.
    document.documentElement.addEventListener("pointerleave", (event) => event.pointerType === "touch" || this.hover(null));
    document.addEventListener("click", (event) => {
      const node = event.target.closest?.("[data-link]");
      if (node) this.select(node.dataset.link);
    });
  }

  hover(node) {
    const name = node?.closest?.("[data-link]")?.dataset.link ?? "";
    if (name === this.mine) return;
    this.mine = name;
    this.show();
    this.channel.send({ type: "point", name });
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
