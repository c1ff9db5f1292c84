// A handout: the text with a picture of each step. The pictures are taken of a second sim that nobody sees, in the light
// theme and always as large, so that the one beside the text stays as it is.
import { Frame } from "./frame.js";

const PATIENCE = 20000; // milliseconds for one picture
const TRIES = 5; // a picture may be of the state before

export class Handout {
  constructor({ steps, embed }) {
    this.steps = steps;
    this.embed = embed;
    this.button = document.querySelector("[data-handout]");
    this.status = document.querySelector("[data-handout-status]");
  }

  begin() {
    this.button.hidden = false;
    this.button.addEventListener("click", () => this.make());
  }

  async make() {
    this.button.disabled = true;
    try {
      await this.illustrate();
      this.status.textContent = "";
    } catch {
      this.status.textContent = "Without pictures of the steps: the sim didn’t answer.";
    }
    this.button.disabled = false;
    this.print();
  }

  // A sandboxed frame may not print unless it is allowed to, and isn't told.
  print() {
    let begun = false;
    addEventListener("beforeprint", () => (begun = true), { once: true });
    print();
    if (!begun && self.origin === "null") this.status.textContent = "The page around doesn’t let this one print: open it in a tab of its own.";
  }

  async illustrate() {
    const wanted = this.steps.filter(({ id }) => !document.getElementById(id).querySelector(".taken"));
    if (!wanted.length) return;
    const frame = this.unseen();
    try {
      const sim = new Frame(frame);
      await heard(sim, "ready");
      for (const [k, step] of wanted.entries()) {
        this.status.textContent = `Taking picture ${k + 1} of ${wanted.length}`;
        put(step, await taken(sim, step));
      }
    } finally {
      frame.remove();
    }
    await Promise.all([...document.querySelectorAll(".taken img")].map((image) => image.decode()));
  }

  unseen() {
    const frame = document.createElement("iframe");
    Object.assign(frame, { src: this.embed, className: "studio", inert: true, ariaHidden: "true" });
    document.body.append(frame);
    return frame;
  }
}

async function taken(sim, step) {
  sim.set(step);
  for (let k = 0; k < TRIES; k++) {
    sim.post({ type: "sim3:get", picture: true });
    const { query, picture } = await heard(sim, "picture");
    if (query === step.query) return picture;
  }
  return null;
}

function heard(sim, type) {
  return new Promise((resolve, reject) => {
    sim.on(type, resolve);
    setTimeout(() => reject(new Error(type)), PATIENCE);
  });
}

function put({ id, title }, picture) {
  if (!picture) return;
  const figure = document.createElement("figure");
  figure.className = "taken";
  figure.append(Object.assign(new Image(), { src: picture, alt: title }));
  document.getElementById(id).querySelector("h2").after(figure);
}
