// The parts of the column: what the server says differs is put in its place.
import { column } from "./page.js";
import { morph } from "./morph.js";
import { Steady } from "./steady.js";

export class Parts {
  // `goesOn()` is told of what a hand in the scene has moved.
  constructor(pace, controls, handles, highlight, goesOn) {
    this.pace = pace;
    this.controls = controls;
    this.handles = handles;
    this.highlight = highlight;
    this.goesOn = goesOn;
    this.steady = new Steady();
    this.version = -1;
  }

  show(message) {
    this.version = message.version;
    this.steady.through(() => this.put(message));
  }

  put({ version, values, parts }) {
    // Frames of pictures come before what is in them.
    for (const [name, html] of Object.entries(parts)) {
      const node = column.querySelector(`[data-part="${CSS.escape(name)}"]`);
      if (node) morph(node, html);
    }
    column.dataset.version = version;
    this.pace.answered();
    this.controls.show(values);
    this.highlight.moved(Object.keys(values));
    if (this.highlight.grips && Object.keys(values).length) this.goesOn();
    if (!Object.keys(parts).length) return;
    this.handles.drawn();
    this.highlight.show();
  }
}
