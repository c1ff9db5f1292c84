"""What axe finds on a page.

Two of its rules take most of the time and find the same at each text of one look, on whichever page: whether a text can
be read on what is behind it, and a link be told from the words around it. They are asked of one of each look.
"""

from __future__ import annotations

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
OF_LOOKS = ["color-contrast", "link-in-text-block"]
"""The rules that are asked of looks."""
READABLE: set[str] = set()
"""Looks at which nothing was found."""
# Marks of all texts of one look the longest (axe has no opinion on single letters), but of those that are known. A look
# is colour, size and weight, and all that paints or places what is behind; a link's, those of the words around it too.
MARK = """(readable) => {
  const known = new Map();
  const behind = (node) => {
    if (!node) return "";
    if (!known.has(node)) {
      const { backgroundColor, backgroundImage, opacity, filter, position } = getComputedStyle(node);
      const own = [backgroundColor, backgroundImage, opacity, filter].join();
      const there = position === "static" ? "" : [position, node.tagName, node.getAttribute("class")].join();
      known.set(node, behind(node.parentElement) + (own === "rgba(0, 0, 0, 0),none,1,none" ? "" : own) + there);
    }
    return known.get(node);
  };
  const says = (node) => node.matches("input, select, textarea") ? node.value :
    [...node.childNodes].map(({ nodeType, data }) => nodeType === Node.TEXT_NODE ? data.trim() : "").join("");
  const text = (node) => {
    const { color, fontSize, fontWeight, textShadow, textDecorationLine, borderBottom } = getComputedStyle(node);
    return [color, fontSize, fontWeight, textShadow, textDecorationLine, borderBottom].join();
  };
  const among = (link) => {
    let words = link.parentElement;
    while (getComputedStyle(words).display === "inline") words = words.parentElement;
    const alone = words.textContent.length <= 2 * link.textContent.length;
    return [text(link), text(link.parentElement), alone ? "alone" : "among words"];
  };
  const longest = new Map();
  for (const node of document.querySelectorAll("body *")) {
    delete node.dataset.look;
    const length = says(node).length;
    if (!length || !node.checkVisibility()) continue;
    const link = node.closest("a[href], [role=link]");
    const look = [text(node), behind(node), ...(link ? among(link) : [])].join();
    if (readable.includes(look) || length <= (longest.get(look)?.length ?? 0)) continue;
    longest.set(look, { node, link, length });
  }
  for (const { node, link } of longest.values()) (link ?? node).dataset.look = node.dataset.look = "";
  return [...longest.keys()];
}"""
RUN = """async ([rules, ofLooks]) => {
  const told = { resultTypes: ["violations"] };
  const exclude = ["iframe"];
  const off = Object.fromEntries(ofLooks.map((rule) => [rule, { enabled: false }]));
  const found = [];
  if (rules.length) found.push(await axe.run({ exclude }, { ...told, runOnly: rules, rules: off }));
  if (document.querySelector("[data-look]"))
    found.push(await axe.run({ exclude, include: ["[data-look]"] }, { ...told, runOnly: ofLooks }));
  return found.flatMap(({ violations }) => violations).flatMap(({ id, impact, nodes }) => nodes.map(
    ({ target, html, failureSummary }) => `${id} (${impact}): ${target} ${html.slice(0, 200)} ${failureSummary}`));
}"""


def findings(page: Page, *, colours_alone: bool = False) -> list[str]:
    """What axe finds, in words; of colours alone, what can differ by the theme.

    Frames in the page are not looked into.
    """
    if not page.evaluate("'axe' in window"):
        page.evaluate(Axe().axe_script)
    looks = page.evaluate(MARK, [*READABLE])
    found: list[str] = page.evaluate(RUN, [[] if colours_alone else TAGS, OF_LOOKS])
    if not found:
        READABLE.update(looks)
    return found
