// Messages of poses (clients/web/README.md has their layout), and poses between two of them by their time stamps.

export function decode(buffer) {
  const view = new DataView(buffer);
  const at = (offset) => view.getUint32(offset, true);
  const frame = {
    isKey: view.getUint8(0) === 1, run: at(4), time: view.getFloat64(8, true), stamp: view.getFloat64(16, true),
    step: view.getFloat64(24, true), number: at(32), key: at(36), revision: at(40),
  };
  const bodies = at(44), shafts = at(48), exact = at(52);
  let offset = 56;
  const take = (Type, count) => {
    const out = new Type(buffer, offset, count);
    offset += out.byteLength;
    return out;
  };
  const align = () => { offset = Math.ceil(offset / 8) * 8; };
  frame.names = take(Uint32Array, bodies);
  frame.positions = take(Float32Array, 3 * bodies);
  frame.rotations = take(Int16Array, 4 * bodies);
  frame.shaftNames = take(Uint32Array, shafts);
  align();
  frame.shafts = take(Float64Array, 2 * shafts);
  const handles = take(Uint32Array, exact);
  align();
  frame.exact = new Map();
  for (const handle of handles) frame.exact.set(handle, take(Float64Array, 13));
  return frame;
}

function sameNumbers(a, b) {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return false;
  return true;
}

// Complete moments, of the last few messages.
const kMostMoments = 12;

export class Poses {
  constructor() { this.clear(); }

  clear() {
    this.key = null;
    this.moments = [];
    this.layout = null; // { bodies: Map handle -> place, shafts: Map handle -> place, handles, shaftHandles }
    this.offset = Infinity; // ms: smallest difference seen between this clock and the server's stamps
    this.interval = 30;     // ms between moments, smoothed
    this.received = 0;
  }

  // The moment that a message completes; null: its key frame did not come.
  add(buffer) {
    const frame = decode(buffer);
    ++this.received;
    if (frame.isKey) {
      if (!this.layout || !sameNumbers(this.layout.handles, frame.names) || !sameNumbers(this.layout.shaftHandles, frame.shaftNames)) {
        this.layout = {
          handles: frame.names, shaftHandles: frame.shaftNames,
          bodies: new Map(Array.from(frame.names, (handle, place) => [handle, place])),
          shafts: new Map(Array.from(frame.shaftNames, (handle, place) => [handle, place])),
        };
      }
      this.key = frame;
    } else if (!this.key || this.key.number !== frame.key) return null;
    const moment = { ...frame, layout: this.layout };
    if (!frame.isKey) {
      moment.positions = this.key.positions.slice();
      moment.rotations = this.key.rotations.slice();
      moment.shafts = this.key.shafts.slice();
      frame.names.forEach((place, i) => {
        moment.positions.set(frame.positions.subarray(3 * i, 3 * i + 3), 3 * place);
        moment.rotations.set(frame.rotations.subarray(4 * i, 4 * i + 4), 4 * place);
      });
      frame.shaftNames.forEach((place, i) => moment.shafts.set(frame.shafts.subarray(2 * i, 2 * i + 2), 2 * place));
    }
    const last = this.moments.at(-1);
    // After a reset or a rewind nothing lies between before and after.
    if (last && (last.run !== moment.run || moment.time < last.time)) this.moments.length = 0;
    else if (last) this.interval += 0.1 * (Math.min(200, moment.stamp - last.stamp) - this.interval);
    this.moments.push(moment);
    if (this.moments.length > kMostMoments) this.moments.shift();
    // The fastest way of a message counts; it may become slower over time.
    this.offset = Math.min(this.offset + 0.05, performance.now() - moment.stamp);
    return moment;
  }

  get newest() { return this.moments.at(-1) ?? null; }

  // Two moments and the share of the second, for what is seen at `now` (ms, performance.now()); null: there are none.
  between(now) {
    const last = this.newest;
    if (!last) return null;
    const stamp = now - this.offset - 1.5 * this.interval;
    for (let i = this.moments.length - 1; i > 0; --i) {
      const a = this.moments[i - 1], b = this.moments[i];
      if (a.stamp <= stamp && stamp < b.stamp && a.layout === b.layout) return { a, b, share: (stamp - a.stamp) / (b.stamp - a.stamp) };
      if (a.stamp <= stamp && stamp < b.stamp) return { a: b, b, share: 1 };
    }
    const only = stamp >= last.stamp ? last : this.moments[0];
    return { a: only, b: only, share: 1 };
  }
}

// Position and rotation (w x y z) of the body at `place`, into out[at ..]: seven numbers.
export function mixBody({ a, b, share }, place, out, at) {
  const p = 3 * place, q = 4 * place;
  for (let i = 0; i < 3; ++i) out[at + i] = a.positions[p + i] + share * (b.positions[p + i] - a.positions[p + i]);
  let dot = 0;
  for (let i = 0; i < 4; ++i) dot += a.rotations[q + i] * b.rotations[q + i];
  const sign = dot < 0 ? -1 : 1;
  let square = 0;
  for (let i = 0; i < 4; ++i) {
    const value = (1 - share) * a.rotations[q + i] + share * sign * b.rotations[q + i];
    out[at + 3 + i] = value;
    square += value * value;
  }
  const scale = square > 0 ? 1 / Math.sqrt(square) : 0;
  for (let i = 0; i < 4; ++i) out[at + 3 + i] *= scale;
}

export function mixAngle({ a, b, share }, place) { return a.shafts[2 * place] + share * (b.shafts[2 * place] - a.shafts[2 * place]); }
