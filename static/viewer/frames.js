// When viser's client draws the scene, and how finely.
import { sim } from "./page.js";

const SETTLED = 300; // milliseconds after a change when the scene is drawn once more, for what came late
const LOADING = 1500; // milliseconds for which a new scene is drawn as viser does it: textures and letters still come
const HEARTBEAT = 1000; // milliseconds after which viser's client draws whatever happened
const COARSER = 0.75; // of the resolution, where a machine needs more than SLOW milliseconds for half of its frames
const FINER = 1.5; // times the resolution, for smooth edges where nothing else makes them so
const FINEST = 2; // pixels of the screen for one of the page: viser's client takes no more
const SLOW = 40;
const QUICK = 20; // milliseconds with which it gets the whole one back; a coarser frame has half the pixels
const SAMPLES = 8; // changes between two such decisions
const NO_GPU = /swiftshader|llvmpipe|softpipe|basic render/i;
let slow = false;
let beat = (draw) => draw(); // what becomes of viser's frame each second

// What draws WebGL says so itself; Chromium and Safari only where they are asked by the longer name.
export function noticeRenderer(context) {
  const name = context.getParameter(context.RENDERER);
  const longer = name === "WebKit WebGL" && context.getExtension("WEBGL_debug_renderer_info");
  slow = NO_GPU.test(longer ? context.getParameter(longer.UNMASKED_RENDERER_WEBGL) : name);
}

// Where the processor draws, smooth edges take two fifths of a frame: they are left to the frame that stays.
export function withoutGPU() {
  return slow;
}

// Pixels of the screen for one of the page: fewer where the page is zoomed out.
export function wholeResolution() {
  return Math.min(devicePixelRatio, FINEST);
}

// viser draws each second for what it may have missed: without a GPU that takes a tenth of a processor for as long as a page
// is open, and holds up the hand that comes then. Called before its client starts.
export function tameHeartbeat() {
  const repeat = window.setInterval;
  window.setInterval = (call, wait, ...given) =>
    repeat(wait === HEARTBEAT ? () => beat(() => call(...given)) : call, wait, ...given);
}

// viser draws for a quarter of a second after each change, which takes most of a machine without a GPU. One frame shows a
// change (React asks for another by itself where it has something to add), and one more, when nothing has changed for a
// while, what comes late, as finely as can be. A second later one of its frames each second is let through.
export function drawLess(mutable) {
  const whole = mutable.requestRender;
  const sharpness = new Sharpness(mutable.scene.__r3f.root);
  let late = 0;
  let changed = 0;
  let missed = true;
  const frame = () => {
    const { internal, invalidate } = mutable.scene.__r3f.root.getState();
    if (!internal.frames) invalidate(); // one that is still to be drawn shows this change too
  };
  const rest = () => {
    sharpness.moving(false);
    frame();
  };
  const loading = () => !sim.liveAt || performance.now() < sim.liveAt + LOADING;
  beat = (call) => {
    const { internal } = mutable.scene.__r3f.root.getState();
    const { frames } = internal;
    call();
    if (loading()) return;
    if (missed && performance.now() > changed + HEARTBEAT) missed = false;
    else internal.frames = frames;
  };
  const draw = () => {
    changed = performance.now();
    missed = true;
    clearTimeout(late);
    late = setTimeout(rest, sim.liveAt ? SETTLED : LOADING);
    sharpness.moving(true);
    if (loading()) {
      whole();
      return;
    }
    // viser takes what came while it draws, and React adds most of it after that frame: each change would be drawn twice,
    // first without what it is about. Taken now, all of it is in the next frame.
    mutable.drainMessageQueue?.();
    frame();
    requestAnimationFrame((first) => requestAnimationFrame((second) => sharpness.took(second - first)));
  };
  Object.defineProperty(mutable, "requestRender", { configurable: true, get: () => draw, set: () => {} });
}

// viser's client lowers its resolution when few frames come, as they do here whenever little changes; and each change of
// it holds up a frame. It keeps one instead while things move, coarser only where two frames that follow each other take
// long, and has the whole one at rest. The resolution follows a page that is zoomed.
class Sharpness {
  constructor(root) {
    this.root = root;
    this.share = 1;
    this.still = false;
    this.times = [];
    root.subscribe((state) => this.keep(state));
  }

  keep({ viewport, setDpr }) {
    const whole = wholeResolution();
    const wanted = this.still ? Math.min(whole * (slow ? FINER : 1), FINEST) : whole * this.share;
    if (viewport.dpr !== wanted) setDpr(wanted);
  }

  moving(so) {
    this.still = !so;
    this.keep(this.root.getState());
  }

  // How long a change took, in milliseconds.
  took(time) {
    this.times.push(time);
    if (this.times.length < SAMPLES) return;
    const middle = this.times.sort((a, b) => a - b)[SAMPLES / 2];
    this.times = [];
    this.share = middle > SLOW ? COARSER : middle < QUICK ? 1 : this.share;
    this.keep(this.root.getState());
  }
}
