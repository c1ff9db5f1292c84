// All that knows viser's client from inside, with frames.js: what it is told where it looks for it, and what it lets pages
// see. Tests compare what stands here with the client of the installed version.
import { drawLess, noticeRenderer, tameHeartbeat, wholeResolution, withoutGPU } from "./frames.js";
import { Query, scene, sim } from "./page.js";

const LABEL_INK = "vec4(0.0, 0.0, 0.0, a)";
const LABEL_PLATE = "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)";
const MAP = "data:image/jpeg"; // how its address begins
const TAKEN = 3000; // milliseconds in which a scene that was taken away may come back
let viewer = null; // viser's own state, once it is there
let eye = null; // what viser's camera last said of itself
let untold = null; // the same where the server wasn't told of it
let send = null; // tells the server something, as viser's client does

// viser reads from the address which websocket is this page's, whether the theme is dark, and from where to look. The
// address itself holds the state from the first moment on, so viser is given another query where it reads it.
// `looked` hears of each view from which the scene is seen, and says whether the server needn't; `blind` hears that the
// browser draws no 3D, or no more.
export function prepare(view, looked, blind) {
  const search = new Query({
    websocket: `${sim.socket}?viewer=${sim.viewer}`,
    initialCameraPosition: view.slice(0, 3).join(","),
    initialCameraLookAt: view.slice(3).join(","),
    initialCameraFov: `${sim.field}`,
    fixedDpr: `${wholeResolution()}`,
    ...(sim.dark ? { darkMode: "1" } : {}),
  });
  window.URLSearchParams = class extends Query {
    constructor(init) {
      super(init === location.search ? search : init);
    }
  };
  if (sim.dark && window.WebGL2RenderingContext) darkenLabels();
  if (self.origin === "null") avoidModuleWorkers();
  const replace = history.replaceState.bind(history);
  history.replaceState = (data, title, url) => title === "Viser" || replace(data, title, url);
  // viser asks the document for focus before it reconnects; a frame that nobody clicked yet must reconnect too.
  document.hasFocus = () => document.visibilityState === "visible" && !sim.resting;
  noticeWebGL(blind);
  leaveMap();
  tameHeartbeat();
  keepKeys();
  freeFingers();
  adopt(looked);
}

// A page without a server holds the client as viser ships it: a script with its code as data beside it.
export function start() {
  const script = document.createElement("script");
  const held = document.getElementById("client");
  if (held) {
    Object.assign(script.dataset, held.dataset);
    script.textContent = held.textContent;
  } else {
    Object.assign(script, { src: sim.client, crossOrigin: "anonymous" });
  }
  document.body.append(script);
}

// Messages as a server would send them.
export function show(messages) {
  viewer.messageQueue.push(...messages);
  viewer.requestRender();
}

// Whether there is WebGL is seen when viser asks for it: to ask beforehand takes up to 0.4 s without a GPU. It asks first
// on a canvas of no use, which says what will draw.
function noticeWebGL(blind) {
  const { prototype } = HTMLCanvasElement;
  const ask = prototype.getContext;
  prototype.getContext = function (kind, ...options) {
    if (kind !== "webgl2") return ask.call(this, kind, ...options);
    const context = ask.call(this, kind, { ...options[0], ...(withoutGPU() ? { antialias: false } : {}) });
    if (context) noticeRenderer(context);
    else blind();
    return context;
  };
  // A machine that slept can give back what draws, but empty: viser's client then misses half of the scene.
  scene.addEventListener("webglcontextrestored", () => location.reload(), true);
  scene.addEventListener("webglcontextlost", ({ target }) => setTimeout(() => target.isConnected && blind(), TAKEN), true);
}

// The photograph that viser lights scenes by, where a server sends none, lies in its client. It would be made ready
// before the server has said that no scene here is lit by it, which takes a tenth of an opening without a GPU.
function leaveMap() {
  const ask = window.fetch;
  window.fetch = (what, ...options) =>
    (what.url ?? `${what}`).startsWith(MAP) ? new Promise(() => {}) : ask(what, ...options);
}

// viser's client turns the view by keys wherever the focus is; here only while the scene has it.
function keepKeys() {
  const listen = document.addEventListener.bind(document);
  document.addEventListener = (kind, take, options) =>
    listen(kind, kind === "keydown" && !options ? (event) => document.activeElement === sceneCanvas() && take(event) : take, options);
}

// A browser lets the canvas capture each finger by itself. viser then takes the tap for the drag of a handle, and drops it.
function freeFingers() {
  scene.addEventListener("pointerdown", ({ target, pointerId, pointerType }) => {
    if (pointerType === "touch" && target.hasPointerCapture(pointerId)) target.releasePointerCapture(pointerId);
  }, true);
}

// viser publishes its state for its own tests, when the canvas is there.
function adopt(looked) {
  Object.defineProperty(window, "__viserMutable", {
    configurable: true,
    get: () => viewer,
    set: (mutable) => {
      viewer = mutable;
      drawLess(mutable);
      watchCamera(mutable, looked);
    },
  });
}

// From where the scene is looked at: the viewpoint x, y, z, and the place that it looks at.
export function lookFrom([x, y, z, u, v, w]) {
  if (!viewer) return;
  show([
    { type: "SetCameraPositionMessage", position: [x, y, z], initial: false },
    { type: "SetCameraLookAtMessage", look_at: [u, v, w], initial: false },
  ]);
}

// What viser tells the server of its camera tells us from where the scene is looked at.
function watchCamera(mutable, looked) {
  send = mutable.sendMessage;
  const watched = (message) => {
    if (message.type === "ViewerCameraMessage") {
      eye = message;
      untold = looked([...message.position, ...message.look_at]) ? message : null;
      if (untold) return;
    }
    send(message);
  };
  Object.defineProperty(mutable, "sendMessage", { configurable: true, get: () => watched, set: (other) => { send = other; } });
}

// Before a hand drags something: the server works out by the camera where to.
export function tellCamera() {
  if (untold) send(untold);
  untold = null;
}

// The ray through a place on the page, where the scene is: origin, then direction; null before there is a camera.
export function rayThrough({ clientX, clientY }) {
  const canvas = sceneCanvas();
  if (!eye || !canvas) return null;
  const { left, top, width, height } = canvas.getBoundingClientRect();
  const half = Math.tan(eye.fov / 2) * (2 / height);
  const [x, y] = [(clientX - left - width / 2) * half, (clientY - top - height / 2) * half];
  const [qw, qx, qy, qz] = eye.wxyz; // right, down and forward of the camera in the world
  return [
    ...eye.position,
    (1 - 2 * (qy * qy + qz * qz)) * x + 2 * (qx * qy - qw * qz) * y + 2 * (qx * qz + qw * qy),
    2 * (qx * qy + qw * qz) * x + (1 - 2 * (qx * qx + qz * qz)) * y + 2 * (qy * qz - qw * qx),
    2 * (qx * qz - qw * qy) * x + 2 * (qy * qz + qw * qx) * y + 1 - 2 * (qx * qx + qy * qy),
  ];
}

// Which version of the state the scene shows; undefined before it shows any.
export function drawnVersion() {
  return viewer?.nodePoseData["/version"]?.position[0];
}

// viser writes labels in black on white in any theme. In the dark one their shaders are told its colours.
function darkenLabels() {
  const light = (color) => [1, 3, 5].map((k) => (parseInt(color.slice(k, k + 2), 16) / 255).toFixed(3)).join(", ");
  const { prototype } = WebGL2RenderingContext;
  const take = prototype.shaderSource;
  prototype.shaderSource = function (shader, source) {
    take.call(this, shader, source
      .replace(LABEL_INK, `vec4(${light(sim.label.ink)}, a)`)
      .replace(LABEL_PLATE, `vec4(${light(sim.label.plate)}, 0.75 * vAlpha)`));
  };
}

// In a sandboxed frame Chromium loads no module worker from a blob. viser's client then tries a data address.
function avoidModuleWorkers() {
  const Plain = Worker;
  window.Worker = class extends Plain {
    constructor(url, options) {
      if (options?.type === "module" && String(url).startsWith("blob:")) throw new Error("no module worker from a blob");
      super(url, options);
    }
  };
}

// The canvas that the scene is painted on. viser makes a new one when it connects anew, and leaves the old one for a
// while; to look for it among them by its size would lay the page out at each key and each state.
export function sceneCanvas() {
  return viewer?.canvas ?? null;
}
