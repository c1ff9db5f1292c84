// Of a sim that shows what is under the pointer, the server hears where that passes over the scene: as fast as it shows it,
// and the newest. Neither of a finger, nor while a button is held, nor from somebody who only watches.
import { Pace } from "./pace.js";
import { scene, sim } from "./page.js";
import { rayThrough } from "./viser_dom.js";

export class Pointer {
  constructor(channel) {
    this.pace = new Pace(channel);
    this.over = false;
    if (!sim.under) return;
    scene.addEventListener("pointermove", (event) => this.tell(this.ray(event)));
    for (const kind of ["pointerleave", "pointerdown"]) scene.addEventListener(kind, () => this.tell(null), true);
  }

  ray(event) {
    const passes = event.pointerType !== "touch" && !event.buttons && event.target.matches("canvas");
    return passes && !sim.watching ? rayThrough(event) : null;
  }

  tell(ray) {
    if (ray || this.over) this.pace.put("over", { type: "over", ray });
    this.over = ray !== null;
  }
}
