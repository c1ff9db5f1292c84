// The channel to the server: JSON both ways. It is opened anew whenever it breaks off.
import { IDLE, reduced, sim } from "./page.js";

const FIRST = 250;
const LAST = 1500; // within the time that the server waits before it draws
const INPUTS = new Set(["slide", "enter", "handle", "action", "select", "set"]); // what changes the state

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
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = (event) => {
      this.socket = null;
      this.lost(event.code, event.reason);
      if (event.code === IDLE) return; // until somebody is there again
      setTimeout(() => this.open(), this.retryAfter);
      this.retryAfter = Math.min(this.retryAfter * 2, LAST);
    };
  }

  send(message) {
    if (INPUTS.has(message.type)) this.goesOn(message);
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
