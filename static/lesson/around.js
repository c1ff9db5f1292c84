// A lesson in a frame, as in a class: what the sim says goes on to the page around it, which may set the sim too, and
// hears of predictions.
const SAID = new Set(["sim3:ready", "sim3:state", "sim3:challenge", "sim3:error"]);
const TAKEN = new Set(["sim3:set", "sim3:get", "sim3:action"]);

export class Around {
  constructor(sim) {
    this.sim = sim;
  }

  begin() {
    if (parent === window) return;
    const inside = this.sim.frame.contentWindow;
    addEventListener("message", ({ source, origin, data }) => {
      if (source === inside && origin === self.origin && SAID.has(data?.type)) parent.postMessage(data, "*");
      if (source === parent && TAKEN.has(data?.type)) this.set(data);
    });
    document.addEventListener("submit", ({ target }) => this.predicted(target));
  }

  set(message) {
    this.sim.tell("touched"); // the text leaves the sim alone
    this.sim.post(message);
  }

  // A prediction that is committed to: the place of its choice, or its number.
  predicted(form) {
    const box = [...document.querySelectorAll("[data-predict]")].indexOf(form);
    if (box < 0 || !form.dataset.answered) return;
    const chosen = [...form.querySelectorAll("[type=radio]")].findIndex((each) => each.checked);
    const value = chosen < 0 ? Number(form.dataset.given) : chosen;
    parent.postMessage({ type: "sim3:prediction", box, value }, "*");
  }
}
