// The teacher's page: the sim that can be everybody's, and how far the learners are.
import { Grid } from "./grid.js";
import { Predictions } from "./predictions.js";
import { Socket } from "./socket.js";
import { data, Stage } from "./stage.js";

const GLIDE = 0.8; // seconds to a learner's state

class Teacher {
  constructor() {
    this.ends = null;
    this.eyes = false;
    this.params = null; // what the sim shows
    this.mine = null; // the teacher's own state, while a learner's is shown
    this.wanted = null; // what the sim is to show as soon as it is there
    this.stage = new Stage(document.querySelector(".shown iframe"), {
      "sim3:state": ({ params }) => this.take(params),
    });
    this.grid = new Grid((animal) => this.socket.send({ type: "ask", animal }));
    this.predictions = new Predictions(this.stage.frame);
    this.socket = new Socket(data.socket, () => this.greeting(), {
      class: (message) => this.welcome(message),
      grid: (message) => this.show(message),
      lent: (message) => this.lent(message),
      full: ({ words }) => this.trouble(`${words} This page tries again by itself.`),
      end: () => this.end(),
    }, (code) => this.trouble(code === 4403 ? "This page’s key leads no class of this code." : "The connection is lost. This page tries again by itself."));
  }

  begin() {
    history.replaceState({ teacher: location.href }, "", data.place); // the key is not for who sees the address bar
    this.stage.load(data.address);
    document.addEventListener("click", ({ target }) => this.press(target.closest("[data-do]")));
    this.socket.open();
  }

  greeting() {
    const known = this.ends ? { ends: this.ends, eyes: this.eyes, params: this.params } : {};
    return { type: "open", page: data.page, query: data.query, ...known };
  }

  // What the class looks at is what this page showed before it was loaded anew.
  welcome({ ends, params }) {
    this.trouble("");
    if (this.ends === null && params) this.wanted = params;
    this.ends = ends;
    if (this.params) this.restore();
  }

  restore() {
    if (this.wanted) this.stage.set(this.wanted);
    this.wanted = null;
  }

  take(params) {
    if (this.wanted) return this.restore();
    this.params = params;
    this.socket.send({ type: "show", params });
  }

  show({ learners, guesses, eyes }) {
    this.eyes = eyes;
    const button = document.querySelector("[data-do=eyes]");
    button.textContent = eyes ? "Go on" : "All eyes here";
    button.ariaPressed = String(eyes);
    document.body.classList.toggle("eyes", eyes);
    this.grid.show(learners);
    this.predictions.show(guesses);
  }

  // A learner's state, for everybody who sees this page's screen; the teacher's own is kept.
  lent({ animal, params }) {
    this.mine ??= this.params;
    this.banner(`${animal} shows this.`);
    this.stage.set(params, GLIDE);
  }

  banner(words) {
    const banner = document.querySelector(".banner");
    banner.hidden = !words;
    banner.querySelector("[role=status]").textContent = words;
  }

  press(button) {
    const does = {
      eyes: () => this.socket.send({ type: "look", eyes: !this.eyes }),
      mine: () => this.goBack(),
      qr: () => document.querySelector(".large").showModal(),
      copy: () => copyLink(),
      only: () => (button.ariaPressed = String(document.body.classList.toggle("only-class"))),
      end: () => document.querySelector(".sure").showModal(),
      ended: () => this.socket.send({ type: "end" }),
      close: () => button.closest("dialog").close(),
    };
    does[button?.dataset.do]?.();
  }

  goBack() {
    this.banner("");
    this.stage.set(this.mine);
    this.mine = null;
  }

  trouble(words) {
    const place = document.querySelector(".connection");
    place.hidden = !words;
    place.textContent = words;
  }

  end() {
    document.querySelector(".sure").close();
    document.body.classList.add("ended");
    document.querySelector(".over").hidden = false;
  }
}

async function copyLink() {
  const status = document.querySelector(".copied");
  try {
    await navigator.clipboard.writeText(data.link);
    status.textContent = "Copied.";
  } catch {
    status.textContent = data.link; // without HTTPS browsers give no clipboard
  }
}

new Teacher().begin();
