// A text of one's own, pasted or from a file: it is sent as it is; the state comes over the channel.
import { column, sim } from "./page.js";

export class Paste {
  constructor(words) {
    this.words = words;
    this.place = column.querySelector(".s3-paste");
    if (!this.place) return;
    this.text = this.place.querySelector("textarea");
    this.text.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.take();
    });
    this.text.addEventListener("input", () => this.say("", ""));
    this.place.querySelector("[data-s3-text]")?.addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      this.text.value = await file.slice(0, sim.paste.longest + 1).text();
      target.value = ""; // so that the same file can be chosen again
      this.take();
    });
  }

  async take() {
    const text = this.text.value;
    if (sim.watching || !text.trim()) return;
    if (new Blob([text]).size > sim.paste.longest) {
      this.say("", `This is too long: at most ${sim.paste.longest / 1024} kB are read. Nothing has changed.`);
      return;
    }
    this.say("Reading…", "");
    try {
      const answer = await fetch(`${sim.place}paste`, { method: "POST", body: text });
      const { said, detail } = await answer.json();
      this.say(said ?? "", detail ?? "");
    } catch {
      this.say("", "The connection broke off. Nothing has changed.");
    }
  }

  say(status, wrong) {
    this.place.querySelector("[role=status]").textContent = status;
    const line = this.place.querySelector(".s3-wrong");
    line.textContent = wrong;
    line.hidden = !wrong;
    this.text.setAttribute("aria-invalid", String(Boolean(wrong)));
    if (wrong && !this.place.checkVisibility()) this.words.notify(`⚠ ${wrong}`);
  }
}
