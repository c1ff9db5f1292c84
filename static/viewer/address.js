// Keeps the address equal to the state. What it must not hold stays beside it: the room, for a reload, and the state
// that Reset leads back to.
import { Query, sim } from "./page.js";

const STAYED = 3000; // milliseconds after which a page that was to be left is still there
const OPTIONS = ["view", "controls", "theme", "only", "challenge", "lesson"];

export class Address {
  constructor() {
    this.options = new Query();
    for (const [name, value] of new Query(sim.search)) if (OPTIONS.includes(name)) this.options.append(name, value);
    this.opened = stateQuery(sim.opened);
    this.query = stateQuery(sim.search);
    const brought = new Query(location.hash.slice(1));
    this.ticket = brought.get("steer") ?? history.state?.ticket ?? "";
    this.left = brought.get("room") ?? history.state?.left ?? ""; // the room of which this is a copy
    this.leaving = 0;
    addEventListener("beforeunload", () => this.leave());
  }

  // Where the address changes while it is reloaded, the browser takes that for a new page, which has no room yet.
  leave() {
    clearTimeout(this.leaving);
    this.leaving = setTimeout(() => {
      this.leaving = 0;
      this.show();
    }, STAYED);
  }

  show() {
    if (this.leaving) return;
    try {
      const { ticket, left } = this;
      history.replaceState({ path: sim.path, opened: this.opened, ticket, left }, "", this.of(sim.address));
    } catch { /* some browsers let a sandboxed frame change no more than its query */ }
  }

  // A path with the state and this page's options.
  of(path) {
    const search = [this.query, this.options.toString().replaceAll("%2C", ",")].filter(Boolean).join("&");
    return path + (search ? "?" + search : "");
  }

  // Where others watch this room, or another one.
  watched(room) {
    return new URL(sim.path.replace(/\/s\/([0-9a-f]{20})\/.*$/, (_, here) => `/s/${room ?? here}/`), location.href).href;
  }

  // The application's own address, which may end like a sim's begins: the path that it is served under is free.
  get site() {
    return sim.place.slice(0, sim.place.lastIndexOf("/sims/"));
  }

  // A link to a page of the sim in this state; to its embed, in a room of its own.
  link(page) {
    return new URL(this.of(sim.path.replace(/\/s(\/[^/]+){1,2}\/$/, `/${page}`)), location.href).href;
  }
}

function stateQuery(search) {
  const given = new Query(search);
  for (const name of OPTIONS) given.delete(name);
  return given.toString();
}
