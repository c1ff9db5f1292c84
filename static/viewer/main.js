// The companion of viser's client: makes its parts and tells them of what comes.
import { Address } from "./address.js";
import { Channel } from "./channel.js";
import { Files } from "./files.js";
import { Focus } from "./focus.js";
import { Handles } from "./handles.js";
import { Height } from "./height.js";
import { Highlight } from "./highlight.js";
import { Host } from "./host.js";
import { sim } from "./page.js";
import { Toolbar } from "./toolbar.js";
import { Trouble } from "./trouble.js";
import { View, firstView } from "./view.js";
import { dismissSoftwareNotice, isFolder, markSliders, nameControls, prepare, start } from "./viser_dom.js";
import { Words } from "./words.js";
import { Work } from "./work.js";

const address = new Address();
prepare(firstView(address));
start();

class Companion {
  constructor() {
    this.channel = new Channel(() => this.greeting(), (message) => this.take(message), (...why) => this.lost(...why));
    this.words = new Words();
    this.trouble = new Trouble();
    this.work = new Work(() => this.channel.send({ type: "cancel" }));
    this.focus = new Focus();
    this.highlight = new Highlight(this.channel);
    this.handles = new Handles(this.channel, this.highlight, this.focus);
    this.files = new Files(this.words);
    this.toolbar = new Toolbar(address, this.words, this.files);
    this.host = new Host(this.channel, address);
    this.height = new Height(this.host);
    this.view = new View(this.channel, address, () => this.height.tellSoon());
    this.state = null;
    this.tidying = false;
  }

  begin() {
    this.highlight.listen(() => this.handles.held !== null, this.focus);
    this.host.listen(this.view, this.height);
    document.addEventListener("keydown", openFolder, true);
    new MutationObserver(() => this.changed()).observe(document.body, { childList: true, subtree: true });
    this.trouble.lost();
    address.show();
    this.channel.open();
  }

  greeting() {
    return { controls: address.options.get("controls") !== "0", query: address.query, opened: address.opened };
  }

  lost(code, reason) {
    this.trouble.lost(code, reason);
    this.work.show({ text: "" });
  }

  take(message) {
    if (message.type === "state") {
      this.trouble.found();
      this.state = message;
      address.query = message.query;
      address.show();
      this.words.speak(message.text);
      this.goLive();
      this.host.state(message);
    } else if (message.type === "point") {
      this.highlight.others(message.name);
    } else if (message.type === "error") {
      this.words.notify("⚠ " + message.message);
      this.host.post({ type: "sim3:error", message: message.message, errors: message.errors });
    } else if (message.type === "work") {
      this.work.show(message);
    }
  }

  // viser draws its panel anew whenever something in it changes.
  changed() {
    this.height.tellSoon();
    this.focus.keep();
    this.highlight.show();
    this.goLive();
    if (this.tidying) return;
    this.tidying = true;
    requestAnimationFrame(() => {
      this.tidying = false;
      nameControls();
      markSliders();
      this.files.show();
      dismissSoftwareNotice();
    });
  }

  // The still picture stays until the scene is live.
  goLive() {
    if (sim.live || !this.state || !document.querySelector("canvas") || !document.querySelector("[data-s3-drawn]")) return;
    sim.live = true;
    address.show();
    // The controls are there; the scene is on the screen with the frame after next.
    requestAnimationFrame(() => requestAnimationFrame(() => document.querySelector(".s3-still").remove()));
    this.words.describe(this.state.text);
    this.host.post({ type: "sim3:ready" });
    this.height.begin();
  }
}

function openFolder(event) {
  if ((event.key !== "Enter" && event.key !== " ") || !isFolder(event.target)) return;
  event.preventDefault();
  event.target.click();
}

new Companion().begin();
