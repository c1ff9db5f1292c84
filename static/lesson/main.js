// A lesson: its text beside the sim.
import { Answers } from "./answers.js";
import { Around } from "./around.js";
import { Frame } from "./frame.js";
import { Handout } from "./handout.js";
import { Steps } from "./steps.js";
import { Values } from "./values.js";

const data = JSON.parse(document.getElementById("lesson").textContent);
const sim = new Frame(document.querySelector("iframe[data-slug]"));
const steps = new Steps(sim, data.steps);
const parts = [new Values(sim), new Answers(sim, steps), new Handout(data), new Around(sim)];
for (const part of parts) part.begin();
steps.begin(data.query);
sim.begin();

// From here on the answers can be opened, whatever went wrong on the way (sim.html).
window.onerror = null;
document.documentElement.classList.add("live");
