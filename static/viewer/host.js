// The page around the sim: what it is told, and what it asks for.
import { embedded, sim } from "./page.js";
import { picture as taken } from "./picture.js";

export class Host {
  constructor(channel, address, highlight) {
    this.channel = channel;
    this.highlight = highlight;
    this.address = address;
    this.afterState = []; // what waits for the next state
    this.params = {};
    this.told = new Map(); // what was last said of each challenge
    this.entered = ""; // the control that the page around typed into last
  }

  post(message) {
    this.postRaw({ slug: sim.slug, ...message });
  }

  postRaw(message) {
    if (embedded) window.parent.postMessage(message, "*");
  }

  state({ version, params, query, solution, challenges }) {
    this.params = params;
    this.post({ type: "sim3:state", params, query, ...(solution === undefined ? {} : { solution }) });
    this.near(challenges ?? {});
    if (this.picturing && solution !== undefined) this.takePicture({ version, query });
    this.afterState.splice(0).forEach((then) => then());
  }

  // Somebody moved something here; a page around that leads them lets go.
  touched() {
    this.entered = "";
    this.post({ type: "sim3:touched" });
  }

  // Of each challenge how near the state is, when that has changed.
  near(challenges) {
    for (const [id, found] of Object.entries(challenges)) {
      const words = JSON.stringify(found);
      if (this.told.get(id) !== words) this.post({ type: "sim3:challenge", id, ...found });
      this.told.set(id, words);
    }
  }

  get(solution) {
    this.told.clear(); // who asks may have heard of nothing yet
    this.channel.send({ type: "get", ...(solution ? { solution: true } : {}) });
  }

  listen(view, height) {
    addEventListener("message", ({ source, data }) => {
      if (source !== window.parent || !embedded || typeof data !== "object" || data === null) return;
      const { type, name, solution, picture } = data;
      if (type === "sim3:set") this.set(data, view);
      else if (type === "sim3:action") this.channel.send({ type: "action", name });
      else if (type === "sim3:enter") this.enter(String(name ?? ""), String(data.text ?? ""));
      else if (type === "sim3:get" && picture) this.getPicture();
      else if (type === "sim3:get") this.get(solution);
      else if (type === "sim3:point") this.highlight.point(String(name ?? ""));
      else height.hear(data);
    });
  }

  // What was typed beside the sim means what it means in its own box.
  enter(name, text) {
    this.channel.send({ type: "enter", name, text });
    this.entered = name;
  }

  // A picture of the scene as soon as it shows the newest state.
  getPicture() {
    this.picturing = true;
    this.channel.send({ type: "get", solution: true });
  }

  async takePicture({ version, query }) {
    this.picturing = false;
    this.post({ type: "sim3:picture", query, picture: await taken(version) });
  }

  set({ params, seconds, theme, controls, view: wanted }, view) {
    const page = theme !== undefined || controls !== undefined || wanted !== undefined;
    if (params !== undefined || !page) {
      this.channel.send({ type: "set", params, ...(seconds === undefined ? {} : { seconds }) });
      if (seconds > 0) this.highlight.briefly(differing(this.params, params), seconds);
    }
    if (!page) return;
    if (isView(wanted)) view.go(wanted);
    else if (wanted !== undefined) this.refuse("view", wanted, "six numbers: viewpoint x, y, z and look-at x, y, z");
    this.setPage(theme, controls);
  }

  // The theme and the controls are the server's work too: the page begins anew with them, in its room, once the server
  // has what else was set.
  setPage(theme, controls) {
    const wanted = {};
    if (theme === "light" || theme === "dark") wanted.theme = theme;
    else if (theme !== undefined) this.refuse("theme", theme, "light or dark");
    if (typeof controls === "boolean") wanted.controls = controls ? "1" : "0";
    else if (controls !== undefined) this.refuse("controls", controls, "true or false");
    const { options } = this.address;
    const now = { theme: sim.dark ? "dark" : "light", controls: options.get("controls") ?? "1" };
    const anew = Object.entries(wanted).filter(([name, value]) => value !== now[name]);
    for (const [name, value] of anew) options.set(name, value);
    this.address.show();
    if (!anew.length) return;
    this.afterState.push(() => location.reload());
    this.channel.send({ type: "get" });
  }

  refuse(parameter, received, allowed) {
    const errors = [{ parameter, received: JSON.stringify(received) ?? "nothing", allowed }];
    this.post({ type: "sim3:error", message: `${parameter}: got ${errors[0].received}, allowed: ${allowed}`, errors });
  }
}

function differing(now, wanted) {
  return Object.keys(wanted ?? {}).find((name) => JSON.stringify(now[name]) !== JSON.stringify(wanted[name])) ?? "";
}

function isView(view) {
  return Array.isArray(view) && view.length === 6 && view.every((v) => typeof v === "number" && Math.abs(v) < 1e4)
    && view.slice(0, 3).some((v, i) => v !== view[i + 3]);
}
