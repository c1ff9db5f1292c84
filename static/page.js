// What a page does beyond its HTML. On a sim's page the address, the link to full screen and the embed code follow
// the state of the sim; a page of errors in another page's frame tells that page.
const frame = document.querySelector("iframe[data-slug]");
const options = ["view", "controls", "theme"];

addEventListener("message", (event) => {
  if (event.origin !== location.origin || event.source !== frame?.contentWindow) return;
  if (event.data?.type === "sim3:state") follow(event.data.query);
});

// Whichever of the two starts first: the sim tells of itself when it is ready, or when it is asked.
frame?.contentWindow.postMessage({ type: "sim3:get" }, location.origin);

// The sim tells its parameters; the options that this page was opened with stay beside them.
function follow(query) {
  const given = new URLSearchParams(location.search);
  const kept = options.filter((name) => given.has(name)).map((name) => [name, given.get(name)]);
  const search = [query, new URLSearchParams(kept).toString().replaceAll("%2C", ",")].filter(Boolean).join("&");
  history.replaceState(null, "", location.pathname + (search && "?" + search) + location.hash);
  for (const link of document.querySelectorAll("[data-follows]")) link.search = [link.dataset.follows, search].filter(Boolean).join("&");
  showCode();
}

function showCode() {
  const full = document.querySelector("[data-follows]");
  const place = document.querySelector("[data-embed]");
  if (full && place) place.textContent = full.href.replaceAll("&", "&amp;").replaceAll('"', "&quot;");
}

// When the reader's system turns dark or light, the page follows by its CSS, the sim by loading anew: its address
// holds its state.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  if (frame && !document.documentElement.dataset.theme) frame.contentWindow.location.reload();
});

for (const button of document.querySelectorAll("[data-copy]")) {
  button.hidden = false;
  button.addEventListener("click", () => copy(button));
}

async function copy(button) {
  const section = button.closest("section");
  const code = section.querySelector("pre");
  const status = section.querySelector("[role=status]");
  status.textContent = "";
  try {
    await navigator.clipboard.writeText(code.textContent);
    status.textContent = "Copied.";
  } catch {
    // Without HTTPS, as on a server in a classroom, browsers give no clipboard.
    getSelection().selectAllChildren(code);
    status.textContent = document.execCommand("copy") ? "Copied." : "The code is selected: copy it with Ctrl+C.";
  }
}

showCode();

const error = document.querySelector("[data-error]");
if (error && parent !== window) {
  parent.postMessage({ type: "sim3:error", slug: error.dataset.error, message: error.innerText }, "*");
}
