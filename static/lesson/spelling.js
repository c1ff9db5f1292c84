// Numbers in the text, spelled as the server spells them (app/lessons/state.py, sims/kit/readout.py).

// The value of a path such as pitch, R.0.2 or solution.selected.
export function valueAt({ params, solution }, path) {
  const names = path.split(".");
  if (names[0] === "solution") names.shift();
  const from = path.startsWith("solution.") || !(names[0] in params) ? solution : params;
  return names.reduce((at, name) => at?.[name], from);
}

// With so many digits after the point, as the read-outs have it; without a number of digits, as boxes have it.
export function figure(value, digits) {
  const text = digits === null ? asInBox(value) : fixed(value, digits);
  return (/[1-9]/.test(text) ? text : text.replace("-", "")).replaceAll("-", "−");
}

function asInBox(value) {
  const size = Math.abs(value);
  const text = size && (size < 1e-4 || size >= 1e6) ? value.toExponential(5).replace(/\.?0+e/, "e") : `${Number(value.toPrecision(6))}`;
  return text.replace("e+", "e");
}

// toFixed rounds a tie up, Python to the even digit. What a number is exactly is seen in more digits.
function fixed(value, digits) {
  const text = value.toFixed(digits);
  const whole = Math.abs(value).toFixed(Math.min(digits + 40, 100));
  const cut = whole.length - (Math.min(digits + 40, 100) - digits);
  if (!/^\.?50*$/.test(whole.slice(cut)) || !/[13579]$/.test(text)) return text;
  return (value < 0 ? "-" : "") + whole.slice(0, cut).replace(/\.$/, "");
}

export function spelled(value, { digits, boxed, unit = "" }) {
  const number = (each) => figure(each, digits === undefined ? (Number.isInteger(each) ? 0 : 3) : Number(digits));
  if (value === null || value === undefined) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return `(${value.map(number).join(", ")})`;
  if (typeof value !== "number") return String(value);
  return (boxed === undefined ? number(value) : figure(value, null)) + (["", "°", "%"].includes(unit) ? "" : "\u2009") + unit;
}

const ABSENT = "\0"; // no page's HTML can hold it

// A link with the numbers of a state; where there are none, the sim that it opens has its own.
export function filled(href, state) {
  const spelt = href.replace(/\{value:([^{}:]+)(?::(\d+))?\}/g, (_, path, digits) => {
    const numbers = [valueAt(state, path)].flat();
    return numbers.every(Number.isFinite) ? numbers.map((each) => Number(each.toPrecision(Number(digits || 6)))).join() : ABSENT;
  });
  const [, path, query = "", part = ""] = /^([^?#]*)(?:\?([^#]*))?(#.*)?$/.exec(spelt);
  const kept = query.split("&").filter((each) => each && !each.includes(ABSENT)).join("&");
  return path + (kept && "?") + kept + part;
}
