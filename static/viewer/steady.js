// What is under a hand stays where it is, whatever the text above it comes to say.
import { column } from "./page.js";

export class Steady {
  constructor() {
    this.held = null;
    document.addEventListener("pointerdown", ({ target }) => this.hold(target), true);
    for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, () => this.letGo(), true);
  }

  hold(target) {
    this.held = column.contains(target) ? target.closest(".s3-pane, [data-slide]") : null;
    if (this.held) for (const text of texts()) text.style.minHeight = `${text.getBoundingClientRect().height}px`;
  }

  letGo() {
    if (this.held) for (const text of texts()) text.style.minHeight = "";
    this.held = null;
  }

  // Texts that are held can't shrink; where they grow, the column is scrolled by as much.
  through(change) {
    const top = this.top();
    change();
    if (top !== undefined) column.scrollTop += this.top() - top;
  }

  top() {
    return this.held?.getBoundingClientRect().top;
  }
}

function texts() {
  return column.querySelectorAll(":scope > :is(.s3-caption, .s3-key)");
}
