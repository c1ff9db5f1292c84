// Questions: predictions, which the sim then plays, checks, and challenges, which the sim says how near one is to.
import { valueAt } from "./spelling.js";

const PLAY = 1.2; // seconds
const REST = 700; // milliseconds without a change before how near one is is spoken

export class Answers {
  constructor(sim, steps) {
    this.sim = sim;
    this.steps = steps;
    this.live = document.querySelector("[data-live]");
    this.speaking = 0;
  }

  begin() {
    for (const form of document.querySelectorAll("[data-predict]")) this.predict(form);
    for (const form of document.querySelectorAll("[data-check]")) this.check(form);
    this.sim.on("challenge", (found) => this.challenge(found));
  }

  predict(form) {
    const asked = JSON.parse(form.dataset.predict);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const right = this.judge(form, asked);
      if (right === null) return say(form, asked.kind === "choice" ? "Choose one first." : "A number is needed here.");
      form.dataset.answered = right ? "right" : "wrong";
      for (const input of form.querySelectorAll("fieldset :is(input, button)")) input.disabled = true;
      form.querySelector("[data-right]")?.closest("label").classList.add("right");
      const words = right ? "You saw that coming." : "Not what you expected? See what happens.";
      say(form, asked.said ? `${words} It is ${asked.said}.` : words);
      this.play(asked);
    });
  }

  judge(form, { kind, path, within, answer }) {
    if (kind === "choice") {
      const chosen = form.querySelector("input:checked");
      return chosen && "right" in chosen.dataset;
    }
    const text = form.querySelector("input")?.value.trim().replace("−", "-").replace(",", ".");
    const value = kind === "set" ? valueAt(this.sim.state ?? { params: {}, solution: {} }, path) : text ? Number(text) : NaN;
    form.dataset.given = value;
    return Number.isFinite(value) ? Math.abs(value - answer) <= within : null;
  }

  play({ from, to }) {
    if (from) this.sim.set(from);
    this.steps.go(to, PLAY);
  }

  check(form) {
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("change", ({ target }) => {
      for (const each of form.querySelectorAll(".reason")) each.hidden = each.previousElementSibling !== target.closest("label");
      form.dataset.answered = "right" in target.dataset ? "right" : "wrong";
      say(form, "right" in target.dataset ? "Right." : "Not this one.");
    });
  }

  // Solved once is solved, by a learner: what the text itself shows or passes on its way is nobody's.
  challenge({ id, solved, progress, words }) {
    const box = document.querySelector(`[data-challenge="${CSS.escape(id)}"]`);
    if (!box || box.dataset.solved) return;
    box.querySelector("progress").value = progress;
    const near = box.querySelector(".near");
    if (near.textContent === words) return;
    near.textContent = words;
    const title = box.querySelector("strong").textContent;
    if (solved && this.steps.taken) {
      box.dataset.solved = "1";
      this.speak(`${title}: solved.`, 0);
    } else if (box.closest(".current")) this.speak(`${title}: ${words}`, REST);
  }

  // Of the step that is read, and not while something moves.
  speak(words, after) {
    clearTimeout(this.speaking);
    this.speaking = setTimeout(() => (this.live.textContent = words), after);
  }
}

function say(form, words) {
  form.querySelector("[role=status]").textContent = words;
}
