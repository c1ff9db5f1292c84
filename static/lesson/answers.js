// Questions: predictions, which the sim then plays, checks, and challenges, which the sim says how near one is to.
import { spelled, valueAt } from "./values.js";

const PLAY = 1.2; // seconds

export class Answers {
  constructor(sim, steps) {
    this.sim = sim;
    this.steps = steps;
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
      const answer = typeof asked.answer === "number" && asked.kind !== "choice" ? ` It is ${spelled(asked.answer, {})}.` : "";
      say(form, (right ? "You saw that coming." : "Not what you expected? See what happens.") + answer);
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
    if (!box || box.dataset.solved || (solved && this.steps.gliding)) return;
    box.querySelector("progress").value = progress;
    const near = box.querySelector(".near");
    if (near.textContent !== words) near.textContent = words;
    if (solved && this.steps.taken) box.dataset.solved = "1";
  }
}

function say(form, words) {
  form.querySelector("[role=status]").textContent = words;
}
