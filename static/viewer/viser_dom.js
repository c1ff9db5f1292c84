// All that knows viser's client from inside: what it is told where it looks for it, and the markup of its panel. Tests
// compare what stands here with the client of the installed version.
import { Query, element, sim } from "./page.js";

const LABEL_INK = "vec4(0.0, 0.0, 0.0, a)";
const LABEL_PLATE = "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)";
const SOFTWARE = "Software WebGL";
const SCROLLS = ".mantine-ScrollArea-viewport, [data-dock-region]";
const FOLDER = ".mantine-Paper-root > :is(.tabler-icon-chevron-down, .tabler-icon-chevron-up)";
const TRACK = ".mantine-Slider-trackContainer, .mantine-Slider-track";

// viser reads from the address which websocket is this page's, whether the theme is dark, and from where to look. The
// address itself holds the state from the first moment on, so viser is given another query where it reads it.
export function prepare(view) {
  const search = new Query({
    websocket: `${sim.socket}?viewer=${sim.viewer}`,
    initialCameraPosition: view.slice(0, 3).join(","),
    initialCameraLookAt: view.slice(3).join(","),
    initialCameraFov: `${sim.layout.field}`,
    ...(sim.dark ? { darkMode: "1" } : {}),
  });
  window.URLSearchParams = class extends Query {
    constructor(init) {
      super(init === location.search ? search : init);
    }
  };
  if (sim.dark) darkenLabels();
  if (self.origin === "null") avoidModuleWorkers();
  const replace = history.replaceState.bind(history);
  history.replaceState = (data, title, url) => title === "Viser" || replace(data, title, url);
  // viser asks the document for focus before it reconnects; a frame that nobody clicked yet must reconnect too.
  document.hasFocus = () => document.visibilityState === "visible";
  // Else phones widen the page for a menu that stands out at its side for a moment, the menu grows with it, and so on.
  document.querySelector("meta[name=viewport]").content += ", minimum-scale=1";
}

export function start() {
  document.body.append(Object.assign(document.createElement("script"), { src: sim.client, crossOrigin: "anonymous" }));
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

// viser makes a new canvas when it connects anew, and leaves the old one for a while: the scene is what is seen.
export function sceneCanvas() {
  const area = (canvas) => canvas.clientWidth * canvas.clientHeight;
  return [...document.querySelectorAll("canvas")].reduce((best, one) => (best && area(best) >= area(one) ? best : one), null);
}

export function describeScene(words) {
  const canvas = sceneCanvas();
  if (!canvas) return;
  for (const old of document.querySelectorAll("canvas[role]")) {
    if (old === canvas) continue;
    old.removeAttribute("role");
    old.removeAttribute("aria-label");
  }
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", words);
}

export function nameControls() {
  for (const label of document.querySelectorAll("label[for]")) {
    const row = label.closest(".mantine-Flex-root");
    if (!row || row.querySelectorAll("label[for]").length > 1) continue;
    const slider = row.querySelector("[role=slider]");
    const boxes = row.querySelectorAll("input:not([type=hidden])");
    slider?.setAttribute("aria-label", label.textContent);
    boxes.forEach((box, k) => {
      const which = boxes.length > 1 ? `, ${k + 1} of ${boxes.length}` : "";
      box.setAttribute("aria-label", label.textContent + which);
      if (sim.watching) box.disabled = true; // viser leaves the number box of a disabled slider open
    });
  }
  for (const button of document.querySelectorAll("button.mantine-ActionIcon-root:not([aria-label])")) {
    button.setAttribute("aria-label", "Settings of the viewer");
  }
  // viser's folders open to a pointer alone.
  for (const icon of document.querySelectorAll(FOLDER)) {
    const head = icon.parentElement;
    head.tabIndex = 0;
    head.setAttribute("role", "button");
    head.setAttribute("aria-expanded", icon.classList.contains("tabler-icon-chevron-up"));
  }
  document.getElementById("root").setAttribute("role", "main");
}

export function isFolder(node) {
  return Boolean(node.matches?.("[aria-expanded].mantine-Paper-root"));
}

export function markSliders() {
  const data = document.querySelector("[data-s3-regions]");
  if (!data) return;
  for (const [label, spans] of Object.entries(JSON.parse(data.dataset.s3Regions))) {
    for (const node of document.querySelectorAll("label[for]")) {
      const track = node.textContent === label && document.getElementById(node.htmlFor)?.querySelector(TRACK);
      if (track) mark(track, spans);
    }
  }
}

function mark(track, spans) {
  const wanted = spans.map(([from, to]) => `${from},${to}`).join(";");
  if (track.dataset.regions === wanted) return;
  track.dataset.regions = wanted;
  track.querySelectorAll(".s3-region").forEach((old) => old.remove());
  for (const [from, to] of spans) {
    const region = element("span", { class: "s3-region", title: "near gimbal lock" }, track);
    region.style.left = `${100 * from}%`;
    region.style.width = `${100 * (to - from)}%`;
  }
}

// viser's hint about software rendering would stand over the scene on every school machine without a GPU.
export function dismissSoftwareNotice() {
  for (const note of document.querySelectorAll(".mantine-Notification-root")) {
    if (note.textContent.includes(SOFTWARE)) note.querySelector("button")?.click();
  }
}

// How far down the contents of viser's panels would reach, if nothing were scrolled away.
export function contentEnds() {
  return [...document.querySelectorAll(SCROLLS)].map((node) => node.getBoundingClientRect().top + node.scrollHeight);
}
