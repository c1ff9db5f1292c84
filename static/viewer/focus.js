// The focus stays where it is when a picture or a table is drawn anew.
import { linked } from "./highlight.js";

export class Focus {
  constructor() {
    this.wanted = null;
    this.returning = false;
    document.addEventListener("focusin", (event) => {
      const grip = event.target.closest?.("[data-handle], [data-pick]");
      const row = event.target.closest?.("[data-link]");
      if (grip) this.want(grip.dataset.handle ?? grip.dataset.pick);
      else this.wanted = row ? `${linked(row.dataset.link)} button` : null;
    });
  }

  // The handle of a name, or where it isn't there, the picture in which it can be put.
  want(name) {
    const handle = `[data-handle="${CSS.escape(name)}"]`;
    this.wanted = `${handle}, svg:not(:has(${handle})) [data-pick="${CSS.escape(name)}"]`;
  }

  // At once, and not with the next picture: under software rendering that may be several keys away.
  keep() {
    if (!this.wanted || document.activeElement !== document.body) return;
    this.returning = true;
    document.querySelector(this.wanted)?.focus({ preventScroll: true });
    this.returning = false;
  }
}
