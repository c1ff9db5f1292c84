// The viewpoint: worked out anew when the page's size has left it, but never against one that somebody chose.
import { sim } from "./page.js";

const REST = 150; // milliseconds without another size

// A viewpoint is chosen for a landscape scene; in a tall or narrow one, step back so that the same sphere fits. The
// server does the same for the views that it finds later (sims/kit/scene/view.py).
export function fit() {
  const { field, sheet, lower } = sim.layout;
  const { left, right, phone } = sim.covered;
  const seen = phone ? sheet : 1; // of the height; viser's bottom sheet covers the rest
  const target = sim.view.slice(3);
  const away = sim.view.slice(0, 3).map((v, i) => v - target[i]);
  const width = Math.max(innerWidth - left - right, 1);
  const half = Math.tan(field / 2) * Math.min(1, width / (innerHeight * seen)) * seen;
  const scale = sim.radius / Math.sin(Math.atan(half)) / Math.hypot(...away);
  if (phone) target[2] -= lower * sim.radius; // so that the scene stands above the sheet
  return [...away.map((v, i) => target[i] + v * scale), ...target];
}

export class View {
  constructor(channel, address, resized) {
    this.channel = channel;
    this.address = address;
    this.chosen = address.options.has("view");
    this.last = fit();
    this.sizing = 0;
    for (const kind of ["pointerdown", "wheel", "keydown"]) {
      document.addEventListener(kind, (event) => {
        if (event.target.matches?.("canvas")) this.chosen = true;
      }, { capture: true, passive: true });
    }
    addEventListener("resize", () => {
      clearTimeout(this.sizing);
      this.sizing = setTimeout(() => {
        if (!innerWidth || !innerHeight) return; // hidden again
        resized();
        this.refit();
      }, REST);
    });
  }

  refit() {
    const view = fit();
    if (this.chosen || Math.hypot(...view.map((v, i) => v - this.last[i])) < 0.02 * sim.radius) return;
    this.last = view;
    this.channel.send({ type: "view", view, fit: true });
  }

  choose(view) {
    this.chosen = true;
    this.address.options.set("view", view.join(","));
    this.channel.send({ type: "view", view });
  }
}

// The first one: that of the link, or the one that fits.
export function firstView(address) {
  return address.options.get("view")?.replaceAll("−", "-").split(",").map(Number) ?? fit();
}
