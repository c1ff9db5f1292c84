// The sim beside the text, by the messages that any page around a sim may use.
const ANSWERED = 3000; // milliseconds after which an answer isn't waited for any more

export class Frame {
  constructor(frame) {
    this.frame = frame;
    this.takers = {};
    this.state = null; // params, query, and the solution of the newest state that is solved
    this.asked = 0;
    this.stale = false;
    addEventListener("message", ({ source, origin, data }) => {
      if (origin === location.origin && source === frame.contentWindow) this.take(data);
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
    switch (data?.type) {
      case "sim3:state":
        this.takeState(data);
        break;
      case "sim3:ready":
      case "sim3:drawn":
        this.ask();
        break;
      case "sim3:challenge":
        this.tell("challenge", data);
    }
  }

  takeState({ params, query, solution }) {
    this.tell("state", { params, query });
    if (solution === undefined) return;
    this.state = { params, query, solution };
    this.tell("values", this.state);
    this.asked = 0;
    if (this.stale) this.ask();
  }

  // The newest values: one question is on its way at a time.
  ask() {
    this.stale = performance.now() - this.asked < ANSWERED;
    if (this.stale) return;
    this.asked = performance.now();
    this.post({ type: "sim3:get", solution: true });
  }

  // What a step, a link or a question names: `seconds` to glide there.
  set({ params, view }, seconds) {
    this.post({ type: "sim3:set", params, ...(seconds ? { seconds } : {}), ...(view ? { view } : {}) });
  }

  post(message) {
    this.frame.contentWindow.postMessage(message, location.origin);
  }
}
