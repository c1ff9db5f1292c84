// The websocket of a class: opened anew whenever it breaks off, until the class is over.
const FIRST = 250;
const LAST = 2000;
const OVER = 4410;

export class Socket {
  // `greeting()` says who the page is, `takers` take what comes, by its type, and `lost` the code of a socket that ends.
  constructor(path, greeting, takers, lost) {
    this.url = new URL(path, location.href).href.replace(/^http/, "ws");
    this.greeting = greeting;
    this.takers = takers;
    this.lost = lost;
    this.retryAfter = FIRST;
    this.over = false;
  }

  open() {
    this.socket = new WebSocket(this.url);
    this.socket.onopen = () => this.send(this.greeting());
    this.socket.onmessage = ({ data }) => this.take(JSON.parse(data));
    this.socket.onclose = ({ code }) => {
      if (this.over) return;
      if (code === OVER) return this.end();
      this.lost(code);
      setTimeout(() => this.open(), this.retryAfter);
      this.retryAfter = Math.min(2 * this.retryAfter, LAST);
    };
  }

  take(message) {
    if (message.type === "end") return this.end();
    if (message.type === "class") this.retryAfter = FIRST;
    this.takers[message.type]?.(message);
  }

  end() {
    this.over = true;
    this.socket.close();
    this.takers.end();
  }

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
