// The scene as a picture, once it shows a state.
import { drawnVersion, sceneCanvas } from "./viser_dom.js";

const PATIENCE = 5000; // milliseconds after which a scene that isn't drawn has no picture
const frame = () => new Promise(requestAnimationFrame);

// A PNG as a data address; null where nothing is drawn. What arrived is on the canvas with the frame after next.
export async function picture(version) {
  const until = performance.now() + PATIENCE;
  while (!(drawnVersion() >= version)) {
    if (performance.now() > until) return null;
    await frame();
  }
  await frame();
  await frame();
  await frame();
  return sceneCanvas()?.toDataURL("image/png") ?? null;
}
