// How far each learner is: one cell for each, which stays in its place.
const MARKS = { asked: "Asked …", no: "Would rather not", yes: "Shown" };

export class Grid {
  // `ask(animal)` asks a learner whether their state may be shown.
  constructor(ask) {
    this.list = document.querySelector(".grid");
    this.cells = new Map();
    this.list.addEventListener("click", ({ target }) => {
      const button = target.closest("button");
      if (button) ask(button.value);
    });
  }

  show(learners) {
    const here = learners.filter((learner) => learner.here).length;
    document.querySelector(".count").textContent = learners.length ? here : "";
    document.querySelector(".nobody").hidden = learners.length > 0;
    const names = new Set(learners.map(({ animal }) => animal));
    for (const [name, cell] of this.cells) if (!names.has(name)) this.remove(name, cell);
    for (const learner of learners) this.fill(this.cells.get(learner.animal) ?? this.add(learner.animal), learner);
  }

  remove(name, cell) {
    cell.remove();
    this.cells.delete(name);
  }

  add(animal) {
    const cell = document.createElement("li");
    cell.innerHTML = '<b class="animal"></b><button type="button">Show</button><progress max="1"></progress><span class="near"></span>';
    cell.querySelector("b").textContent = animal;
    const button = cell.querySelector("button");
    button.value = animal;
    button.ariaLabel = `Ask ${animal} whether everybody may see their sim`;
    cell.querySelector("progress").ariaLabel = `How far ${animal} is`;
    this.cells.set(animal, cell);
    const next = [...this.list.children].find((each) => each.firstChild.textContent > animal);
    this.list.insertBefore(cell, next ?? null);
    return cell;
  }

  fill(cell, { here, solved, of, progress, words, asked }) {
    cell.classList.toggle("away", !here);
    cell.classList.toggle("solved", of > 0 && solved === of);
    const bar = cell.querySelector("progress");
    bar.hidden = of === 0;
    bar.value = progress;
    cell.querySelector("button").disabled = !here || asked === "asked";
    const near = of > 1 ? `${solved} of ${of} challenges` : words;
    const said = !here ? "Away" : MARKS[asked] && asked !== "yes" ? MARKS[asked] : solved === of && of > 0 ? "✓ Solved" : near;
    put(cell.querySelector(".near"), said);
  }
}

function put(node, words) {
  if (node.textContent !== words) [node.textContent, node.title] = [words, words];
}
