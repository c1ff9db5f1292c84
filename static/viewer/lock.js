// Who only watches sees everything and sets nothing; files and texts are taken from those alone who have the key.
import { column, sim } from "./page.js";

const TAKERS = "textarea, [data-s3-file], [data-s3-text], [data-s3=take]";
const CONTROLS = `input, select, [data-act], [data-nudge], ${TAKERS}`;

export function lock() {
  const closed = sim.watching ? CONTROLS : sim.keyed ? "" : TAKERS;
  for (const node of column.querySelectorAll(".s3-controls [data-locked]")) {
    if (closed && node.matches(closed)) continue;
    node.disabled = false;
    delete node.dataset.locked;
  }
  for (const node of closed ? column.querySelectorAll(`.s3-controls :is(${closed}):not(:disabled)`) : []) {
    node.disabled = true;
    node.dataset.locked = "";
  }
}
