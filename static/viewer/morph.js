// Makes what is in a node what some HTML says, and touches only what differs: focus, a held handle and what somebody
// types stay where they are.
const OPENED = ".s3-why, .s3-wrong"; // what this page alone knows of: whether it is open, and what it says
const KEPT = new Set(["open", "value", "checked", "selected", "aria-invalid", "aria-valuetext"]); // what inputs show is told beside
const PARSER = document.createElement("template");

export function morph(node, html) {
  PARSER.innerHTML = html;
  children(node, PARSER.content);
  PARSER.innerHTML = "";
}

function children(old, wanted) {
  let at = old.firstChild;
  for (const next of [...wanted.childNodes]) {
    if (!at) {
      old.append(next);
    } else if (alike(at, next)) {
      const same = at;
      at = at.nextSibling;
      become(same, next);
    } else {
      const gone = at;
      at = at.nextSibling;
      gone.replaceWith(next);
    }
  }
  while (at) {
    const gone = at;
    at = at.nextSibling;
    gone.remove();
  }
}

// Handles, parts and links keep their nodes: who holds one goes on holding it.
function alike(a, b) {
  if (a.nodeType !== b.nodeType || a.nodeName !== b.nodeName) return false;
  if (a.nodeType !== Node.ELEMENT_NODE) return true;
  return ["data-handle", "data-part", "data-pick", "id"].every((name) => a.getAttribute(name) === b.getAttribute(name));
}

function become(old, next) {
  if (old.nodeType !== Node.ELEMENT_NODE) {
    if (old.data !== next.data) old.data = next.data;
    return;
  }
  if (old.matches(OPENED)) return;
  for (const { name, value } of next.attributes) if (name !== "aria-expanded" && old.getAttribute(name) !== value) old.setAttribute(name, value);
  for (const { name } of [...old.attributes]) if (!next.hasAttribute(name) && !KEPT.has(name)) old.removeAttribute(name);
  children(old, next);
}
