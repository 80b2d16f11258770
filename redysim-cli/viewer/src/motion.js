// Where every link is at a time: the coordinates of the joints between the recorded instants, and the links that they carry.

import { Quaternion, Vector3 } from "three";

export class Motion {
  /** `t`, the instants, and for each joint its coordinates `q` and rates `v` at them; `bodies`, the ground and the links. */
  constructor({ t, q, v }, bodies) {
    Object.assign(this, { t, q, v });
    this.joints = bodies.slice(1).map(({ joint }) => ({
      ...joint,
      axis: new Vector3(...joint.axis),
      position: new Vector3(...joint.position),
      rotation: new Quaternion(...joint.rotation),
    }));
    this.poses = bodies.map(() => ({ position: new Vector3(), rotation: new Quaternion() }));
    this.order = parentsFirst(this.joints);
    this.turn = new Quaternion();
    this.seek(this.start);
  }

  get start() {
    return this.t[0];
  }

  get end() {
    return this.t[this.t.length - 1];
  }

  /** Goes to `time`, which it keeps within the run: `poses` has the ground and then every link there. */
  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.frame = indexAt(this.t, this.time);
    const [before, after] = [this.t[this.frame], this.t[this.frame + 1]];
    this.part = after > before ? (this.time - before) / (after - before) : 0;
    for (const link of this.order) this.#carry(link);
  }

  #carry(link) {
    const { parent, turn, slide, axis, offset, coordinate, position, rotation } = this.joints[link];
    const [carrier, pose] = [this.poses[parent], this.poses[link + 1]];
    const value = coordinate === null ? 0 : offset + this.#coordinate(coordinate);
    pose.rotation.copy(rotation);
    pose.position.set(0, 0, 0);
    if (turn) pose.rotation.multiply(this.turn.setFromAxisAngle(axis, turn * value));
    if (slide) pose.position.copy(axis).multiplyScalar(slide * value).applyQuaternion(rotation);
    pose.position.add(position).applyQuaternion(carrier.rotation).add(carrier.position);
    pose.rotation.premultiply(carrier.rotation);
  }

  /** The cubic that has the coordinates and rates of the instants before and after. */
  #coordinate(joint) {
    const { t, frame, part } = this;
    const [q, v] = [this.q[joint], this.v[joint]];
    if (part === 0) return q[frame];
    const [step, rest] = [t[frame + 1] - t[frame], 1 - part];
    const ends = rest * rest * (1 + 2 * part) * q[frame] + part * part * (1 + 2 * rest) * q[frame + 1];
    return ends + part * rest * step * (rest * v[frame] - part * v[frame + 1]);
  }
}

/** The numbers of the links, each after the one that carries it. */
function parentsFirst(joints) {
  const order = [];
  const waiting = joints.map((_, link) => link);
  const placed = new Set([0]);
  while (waiting.length > order.length) {
    for (const link of waiting) {
      if (placed.has(link + 1) || !placed.has(joints[link].parent)) continue;
      placed.add(link + 1);
      order.push(link);
    }
  }
  return order;
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
