// Numbers of the controls: what a hand means by a place on a slider, and how a box spells a value.

// A hand on a slider means round numbers; its ends are exact.
export function stepped(input) {
  const [value, low, high, step] = [input.value, input.min, input.max, input.dataset.step].map(Number);
  if (value <= low || value >= high) return value;
  const near = Math.round(value / step) * step;
  return Math.min(Math.max(Number(near.toPrecision(12)), low), high);
}

// A number as a box shows it: exact up to six digits, with a true minus sign. The server spells it in the same way.
export function text(value) {
  if (typeof value !== "number") return value ?? "";
  const size = Math.abs(value);
  const spelled = size && (size < 1e-4 || size >= 1e6) ? value.toExponential(5).replace(/\.?0+e/, "e") : `${Number(value.toPrecision(6))}`;
  return spelled.replace("e+", "e").replaceAll("-", "−");
}

// What a slider says of itself, with its unit.
export function tellValue(input, value) {
  const unit = input.closest(".s3-slide")?.querySelector(".s3-unit")?.textContent ?? "";
  const says = `${text(value)}${unit && unit !== "°" ? " " : ""}${unit}`;
  if (input.getAttribute("aria-valuetext") !== says) input.setAttribute("aria-valuetext", says);
}
