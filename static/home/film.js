// What was recorded: of each frame which values the scene's nodes have, and what stands beside the scene.
const KINDS = {
  "<f4": Float32Array, "<f8": Float64Array, "|u1": Uint8Array, "<u2": Uint16Array, "<u4": Uint32Array,
  "|i1": Int8Array, "<i2": Int16Array, "<i4": Int32Array, "<f2": Uint16Array,
};

export async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Film(await new Response(stream).arrayBuffer());
}

class Film {
  constructor(buffer) {
    const length = Number(new DataView(buffer).getBigUint64(0, true));
    const told = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
    Object.assign(this, { keys: told.keys, parts: told.parts, texts: told.texts, said: told.said });
    let at = 8 + filled(length);
    const places = told.lengths.map((bytes) => [(at += filled(bytes)) - filled(bytes), bytes]);
    this.values = told.values.map((value) => whole(value, buffer, places));
    this.frames = tables(told.frames, this.keys.length);
    this.shown = this.keys.map(() => -1);
  }

  // What viser has to be told to show a frame after the one that it shows.
  messages(frame) {
    const wanted = this.frames[frame];
    const made = new Set();
    const told = [];
    this.keys.forEach(([name, what], key) => {
      if (what || this.shown[key] < 0 || this.shown[key] === wanted[key]) return;
      made.add(name);
      if (wanted[key] < 0) told.push({ type: "RemoveSceneNodeMessage", name, owner: this.values[this.shown[key]].owner });
    });
    this.keys.forEach(([name], key) => {
      if (made.has(name)) this.shown[key] = -1;
      if (wanted[key] >= 0 && wanted[key] !== this.shown[key]) told.push({ ...this.values[wanted[key]] });
      this.shown[key] = wanted[key];
    });
    return told;
  }

  // Name and HTML of each part beside the scene.
  words(frame) {
    return this.parts.map((name, k) => [name, this.texts[this.said[frame][k]]]);
  }
}

function filled(bytes) {
  return Math.ceil(bytes / 8) * 8;
}

function tables(frames, count) {
  let table = new Array(count).fill(-1);
  return frames.map((changes) => {
    table = table.slice();
    for (let k = 0; k < changes.length; k += 2) table[changes[k]] = changes[k + 1];
    return table;
  });
}

// A value with its arrays in place of where they are.
function whole(value, buffer, places) {
  if (Array.isArray(value)) return value.map((each) => whole(each, buffer, places));
  if (typeof value !== "object" || value === null) return value;
  if ("array@" in value) {
    const [at, bytes] = places[value["array@"]];
    const Kind = KINDS[value.dtype];
    return new Kind(buffer, at, bytes / Kind.BYTES_PER_ELEMENT);
  }
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, whole(each, buffer, places)]));
}
