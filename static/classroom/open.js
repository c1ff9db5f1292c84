// Where a class is opened: only the challenges of the sim that is chosen.
const page = document.querySelector("#page");
const challenge = document.querySelector("#challenge");

function follow() {
  const slug = page.value.split("/")[1];
  const own = page.value.startsWith("lessons/"); // the server knows of which sim it is
  for (const group of challenge.querySelectorAll("optgroup")) group.hidden = !own && group.dataset.sim !== slug;
  if (challenge.selectedOptions[0]?.parentElement.hidden) challenge.value = "";
}

page.addEventListener("change", follow);
follow();
