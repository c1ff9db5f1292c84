// A strip above the column: the steps of the sim's lesson with back and next, and a challenge, that of the link or of the
// step, with how near it is.
import { column, element, sim } from "./page.js";

const GLIDE = 0.8; // seconds to the state of a step
const REST = 700; // milliseconds without a change before how near one is is spoken

export class Strip {
  constructor(channel, view, address) {
    this.channel = channel;
    this.view = view;
    this.at = 0;
    this.begun = false; // whether a state was shown
    this.linked = address.options.get("challenge");
    this.solved = new Set();
    this.found = {}; // how near the state is to each challenge
    if (!sim.steps.length && !this.linked) return;
    this.strip = element("section", { class: "s3-strip", "aria-label": sim.steps.length ? "Lesson" : "Challenge" }, column);
    column.prepend(this.strip);
    if (sim.steps.length) this.addSteps();
    this.addChallenge();
    if (sim.steps.length) this.tell();
  }

  addSteps() {
    const row = element("div", { class: "s3-steps" }, this.strip);
    this.back = this.button("‹", "Back", -1, row);
    this.where = element("b", {}, row);
    this.next = this.button("›", "Next", 1, row);
    this.sentence = element("p", { class: "s3-step" }, this.strip);
  }

  addChallenge() {
    this.box = element("p", { class: "s3-challenge" }, this.strip);
    this.tick = element("span", { class: "s3-tick", "aria-hidden": "true" }, this.box);
    this.title = element("b", {}, this.box);
    this.goal = element("span", { class: "s3-goal" }, this.box);
    this.near = element("span", { class: "s3-away" }, this.box);
    this.live = element("span", { role: "status", class: "s3-hidden" }, this.strip);
  }

  button(mark, name, by, row) {
    const button = element("button", { type: "button", "aria-label": name, title: name }, row);
    button.textContent = mark;
    button.addEventListener("click", () => this.go(this.at + by));
    return button;
  }

  go(at) {
    this.at = at;
    const { params, view } = sim.steps[at];
    this.channel.send({ type: "set", params, seconds: GLIDE });
    if (view) this.view.go(view);
    this.tell();
    this.speak(`${this.where.textContent}. ${this.sentence.textContent}`, 0);
  }

  tell() {
    const { title, words } = sim.steps[this.at];
    this.where.textContent = `${this.at + 1} of ${sim.steps.length}: ${title}`;
    this.sentence.textContent = words;
    this.back.disabled = this.at === 0;
    this.next.disabled = this.at + 1 === sim.steps.length;
    this.showChallenge();
  }

  // That of the link, or else the first of the step that isn't solved yet.
  get challenge() {
    const ids = this.linked ? [this.linked] : sim.steps[this.at]?.challenges ?? [];
    const id = ids.find((each) => !this.solved.has(each)) ?? ids.at(-1);
    return sim.challenges.find((each) => each.id === id);
  }

  // The frame may have been opened in the state of any step.
  show({ query, challenges }) {
    if (!this.strip) return;
    const opened = this.begun ? -1 : sim.steps.findIndex((step) => step.query === query);
    this.begun = true;
    this.found = challenges ?? {};
    if (opened > 0) this.at = opened;
    if (sim.steps.length) this.tell();
    else this.showChallenge();
  }

  // A challenge stays solved once it was.
  showChallenge() {
    const { challenge } = this;
    this.box.hidden = !challenge;
    if (!challenge) return;
    const { id, title, goal } = challenge;
    const found = this.found[id];
    const done = this.solved.has(id);
    this.title.textContent = title;
    this.goal.textContent = goal;
    if (!done) this.near.textContent = found?.words ?? "";
    this.tick.toggleAttribute("data-solved", done || found?.solved === true);
    if (done || !found || this.said === id + found.words) return;
    this.said = id + found.words;
    if (found.solved) this.solved.add(id);
    this.speak(found.solved ? `${title}: solved.` : `${title}: ${found.words}`, found.solved ? 0 : REST);
  }

  speak(words, after) {
    clearTimeout(this.speaking);
    this.speaking = setTimeout(() => (this.live.textContent = words), after);
  }
}
