// The step that is read moves the sim, unless somebody has taken over; they are asked.
const GLIDE = 0.8; // seconds
const SLACK = 3000; // milliseconds after a glide in which the sim must have arrived, or somebody has taken over
const LINE = 0.4; // of the height in which the text is seen: what has passed it is read

export class Steps {
  constructor(sim, steps) {
    this.sim = sim;
    this.steps = steps.map((step) => ({ ...step, node: document.getElementById(step.id) }));
    this.at = -1;
    this.wanted = null; // the query of the state that the text asked for last
    this.until = 0; // before then the sim is on its way there
    this.arrived = false;
    this.taken = false; // somebody moved the sim since
    this.mine = null; // their state
    sim.on("state", (state) => this.hear(state));
    addEventListener("scroll", () => this.look(), { passive: true });
    addEventListener("resize", () => this.look());
    document.addEventListener("click", (event) => this.press(event));
  }

  // What the sim begins with: the first step's state, or that of the link, which is somebody's own.
  begin(query) {
    if (query) this.taken = true;
    else [this.wanted, this.arrived] = [this.steps[0]?.query ?? "", true];
    this.look();
  }

  hear({ params, query }) {
    this.query = query;
    if (query === this.wanted) [this.arrived, this.taken] = [true, false];
    else if (this.wanted === null || this.arrived || performance.now() > this.until) {
      this.taken = true;
      this.mine = { params, query };
    }
    this.offer();
  }

  // The last step whose heading has passed the line; at the end of the page the last one.
  look() {
    const stage = document.querySelector(".stage").getBoundingClientRect();
    const top = stage.width > 0.8 * innerWidth ? Math.max(stage.bottom, 0) : 0;
    const line = top + LINE * (innerHeight - top);
    const end = scrollY + innerHeight > document.documentElement.scrollHeight - 4;
    const passed = this.steps.filter(({ node }) => node.getBoundingClientRect().top < (end ? innerHeight : line));
    this.reach(passed.length - 1);
  }

  reach(k) {
    if (k < 0 || k === this.at) return;
    const first = this.at < 0;
    this.at = k;
    for (const [i, { node }] of this.steps.entries()) node.classList.toggle("current", i === k);
    if (!this.taken && !(first && this.steps[k].query === this.wanted)) this.go(this.steps[k], GLIDE);
    this.offer();
  }

  // Whether the text moves the sim: what it passes on the way is nobody's doing.
  get gliding() {
    return !this.arrived && performance.now() < this.until;
  }

  go(state, seconds) {
    this.wanted = state.query;
    this.arrived = this.query === state.query;
    this.until = performance.now() + 1000 * seconds + SLACK;
    this.taken = false;
    this.sim.set(state, seconds);
  }

  // "Show this" where the sim is elsewhere, and the way back to what somebody had.
  offer() {
    const step = this.steps[this.at];
    for (const button of document.querySelectorAll("[data-show], [data-mine]")) {
      const here = step?.node.contains(button);
      button.hidden = !here || ("show" in button.dataset ? !this.taken || this.query === step.query : this.taken || !this.mine);
    }
  }

  press(event) {
    const button = event.target.closest("[data-show], [data-mine], a[data-set]");
    if (!button || (button.matches("a") && (event.ctrlKey || event.metaKey || event.shiftKey))) return;
    event.preventDefault();
    if ("show" in button.dataset) this.go(this.steps[this.at], GLIDE);
    else if ("mine" in button.dataset) this.goBack();
    else this.go(JSON.parse(button.dataset.set), GLIDE);
    this.offer();
  }

  goBack() {
    const { mine } = this;
    this.go(mine, GLIDE);
    [this.taken, this.mine] = [true, mine];
  }
}
