// Where every link is at a time, between the recorded frames.

import { Quaternion, Vector3 } from "three";

/** Numbers that a pose has: origin x, y, z and quaternion x, y, z, w. */
const POSE = 7;

export class Motion {
  /** `poses`: the instants `t`, and for each the poses of all `links` in `values`. */
  constructor(poses, links) {
    this.t = poses.t;
    this.values = poses.values;
    this.links = links;
    this.other = { position: new Vector3(), rotation: new Quaternion() };
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
  }

  /** Puts the pose of link number `link` at the present time into `position` and `rotation`. */
  pose(link, position, rotation) {
    this.at(this.frame, link, position, rotation);
    if (this.part > 0) {
      this.at(this.frame + 1, link, this.other.position, this.other.rotation);
      position.lerp(this.other.position, this.part);
      rotation.slerp(this.other.rotation, this.part);
    }
  }

  /** Puts the pose of link number `link` in frame number `frame` into `position` and `rotation`. */
  at(frame, link, position, rotation) {
    const from = (frame * this.links + link) * POSE;
    position.fromArray(this.values, from);
    rotation.fromArray(this.values, from + 3).normalize();
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
