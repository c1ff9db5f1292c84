// The sim beside the text, by the messages that any page around a sim may use.
const ANSWERED = 3000; // milliseconds after which an answer isn't waited for any more

export class Frame {
  constructor(frame) {
    this.frame = frame;
    this.takers = {};
    this.state = null; // params, query, and the solution of the newest state that is solved
    this.asked = null; // when the question was sent that isn't answered yet
    this.stale = false;
    this.again = 0;
    this.heard = false; // whether the sim has said anything
    this.waiting = null; // what it is to be set to when it can hear
    addEventListener("message", ({ source, origin, data }) => {
      if (origin === self.origin && source === frame.contentWindow) this.take(data);
    });
  }

  // Whichever of the two starts first: the sim tells of itself when it is ready, or when it is asked.
  begin() {
    this.ask();
  }

  on(type, taker) {
    (this.takers[type] ??= []).push(taker);
  }

  tell(type, what) {
    for (const taker of this.takers[type] ?? []) taker(what);
  }

  take(data) {
    this.begins();
    const type = String(data?.type).replace("sim3:", "");
    if (type === "state") this.takeState(data);
    else if (type === "drawn") this.ask();
    else if (type === "ready") this.askAnew();
    if (["ready", "challenge", "touched", "error", "picture"].includes(type)) this.tell(type, data);
  }

  // A step may be reached before the sim is there, by a link to it.
  begins() {
    if (!this.heard && this.waiting) this.post(this.waiting);
    this.heard = true;
  }

  takeState({ params, query, solution }) {
    this.tell("state", { params, query });
    if (solution === undefined) return;
    this.state = { params, query, solution };
    this.tell("values", this.state);
    this.asked = null;
    if (this.stale) this.ask();
  }

  // The newest values: one question is on its way at a time.
  ask() {
    this.stale = this.asked !== null && performance.now() - this.asked < ANSWERED;
    if (this.stale) return;
    this.asked = performance.now();
    clearTimeout(this.again); // a sim that wasn't there yet never heard the question
    this.again = setTimeout(() => this.asked !== null && this.askAnew(), ANSWERED);
    this.post({ type: "sim3:get", solution: true });
  }

  // What was asked before the sim was ready, it never heard.
  askAnew() {
    this.asked = null;
    this.ask();
  }

  // What a step, a link or a question names: `seconds` to glide there.
  set({ params, view }, seconds) {
    const message = { type: "sim3:set", params, ...(seconds ? { seconds } : {}), ...(view ? { view } : {}) };
    if (!this.heard) this.waiting = message;
    this.post(message);
  }

  // What somebody moves or types in the text, as if they did it beside the scene.
  move(params) {
    this.tell("touched");
    this.set({ params });
  }

  enter(name, text) {
    this.tell("touched");
    this.post({ type: "sim3:enter", name, text });
  }

  post(message) {
    this.frame.contentWindow.postMessage(message, "*");
  }
}
