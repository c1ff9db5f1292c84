// The channel to the server: JSON both ways. It is opened anew whenever it breaks off.
import { IDLE, reduced, sim } from "./page.js";

const FIRST = 250;
const LAST = 1500; // within the time that the server waits before it draws
const INPUTS = new Set(["slide", "enter", "handle", "action", "select", "set"]); // what changes the state
const ABSOLUTE = new Set(["slide", "enter", "handle", "select"]); // what leads to the same state when it is said twice
const TOLD = 1000; // milliseconds within which the state that the page holds has what was put in
const MOST_KEPT = 100;

export class Channel {
  // `greeting()` says what the page holds; `take` gets what comes, `lost` the code and reason of a channel that ends, and
  // `goesOn` what is about to change the state.
  constructor(greeting, take, lost, goesOn) {
    this.greeting = greeting;
    this.take = take;
    this.lost = lost;
    this.goesOn = goesOn;
    this.socket = null;
    this.retryAfter = FIRST;
    this.answered = false; // whether the server has answered this socket's greeting, and so takes inputs
    this.kept = []; // inputs that the server may not know of, in order
  }

  // Somebody is there again.
  wake() {
    if (!this.socket) this.open();
  }

  open() {
    this.socket = new WebSocket(`${sim.socket}channel?viewer=${sim.viewer}`);
    this.socket.onopen = () => {
      this.retryAfter = FIRST;
      this.send({ type: "hello", dark: sim.dark, reduced: reduced.matches, ...this.greeting() });
    };
    this.socket.onmessage = (event) => {
      const message = JSON.parse(event.data);
      if (!this.answered && message.type === "state") this.catchUp(message.begins);
      this.take(message);
    };
    this.socket.onclose = (event) => {
      this.socket = null;
      if (this.answered) this.forget();
      this.answered = false;
      this.lost(event.code, event.reason);
      if (event.code === IDLE) return; // until somebody is there again
      setTimeout(() => this.open(), this.retryAfter);
      this.retryAfter = Math.min(this.retryAfter * 2, LAST);
    };
  }

  send(message) {
    const input = INPUTS.has(message.type);
    if (input) {
      this.goesOn(message);
      this.keep(message);
    }
    if (this.socket?.readyState === WebSocket.OPEN && (this.answered || !input)) this.socket.send(JSON.stringify(message));
  }

  // What is put in while there is no connection is said when there is one again. What was sent shortly before it broke
  // is said again only to a room that `begins` with the state that this page held: one that went on all the time had
  // it, and may have been moved by others since.
  catchUp(begins) {
    this.answered = true;
    const said = this.kept.filter(({ sent }) => begins || !sent);
    this.kept = [];
    for (const { message } of said) {
      this.socket.send(JSON.stringify(message));
      this.keep(message);
    }
  }

  // A press that was sent isn't said again, for twice is more than once; and nothing from before it, for it led on from
  // there. Of what leads to the same state when it is said twice, the last counts; but a press that waits saw the one before.
  keep(message) {
    const sent = this.answered;
    const absolute = ABSOLUTE.has(message.type);
    if (sent) this.forget();
    if (sent && !absolute) {
      this.kept = [];
      return;
    }
    const key = `${message.type} ${message.name}`;
    const press = this.kept.findLastIndex((each) => !ABSOLUTE.has(each.message.type));
    if (absolute) this.kept = this.kept.filter((each, k) => k <= press || each.key !== key);
    this.kept.push({ key, message, sent, at: performance.now() });
    this.kept.splice(0, this.kept.length - MOST_KEPT);
  }

  forget() {
    const told = performance.now() - TOLD;
    this.kept = this.kept.filter(({ sent, at }) => !sent || at > told);
  }
}
