// A learner's page: a sim or lesson of their own, and what the class wants of it.
import { Socket } from "./socket.js";
import { data, Stage } from "./stage.js";

const GLIDE = 0.8; // seconds to the teacher's state
const OFTEN = 1000; // milliseconds between two reports of where the sim is
const RETURNS = 5000; // milliseconds
const WAITING = { 1013: "The class is full. This page tries again by itself.", 4404: "Waiting for your teacher’s page …" };

class Learner {
  constructor() {
    this.me = history.state?.me ?? randomName();
    this.animal = history.state?.animal ?? "";
    this.mine = null; // the learner's own state, as the sim told it last
    this.teachers = null; // the teacher's, while all eyes are there
    this.returning = 0; // until then the sim may be on its way back to the learner's own state
    this.guesses = new Map();
    this.reporting = 0;
    this.reported = "";
    this.bar = document.querySelector(".says");
    this.question = document.querySelector(".ask");
    this.socket = new Socket(data.socket, () => ({ type: "join", me: this.me, animal: this.animal }), {
      class: (message) => this.enter(message),
      eyes: (message) => this.look(message),
      ask: () => this.beAsked(),
      full: ({ words }) => this.say(words),
      end: () => this.end(),
    }, (code) => this.lost(code));
  }

  begin() {
    for (const button of document.querySelectorAll("[data-answer]")) {
      button.addEventListener("click", () => this.answer(button.dataset.answer === "yes"));
    }
    this.socket.open();
  }

  say(words) {
    if (this.bar.textContent !== words) this.bar.textContent = words;
  }

  lost(code) {
    this.question.hidden = true;
    this.say(WAITING[code] ?? "The connection is lost. Your sim goes on; this page looks for the class.");
  }

  // ---- what the class says

  enter({ address, animal, eyes, params }) {
    this.animal = animal;
    history.replaceState({ ...history.state, me: this.me, animal }, "");
    document.querySelector(".me").textContent = `You are ${animal}`;
    this.stage ??= this.open(address);
    for (const [box, value] of this.guesses) this.socket.send({ type: "guess", box, value });
    this.reported = "";
    if (this.mine) this.report();
    this.look({ on: eyes, params });
  }

  open(address) {
    const frame = document.querySelector(".frame");
    const stage = new Stage(Object.assign(document.createElement("iframe"), {
      allow: "fullscreen; clipboard-write", name: "sim3-class", title: "Your sim",
    }), {
      "sim3:ready": () => this.teachers && this.show(),
      "sim3:state": (state) => this.take(state),
      "sim3:prediction": ({ box, value }) => this.guess(box, value),
    });
    frame.append(stage.frame);
    stage.load(address);
    return stage;
  }

  look({ on, params }) {
    const before = this.teachers;
    this.teachers = on ? params ?? {} : null;
    this.stage.frame.inert = on;
    document.body.classList.toggle("eyes", on);
    if (on) this.show();
    else if (before && this.mine) {
      this.returning = performance.now() + RETURNS;
      this.stage.set(this.mine.params);
    }
    this.say(on ? "All eyes on your teacher’s sim. Your own comes back." : "");
  }

  show() {
    this.stage.set(this.teachers, GLIDE);
  }

  // ---- what the sim says

  // What it passes on its way to the teacher's state and back is not the learner's.
  take({ params, query }) {
    if (this.teachers) return;
    if (performance.now() < this.returning && query !== this.mine.query) return;
    this.returning = 0;
    this.mine = { params, query };
    this.reporting ||= setTimeout(() => this.report(), this.reported ? OFTEN : 0);
  }

  report() {
    clearTimeout(this.reporting);
    this.reporting = 0;
    if (this.mine.query === this.reported && this.reported) return;
    this.reported = this.mine.query;
    this.socket.send({ type: "at", params: this.mine.params });
  }

  guess(box, value) {
    if (this.guesses.has(box)) return;
    this.guesses.set(box, value);
    this.socket.send({ type: "guess", box, value });
  }

  // ---- may it be shown

  beAsked() {
    this.question.hidden = false;
    this.question.querySelector("button").focus();
  }

  answer(yes) {
    this.question.hidden = true;
    this.socket.send({ type: "answer", ...(yes && this.mine ? { params: this.mine.params } : {}) });
  }

  end() {
    this.question.hidden = true;
    if (this.stage) this.look({ on: false });
    this.say("The class is over. You can go on with your sim; nothing is kept.");
  }
}

function randomName() {
  return Array.from(crypto.getRandomValues(new Uint8Array(12)), (b) => b.toString(16).padStart(2, "0")).join("");
}

// The teacher's page shows the learners' address in its bar; loaded anew, it is the teacher's again.
if (history.state?.teacher) location.replace(history.state.teacher);
else new Learner().begin();
