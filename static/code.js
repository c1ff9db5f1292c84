// The scripts of a lesson's page: they have the numbers of the sim beside them, once it rests.
const REST = 300; // milliseconds without another state
const section = document.querySelector("[data-code]");
const frame = document.querySelector("iframe[data-slug]");
let shown = null;
let waiting = 0;
let asking = new AbortController();

addEventListener("message", ({ origin, source, data }) => {
  if (origin !== self.origin || source !== frame.contentWindow || data?.type !== "sim3:state") return;
  if (data.query === shown) return;
  shown = data.query;
  clearTimeout(waiting);
  asking.abort(); // the newest wins
  waiting = setTimeout(follow, REST, data.query);
});

async function follow(query) {
  asking = new AbortController();
  try {
    await Promise.all([...section.querySelectorAll(".script")].map((place) => show(place, query, asking.signal)));
  } catch {
    if (shown === query) shown = null; // given up for a newer one, or not to be had now
  }
}

async function show(place, query, signal) {
  const address = `${section.dataset.code}?lang=${place.dataset.lang}${query && "&" + query}`;
  const answer = await fetch(address, { signal });
  if (!answer.ok) throw new Error(answer.statusText);
  const text = await answer.text();
  if (signal.aborted) return;
  place.querySelector("code").textContent = text;
  for (const link of place.querySelectorAll("[data-format]")) {
    link.href = link.dataset.format === "py" ? address : `${address}&format=${link.dataset.format}`;
  }
}
