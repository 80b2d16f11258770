// A recorded motion: the coordinates between its instants, and the links there.

/** Instants at most that are looked at to see how far the mechanism reaches. */
const LOOKS = 300;

export class Motion {
  /** `t`, the instants, and for each coordinate its values `q` and rates `v` at them. */
  constructor({ t, q, v }, linkage) {
    Object.assign(this, { t, q, v, linkage });
    this.seek(this.start);
  }

  get start() {
    return this.t[0];
  }

  get end() {
    return this.t[this.t.length - 1];
  }

  /** Goes to `time`, which it keeps within the run. */
  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.frame = indexAt(this.t, this.time);
    const [before, after] = [this.t[this.frame], this.t[this.frame + 1]];
    this.part = after > before ? (this.time - before) / (after - before) : 0;
    this.linkage.place(this.q.map((_, coordinate) => this.#coordinate(coordinate)));
  }

  /** Calls `look` at positions that show how far the mechanism reaches, and goes to the start. */
  visit(look) {
    const every = Math.max(1, Math.floor(this.t.length / LOOKS));
    for (let frame = 0; frame < this.t.length; frame += every) {
      this.seek(this.t[frame]);
      look();
    }
    this.seek(this.start);
  }

  /** Calls `look` where the mechanism must be above the ground. */
  stand(look) {
    this.visit(look);
  }

  /** The cubic that has the coordinates and rates of the instants before and after. */
  #coordinate(coordinate) {
    const { t, frame, part } = this;
    const [q, v] = [this.q[coordinate], this.v[coordinate]];
    if (part === 0) return q[frame];
    const [step, rest] = [t[frame + 1] - t[frame], 1 - part];
    const ends = rest * rest * (1 + 2 * part) * q[frame] + part * part * (1 + 2 * rest) * q[frame + 1];
    return ends + part * rest * step * (rest * v[frame] - part * v[frame + 1]);
  }
}

/** The number of the last of the ascending `times` that is not after `time`; the first if all are. */
export function indexAt(times, time) {
  let [low, high] = [0, times.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}
