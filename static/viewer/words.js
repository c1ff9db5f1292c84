// The page's words: what is spoken of a change, and notices for a moment.
import { element, sim } from "./page.js";
import { describeScene } from "./view.js";

const REST = 700; // milliseconds without a change before it is spoken
const SEEN = 6000;

export class Words {
  constructor() {
    this.live = element("div", { "aria-live": "polite", role: "status", class: "s3-hidden" });
    this.notice = element("div", { role: "alert", class: "s3-notice", hidden: "" });
    this.speaking = 0;
    this.last = "";
    this.hiding = 0;
  }

  speak(text, seen) {
    this.describe(text, seen);
    if (text === this.last) return; // what a motion says as it goes on is spoken meanwhile
    this.last = text;
    clearTimeout(this.speaking);
    this.speaking = setTimeout(() => (this.live.textContent = text), REST);
  }

  describe(text, seen) {
    describeScene(`${sim.title}. ${text} ${seen} Arrow keys turn the view, plus and minus zoom, Home goes back.`);
  }

  notify(text) {
    this.notice.textContent = text;
    this.notice.hidden = false;
    clearTimeout(this.hiding);
    this.hiding = setTimeout(() => this.dismiss(), SEEN);
  }

  dismiss() {
    this.notice.hidden = true;
  }
}

// A "?" says its sentence, or keeps it to itself.
export function explain(ask) {
  const why = document.getElementById(ask.getAttribute("aria-controls"));
  why.hidden = !why.hidden;
  ask.setAttribute("aria-expanded", String(!why.hidden));
  if (!why.hidden) why.scrollIntoView({ block: "nearest" });
}
