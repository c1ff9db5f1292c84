// The companion of viser's client. It keeps the address equal to the state, lets pointers and keys move handles in
// image panes, gives viser's controls accessible names, speaks what changed, and talks to the page around the sim.
const sim = window.sim3;
const { Query } = sim; // the browser's own URLSearchParams: boot.js has another for viser
const embedded = window.parent !== window;
const reduced = matchMedia("(prefers-reduced-motion: reduce)");
const options = ["view", "controls", "theme"];
const kept = new Query();
for (const [name, value] of new Query(sim.search)) if (options.includes(name)) kept.append(name, value);
const opened = stateQuery(sim.opened);
let query = stateQuery(sim.search);
let socket = null;
let retryAfter = 250;
let state = null;

// --- Address -----------------------------------------------------------------------------------------------------

function stateQuery(search) {
  const given = new Query(search);
  for (const name of options) given.delete(name);
  return given.toString();
}

function withOptions(search) {
  return [search, readable(kept)].filter(Boolean).join("&");
}

function readable(search) {
  return search.toString().replaceAll("%2C", ",");
}

function withState(path) {
  const search = withOptions(query);
  return path + (search ? "?" + search : "");
}

// What the address must not hold stays beside it: the room, for a reload, and the state that Reset leads back to.
function showAddress() {
  try {
    history.replaceState({ path: sim.path, opened }, "", withState(sim.address));
  } catch { /* some browsers let a sandboxed frame change no more than its query */ }
}

// --- Channel -----------------------------------------------------------------------------------------------------

function connect() {
  socket = new WebSocket(`${sim.socket}channel?viewer=${sim.viewer}`);
  socket.onopen = () => {
    retryAfter = 250;
    send({
      type: "hello", dark: sim.dark, reduced: reduced.matches, width: innerWidth, height: innerHeight,
      controls: kept.get("controls") !== "0", query, opened,
    });
  };
  socket.onmessage = (event) => receive(JSON.parse(event.data));
  socket.onclose = (event) => {
    socket = null;
    lost(event.code === REFUSED ? event.reason : "");
    showWork({ text: "" });
    setTimeout(connect, retryAfter);
    retryAfter = Math.min(retryAfter * 2, 1500); // within the time that the server waits before it draws
  };
}

function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

function receive(message) {
  if (message.type === "state") {
    found();
    state = message;
    query = message.query;
    showAddress();
    speak(message.text);
    describeScene(message.text);
    goLive();
    const { params, solution } = message;
    post({ type: "sim3:state", params, query, ...(solution === undefined ? {} : { solution }) });
    afterState.splice(0).forEach((then) => then());
  } else if (message.type === "point") {
    theirs = message.name;
    light();
  } else if (message.type === "error") {
    notify("⚠ " + message.message);
    post({ type: "sim3:error", message: message.message, errors: message.errors });
  } else if (message.type === "work") {
    showWork(message);
  }
}

// --- No connection: after a while in words, for whoever runs the server --------------------------------------------

const REFUSED = 4403; // the server says what is wrong with what it saw
const PATIENCE = 5000;
let missing = 0;
let why = "";

function lost(reason) {
  why = reason || why;
  if (reason) return showTrouble();
  missing ||= setTimeout(showTrouble, PATIENCE);
}

function found() {
  clearTimeout(missing);
  missing = 0;
  why = "";
  document.querySelector(".s3-trouble")?.remove();
}

function showTrouble() {
  const box = document.querySelector(".s3-trouble") ?? element("section", { class: "s3-trouble", role: "alert" });
  const words = [
    ["h2", state ? "The connection to the server is lost" : "This sim can’t reach its server"],
    ["p", state ? "It tries again by itself, and goes on where you are." : "It tries again by itself. If it stays like this, tell whoever runs the server:"],
    ["p", why || (state ? "" : `The page came, but the websocket to ${new URL(sim.place).host} doesn’t open. A proxy on the way must let websockets through (Upgrade and Connection), and hand on the Host that the browser asked for.`)],
  ];
  if (box.textContent === words.map(([, text]) => text).join("")) return;
  box.replaceChildren();
  for (const [tag, text] of words) if (text) element(tag, {}, box).textContent = text;
}

// viser asks the document for focus before it reconnects; a frame that nobody clicked yet must reconnect too.
document.hasFocus = () => document.visibilityState === "visible";

// --- Words -------------------------------------------------------------------------------------------------------

function element(tag, attributes, parent = document.body) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  parent.append(node);
  return node;
}

element("h1", {}, element("header", { class: "s3-hidden" })).textContent = sim.title;
const live = element("div", { "aria-live": "polite", role: "status", class: "s3-hidden" });
const notice = element("div", { role: "alert", class: "s3-notice", hidden: "" });
let speaking = 0;
let hiding = 0;

function speak(text) {
  clearTimeout(speaking);
  speaking = setTimeout(() => (live.textContent = text), 700);
}

function notify(text) {
  notice.textContent = text;
  notice.hidden = false;
  clearTimeout(hiding);
  hiding = setTimeout(() => (notice.hidden = true), 6000);
}

// What takes the server long: in words, how much of it is done, and a way back to what is shown.
const work = element("div", { class: "s3-work", role: "group", "aria-label": "Work in progress", hidden: "" });
const workWords = element("span", { role: "status" }, work);
const workBar = element("progress", { max: "1", "aria-label": "Progress" }, work);
const workCancel = element("button", { type: "button" }, work);
workCancel.textContent = "Cancel";
workCancel.addEventListener("click", () => send({ type: "cancel" }));

function showWork({ text, done, cancel }) {
  work.hidden = !text;
  if (workWords.textContent !== text) workWords.textContent = text;
  if (typeof done === "number") workBar.value = done;
  else workBar.removeAttribute("value");
  workCancel.hidden = !cancel || sim.watching;
}

// viser makes a new canvas when it connects anew, and leaves the old one for a while: the scene is what is seen.
function sceneCanvas() {
  const area = (canvas) => canvas.clientWidth * canvas.clientHeight;
  return [...document.querySelectorAll("canvas")].reduce((best, one) => (best && area(best) >= area(one) ? best : one), null);
}

function describeScene(text) {
  const canvas = sceneCanvas();
  if (!canvas) return;
  for (const old of document.querySelectorAll("canvas[role]")) {
    if (old !== canvas) old.removeAttribute("role"), old.removeAttribute("aria-label");
  }
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${sim.title}, 3D scene. ${text}`);
}

// --- Image panes: viser replaces their markup at each update, so everything listens at the document ----------------

let held = null;
let sentAt = 0;
let waiting = 0;

function place(event, svg) {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  return { x: point.x, y: point.y };
}

function within(value, low, high) {
  return Math.min(Math.max(value, low), high);
}

function moveTo(name, at, svgName) {
  const box = document.querySelector(`svg[data-pane="${svgName}"]`).viewBox.baseVal;
  const x = Math.round(within(at.x, 0, box.width - 1) * 100) / 100;
  const y = Math.round(within(at.y, 0, box.height - 1) * 100) / 100;
  held = { ...held, name, svgName, x, y };
  const due = sentAt + 40 - performance.now();
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    sentAt = performance.now();
    send({ type: "handle", name, x, y });
  }, Math.max(due, 0));
}

document.addEventListener("pointerdown", (event) => {
  const grip = event.target.closest?.("[data-handle]");
  if (!grip || sim.watching || event.button !== 0) return;
  event.preventDefault();
  event.stopPropagation();
  const svg = grip.closest("svg");
  const start = place(event, svg);
  grip.focus({ preventScroll: true });
  document.documentElement.setPointerCapture(event.pointerId);
  held = {
    pointer: event.pointerId, dx: Number(grip.dataset.x) - start.x, dy: Number(grip.dataset.y) - start.y,
    name: grip.dataset.handle, svgName: svg.dataset.pane, link: grip.dataset.link,
  };
  document.documentElement.classList.add("s3-holding");
}, true);

// A click anywhere in a picture that says so, or Enter on it, puts its handle there; the handle then takes the focus.
// A click on a point means the very pixel of that point.
function pick(ground, at) {
  if (sim.watching) return;
  focused = gripNamed(ground.dataset.pick);
  moveTo(ground.dataset.pick, at, ground.closest("svg").dataset.pane);
  held = null;
}

document.addEventListener("click", (event) => {
  const svg = event.target.closest?.("svg[data-pane]");
  const ground = svg?.querySelector("[data-pick]");
  if (!ground || event.target.closest("[data-handle]")) return;
  const spot = event.target.closest(".s3-point:has(.s3-reach)")?.transform.baseVal[0].matrix;
  pick(ground, spot ? { x: spot.e, y: spot.f } : place(event, svg));
});

document.addEventListener("pointermove", (event) => {
  if (held?.pointer !== event.pointerId) return;
  event.preventDefault();
  const svg = document.querySelector(`svg[data-pane="${held.svgName}"]`);
  if (!svg) return;
  const at = place(event, svg);
  moveTo(held.name, { x: at.x + held.dx, y: at.y + held.dy }, held.svgName);
}, true);

for (const kind of ["pointerup", "pointercancel"]) {
  document.addEventListener(kind, (event) => {
    if (held?.pointer !== event.pointerId) return;
    if (kind === "pointerup" && held.link && held.x === undefined) select(held.link);
    held = null;
    document.documentElement.classList.remove("s3-holding");
  }, true);
}

// Fingers that hold a handle must not scroll the panel.
document.addEventListener("touchmove", (event) => held && event.preventDefault(), { passive: false, capture: true });

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

document.addEventListener("keydown", (event) => {
  const grip = event.target.closest?.("[data-handle]");
  if (grip && arrows[event.key] && !sim.watching) {
    event.preventDefault();
    const [dx, dy] = arrows[event.key];
    const step = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
    const name = grip.dataset.handle;
    const last = keyed?.name === name && performance.now() - keyed.at < 400 ? keyed : null;
    const x = (last ? last.x : Number(grip.dataset.x)) + dx * step;
    const y = (last ? last.y : Number(grip.dataset.y)) + dy * step;
    moveTo(name, { x, y }, grip.closest("svg").dataset.pane);
    keyed = { name, x: held.x, y: held.y, at: performance.now() };
    held = null;
  } else if ((event.key === "Enter" || event.key === " ") && event.target.matches?.("[aria-expanded].mantine-Paper-root")) {
    event.preventDefault();
    event.target.click();
  } else if (event.target.matches?.("[data-pick]") && ["Enter", " "].includes(event.key)) {
    event.preventDefault();
    const { width, height } = event.target.closest("svg").viewBox.baseVal;
    pick(event.target, { x: (width - 1) / 2, y: (height - 1) / 2 });
  } else if (event.key === "?" && !/^(INPUT|TEXTAREA)$/.test(event.target.tagName)) {
    showKeys();
  }
}, true);

let keyed = null;

// --- viser's page: names for its controls, marks on its sliders, focus kept when a pane is redrawn -----------------

function nameControls(root) {
  for (const label of root.querySelectorAll("label[for]")) {
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
  for (const button of root.querySelectorAll("button.mantine-ActionIcon-root:not([aria-label])")) {
    button.setAttribute("aria-label", "Settings of the viewer");
  }
  // viser's folders open to a pointer alone.
  for (const icon of root.querySelectorAll(".mantine-Paper-root > :is(.tabler-icon-chevron-down, .tabler-icon-chevron-up)")) {
    const head = icon.parentElement;
    head.tabIndex = 0;
    head.setAttribute("role", "button");
    head.setAttribute("aria-expanded", icon.classList.contains("tabler-icon-chevron-up"));
  }
  document.getElementById("root").setAttribute("role", "main");
}

function markSliders() {
  const data = document.querySelector("[data-s3-regions]");
  if (!data) return;
  for (const [label, spans] of Object.entries(JSON.parse(data.dataset.s3Regions))) {
    for (const node of document.querySelectorAll("label[for]")) {
      if (node.textContent !== label) continue;
      const track = document.getElementById(node.htmlFor)?.querySelector(".mantine-Slider-trackContainer, .mantine-Slider-track");
      if (!track) continue;
      const wanted = spans.map(([from, to]) => `${from},${to}`).join(";");
      if (track.dataset.regions === wanted) continue;
      track.dataset.regions = wanted;
      track.querySelectorAll(".s3-region").forEach((old) => old.remove());
      for (const [from, to] of spans) {
        const mark = element("span", { class: "s3-region", title: "near gimbal lock" }, track);
        mark.style.left = `${100 * from}%`;
        mark.style.width = `${100 * (to - from)}%`;
      }
    }
  }
}

let focused = null;

// The handle of a name, or where it isn't there, the picture in which it can be put.
function gripNamed(name) {
  const handle = `[data-handle="${CSS.escape(name)}"]`;
  return `${handle}, svg:not(:has(${handle})) [data-pick="${CSS.escape(name)}"]`;
}

document.addEventListener("focusin", (event) => {
  const grip = event.target.closest?.("[data-handle], [data-pick]");
  const row = event.target.closest?.("[data-link]");
  focused = grip ? gripNamed(grip.dataset.handle ?? grip.dataset.pick) : row ? `${linked(row.dataset.link)} button` : null;
});

// At once, and not with the next picture: under software rendering that may be several keys away.
let keeping = false;

function keepFocus() {
  if (!focused || document.activeElement !== document.body) return;
  keeping = true;
  document.querySelector(focused)?.focus({ preventScroll: true });
  keeping = false;
}

// --- Links: what stands for the same thing in pictures and tables lights up together; a click selects it -----------

let mine = ""; // what the pointer or the focus is on
let theirs = ""; // what somebody else in the room points at

function linked(name) {
  return `[data-link="${CSS.escape(name)}"]`;
}

function light() {
  const lit = [mine, theirs].filter(Boolean).map(linked).join();
  for (const node of document.querySelectorAll(".s3-lit")) if (!lit || !node.matches(lit)) node.classList.remove("s3-lit");
  if (lit) for (const node of document.querySelectorAll(lit)) node.classList.add("s3-lit");
}

function pointAt(node) {
  const name = node?.closest?.("[data-link]")?.dataset.link ?? "";
  if (name === mine) return;
  mine = name;
  light();
  send({ type: "point", name });
}

function select(name) {
  if (!sim.watching) send({ type: "select", name });
}

// What is held stays lit, wherever the pointer is; focus that comes back to a table drawn anew points at nothing new.
document.addEventListener("pointerover", (event) => held?.pointer === undefined && pointAt(event.target));
document.addEventListener("focusin", (event) => keeping || pointAt(event.target));
// A finger has left when it is lifted; what it touched stays lit until it touches something else.
document.documentElement.addEventListener("pointerleave", (event) => event.pointerType === "touch" || pointAt(null));

document.addEventListener("click", (event) => {
  const node = event.target.closest?.("[data-link]");
  if (node) select(node.dataset.link);
});

let tidying = false;

new MutationObserver(() => {
  tellHeightSoon();
  keepFocus();
  light();
  goLive();
  if (tidying) return;
  tidying = true;
  requestAnimationFrame(() => {
    tidying = false;
    nameControls(document);
    markSliders();
    showBringing();
    dismissSoftwareNotice();
  });
}).observe(document.body, { childList: true, subtree: true });

// viser's hint about software rendering would stand over the scene on every school machine without a GPU.
function dismissSoftwareNotice() {
  for (const note of document.querySelectorAll(".mantine-Notification-root")) {
    if (/Software WebGL/.test(note.textContent)) note.querySelector("button")?.click();
  }
}

// --- Still picture until the scene is live ------------------------------------------------------------------------

function goLive() {
  if (sim.live || !state || !document.querySelector("canvas") || !document.querySelector("[data-s3-drawn]")) return;
  sim.live = true;
  showAddress();
  // The controls are there; the scene is on the screen with the frame after next.
  requestAnimationFrame(() => requestAnimationFrame(() => document.querySelector(".s3-still").remove()));
  describeScene(state.text);
  post({ type: "sim3:ready" });
  askForHeight();
}

// --- Toolbar -----------------------------------------------------------------------------------------------------

document.addEventListener("click", (event) => {
  const kind = event.target.closest?.("[data-s3]")?.dataset.s3;
  if (kind === "share") share();
  else if (kind === "picture") savePicture();
  else if (kind === "keys") showKeys();
  else if (kind === "download") download(`${sim.place}result/${event.target.value}`, event.target.value);
  else if (kind === "give-up") bringing.request.abort();
  else if (kind === "close") event.target.closest("dialog").close();
});

async function share() {
  const link = new URL(withState(sim.path.replace(/\/s(\/[^/]+){1,2}\/$/, "/embed")), location.href).href;
  try {
    // Frames of other sites may not; asking all the same would leave an error in the console.
    if (document.featurePolicy?.allowsFeature("clipboard-write") === false) throw new Error("not allowed");
    await navigator.clipboard.writeText(link);
    notify("Link copied. It opens this sim in exactly this state.");
  } catch {
    dialog("Link to this state", `<p><input class="s3-link" readonly aria-label="Link" value=""></p>`);
    const field = document.querySelector(".s3-link");
    field.value = link;
    field.select();
  }
}

function savePicture() {
  const canvas = sceneCanvas();
  requestAnimationFrame(() => {
    download(canvas.toDataURL("image/png"), `${sim.slug}.png`);
  });
}

function download(href, name) {
  const link = element("a", { href, download: name });
  link.click();
  link.remove();
}

// --- Files that a learner brings: sent as they are, with how far they are; the state comes over the channel ----------

const bringing = { words: "", share: null, request: null };

function showBringing() {
  const bar = document.querySelector(".s3-bring progress");
  const words = document.querySelector("[data-s3-file-status]");
  if (!bar || (!bringing.words && bar.hidden)) return;
  bar.hidden = bar.nextElementSibling.hidden = bringing.share === null;
  if (bringing.share === 1) bar.removeAttribute("value");
  else if (bringing.share !== null) bar.value = bringing.share;
  if (bringing.words && words.textContent !== bringing.words) words.textContent = bringing.words;
}

function say(words, share = null) {
  Object.assign(bringing, { words, share });
  showBringing();
  // A file can be dropped anywhere, also while the controls of files are folded away.
  if (!document.querySelector(".s3-bring")?.checkVisibility()) notify(words);
}

function bring(file) {
  const size = `${(file.size / 1e6).toFixed(1)} MB`;
  if (file.size > sim.files.largest) {
    say(`⚠ “${file.name}” has ${size}; at most ${sim.files.largest / 1e6} MB are taken. Nothing has changed.`);
    return;
  }
  const request = (bringing.request = new XMLHttpRequest());
  const failed = (words) => say(`⚠ “${file.name}”: ${words} Nothing has changed.`);
  request.open("POST", `${sim.place}file?name=${encodeURIComponent(file.name)}`);
  request.upload.onprogress = (event) => say(`Sending “${file.name}”, ${size}…`, event.loaded / event.total * 0.999);
  request.upload.onload = () => say(`Reading “${file.name}”, ${size}…`, 1);
  request.onerror = () => failed("The connection broke off.");
  request.onabort = () => failed("It was given up.");
  request.onload = () => {
    if (request.status === 200) return say(`“${file.name}” is shown.`);
    let words = "The server didn't take it.";
    try { words = JSON.parse(request.responseText).detail; } catch { /* not from us */ }
    failed(words);
  };
  say(`Sending “${file.name}”, ${size}…`, 0);
  request.send(file);
}

document.addEventListener("change", (event) => {
  if (!event.target.matches?.("[data-s3-file]") || !event.target.files.length) return;
  bring(event.target.files[0]);
  event.target.value = ""; // so that the same file can be brought again
});

if (sim.files && !sim.watching) {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer?.files.length) bring(event.dataTransfer.files[0]);
  });
}

function dialog(title, html) {
  document.querySelector("dialog.s3-dialog")?.remove();
  const box = element("dialog", { class: "s3-dialog", "aria-label": title });
  box.innerHTML = `<h2>${title}</h2>${html}<button type="button" data-s3="close">Close</button>`;
  box.showModal();
}

function showKeys() {
  dialog("Keys", `<table>
    <tr><th scope="row"><kbd>Tab</kbd></th><td>next control or point</td></tr>
    <tr><th scope="row"><kbd>←</kbd> <kbd>→</kbd> on a slider</th><td>one step</td></tr>
    <tr><th scope="row">arrow keys on a point in a picture</th><td>one pixel; with <kbd>Shift</kbd> ten, with <kbd>Alt</kbd> a tenth</td></tr>
    <tr><th scope="row">click, or <kbd>Enter</kbd>, on a picture</th><td>choose a pixel, where the sim has something to say of it</td></tr>
    <tr><th scope="row">drag in the scene</th><td>turn the view; right button moves it, wheel zooms</td></tr>
    <tr><th scope="row">drag a ringed point</th><td>move it; with <kbd>Shift</kbd> along one axis</td></tr>
    <tr><th scope="row">point at, or click, a point or its row</th><td>light it up, or select it, everywhere</td></tr>
    <tr><th scope="row"><kbd>?</kbd></th><td>these keys</td></tr></table>`);
}

// --- The page around the sim ---------------------------------------------------------------------------------------

function post(message) {
  if (embedded) window.parent.postMessage({ slug: sim.slug, ...message }, "*");
}

const afterState = []; // what waits for the next state

function refuse(parameter, received, allowed) {
  const errors = [{ parameter, received: JSON.stringify(received) ?? "nothing", allowed }];
  post({ type: "sim3:error", message: `${parameter}: got ${errors[0].received}, allowed: ${allowed}`, errors });
}

function isView(view) {
  return Array.isArray(view) && view.length === 6 && view.every((v) => typeof v === "number" && Math.abs(v) < 1e4)
    && view.slice(0, 3).some((v, i) => v !== view[i + 3]);
}

// The theme and the controls are the server's work too: the page begins anew with them, in its room, once the server
// has what else was set.
function setPage({ theme, controls, view }) {
  const wanted = {};
  if (theme === "light" || theme === "dark") wanted.theme = theme;
  else if (theme !== undefined) refuse("theme", theme, "light or dark");
  if (typeof controls === "boolean") wanted.controls = controls ? "1" : "0";
  else if (controls !== undefined) refuse("controls", controls, "true or false");
  const now = { theme: sim.dark ? "dark" : "light", controls: kept.get("controls") ?? "1" };
  const anew = Object.entries(wanted).filter(([name, value]) => value !== now[name]);
  for (const [name, value] of anew) kept.set(name, value);
  if (isView(view)) {
    chosen = true;
    kept.set("view", view.join(","));
    send({ type: "view", view });
  } else if (view !== undefined) refuse("view", view, "six numbers: viewpoint x, y, z and look-at x, y, z");
  showAddress();
  if (!anew.length) return;
  afterState.push(() => location.reload());
  send({ type: "get" });
}

addEventListener("message", (event) => {
  if (event.source !== window.parent || !embedded || typeof event.data !== "object" || event.data === null) return;
  const { type, params, name, seconds, solution, theme, controls, view, subject, context, action } = event.data;
  const page = theme !== undefined || controls !== undefined || view !== undefined;
  if (type === "sim3:set") {
    if (params !== undefined || !page) send({ type: "set", params, ...(seconds === undefined ? {} : { seconds }) });
    if (page) setPage({ theme, controls, view });
  } else if (type === "sim3:action") send({ type: "action", name });
  else if (type === "sim3:get") send({ type: "get", ...(solution ? { solution: true } : {}) });
  else if (subject === "lti.capabilities.response") {
    heightTo.canvas = event.data.supported_messages?.some((message) => message.subject === "lti.frameResize");
    tellHeight();
  } else if (context === "h5p" && ["hello", "resize"].includes(action)) {
    heightTo.h5p = true;
    tellHeight();
  }
});

// --- How high the frame would best be: for course pages, and for Canvas and H5P, if they answer in their own words --

const heightTo = { canvas: false, h5p: false };
let told = 0;

function postRaw(message) {
  if (embedded) window.parent.postMessage(message, "*");
}

function askForHeight() {
  postRaw({ subject: "lti.capabilities" });
  postRaw({ context: "h5p", action: "hello" });
  tellHeight();
}

// As high as the controls and read-outs need beside the scene, or below it on a phone, within reason.
function wantedHeight() {
  const content = [...document.querySelectorAll(".mantine-ScrollArea-viewport, [data-dock-region]")]
    .map((node) => node.getBoundingClientRect().top + node.scrollHeight);
  const [least, most] = innerWidth <= 576 ? [640, 900] : [480, 900];
  return Math.round(Math.min(Math.max(least, ...content), most));
}

let telling = 0;

function tellHeightSoon() {
  if (!embedded || !sim.live) return;
  clearTimeout(telling);
  telling = setTimeout(() => Math.abs(wantedHeight() - told) > 8 && tellHeight(), 400);
}

function tellHeight() {
  const height = wantedHeight();
  told = height;
  post({ type: "sim3:height", height });
  if (heightTo.canvas) postRaw({ subject: "lti.frameResize", height });
  // H5P's own content asks first for a frame of no height, to measure itself: a scene would be drawn anew for that.
  if (heightTo.h5p) postRaw({ context: "h5p", action: "resize", scrollHeight: height, clientHeight: innerHeight });
}

// --- Viewpoint: worked out anew when the page's size has left it, but never against one that somebody chose ---------

let chosen = kept.has("view");
let looked = sim.fit();
let sizing = 0;

for (const kind of ["pointerdown", "wheel", "keydown"]) {
  document.addEventListener(kind, (event) => { if (event.target.matches?.("canvas")) chosen = true; }, { capture: true, passive: true });
}

addEventListener("resize", () => {
  clearTimeout(sizing);
  sizing = setTimeout(() => {
    if (!innerWidth || !innerHeight) return; // hidden again
    tellHeightSoon();
    const view = sim.fit();
    if (chosen || Math.hypot(...view.map((v, i) => v - looked[i])) < 0.02 * sim.radius) return;
    looked = view;
    send({ type: "view", view, fit: true });
  }, 150);
});

lost("");
showAddress();
connect();
