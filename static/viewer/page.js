// What the server and boot.js say of this page, and the browser's own classes before viser's are put in their place.
export const sim = window.sim3;
export const Query = URLSearchParams;
export const embedded = window.parent !== window;
export const IDLE = 4408; // code of a websocket in whose room nobody has done anything for long
export const reduced = matchMedia("(prefers-reduced-motion: reduce)");
export const column = document.querySelector(".s3-column");
export const scene = document.querySelector(".s3-scene");

export function element(tag, attributes = {}, parent = document.body) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  parent.append(node);
  return node;
}
