// What the learners predicted: a histogram for each question of the lesson that somebody has answered.
export class Predictions {
  constructor(frame) {
    this.frame = frame; // the lesson, whose questions these are
    this.section = document.querySelector(".predictions");
    this.told = "";
  }

  show(guesses) {
    const told = JSON.stringify(guesses);
    if (told === this.told) return;
    const forms = this.frame.contentDocument?.querySelectorAll("[data-predict]") ?? [];
    const boxes = Object.entries(guesses).filter(([box]) => forms[box]).map(([box, values]) => histogram(forms[box], values));
    this.section.hidden = !boxes.length;
    this.section.querySelector(".boxes").replaceChildren(...boxes);
    if (boxes.length) this.told = told;
  }
}

function histogram(form, values) {
  const figure = element("figure", {});
  element("figcaption", { textContent: question(form) }, figure);
  const rows = element("ul", { className: "bars" }, figure);
  for (const { words, count, right } of counted(form, values)) {
    const row = element("li", { className: right ? "right" : "" }, rows);
    element("span", { textContent: words }, row);
    element("meter", { max: values.length, value: count, ariaLabel: `${words}: ${count} of ${values.length}` }, row);
    element("b", { textContent: count }, row);
  }
  return figure;
}

function question(form) {
  const asked = [...form.querySelectorAll("fieldset > p")].find((each) => !each.matches(".row"));
  return asked?.textContent ?? "Prediction";
}

// Of choices each with its count; of numbers those that were said, in order.
function counted(form, values) {
  const { kind, answer, within } = JSON.parse(form.dataset.predict);
  const count = (value) => values.filter((each) => each === value).length;
  if (kind === "choice") {
    return [...form.querySelectorAll(".choice")].map((choice, k) => ({
      words: choice.textContent.trim(), count: count(k), right: choice.querySelector("[data-right]") !== null,
    }));
  }
  const numbers = [...new Set(values)].toSorted((a, b) => a - b);
  return numbers.map((each) => ({
    words: String(Number(each.toPrecision(4))).replace("-", "−"), count: count(each), right: Math.abs(each - answer) <= within,
  }));
}

function element(tag, properties, parent) {
  const made = Object.assign(document.createElement(tag), properties);
  parent?.append(made);
  return made;
}
