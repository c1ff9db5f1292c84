// The buttons that every sim has: share, save the picture, keys, downloads.
import { dialog } from "./dialog.js";
import { copied, doubt, download } from "./giving.js";
import { column, sim } from "./page.js";
import { TakeHome } from "./take_home.js";
import { sceneCanvas } from "./viser_dom.js";

export class Toolbar {
  constructor(address, words, files, view, paste, live) {
    this.address = address;
    this.words = words;
    this.takeHome = new TakeHome(address);
    const does = {
      share: (button) => this.share(button),
      code: () => this.copyCode(),
      copy: (button) => this.copy(button.value, "Copied.", button.ariaLabel),
      picture: () => this.give(savePicture),
      "take-home": () => this.takeHome.open(),
      present: () => live.present(),
      keys: showKeys,
      more: unfold,
      download: ({ value }) => this.give(() => download(`${sim.place}result/${value}`, value)),
      enlarge: (button) => enlarge(button.closest("figure")),
      home: () => view.look("home"),
      "give-up": () => files.giveUp(),
      take: () => paste.take(),
      close: (button) => button.closest("dialog").close(),
    };
    if (!sim.code) document.querySelector("[data-s3=code]")?.remove();
    document.addEventListener("click", (event) => {
      does[event.target.closest?.("[data-s3]")?.dataset.s3]?.(event.target);
      if (event.target.closest?.("[data-act]")?.dataset.act === "reset") view.reset();
    });
    document.addEventListener("keydown", (event) => {
      if (event.key === "?" && !event.target.matches?.("input[type=text], textarea")) showKeys();
      if (event.key === "Escape") document.querySelector(".s3-full")?.classList.remove("s3-full");
    }, true);
  }

  // The dialog comes from the server. When it doesn't come, the link is what matters.
  async share(button) {
    try {
      await (await import(sim.share)).share(this.address.link("share"), button);
    } catch {
      this.copy(this.address.link("embed"), "Link copied. It opens this sim in exactly this state and view.", "Link to this state");
    }
  }

  give(saves) {
    saves();
    if (doubt) this.words.notify(doubt);
  }

  async copy(words, done, title) {
    if (await copied(words)) {
      this.words.notify(done);
      return;
    }
    const tag = words.includes("\n") ? 'textarea rows="12"' : "input";
    dialog(title, `<p><${tag} class="s3-link" readonly aria-label="${title}">${tag === "input" ? "" : "</textarea>"}</p>`);
    const field = document.querySelector(".s3-link");
    field.value = words;
    field.select();
  }

  async copyCode() {
    try {
      const answer = await fetch(this.address.of(sim.code));
      if (!answer.ok) throw new Error(answer.statusText);
      await this.copy(await answer.text(), "Script copied. It runs with Python and NumPy, and has the numbers of now.", "Script of this state");
    } catch {
      this.words.notify("⚠ The script can’t be had just now. Try again.");
    }
  }
}

// What is seldom wanted; at the foot of the column it is scrolled into sight.
function unfold(button) {
  const rest = document.getElementById(button.getAttribute("aria-controls"));
  rest.hidden = !rest.hidden;
  button.ariaExpanded = String(!rest.hidden);
  const below = rest.getBoundingClientRect().bottom - column.getBoundingClientRect().bottom;
  if (below > 0) column.scrollTop += below;
}

// A picture covers the scene, or goes back to its place; it stays live. Two that stand side by side do so together.
function enlarge(figure) {
  const pair = !figure.matches(".s3-wide") && figure.parentElement.querySelectorAll(".s3-pane:not(.s3-wide)").length > 1;
  const shown = pair ? figure.parentElement : figure;
  const large = !shown.classList.contains("s3-full");
  document.querySelector(".s3-full")?.classList.remove("s3-full");
  shown.classList.toggle("s3-full", large);
  document.documentElement.style.setProperty("--s3-left", `${column.offsetLeft || innerWidth}px`);
}

function savePicture() {
  const canvas = sceneCanvas();
  requestAnimationFrame(() => download(canvas.toDataURL("image/png"), `${sim.slug}.png`));
}

function showKeys() {
  dialog("Keys", `<table>
    <tr><th scope="row"><kbd>Tab</kbd></th><td>next control or point</td></tr>
    <tr><th scope="row"><kbd>←</kbd> <kbd>→</kbd> on a slider</th><td>one step; ten with <kbd>Shift</kbd>, or <kbd>Page Up</kbd> and <kbd>Page Down</kbd>; <kbd>Home</kbd> and <kbd>End</kbd> go to its ends</td></tr>
    <tr><th scope="row">double click on a slider</th><td>back to what it was at first</td></tr>
    <tr><th scope="row">in a number box</th><td>47.5, 45,5, −0.6, 1e2, π/3, 90° and 30 cm are understood; <kbd>Enter</kbd> takes it, <kbd>Esc</kbd> gives it up, <kbd>↑</kbd> <kbd>↓</kbd> go one step</td></tr>
    <tr><th scope="row"><kbd>←</kbd> <kbd>→</kbd> <kbd>↑</kbd> <kbd>↓</kbd> on the scene</th><td>turn the view; <kbd>+</kbd> <kbd>−</kbd> zoom, <kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> move, <kbd>1</kbd> <kbd>2</kbd> <kbd>3</kbd> front, side, top, <kbd>Home</kbd> back</td></tr>
    <tr><th scope="row">arrow keys on a point in a picture</th><td>one pixel; with <kbd>Shift</kbd> ten, with <kbd>Alt</kbd> a tenth</td></tr>
    <tr><th scope="row">click, or <kbd>Enter</kbd>, on a picture</th><td>choose a pixel, where the sim has something to say of it</td></tr>
    <tr><th scope="row">drag in the scene</th><td>turn the view; right button moves it, wheel zooms</td></tr>
    <tr><th scope="row">drag a ringed point</th><td>move it; with <kbd>Shift</kbd> along one axis</td></tr>
    <tr><th scope="row">point at, or click, a point or its row</th><td>light it up, or select it, everywhere</td></tr>
    <tr><th scope="row"><kbd>?</kbd></th><td>these keys</td></tr></table>`);
}
