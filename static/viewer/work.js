// What takes the server long: in words, how much of it is done, and a way back to what is shown.
import { element, scene, sim } from "./page.js";

export class Work {
  constructor(cancel) {
    this.box = element("div", { class: "s3-work", role: "group", "aria-label": "Work in progress", hidden: "" }, scene);
    this.words = element("span", { role: "status" }, this.box);
    this.bar = element("progress", { max: "1", "aria-label": "Progress" }, this.box);
    this.button = element("button", { type: "button" }, this.box);
    this.button.textContent = "Cancel";
    this.button.addEventListener("click", cancel);
  }

  show({ text, done, cancel }) {
    this.box.hidden = !text;
    if (this.words.textContent !== text) this.words.textContent = text;
    if (typeof done === "number") this.bar.value = done;
    else this.bar.removeAttribute("value");
    this.button.hidden = !cancel || sim.watching;
  }
}
