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
    if (parts.arranged) arrange(parts.arranged.split(" "));
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

// Controls stand in the order that the state asks for. One that stands right isn't touched: who is in it stays there.
function arrange(names) {
  let before = null;
  for (const name of names) {
    const node = column.querySelector(`.s3-controls > [data-part="control:${CSS.escape(name)}"]`);
    if (!node) continue;
    if (before && before.nextElementSibling !== node) before.after(node);
    before = node;
  }
}
