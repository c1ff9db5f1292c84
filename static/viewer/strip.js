// A strip above the column: the steps of the sim's lesson with back and next, and the challenge of the link.
import { column, element, sim } from "./page.js";

const GLIDE = 0.8; // seconds to the state of a step

export class Strip {
  constructor(channel, view, address) {
    this.channel = channel;
    this.view = view;
    this.at = Math.max(sim.steps.findIndex(({ query }) => query === address.query), 0);
    this.challenge = sim.challenges.find(({ id }) => id === address.options.get("challenge"));
    if (!sim.steps.length && !this.challenge) return;
    this.strip = element("section", { class: "s3-strip", "aria-label": sim.steps.length ? "Lesson" : "Challenge" }, column);
    column.prepend(this.strip);
    if (sim.steps.length) this.addSteps();
    if (this.challenge) this.addChallenge();
  }

  addSteps() {
    this.where = element("p", { class: "s3-step", "aria-live": "polite" }, this.strip);
    const row = element("div", { class: "s3-actions" }, this.strip);
    this.back = this.button("‹ Back", -1, row);
    this.next = this.button("Next ›", 1, row);
    this.tell();
  }

  addChallenge() {
    const box = element("p", { class: "s3-challenge" }, this.strip);
    this.tick = element("span", { class: "s3-tick", "aria-hidden": "true" }, box);
    element("b", {}, box).textContent = this.challenge.title;
    box.append(` ${this.challenge.goal} `);
    this.near = element("span", { role: "status", class: "s3-near" }, box);
  }

  button(label, by, row) {
    const button = element("button", { type: "button" }, row);
    button.textContent = label;
    button.addEventListener("click", () => this.go(this.at + by));
    return button;
  }

  go(at) {
    this.at = at;
    const { params, view } = sim.steps[at];
    this.channel.send({ type: "set", params, seconds: GLIDE });
    if (view) this.view.go(view);
    this.tell();
  }

  tell() {
    const { title, words } = sim.steps[this.at];
    this.where.innerHTML = "";
    element("b", {}, this.where).textContent = `${this.at + 1} of ${sim.steps.length}: ${title}`;
    this.where.append(` ${words}`);
    this.back.disabled = this.at === 0;
    this.next.disabled = this.at + 1 === sim.steps.length;
  }

  // A challenge stays solved once it was.
  show({ challenges }) {
    const found = this.challenge && challenges?.[this.challenge.id];
    if (!found || this.tick.dataset.solved) return;
    if (found.solved) this.tick.dataset.solved = "1";
    if (this.near.textContent !== found.words) this.near.textContent = found.words;
  }
}
