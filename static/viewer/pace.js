// What is moved is sent as fast as it can be drawn: while one value is on its way, the next ones wait, and the newest of
// each takes the place of the others. The last one always arrives.
const PATIENCE = 200; // milliseconds after which more goes out although the last wasn't answered

export class Pace {
  constructor(channel) {
    this.channel = channel;
    this.waiting = new Map();
    this.sent = 0; // when what isn't answered yet was sent; 0 for nothing
    this.timer = 0;
  }

  get idle() {
    return !this.sent && !this.waiting.size;
  }

  put(key, message) {
    this.waiting.delete(key);
    this.waiting.set(key, message);
    this.flush();
  }

  answered() {
    this.sent = 0;
    this.flush();
  }

  flush() {
    clearTimeout(this.timer);
    if (!this.waiting.size) return;
    const due = this.sent ? this.sent + PATIENCE - performance.now() : 0;
    if (due > 0) {
      this.timer = setTimeout(() => this.flush(), due);
      return;
    }
    for (const message of this.waiting.values()) this.channel.send(message);
    this.waiting.clear();
    this.sent = performance.now();
  }
}
