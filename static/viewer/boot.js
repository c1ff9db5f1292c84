// Runs before the page is first painted: says what the page is like, keeps a still picture until the scene is live,
// and starts the rest. A frame in a hidden tab or a closed <details> has no size: all begins when it gets one.
(() => {
  const data = JSON.parse(document.getElementById("sim3").textContent);
  const root = document.documentElement;
  root.classList.toggle("s3-led", window.name === "lesson"); // the text around says what to do (names of frames: base.html)

  const boot = () => {
    const given = new URLSearchParams(location.search);
    const bytes = crypto.getRandomValues(new Uint8Array(8));
    const theme = given.get("theme");
    const dark = theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    // The room and its key are in the page, never in its address; a reload goes on in the room that it left.
    const reloaded = performance.getEntriesByType("navigation")[0]?.type === "reload";
    const path = (reloaded && history.state?.path) || data.path;
    const place = new URL(path, location.href).href; // location.origin is "null" in a sandboxed frame

    root.style.setProperty("--s3-still", `url(${data.still[dark ? "dark" : "light"]})`);
    root.style.colorScheme = dark ? "dark" : "light";
    root.dataset.theme = dark ? "dark" : "light";

    window.sim3 = {
      ...data, dark, place, path, keyed: !data.watching,
      viewer: Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join(""),
      socket: place.replace(/^http/, "ws"), search: location.search, opened: history.state?.opened ?? location.search,
    };
    const start = () => document.body.append(Object.assign(document.createElement("script"), { src: data.main, type: "module" }));
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start);
    else start();
  };

  const begin = () => {
    if (!innerWidth || !innerHeight) return;
    removeEventListener("resize", begin);
    clearInterval(looking);
    boot();
  };
  // A page that isn't painted, as one behind others, is told of no resize.
  const looking = setInterval(begin, 200);
  addEventListener("resize", begin);
  begin();
})();
