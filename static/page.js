// What a page does beyond its HTML. On a sim's page the address, the link to full screen and those to share it
// follow the state of the sim; a page of errors in another page's frame tells that page.
const frame = document.querySelector("iframe[data-slug]");
const options = ["view", "controls", "theme"];

addEventListener("message", (event) => {
  if (event.origin !== self.origin || event.source !== frame?.contentWindow) return;
  if (event.data?.type === "sim3:state") follow(event.data.query);
});

// Whichever of the two starts first: the sim tells of itself when it is ready, or when it is asked.
frame?.contentWindow.postMessage({ type: "sim3:get" }, "*");

// The sim tells its parameters; the options that this page was opened with stay beside them.
function follow(query) {
  const given = new URLSearchParams(location.search);
  const kept = options.filter((name) => given.has(name)).map((name) => [name, given.get(name)]);
  const search = [query, new URLSearchParams(kept).toString().replaceAll("%2C", ",")].filter(Boolean).join("&");
  history.replaceState(null, "", location.pathname + (search && "?" + search) + location.hash);
  for (const link of document.querySelectorAll("[data-follows], [data-dialog]")) {
    link.search = [link.dataset.follows, search].filter(Boolean).join("&");
  }
}

// When the reader's system turns dark or light, the page follows by its CSS, the sim by loading anew: its address
// holds its state.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  if (frame && !document.documentElement.dataset.theme) frame.contentWindow.location.reload();
});

// The sim at full screen stays the one of the page; where browsers don't do that, the link opens one of its own.
const full = document.querySelector(".stage .full");
full?.addEventListener("click", (event) => {
  if (!document.fullscreenEnabled || event.ctrlKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  frame.parentElement.requestFullscreen().catch(() => location.assign(full.href));
});

// What is wider than the page is scrolled by keys too, where it is. (A script's own box always can be.)
const wide = new ResizeObserver((seen) => {
  for (const { target } of seen) if (target.scrollWidth > target.clientWidth) target.tabIndex = 0;
    else target.removeAttribute("tabindex");
});
for (const node of document.querySelectorAll(".words :is(table, math[display=block])")) wide.observe(node);

for (const button of document.querySelectorAll("[data-copy]")) {
  button.hidden = false;
  button.addEventListener("click", () => copy(button));
}

async function copy(button) {
  const section = button.closest(".script");
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

// A frame that is sandboxed without allow-forms drops a form without a word. Who takes it here hears of it all the same;
// what only the server can take is said.
document.addEventListener("click", ({ target }) => {
  const button = target.closest("button[type=submit], button:not([type])");
  if (!button?.form) return;
  let told = false;
  button.form.addEventListener("submit", () => (told = true), { capture: true, once: true });
  setTimeout(() => told || sendAnyway(button));
});

const unsent = Object.assign(document.createElement("p"), { role: "alert", className: "wrong" });

function sendAnyway(button) {
  const { form } = button;
  if (!form.reportValidity()) return;
  if (!form.dispatchEvent(new SubmitEvent("submit", { bubbles: true, cancelable: true, submitter: button }))) return;
  if (form.method === "get") {
    const address = new URL(form.action);
    address.search = new URLSearchParams(new FormData(form, button)); // in place of a query of its own, as browsers do
    location.assign(address);
    return;
  }
  unsent.textContent = `The page around this one doesn’t let it send anything. Open ${location.href} in a tab of its own.`;
  button.after(unsent);
}

// The dialog of what a state is handed on by; without it the link leads to the same as a page.
for (const link of document.querySelectorAll("[data-dialog]")) link.addEventListener("click", (event) => open(event, link));

async function open(event, link) {
  if (event.ctrlKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  const address = new URL(link.href);
  address.searchParams.set("share-opens", "lesson");
  if (seenFrom()) address.searchParams.set("view", seenFrom());
  try {
    await (await import(link.dataset.dialog)).share(address.href, link);
  } catch {
    location.assign(address.href);
  }
}

// The sim's own address holds from where it is looked at, once somebody has turned it.
function seenFrom() {
  try {
    return new URLSearchParams(frame.contentWindow.location.search).get("view");
  } catch {
    return null; // in a frame without an origin the sim's is another one
  }
}

const error = document.querySelector("[data-error]");
if (error && parent !== window) {
  parent.postMessage({ type: "sim3:error", slug: error.dataset.error, message: error.innerText }, "*");
}
