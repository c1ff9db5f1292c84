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
    this.kept = []; // inputs that a server which comes anew may not know of, in order
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
      for (const each of this.kept) this.socket.send(JSON.stringify(each.message));
      for (const each of this.kept) each.sent = true;
    };
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = (event) => {
      this.socket = null;
      this.forget();
      this.lost(event.code, event.reason);
      if (event.code === IDLE) return; // until somebody is there again
      setTimeout(() => this.open(), this.retryAfter);
      this.retryAfter = Math.min(this.retryAfter * 2, LAST);
    };
  }

  send(message) {
    const open = this.socket?.readyState === WebSocket.OPEN;
    if (INPUTS.has(message.type)) {
      this.goesOn(message);
      this.keep(message, open);
    }
    if (open) this.socket.send(JSON.stringify(message));
  }

  // What was put in shortly before the connection breaks, or while there is none, is said when there is one again. A
  // press that was sent isn't, for twice is more than once; and nothing from before it, for it led on from there.
  keep(message, sent) {
    this.forget();
    const key = `${message.type} ${message.name}`;
    if (sent && !ABSOLUTE.has(message.type)) {
      this.kept = [];
      return;
    }
    if (ABSOLUTE.has(message.type)) this.kept = this.kept.filter((each) => each.key !== key);
    this.kept.push({ key, message, sent, at: performance.now() });
    this.kept.splice(0, this.kept.length - MOST_KEPT);
  }

  forget() {
    const told = performance.now() - TOLD;
    this.kept = this.kept.filter(({ sent, at }) => !sent || at > told);
  }
}
