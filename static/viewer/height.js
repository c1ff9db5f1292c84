// How high the frame would best be: for course pages, and for Canvas and H5P, if they answer in their own words.
import { column, embedded, sim } from "./page.js";

const REST = 400;

export class Height {
  constructor(host) {
    this.host = host;
    this.canvas = false;
    this.h5p = false;
    this.told = 0;
    this.telling = 0;
  }

  begin() {
    this.host.postRaw({ subject: "lti.capabilities" });
    this.host.postRaw({ context: "h5p", action: "hello" });
    this.tell();
  }

  tellSoon() {
    if (!embedded || !sim.live) return;
    clearTimeout(this.telling);
    this.telling = setTimeout(() => Math.abs(wanted() - this.told) > 8 && this.tell(), REST);
  }

  tell() {
    const height = (this.told = wanted());
    this.host.post({ type: "sim3:height", height });
    if (this.canvas) this.host.postRaw({ subject: "lti.frameResize", height });
    // H5P's own content asks first for a frame of no height, to measure itself: a scene would be drawn anew for that.
    if (this.h5p) this.host.postRaw({ context: "h5p", action: "resize", scrollHeight: height, clientHeight: innerHeight });
  }

  // What a learning platform answers in its own words; false if it is none of that.
  hear({ subject, supported_messages: messages, context, action }) {
    if (subject === "lti.capabilities.response") this.canvas = messages?.some((one) => one.subject === "lti.frameResize");
    else if (context === "h5p" && ["hello", "resize"].includes(action)) this.h5p = true;
    else return;
    this.tell();
  }
}

// As high as the controls and read-outs need beside the scene, or below it on a phone, within reason.
function wanted() {
  const beside = column.offsetLeft > 0;
  const needs = (beside ? 0 : column.offsetTop) + column.scrollHeight;
  return Math.round(Math.min(Math.max(beside ? 480 : 640, needs), 900));
}
