// Filters the launcher as somebody types: what has all the words stays.
const field = document.getElementById("find");
const none = document.querySelector(".none");
const items = [...document.querySelectorAll("[data-filtered] > [data-words]")];
const cards = items.filter((item) => item.matches(".card"));

field.closest("[hidden]").hidden = false;
field.addEventListener("input", filter);
none.querySelector("button").addEventListener("click", () => {
  field.value = "";
  filter();
  field.focus();
});
filter(); // a browser that comes back has kept what was typed

function filter() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const item of items) item.hidden = !words.every((word) => item.dataset.words.includes(word));
  const left = cards.filter((card) => !card.hidden).length;
  none.hidden = left > 0;
  document.querySelector(".find [role=status]").textContent = words.length ? `${left} of ${cards.length}` : "";
}
