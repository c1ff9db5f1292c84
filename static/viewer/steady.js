// What is under a hand stays where it is, whatever the text above it comes to say; what is moved by keys stays in sight.
import { column } from "./page.js";

const ANSWERED = 5000; // milliseconds after a key in which what it brought about has come

export class Steady {
  constructor() {
    this.held = null;
    this.keyed = null; // what keys move, until that is done, or somebody scrolls or points elsewhere
    this.forgetting = 0;
    document.addEventListener("pointerdown", ({ target }) => this.hold(target), true);
    document.addEventListener("wheel", () => this.forget(), { passive: true, capture: true });
    addEventListener("blur", () => this.forget());
    column.addEventListener("keydown", ({ target }) => this.follow(target));
    for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, () => this.letGo(), true);
  }

  // A page around that goes on, and scrolls, isn't brought back to it.
  follow(target) {
    this.forget();
    this.keyed = target.closest("[data-slide], [data-box], [data-handle], summary");
    this.forgetting = setTimeout(() => this.forget(), ANSWERED);
  }

  forget() {
    clearTimeout(this.forgetting);
    this.keyed = null;
  }

  hold(target) {
    this.forget();
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
