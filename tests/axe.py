"""What axe finds on a page.

Its rule on contrast takes most of the time, and finds the same at each text of one look: it is asked of one of each.
"""

from __future__ import annotations

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
COLOURS = ["link-in-text-block"]
"""Rules whose answer differs by the theme, beside the one on contrast."""
# Marks of all texts of one look the longest (axe has no opinion on single letters). A look is colour, size and weight,
# and all that paints or places what is behind.
MARK = """() => {
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
  const longest = new Map();
  for (const node of document.querySelectorAll("body *")) {
    delete node.dataset.look;
    const length = says(node).length;
    if (!length || !node.checkVisibility()) continue;
    const { color, fontSize, fontWeight, textShadow } = getComputedStyle(node);
    const look = [color, fontSize, fontWeight, textShadow, behind(node)].join();
    if (length > (longest.get(look)?.length ?? 0)) longest.set(look, { node, length });
  }
  for (const { node } of longest.values()) node.dataset.look = "";
}"""
RUN = """async (rules) => {
  const told = { resultTypes: ["violations"] };
  const exclude = ["iframe"];
  const all = await axe.run({ exclude }, { ...told, runOnly: rules, rules: { "color-contrast": { enabled: false } } });
  const looks = await axe.run({ exclude, include: ["[data-look]"] }, { ...told, runOnly: ["color-contrast"] });
  return [...all.violations, ...looks.violations].flatMap(({ id, impact, nodes }) => nodes.map(
    ({ target, html, failureSummary }) => `${id} (${impact}): ${target} ${html.slice(0, 200)} ${failureSummary}`));
}"""


def findings(page: Page, rules: list[str] = TAGS) -> list[str]:
    """What axe finds, in words, by all rules with those tags or by single ones, and by the one on contrast.

    Frames in the page are not looked into.
    """
    if not page.evaluate("'axe' in window"):
        page.evaluate(Axe().axe_script)
    page.evaluate(MARK)
    found: list[str] = page.evaluate(RUN, rules)
    return found
