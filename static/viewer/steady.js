// What is under a hand stays where it is, whatever the text above it comes to say; what is moved by keys stays in sight.
import { column } from "./page.js";

export class Steady {
  constructor() {
    this.held = null;
    this.keyed = null; // what keys move, until somebody scrolls or points elsewhere
    document.addEventListener("pointerdown", ({ target }) => this.hold(target), true);
    document.addEventListener("wheel", () => (this.keyed = null), { passive: true, capture: true });
    column.addEventListener("keydown", ({ target }) => (this.keyed = target.closest("[data-slide], [data-box], [data-handle], summary")));
    for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, () => this.letGo(), true);
  }

  hold(target) {
    this.keyed = null;
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
    else if (this.keyed === document.activeElement) this.keyed.scrollIntoView({ block: "nearest" });
  }

  top() {
    return this.held?.getBoundingClientRect().top;
  }
}

function texts() {
  return column.querySelectorAll(":scope > :is(.s3-caption, .s3-key)");
}
