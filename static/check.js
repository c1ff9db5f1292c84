// What the frame that this page is in lets a sim do. The words stand in the page; here is found out which of them hold.
const PATIENCE = 5000; // milliseconds after which a websocket isn't waited for any more
const SMALLEST = [320, 300]; // pixels in which a sim can be used
const NEEDED = ["scripts", "webgl", "websocket", "worker", "size"];
const script = document.querySelector("script[data-socket]");

const looks = {
  scripts: () => true,
  webgl: () => Boolean(document.createElement("canvas").getContext("webgl2")),
  websocket: opens,
  worker: works,
  size: () => innerWidth >= SMALLEST[0] && innerHeight >= SMALLEST[1],
  clipboard: () => Boolean(navigator.clipboard) && document.featurePolicy?.allowsFeature("clipboard-write") !== false,
  fullscreen: () => document.fullscreenEnabled === true,
  storage: stores,
};

function opens() {
  const address = new URL(script.dataset.socket, location.href).href.replace(/^http/, "ws");
  return new Promise((resolve) => {
    const socket = new WebSocket(address);
    socket.onclose = ({ code }) => resolve(code === 1000);
    setTimeout(() => resolve(false), PATIENCE);
  });
}

function works() {
  if (typeof WebAssembly !== "object") return false;
  const address = URL.createObjectURL(new Blob(["postMessage(1)"], { type: "text/javascript" }));
  return new Promise((resolve) => {
    const worker = new Worker(address);
    worker.onmessage = () => resolve(true);
    worker.onerror = () => resolve(false);
    setTimeout(() => resolve(false), PATIENCE);
  });
}

function stores() {
  localStorage.setItem("sim3", "");
  localStorage.removeItem("sim3");
  return true;
}

async function look(name) {
  let found = false;
  try {
    found = await looks[name]();
  } catch { /* what is forbidden raises */ }
  document.querySelector(`[data-check="${name}"]`).dataset.found = found ? "yes" : "no";
  return found;
}

async function begin() {
  const found = await Promise.all(Object.keys(looks).map(async (name) => [name, await look(name)]));
  const missing = found.filter(([name, yes]) => !yes && NEEDED.includes(name)).map(([name]) => name);
  document.querySelector(".verdict").dataset.found = missing.length ? "no" : "yes";
  document.querySelector("[data-letter]").value = letter(missing);
}

function letter(missing) {
  const site = document.referrer || location.origin;
  const asks = missing.map((name) => `- ${document.querySelector(`[data-check="${name}"] [data-ask]`).textContent}`);
  if (!asks.length) return "Nothing has to be asked for.";
  return [`Sims from ${location.host} don’t work fully in a page of ${site}. Please see to this:`, ...asks].join("\n");
}

const measured = () => {
  const place = parent === window ? "in a window of its own" : "in a frame of another page";
  document.querySelector("[data-measured]").textContent = `${innerWidth} × ${innerHeight} pixels, ${place}`;
};

addEventListener("resize", () => {
  measured();
  look("size");
});
measured();
begin();
