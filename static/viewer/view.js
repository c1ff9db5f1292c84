// From where the scene is looked at: the sim's own view, fitted to the page's size, until somebody chooses another. By
// pointer and finger viser does the turning; buttons and keys are done here.
import { embedded, scene, sim } from "./page.js";
import { sceneCanvas, tellCamera } from "./viser_dom.js";

const REST = 150; // milliseconds without another size
const KEPT = 400; // milliseconds between two addresses: Safari allows a hundred in 30 s
const SEEN = 2500; // milliseconds for which a hint stands there
const STILL = 4; // pixels that a hand moves in a click
const TURNS = /^(Arrow\w+|[wasdqe])$/i; // viser's own keys
const KEYS = { 1: "front", 2: "side", 3: "top", "+": "in", "=": "in", "-": "out", Home: "home" };
const FROM = { front: [0, -1, 0], side: [1, 0, 0], top: [0, -1e-3, 1] };

// A viewpoint is chosen for a landscape scene; in a tall or narrow one, step back so that the same sphere fits.
export function fit() {
  const target = sim.view.slice(3);
  const away = sim.view.slice(0, 3).map((v, i) => v - target[i]);
  const scale = sim.radius ? sim.radius * distance(shape()) / Math.hypot(...away) : 1;
  return [...away.map((v, i) => target[i] + v * scale), ...target];
}

// From how far away a sphere of radius 1 fits into a page of some width over height. The server does the same for the
// views that it finds later (sims/kit/scene/view.py).
export function distance(aspect) {
  return 1 / Math.sin(Math.atan(Math.tan(sim.field / 2) * Math.min(1, aspect)));
}

// Width over height of the scene.
export function shape() {
  return Math.max(scene.clientWidth, 1) / Math.max(scene.clientHeight, 1);
}

export class View {
  constructor(channel, address, resized) {
    this.channel = channel;
    this.address = address;
    this.linked = read(address.options.get("view"));
    this.home = fit();
    this.camera = this.linked ?? this.home;
    this.sizing = this.keeping = this.hinting = 0;
    this.hands = new Set(); // pointers that are down
    this.from = null; // where the last one came down on the scene
    this.led = false; // whether it follows somebody else's
    this.freed = () => {}; // hears that a hand took it from there
    this.waiting = false; // whether the camera goes home when they are up
    addEventListener("pointerdown", (event) => this.hands.add(event.pointerId), true);
    for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, (event) => this.lift(event), true);
    this.hint = scene.querySelector(".s3-hint");
    scene.addEventListener("click", (event) => this.look(event.target.closest?.("[data-look]")?.dataset.look));
    scene.addEventListener("pointerdown", (event) => this.press(event), { capture: true, passive: true });
    scene.addEventListener("keydown", (event) => this.key(event));
    scene.addEventListener("wheel", ({ target }) => target === sceneCanvas() && this.letGo(), { passive: true });
    addEventListener("pointermove", (event) => this.pull(event));
    if (embedded) this.share();
    addEventListener("resize", () => {
      clearTimeout(this.sizing);
      this.sizing = setTimeout(() => {
        if (!innerWidth || !innerHeight) return; // hidden again
        resized();
        this.refit();
      }, REST);
    });
  }

  // The first one: that of the link, or the one that fits.
  get first() {
    return this.linked ?? this.home;
  }

  // ---- the page around it scrolls past a frame until somebody means the scene

  share() {
    scene.dataset.shared = "";
    scene.addEventListener("wheel", (event) => {
      if (!("shared" in scene.dataset) || event.ctrlKey || !event.target.matches("canvas")) return;
      event.stopPropagation();
      this.say("Click the scene, or hold Ctrl, to zoom with the wheel");
    }, { capture: true, passive: true });
    scene.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && (scene.dataset.shared = ""));
    document.addEventListener("pointerdown", (event) => scene.contains(event.target) || (scene.dataset.shared = ""));
    scene.addEventListener("pointercancel", () => this.say("Tap the scene to turn it; two fingers zoom"));
    this.passBy();
  }

  // One finger on its way past the frame turns nothing before the browser takes it for scrolling; two mean the scene.
  passBy() {
    addEventListener("pointermove", (event) => {
      const one = event.pointerType === "touch" && this.hands.size === 1;
      if (one && "shared" in scene.dataset && scene.contains(event.target)) event.stopPropagation();
    }, true);
  }

  lift({ pointerId }) {
    this.hands.delete(pointerId);
    this.follow();
  }

  say(words) {
    this.hint.textContent = words;
    this.hint.hidden = false;
    clearTimeout(this.hinting);
    this.hinting = setTimeout(() => (this.hint.hidden = true), SEEN);
  }

  press(event) {
    const inside = event.target.matches?.("canvas");
    this.from = inside ? [event.clientX, event.clientY] : null;
    if (!inside) return;
    tellCamera();
    if (event.pointerType !== "touch") delete scene.dataset.shared;
    else addEventListener("pointerup", () => delete scene.dataset.shared, { once: true });
    sceneCanvas()?.focus({ preventScroll: true, focusVisible: false });
  }

  // A hand that moves the scene leads its view; a mere click doesn't.
  pull({ pointerId, clientX, clientY }) {
    if (this.led && this.hands.has(pointerId) && this.from && Math.hypot(clientX - this.from[0], clientY - this.from[1]) > STILL) this.letGo();
  }

  letGo() {
    if (!this.led) return;
    this.led = false;
    this.freed();
  }

  key(event) {
    if (event.target !== sceneCanvas() || event.ctrlKey || event.metaKey || event.altKey) return;
    if (TURNS.test(event.key)) this.letGo();
    if (!KEYS[event.key]) return;
    event.preventDefault();
    this.look(KEYS[event.key]);
  }

  // ---- where from

  look(how) {
    if (!how) return;
    this.letGo();
    if (how === "home") {
      this.goHome();
      return;
    }
    const target = this.camera.slice(3);
    const away = this.camera.slice(0, 3).map((v, i) => v - target[i]);
    const far = Math.hypot(...away);
    const to = FROM[how]?.map((v) => v * far) ?? away.map((v) => v * (how === "in" ? 1 / 1.25 : 1.25));
    this.go([...to.map((v, i) => target[i] + v), ...target]);
  }

  go(view) {
    this.camera = view;
    this.channel.send({ type: "view", view });
    this.keep();
  }

  goHome() {
    this.home = fit();
    this.go(this.home);
  }

  // Back to where the link that was opened looked from.
  reset() {
    this.letGo();
    if (this.linked) this.go(this.linked);
    else this.goHome();
  }

  // viser's camera has moved, by hand or because it was told to.
  looked(view) {
    this.camera = view;
    this.keep();
  }

  // The scene has another view of its own. Where its camera isn't there yet, it goes when no hand holds anything, and
  // stays where somebody chose a view.
  found({ view, radius, moved }) {
    this.waiting = !moved && (this.waiting || this.athome);
    sim.view = view;
    sim.radius = radius;
    this.home = fit();
    if (moved) this.camera = this.home;
    this.follow();
    this.keep();
  }

  follow() {
    if (!this.waiting || this.hands.size) return;
    this.waiting = false;
    if (!this.athome && !this.led) this.goHome();
  }

  get athome() {
    return Math.hypot(...this.camera.map((v, i) => v - this.home[i])) < (0.01 * sim.radius || 1e-3);
  }

  keep() {
    this.keeping ||= setTimeout(() => {
      this.keeping = 0;
      if (this.athome) this.address.options.delete("view");
      else this.address.options.set("view", this.camera.map((v) => Number(v.toFixed(3))).join(","));
      this.address.show();
    }, KEPT);
  }

  refit() {
    const before = this.home;
    const chosen = !this.athome;
    this.home = fit();
    if (this.led || chosen || Math.hypot(...this.home.map((v, i) => v - before[i])) < 0.02 * sim.radius) return;
    this.go(this.home);
  }

  // In words, from which side the scene is seen.
  get words() {
    const [x, y, z] = this.camera.slice(0, 3).map((v, i) => v - this.camera[i + 3]);
    const far = Math.hypot(x, y, z);
    const sides = [[-y, "in front", "behind"], [x, "the right", "the left"], [z, "above", "below"]];
    const said = sides.filter(([v]) => Math.abs(v) > 0.2 * far).map(([v, plus, minus]) => (v > 0 ? plus : minus));
    return `Seen from ${said.join(", ")}.`;
  }
}

function read(text) {
  return text?.replaceAll("−", "-").split(",").map(Number) ?? null;
}

// The scene can have the focus; people who don't see it hear what is there.
export function describeScene(words) {
  const canvas = sceneCanvas();
  if (!canvas) return;
  for (const old of scene.querySelectorAll("canvas[role]")) {
    if (old === canvas) continue;
    for (const name of ["role", "aria-label", "tabindex"]) old.removeAttribute(name);
  }
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-roledescription", "3D scene");
  canvas.setAttribute("aria-label", words);
}
