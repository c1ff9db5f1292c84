// The step that is read moves the sim, unless somebody has taken over; they are asked.
const GLIDE = 0.8; // seconds
const LINE = 0.4; // of the height in which the text is seen: what has passed it is read

export class Steps {
  constructor(sim, steps) {
    this.sim = sim;
    this.steps = steps.map((step) => ({ ...step, node: document.getElementById(step.id) }));
    this.at = -1;
    this.query = ""; // of the sim's state
    this.taken = false; // somebody moved the sim since the text did
    this.shown = null; // what the text moved it to
    this.mine = null; // their state
    this.coming = false; // what the text moved it to, which it hasn't told yet
    this.passes = false; // what somebody moved it to hasn't been told yet: until then it tells of what the text did
    sim.on("state", (state) => this.hear(state));
    sim.on("touched", () => Object.assign(this, { taken: true, passes: true }));
    addEventListener("scroll", () => this.look(), { passive: true });
    addEventListener("resize", () => this.look());
    document.addEventListener("click", (event) => this.press(event));
  }

  get step() {
    return this.steps[this.at];
  }

  // What the sim begins with: the first step's state, or that of the link, which is somebody's own.
  begin(query) {
    this.taken = query !== "";
    this.query = query || (this.steps[0]?.query ?? "");
    this.look();
  }

  hear({ params, query }) {
    this.query = query;
    if (query === this.shown?.query) this.coming = false;
    if (query === this.step?.query) this.taken &&= this.passes;
    else if (!this.coming) this.passes = false;
    if (this.taken) this.mine = { params, query };
    this.offer();
  }

  // The last step whose heading has passed the line; at the end of the page the last one.
  look() {
    const stage = document.querySelector(".stage").getBoundingClientRect();
    const top = stage.width > 0.8 * innerWidth ? Math.max(stage.bottom, 0) : 0;
    const line = top + LINE * (innerHeight - top);
    const end = scrollY > 0 && scrollY + innerHeight > document.documentElement.scrollHeight - 4;
    const passed = this.steps.filter(({ node }) => node.getBoundingClientRect().top < (end ? innerHeight : line));
    this.reach(Math.max(passed.length - 1, this.steps.length ? 0 : -1));
  }

  // A state that the step has already is nobody's own: a page that is loaded anew goes on where it was.
  reach(k) {
    if (k === this.at) return;
    this.at = k;
    for (const [i, { node }] of this.steps.entries()) node.classList.toggle("current", i === k);
    if (this.query === this.step.query && !this.moving) this.taken &&= this.passes;
    else if (!this.taken) this.go(this.step, GLIDE);
    this.offer();
  }

  // On its way to what the text has shown last.
  get moving() {
    return !this.taken && this.shown !== null && this.shown.query !== this.query;
  }

  go(state, seconds) {
    this.taken = false;
    this.coming ||= state.query !== this.query;
    this.shown = state;
    this.sim.set(state, seconds);
  }

  // "Show this" where the sim is elsewhere, by somebody's hand or after a question or a link, and the way back to what
  // somebody had.
  offer() {
    const { query, shown, step, taken } = this;
    const away = query !== step?.query && (taken || (shown !== null && shown.query !== step?.query));
    for (const button of document.querySelectorAll("[data-show], [data-mine]")) {
      const here = this.step?.node.contains(button);
      const offered = "show" in button.dataset ? away : !this.taken && this.mine;
      button.hidden = !here || !offered;
    }
  }

  press(event) {
    const button = event.target.closest("[data-show], [data-mine], a[data-set]");
    if (!button || (button.matches("a") && (event.ctrlKey || event.metaKey || event.shiftKey))) return;
    event.preventDefault();
    if ("show" in button.dataset) this.go(this.step, GLIDE);
    else if ("mine" in button.dataset) this.goBack();
    else this.go(JSON.parse(button.dataset.set), GLIDE);
    this.offer();
    if (button.hidden) keepFocus(button);
  }

  goBack() {
    this.go(this.mine, GLIDE);
    this.taken = true;
  }
}

// Who pressed a button that goes stays where they were: on the one that comes in its place, or on the heading.
function keepFocus(button) {
  const other = button.parentElement.querySelector("button:not([hidden])");
  (other ?? button.closest("section")).focus({ preventScroll: true });
}
