// Where every link is: forward kinematics, from the coordinates to the links that the joints carry.

import { Euler, Quaternion, Vector3 } from "three";

/** Of a free joint, how many coordinates are those of its position. */
const LENGTHS = 3;
/** Roll, pitch and yaw turn about the fixed axes x, y, z one after the other. */
const ORDER = "ZYX";

export class Linkage {
  /** `bodies`, the ground and the links. */
  constructor(bodies) {
    this.joints = bodies.slice(1).map(({ joint }) => ({
      ...joint,
      motions: joint.motions.map((motion) => ({ ...motion, axis: new Vector3(...motion.axis) })),
      position: new Vector3(...joint.position),
      rotation: new Quaternion(...joint.rotation),
    }));
    /** The ground and then every link. */
    this.poses = bodies.map(() => ({ position: new Vector3(), rotation: new Quaternion() }));
    this.order = parentsFirst(this.joints);
    this.turn = new Quaternion();
  }

  /** Puts the links where they are at coordinates `q`: rad, m or parts of quaternions. */
  place(q) {
    for (const link of this.order) this.#carry(link, q);
  }

  /** The numbers of the links that carry a body, itself among them; none for the ground. */
  carriers(body) {
    const links = [];
    for (let at = body; at > 0; at = this.joints[at - 1].parent) links.push(at - 1);
    return links;
  }

  /** How the body of a link moves for a unit of each of its coordinates, in the base frame: `spin` and, of its origin,
   * `slide`. Of quaternions there is none. */
  freedoms(link, q) {
    const { coordinate, orientation, kind, motions, offset, parent, rotation } = this.joints[link];
    if (coordinate === null) return [];
    const still = this.poses[parent].rotation.clone().multiply(rotation);
    if (!orientation) {
      return motions.map(({ axis, turn, slide }, index) => {
        const along = axis.clone().applyQuaternion(still);
        if (turn) still.multiply(this.turn.setFromAxisAngle(axis, turn * (offset + q[coordinate + index])));
        const [spin, shift] = [along.clone().multiplyScalar(turn), along.multiplyScalar(slide)];
        return { coordinate: coordinate + index, spin, slide: shift };
      });
    }
    const lengths = kind === "free" ? LENGTHS : 0;
    const [, pitch, yaw] = q.slice(coordinate + lengths);
    const axes = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
    const [x, y] = [new Euler(0, pitch, yaw, ORDER), new Euler(0, 0, yaw, ORDER)];
    const spins = [axes[0].clone().applyEuler(x), axes[1].clone().applyEuler(y), axes[2]];
    const none = new Vector3();
    return [
      ...axes.slice(0, lengths).map((slide) => ({ spin: none, slide: slide.clone().applyQuaternion(still) })),
      ...spins.map((spin) => ({ spin: spin.clone().applyQuaternion(still), slide: none })),
    ].map((freedom, index) => ({ coordinate: coordinate + index, ...freedom }));
  }

  #carry(link, q) {
    const { parent, motions, offset, coordinate, orientation, kind, position, rotation } = this.joints[link];
    const [carrier, pose] = [this.poses[parent], this.poses[link + 1]];
    pose.rotation.copy(rotation);
    pose.position.set(0, 0, 0);
    if (orientation) {
      const lengths = kind === "free" ? LENGTHS : 0;
      if (lengths) pose.position.fromArray(q, coordinate).applyQuaternion(rotation);
      pose.rotation.multiply(this.#turned(orientation, q.slice(coordinate + lengths)));
    } else {
      motions.forEach(({ axis, turn, slide }, index) => {
        const value = coordinate === null ? 0 : offset + q[coordinate + index];
        if (slide) pose.position.add(axis.clone().multiplyScalar(slide * value).applyQuaternion(pose.rotation));
        if (turn) pose.rotation.multiply(this.turn.setFromAxisAngle(axis, turn * value));
      });
    }
    pose.position.add(position).applyQuaternion(carrier.rotation).add(carrier.position);
    pose.rotation.premultiply(carrier.rotation);
  }

  /** The rotation that the first of `values` give: a quaternion of any length, or roll, pitch and yaw. */
  #turned(orientation, values) {
    if (orientation === "quaternion") return this.turn.fromArray(values).normalize();
    const [roll, pitch, yaw] = values;
    return this.turn.setFromEuler(new Euler(roll, pitch, yaw, ORDER));
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
