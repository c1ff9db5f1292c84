// The live room: who steers it and who watches, whose view is seen, and a copy of one's own.
import { dialog } from "./dialog.js";
import { copied } from "./giving.js";
import { lock } from "./lock.js";
import { element, scene, sim } from "./page.js";

const KEPT = ["theme", "controls", "only"]; // of the page's options, on the way back into the room
const PRESENT = `
  <p>Whoever opens this link sees what you do, live and from where you look. They change nothing.</p>
  <p class="s3-give"><input class="s3-link" data-link="watch" readonly aria-label="Link to watch"> <button type="button" data-copies="watch">Copy</button></p>
  <p class="s3-code"><img alt="QR code of the link to watch" width="160" height="160"></p>
  <p data-count></p>
  <h3>Hand over</h3>
  <p data-with="off">Let somebody else steer this sim. You still can, and you take it back when you like.</p>
  <p data-with="off"><button type="button" data-lend="on">Make a link to steer</button></p>
  <p data-with="on">Whoever opens this link steers this sim until you take it back. You still can, too.</p>
  <p class="s3-give" data-with="on"><input class="s3-link" data-link="steer" readonly aria-label="Link to steer"> <button type="button" data-copies="steer">Copy</button></p>
  <p data-with="on"><button type="button" data-lend="off">Take it back</button></p>
  <p role="status"></p>`;

export class Live {
  constructor(channel, address, view) {
    this.channel = channel;
    this.address = address;
    this.view = view;
    this.alone = false; // whether this page goes its own way
    this.part = { steers: sim.keyed, follows: false, led: false, watchers: 0, ticket: "", helpers: 0 };
    this.bar = element("section", { class: "s3-live", "aria-label": "Live room", tabindex: "-1" }, scene);
    this.words = element("p", { role: "status" }, this.bar);
    this.count = element("p", {}, this.bar);
    this.buttons = {
      follow: this.button("Follow the view", () => this.follow(true)),
      take: this.button("Take it back", () => this.lend(false)),
      copy: this.button("Make my own copy", () => location.assign(`${address.link("embed")}#room=${roomOf(sim.path)}`)),
      back: this.button("Back to the live room", () => this.goBack()),
    };
    view.freed = () => this.follow(false);
    document.querySelector("[data-s3=present]").hidden = !sim.keyed;
    addEventListener("hashchange", () => location.reload()); // another link to the same room
    this.show();
  }

  button(label, does) {
    const button = element("button", { type: "button" }, this.bar);
    button.textContent = label;
    button.addEventListener("click", does);
    return button;
  }

  // What the server says of this page's part.
  hear(part) {
    this.part = { ...this.part, ...part };
    sim.watching = !part.steers;
    if (sim.keyed) this.address.ticket = part.ticket;
    this.address.show();
    this.view.led = part.follows;
    this.alone &&= !part.follows;
    lock();
    this.show();
    this.fill();
  }

  follow(on) {
    this.alone = !on;
    this.view.led = on;
    this.channel.send({ type: "follow", on });
  }

  lend(on) {
    this.channel.send({ type: "lend", on });
  }

  goBack() {
    const options = KEPT.filter((name) => this.address.options.has(name)).map((name) => `${name}=${this.address.options.get(name)}`);
    location.assign(`${this.address.watched(this.address.left)}${options.length ? "?" : ""}${options.join("&")}`);
  }

  // ---- the bar in the scene

  show() {
    const { steers, follows, led, ticket, watchers } = this.part;
    write(this.words, this.say());
    write(this.count, steers && (watchers || ticket) ? counted(watchers) : "");
    const wanted = {
      follow: led && !follows && (!sim.keyed || ticket), take: sim.keyed && ticket, copy: !steers, back: sim.keyed && this.left,
    };
    for (const [name, button] of Object.entries(this.buttons)) {
      if (!wanted[name] && button === document.activeElement) this.bar.focus();
      button.hidden = !wanted[name];
    }
  }

  get left() {
    return /^[0-9a-f]{20}$/.test(this.address.left);
  }

  say() {
    const { steers, follows, led, ticket, helpers } = this.part;
    if (sim.keyed && ticket) return helpers ? "Somebody else steers too." : "Whoever opens the link that you made steers too.";
    if (sim.keyed) return this.left ? "This is your own copy." : "";
    if (steers) return "You steer this sim, and others see it.";
    if (this.address.ticket) return "Control was taken back. You are watching.";
    if (!led) return "You are watching. Nobody is presenting just now.";
    return follows ? "You are watching, and your view follows." : "You are watching, from your own view.";
  }

  // ---- the dialog

  present() {
    this.box = dialog("Present", PRESENT);
    this.box.addEventListener("click", ({ target }) => {
      if (target.dataset.lend) this.lend(target.dataset.lend === "on");
      if (target.dataset.copies) this.copy(this.box.querySelector(`[data-link=${target.dataset.copies}]`));
    });
    this.box.querySelector(".s3-code img").src = `${this.address.site}/qr?url=${encodeURIComponent(this.address.watched())}`;
    this.fill();
  }

  fill() {
    if (!this.box?.isConnected) return;
    const { ticket, watchers } = this.part;
    const watch = this.address.watched();
    this.box.querySelector("[data-link=watch]").value = watch;
    this.box.querySelector("[data-link=steer]").value = `${watch}#steer=${ticket}`;
    write(this.box.querySelector("[data-count]"), counted(watchers));
    const focused = this.box.contains(document.activeElement) && document.activeElement;
    for (const node of this.box.querySelectorAll("[data-with]")) node.hidden = (node.dataset.with === "on") !== Boolean(ticket);
    if (focused && !focused.checkVisibility()) this.box.querySelector(ticket ? "[data-copies=steer]" : "[data-lend=on]").focus();
  }

  async copy(field) {
    const said = this.box.querySelector("[role=status]");
    const done = await copied(field.value);
    if (!done) field.select();
    said.textContent = done ? "Link copied." : "The link is selected: copy it with Ctrl C.";
  }
}

function roomOf(path) {
  return path.match(/\/s\/([0-9a-f]{20})\//)[1];
}

function counted(watchers) {
  if (!watchers) return "Nobody is watching just now.";
  return watchers === 1 ? "1 person is watching." : `${watchers} people are watching.`;
}

function write(node, words) {
  if (node.textContent !== words) node.textContent = words;
}
