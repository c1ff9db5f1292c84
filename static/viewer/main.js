// The page of a sim: makes its parts and tells them of what comes.
import { Address } from "./address.js";
import { Channel } from "./channel.js";
import { Controls } from "./controls.js";
import { Files } from "./files.js";
import { Handles } from "./handles.js";
import { Height } from "./height.js";
import { Highlight } from "./highlight.js";
import { Host } from "./host.js";
import { Lead } from "./lead.js";
import { Live } from "./live.js";
import { Pace } from "./pace.js";
import { sim } from "./page.js";
import { Parts } from "./parts.js";
import { Paste } from "./paste.js";
import { Pointer } from "./pointer.js";
import { Strip } from "./strip.js";
import { Toolbar } from "./toolbar.js";
import { Trouble } from "./trouble.js";
import { View } from "./view.js";
import { drawnVersion, prepare, start } from "./viser_dom.js";
import { Words } from "./words.js";
import { Work } from "./work.js";

const LOOKING = 30; // milliseconds between two looks at whether the scene is there

class Page {
  constructor() {
    this.address = new Address();
    this.channel = new Channel(
      () => this.greeting(), (message) => this.take(message), (...why) => this.lost(...why), (message) => this.change(message),
    );
    this.words = new Words();
    this.trouble = new Trouble(() => this.channel.wake());
    this.work = new Work(() => this.channel.send({ type: "cancel" }));
    this.pace = new Pace(this.channel);
    this.highlight = new Highlight(this.channel);
    this.controls = new Controls(this.channel, this.pace);
    this.handles = new Handles(this.pace, this.highlight);
    this.parts = new Parts(this.pace, this.controls, this.handles, this.highlight, () => this.change({}));
    this.pointer = new Pointer(this.channel);
    this.files = new Files(this.words);
    this.host = new Host(this.channel, this.address, this.highlight);
    this.height = new Height(this.host);
    this.view = new View(this.channel, this.address, () => this.resized());
    this.lead = new Lead(this.view);
    this.paste = new Paste(this.words);
    this.live = new Live(this.channel, this.address, this.view);
    this.toolbar = new Toolbar(this.address, this.words, this.files, this.view, this.paste, this.live);
    this.strip = new Strip(this.channel, this.view, this.address);
    this.state = null;
    this.sceneless = false;
    this.does = {
      state: (message) => this.takeState(message),
      show: (message) => this.takeParts(message),
      home: (message) => this.view.found(message),
      room: (message) => this.live.hear(message),
      led: (message) => this.lead.hear(message),
      point: ({ name }) => this.highlight.others(name),
      over: () => this.pointer.pace.answered(),
      error: (message) => this.fail(message),
      work: (message) => this.work.show(message),
    };
  }

  begin() {
    this.highlight.listen(() => this.handles.held !== null);
    this.host.listen(this.view, this.height);
    this.trouble.lost();
    this.address.show();
    this.channel.open();
    prepare(this.view.first, (view) => this.looked(view), () => this.goBlind());
    start();
    this.looking = setInterval(() => this.goLive(), LOOKING);
  }

  greeting() {
    const { query, opened, ticket } = this.address;
    return { query, opened, ticket, follows: !this.live.alone };
  }

  lost(code, reason) {
    this.trouble.lost(code, reason);
    this.pace.answered();
    this.pointer.pace.answered();
    this.work.show({ text: "" });
  }

  take(message) {
    this.does[message.type](message);
  }

  takeState(message) {
    this.trouble.found();
    this.state = message;
    // What is asked for with its solution comes more often than an address may change; what comes by itself follows.
    if (message.solution === undefined) {
      this.address.query = message.query;
      this.address.show();
    }
    this.strip.show(message);
    this.words.speak(message.text, this.view.words);
    this.host.state(message);
  }

  takeParts(message) {
    this.parts.show(message);
    this.host.post({ type: "sim3:drawn" });
    this.height.tellSoon();
  }

  fail({ message, errors, control }) {
    const elsewhere = control && control === this.host.entered; // beside what was typed, in the page around
    if (!elsewhere && (!control || !this.controls.refuse(control, message))) this.words.notify("⚠ " + message);
    this.host.post({ type: "sim3:error", message, errors, ...(control ? { control } : {}) });
  }

  // Somebody goes on, or the page around does: what was refused before is past.
  change({ type, name }) {
    if (type !== "set") this.host.touched();
    this.controls.forgive(name);
    this.words.dismiss();
  }

  goBlind() {
    if (this.sceneless) return;
    this.sceneless = true;
    this.trouble.blind();
  }

  // The still picture stays until the scene is live.
  goLive() {
    if (!this.state || this.parts.version < 0 || (!this.sceneless && drawnVersion() === undefined)) return;
    clearInterval(this.looking);
    sim.live = true;
    sim.liveAt = performance.now();
    this.address.show();
    // The scene is on the screen with the frame after next.
    requestAnimationFrame(() => requestAnimationFrame(() => document.querySelector(".s3-still").remove()));
    this.words.describe(this.state.text, this.view.words);
    this.host.post({ type: "sim3:ready" });
    this.height.begin();
    this.lead.again();
  }

  resized() {
    this.height.tellSoon();
    this.lead.again();
  }

  // On its way the view of who is led is no news for the server, unless a hand may drag something in it.
  looked(view) {
    this.view.looked(view);
    return this.lead.gliding && !this.view.hands.size;
  }
}

new Page().begin();
