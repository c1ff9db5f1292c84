// A dialog of the page's own: one at a time.
import { element } from "./page.js";

export function dialog(title, html) {
  document.querySelector("dialog.s3-dialog")?.remove();
  const box = element("dialog", { class: "s3-dialog", "aria-label": title, tabindex: "-1" });
  box.innerHTML = `<h2>${title}</h2>${html}<button type="button" data-s3="close">Close</button>`;
  box.showModal();
  if (box.scrollTop) box.focus(); // what has the focus lies below what is read first
  box.scrollTop = 0;
  return box;
}
