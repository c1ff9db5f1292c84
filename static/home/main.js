// A sim that was taken home: plays back what was recorded, without a server.
import { unpacked } from "./film.js";
import { column, Query, sim } from "../viewer/page.js";
import { describeScene, View } from "../viewer/view.js";
import { drawnVersion, lookFrom, prepare, show, start } from "../viewer/viser_dom.js";

const LOOKING = 30; // milliseconds between two looks at whether the scene is there
const EACH = 100; // milliseconds of a frame that plays

class Home {
  constructor(film) {
    this.film = film;
    this.frame = 0;
    this.playing = 0;
    this.slider = document.getElementById("at");
    this.button = document.getElementById("play");
    this.slider?.addEventListener("input", () => {
      this.stop();
      this.go(Number(this.slider.value));
    });
    this.button?.addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    const options = new Query(sim.options);
    this.view = new View({ send: ({ view }) => lookFrom(view) }, { options, show() {} }, () => {});
    column.addEventListener("click", ({ target }) => target.closest("[data-home]") && this.view.goHome());
    prepare(this.view.first, (view) => this.view.looked(view), () => this.goBlind());
    start();
    this.waiting = setInterval(() => drawnVersion() !== undefined && this.begin(), LOOKING);
  }

  // viser has shown its own recording, in which nothing is: from here on it shows ours.
  begin() {
    clearInterval(this.waiting);
    document.head.append(document.getElementById("styles")); // viser's own came after them
    show(this.film.messages(this.frame));
    sim.liveAt = performance.now();
    describeScene(document.querySelector("[data-part=about]").textContent);
  }

  go(frame) {
    this.frame = frame;
    if (sim.liveAt) show(this.film.messages(frame));
    for (const [name, html] of this.film.words(frame)) {
      const part = column.querySelector(`[data-part="${CSS.escape(name)}"]`);
      if (part && part.s3 !== html) part.innerHTML = part.s3 = html;
    }
    const { words, query } = sim.sweep[frame];
    this.slider.value = frame;
    this.slider.setAttribute("aria-valuetext", words);
    document.getElementById("value").textContent = words;
    document.getElementById("live").href = sim.live + (query && "?" + query);
  }

  play() {
    this.button.textContent = "Pause";
    this.playing = setInterval(() => this.go((this.frame + 1) % this.film.frames.length), EACH);
  }

  stop() {
    clearInterval(this.playing);
    this.playing = 0;
    this.button.textContent = "Play";
  }

  goBlind() {
    clearInterval(this.waiting);
    document.querySelector(".s3-hint").textContent = "This browser draws no 3D (WebGL): numbers and pictures are all here.";
    document.querySelector(".s3-hint").hidden = false;
  }
}

unpacked(document.getElementById("film").textContent).then((film) => new Home(film));
