// No connection: after a while in words, for whoever runs the server.
import { element, IDLE, scene, sim } from "./page.js";

const PATIENCE = 5000;
const REFUSED = 4403; // the server says what is wrong with what it saw

export class Trouble {
  // `wake()` goes on after a rest.
  constructor(wake) {
    this.wake = wake;
    this.missing = 0;
    this.why = "";
    this.known = false; // whether there ever was a state
  }

  lost(code, reason) {
    this.why = (code === REFUSED && reason) || this.why;
    if (code === IDLE) this.rest();
    else if (code === REFUSED && reason) this.show();
    else this.missing ||= setTimeout(() => this.show(), PATIENCE);
  }

  // The server has put the room away; whoever comes back goes on where they were.
  rest() {
    sim.resting = true;
    const box = element("section", { class: "s3-trouble", role: "alert" });
    element("h2", {}, box).textContent = "Paused";
    element("p", {}, box).textContent = "Nobody has done anything here for a while. Touch anything to go on where you were.";
    const on = new AbortController();
    const wake = () => {
      on.abort();
      sim.resting = false;
      this.wake();
    };
    for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, wake, { signal: on.signal, capture: true });
  }

  // The browser draws no 3D, or no more; the rest works.
  blind() {
    const box = element("section", { class: "s3-trouble s3-blind", role: "alert" }, scene);
    element("h2", {}, box).textContent = sim.live ? "The browser took the scene away" : "This browser can’t draw 3D";
    element("p", {}, box).textContent = (sim.live
      ? "It does so where many are open at once. Reload the page to have it back, in the same state."
      : "WebGL 2 is off, or the machine has none.") + " Numbers, pictures and controls work.";
    offer(box);
  }

  found() {
    this.known = true;
    clearTimeout(this.missing);
    this.missing = 0;
    this.why = "";
    document.querySelector(".s3-trouble:not(.s3-blind)")?.remove();
  }

  show() {
    const box = document.querySelector(".s3-trouble:not(.s3-blind)") ?? element("section", { class: "s3-trouble", role: "alert" });
    const words = this.known ? interrupted(this.why) : unreachable(this.why);
    if (box.textContent === words.map(([, text]) => text).join("")) return;
    box.replaceChildren();
    for (const [tag, text] of words) if (text) element(tag, {}, box).textContent = text;
    offer(box);
  }
}

// The same sim without websockets and without a scene.
function offer(box) {
  const line = element("p", {}, box);
  const link = element("a", { href: `${sim.text}${location.search}` }, line);
  link.textContent = "The numbers and pictures without the scene";
  line.append(" work all the same.");
}

function interrupted(why) {
  return [
    ["h2", "The connection to the server is lost"],
    ["p", "It tries again by itself, and goes on where you are."],
    ["p", why],
  ];
}

function unreachable(why) {
  const blocked = `The page came, but the websocket to ${new URL(sim.place).host} doesn’t open. A proxy on the way must let `
    + "websockets through (Upgrade and Connection), and hand on the Host that the browser asked for.";
  return [
    ["h2", "This sim can’t reach its server"],
    ["p", "It tries again by itself. If it stays like this, tell whoever runs the server:"],
    ["p", why || blocked],
  ];
}
