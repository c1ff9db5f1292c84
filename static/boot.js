// Runs before viser's client and tells it three things where it looks for them, in the query of the address: which
// websocket is this page's, whether the theme is dark, and from where to look. The address itself holds the state from
// the first moment on, for those who reload or come back early, so viser is given another query where it reads it.
// A frame in a hidden tab or a closed <details> has no size: all begins when it gets one, and not before.
(() => {
  const boot = () => {
    const sim = JSON.parse(document.getElementById("sim3").textContent);
    const given = new URLSearchParams(location.search);
    const bytes = crypto.getRandomValues(new Uint8Array(8));
    const viewer = Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join("");
    const theme = given.get("theme");
    const dark = theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    // The room and its key are in the page, never in its address; a reload goes on in the room that it left.
    const reloaded = performance.getEntriesByType("navigation")[0]?.type === "reload";
    const path = (reloaded && history.state?.path) || sim.path;
    const opened = history.state?.opened ?? location.search;
    const place = new URL(path, location.href).href; // location.origin is "null" in a sandboxed frame
    const socket = place.replace(/^http/, "ws");

    const phone = innerWidth <= 576;
    const narrow = innerWidth < 900;
    const right = phone || given.get("controls") === "0" ? 0 : narrow ? 300 : 340;
    const left = sim.panes && !narrow ? 330 : 0;
    document.documentElement.style.setProperty("--s3-right", `${right}px`);
    document.documentElement.style.setProperty("--s3-left", `${left}px`);
    document.documentElement.dataset.controls = given.get("controls") ?? "1";
    // A viewpoint is chosen for a landscape scene; in a tall or narrow one, step back so that the same sphere fits.
    const fit = () => {
      const eye = sim.view.slice(0, 3);
      const target = sim.view.slice(3);
      const width = Math.max(innerWidth - left - right, 1);
      const height = phone ? innerHeight * 0.55 : innerHeight;
      const half = Math.tan(0.35) * Math.min(1, width / height) * (height / innerHeight);
      const distance = Math.hypot(...eye.map((v, i) => v - target[i]));
      const scale = sim.radius / Math.sin(Math.atan(half)) / distance;
      eye.forEach((v, i) => (eye[i] = target[i] + (v - target[i]) * scale));
      // On a phone the bottom sheet covers the lower part: look lower, so that the scene stands above it.
      if (phone) target[2] -= (eye[2] -= sim.radius * 0.75) && sim.radius * 0.75;
      return [...eye, ...target];
    };
    const view = given.get("view")?.replaceAll("−", "-").split(",").map(Number) ?? fit();

    const search = new URLSearchParams({
      websocket: `${socket}?viewer=${viewer}`,
      initialCameraPosition: view.slice(0, 3).join(","),
      initialCameraLookAt: view.slice(3).join(","),
      initialCameraFov: "0.7",
    });
    if (dark) {
      search.set("darkMode", "1");
      // viser writes labels in black on white in any theme. In the dark one their shaders are told its colours.
      const light = (color) => [1, 3, 5].map((k) => (parseInt(color.slice(k, k + 2), 16) / 255).toFixed(3)).join(", ");
      const { prototype } = WebGL2RenderingContext;
      const take = prototype.shaderSource;
      prototype.shaderSource = function (shader, source) {
        take.call(this, shader, source
          .replace("vec4(0.0, 0.0, 0.0, a)", `vec4(${light(sim.label.ink)}, a)`)
          .replace("vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)", `vec4(${light(sim.label.plate)}, 0.75 * vAlpha)`));
      };
    }
    const Query = URLSearchParams;
    window.URLSearchParams = class extends Query {
      constructor(init) {
        super(init === location.search ? search : init);
      }
    };
    if (self.origin === "null") {
      // In a sandboxed frame Chromium loads no module worker from a blob. viser's client then tries a data address.
      const Plain = Worker;
      window.Worker = class extends Plain {
        constructor(url, options) {
          if (options?.type === "module" && String(url).startsWith("blob:")) throw new Error("no module worker from a blob");
          super(url, options);
        }
      };
    }
    const replace = history.replaceState.bind(history);
    history.replaceState = (data, title, url) => title === "Viser" || replace(data, title, url);

    window.sim3 = { ...sim, Query, viewer, dark, place, socket, path, opened, search: location.search, fit };
    // Else phones widen the page for a menu that stands out at its side for a moment, the menu grows with it, and so on.
    document.querySelector("meta[name=viewport]").content += ", minimum-scale=1";
    document.documentElement.style.setProperty("--s3-still", `url(${sim.still[dark ? "dark" : "light"]})`);
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    document.documentElement.style.colorScheme = dark ? "dark" : "light";

    const start = () => {
      for (const attributes of sim.scripts) document.body.append(Object.assign(document.createElement("script"), attributes));
    };
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
