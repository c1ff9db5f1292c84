// Gives a person a text or a file.
import { element } from "./page.js";

// A frame that is sandboxed may not save files unless it is allowed to, and isn't told.
export const doubt = self.origin === "null" ? "If nothing is saved, the page around doesn’t allow it: open the sim in a tab of its own." : "";

// Copies a text; whether that was allowed is what is returned.
export async function copied(text) {
  try {
    // Frames of other sites may not; asking all the same would leave an error in the console.
    if (document.featurePolicy?.allowsFeature("clipboard-write") === false) return false;
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false; // without HTTPS browsers give no clipboard
  }
}

export function download(href, name) {
  const link = element("a", { href, download: name });
  link.click();
  link.remove();
}
