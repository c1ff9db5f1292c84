// Somebody else's viewpoint, which this page follows: viewpoints come some ten times a second, and the view glides from
// each to the next.
import { reduced, sim } from "./page.js";
import { distance, shape } from "./view.js";
import { lookFrom } from "./viser_dom.js";

const LONGER = 1.5; // how much longer a glide takes than the last two viewpoints were apart: it shall not stop between them
const SHORTEST = 100; // milliseconds of a glide
const LONGEST = 400;

export class Lead {
  // `view` is this page's own: it says whether it is led, and from where it looks.
  constructor(view) {
    this.view = view;
    this.told = null; // the newest viewpoint, and the shape of the page that it was seen in
    this.came = 0; // when
    this.frame = 0;
  }

  get gliding() {
    return this.frame !== 0;
  }

  hear({ view, aspect }) {
    const now = performance.now();
    const apart = now - this.came;
    Object.assign(this, { told: { view, aspect }, came: now });
    this.follow(Math.min(Math.max(LONGER * apart, SHORTEST), LONGEST));
  }

  // At once, as where the page has another shape now.
  again() {
    if (this.told) this.follow(0);
  }

  follow(milliseconds) {
    if (!this.view.led || !sim.liveAt) return;
    const from = this.gliding ? this.at : this.view.camera;
    const to = fitted(this.told);
    const begun = performance.now();
    const step = () => {
      this.frame = 0;
      if (!this.view.led) return; // a hand has taken the view
      const share = reduced.matches || !milliseconds ? 1 : Math.min((performance.now() - begun) / milliseconds, 1);
      this.at = between(from, to, share);
      lookFrom(this.at);
      if (share < 1) this.frame = requestAnimationFrame(step);
    };
    cancelAnimationFrame(this.frame);
    step();
  }
}

// The same seen in a page of this one's shape: what fits into the one fits into the other.
export function fitted({ view, aspect }) {
  const target = view.slice(3);
  const scale = distance(shape()) / distance(aspect);
  return [...view.slice(0, 3).map((v, i) => target[i] + (v - target[i]) * scale), ...target];
}

// From viewpoint to viewpoint on an arc around what is looked at.
export function between(a, b, share) {
  if (share >= 1) return b;
  const [from, to] = [a, b].map((view) => view.slice(0, 3).map((v, i) => v - view[i + 3]));
  const [near, far] = [from, to].map((away) => Math.hypot(...away));
  const turned = from.map((v, i) => mix(v / near, to[i] / far, share));
  const length = Math.hypot(...turned);
  if (!(length > 0.1)) return b; // there is no way from one side to the very opposite
  const away = near ** (1 - share) * far ** share / length;
  const target = a.slice(3).map((v, i) => mix(v, b[i + 3], share));
  return [...target.map((v, i) => v + turned[i] * away), ...target];
}

function mix(a, b, share) {
  return a + (b - a) * share;
}
