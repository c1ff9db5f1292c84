// A sim in a frame, or a lesson with its sim, by the messages that any page around one may use. In a sandboxed frame
// both are without an origin, and a message can be sent to that by no other name than "*".
export const data = JSON.parse(document.getElementById("class").textContent);

export class Stage {
  constructor(frame, takers) {
    this.frame = frame;
    this.takers = takers;
    addEventListener("message", ({ source, origin, data: message }) => {
      if (source === frame.contentWindow && origin === self.origin) takers[message?.type]?.(message);
    });
  }

  load(address) {
    this.frame.src = `${data.base}/${address}`;
  }

  set(params, seconds) {
    this.frame.contentWindow.postMessage({ type: "sim3:set", params, ...(seconds ? { seconds } : {}) }, "*");
  }
}
