// What a state is handed on by: a page of the server's, which other pages show as a dialog. Its form follows every
// change; what the server makes of it stands in the elements that are marked `data-result`.
const COPIED = "Copied.";
const SELECTED = "It is selected: copy it with Ctrl+C, or ⌘C.";

// Shows the dialog for the state of an address; at its end the focus is where it was.
export async function share(address, opener) {
  const page = await fetched(address);
  await styled(page.querySelector("[data-sheet]").getAttribute("href"));
  const box = document.createElement("dialog");
  box.className = "share-box";
  box.append(closer(box), document.adoptNode(page.querySelector("[data-share]")));
  box.setAttribute("aria-label", box.querySelector("h1").textContent);
  box.addEventListener("close", () => {
    box.remove();
    opener.focus();
  });
  begin(box);
  document.body.append(box);
  box.showModal();
  box.querySelector("[data-result=link]").select();
}

function closer(box) {
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: "Close", className: "share-close" });
  button.addEventListener("click", () => box.close());
  return button;
}

async function fetched(address) {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${answer.status}`);
  return new DOMParser().parseFromString(await answer.text(), "text/html");
}

function styled(href) {
  if (document.querySelector(`link[href="${href}"]`)) return Promise.resolve();
  const sheet = Object.assign(document.createElement("link"), { rel: "stylesheet", href });
  document.head.append(sheet);
  return new Promise((resolve) => (sheet.onload = sheet.onerror = resolve));
}

// ---- the form

function begin(root) {
  const form = root.querySelector("form");
  root.querySelector("[data-share]").dataset.live = "";
  form.addEventListener("change", () => follow(root, form));
  form.addEventListener("submit", (event) => event.preventDefault());
  root.addEventListener("click", ({ target }) => {
    const copies = target.closest("[data-copies]");
    if (copies) copy(document.getElementById(copies.dataset.copies), copies.parentElement.querySelector("[role=status]"));
    else if (target.closest(".share-qr")) enlarge(target.closest(".share-qr"));
    else if (target.matches("[readonly]")) target.select();
  });
}

let asked = 0;

async function follow(root, form) {
  if (!form.reportValidity()) return;
  const mine = ++asked;
  const query = [...new FormData(form)].map((pair) => pair.map(encodeURIComponent).join("=")).join("&");
  const page = await fetched(`${form.getAttribute("action")}?${query}`);
  if (mine !== asked) return; // something newer is on its way
  for (const made of page.querySelectorAll("[data-result]")) put(root.querySelector(`[data-result="${made.dataset.result}"]`), made);
  for (const status of root.querySelectorAll("[role=status]")) status.textContent = "";
}

// What is the same isn't touched: the preview would begin anew.
function put(shown, made) {
  if (shown.matches("input, textarea")) shown.value = made.value;
  for (const name of ["src", "height", "viewBox", "hidden"]) {
    const value = made.getAttribute(name);
    if (value === null) shown.removeAttribute(name);
    else if (value !== shown.getAttribute(name)) shown.setAttribute(name, value);
  }
}

async function copy(field, status) {
  status.textContent = "";
  try {
    // Frames of other sites may not; asking all the same would leave an error in the console.
    if (document.featurePolicy?.allowsFeature("clipboard-write") === false) throw new Error("not allowed");
    await navigator.clipboard.writeText(field.value);
    status.textContent = COPIED;
  } catch {
    field.focus();
    field.select();
    status.textContent = document.execCommand("copy") ? COPIED : SELECTED;
  }
}

// ---- the code for the back row

function enlarge(button) {
  const box = document.createElement("dialog");
  box.className = "share-full";
  const sheet = document.createElement("button");
  sheet.type = "button";
  sheet.ariaLabel = "QR code of the link, large: close it";
  const words = document.createElement("span");
  words.textContent = button.closest("form").querySelector("[data-result=link]").value;
  sheet.append(button.querySelector("img").cloneNode(), words);
  box.append(sheet);
  sheet.addEventListener("click", () => box.close());
  sheet.addEventListener("fullscreenchange", () => document.fullscreenElement || box.close());
  box.addEventListener("close", () => {
    if (document.fullscreenElement) document.exitFullscreen();
    box.remove();
  });
  document.body.append(box);
  box.showModal();
  // A frame that may not fill the screen is filled itself.
  if (document.fullscreenEnabled) sheet.requestFullscreen().catch(() => {});
}

const own = document.querySelector("main [data-share]");
if (own) begin(own.parentElement);
