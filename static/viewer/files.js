// Files that a learner uploads: sent as they are, with how far they are; the state comes over the channel.
import { sim } from "./page.js";

export class Files {
  constructor(words) {
    this.words = words;
    this.said = "";
    this.share = null; // of the file that has come
    this.request = null;
    document.addEventListener("change", (event) => {
      if (!event.target.matches?.("[data-s3-file]") || !event.target.files.length) return;
      this.upload(event.target.files[0]);
      event.target.value = ""; // so that the same file can be uploaded again
    });
    if (!sim.files || sim.watching) return;
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      if (event.dataTransfer?.files.length) this.upload(event.dataTransfer.files[0]);
    });
  }

  show() {
    const bar = document.querySelector(".s3-upload progress");
    const words = document.querySelector("[data-s3-file-status]");
    if (!bar || (!this.said && bar.hidden)) return;
    bar.hidden = bar.nextElementSibling.hidden = this.share === null;
    if (this.share === 1) bar.removeAttribute("value");
    else if (this.share !== null) bar.value = this.share;
    if (this.said && words.textContent !== this.said) words.textContent = this.said;
  }

  say(words, share = null) {
    this.said = words;
    this.share = share;
    this.show();
    // A file can be dropped anywhere, also while the controls of files are folded away.
    if (!document.querySelector(".s3-upload")?.checkVisibility()) this.words.notify(words);
  }

  refused(words) {
    this.say(`⚠ ${words} Nothing has changed.`);
    const fold = document.querySelector(".s3-upload")?.closest("details");
    if (fold) fold.open = true; // where the words stay when the notice has gone
  }

  giveUp() {
    this.request.abort();
  }

  upload(file) {
    const size = `${(file.size / 1e6).toFixed(1)} MB`;
    if (file.size > sim.files.largest) {
      this.refused(`“${file.name}” has ${size}; at most ${sim.files.largest / 1e6} MB are taken.`);
      return;
    }
    const request = (this.request = new XMLHttpRequest());
    const failed = (words) => this.refused(`“${file.name}”: ${words}`);
    request.open("POST", `${sim.place}file?name=${encodeURIComponent(file.name)}`);
    request.upload.onprogress = (event) => this.say(`Sending “${file.name}”, ${size}…`, event.loaded / event.total * 0.999);
    request.upload.onload = () => this.say(`Reading “${file.name}”, ${size}…`, 1);
    request.onerror = () => failed("The connection broke off.");
    request.onabort = () => failed("It was given up.");
    request.onload = () => {
      if (request.status === 200) this.say(`“${file.name}” is shown.`);
      else failed(refusal(request.responseText));
    };
    this.say(`Sending “${file.name}”, ${size}…`, 0);
    request.send(file);
  }
}

function refusal(text) {
  try {
    return JSON.parse(text).detail;
  } catch {
    return "The server didn't take it."; // its words aren't ours
  }
}
