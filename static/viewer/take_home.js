// The dialog in which a sim is taken home: its present state, or a sweep of one number, as one file.
import { dialog } from "./dialog.js";
import { doubt, download } from "./giving.js";
import { element, Query, sim } from "./page.js";

const FORM = `<p>One file that opens from a memory stick, without server and network. In it, the scene can be turned.</p>
  <form class="s3-take"><label><input type="radio" name="what" value="" checked> This state</label>
    <div hidden><label><input type="radio" name="what" value="sweep"> A sweep, with a slider and a button that plays it</label>
      <p><select name="sweep" aria-label="What is swept"></select> from <input name="from" aria-label="From"> to
        <input name="to" aria-label="To"> <span></span></p></div>
    <p role="status"></p><div class="s3-actions"><button class="s3-primary">Save the file</button></div></form>`;

export class TakeHome {
  constructor(address) {
    this.address = address;
  }

  async open() {
    dialog("Take it home", FORM);
    this.form = document.querySelector(".s3-take");
    this.said = this.form.querySelector("[role=status]");
    const { sweep, what } = this.form.elements;
    sweep.addEventListener("change", () => this.suggest());
    this.form.addEventListener("input", ({ target }) => target.name !== "what" && (what.value = "sweep"));
    this.form.addEventListener("submit", (event) => event.preventDefault());
    this.form.querySelector(".s3-primary").addEventListener("click", () => this.save()); // heard in sandboxed frames too
    await this.trying(async () => this.offer(await (await asked(this.place("sweeps"))).json()));
  }

  offer({ numbers, why }) {
    this.numbers = numbers;
    this.said.textContent = why;
    this.form.querySelector("div").hidden = !numbers.length;
    for (const { name, label } of numbers) {
      element("option", { value: name }, this.form.elements.sweep).textContent = label;
    }
    this.suggest();
  }

  // From the least to the greatest value that the number may have.
  suggest() {
    const { sweep, from, to } = this.form.elements;
    const { low, high, unit } = this.numbers.find(({ name }) => name === sweep.value) ?? {};
    from.value = low;
    to.value = high;
    sweep.parentElement.querySelector("span").textContent = unit ?? "";
  }

  async save() {
    const { what, sweep, from, to } = this.form.elements;
    const wanted = what.value ? { sweep: sweep.value, from: from.value, to: to.value } : {};
    const button = this.form.querySelector(".s3-primary");
    button.disabled = true;
    this.said.textContent = "Recording …";
    await this.trying(async () => {
      const answer = await asked(this.place("home", wanted));
      const name = /filename="(.*)"/.exec(answer.headers.get("content-disposition"))[1];
      const href = URL.createObjectURL(await answer.blob());
      download(href, name);
      setTimeout(() => URL.revokeObjectURL(href), 60_000);
      this.said.textContent = `Saved as ${name}. ${doubt}`;
    });
    button.disabled = false;
  }

  async trying(work) {
    try {
      await work();
    } catch (error) {
      this.said.textContent = `⚠ ${error.message}`;
    }
  }

  // An address beside this sim's page, in its state, view and theme.
  place(name, more = {}) {
    const url = new URL(this.address.link(name));
    const query = new Query(url.search);
    for (const [key, value] of Object.entries({ theme: sim.dark ? "dark" : "light", ...more })) query.set(key, value);
    url.search = query;
    return url;
  }
}

async function asked(address) {
  const answer = await fetch(address).catch(() => {
    throw new Error("The server can’t be reached. Try again in a moment.");
  });
  if (!answer.ok) throw new Error((await answer.json()).detail);
  return answer;
}
