// Where every link is: forward kinematics, from the coordinates to the links that the joints carry.

import { Quaternion, Vector3 } from "three";

export class Linkage {
  /** `bodies`, the ground and the links. */
  constructor(bodies) {
    this.joints = bodies.slice(1).map(({ joint }) => ({
      ...joint,
      axis: new Vector3(...joint.axis),
      position: new Vector3(...joint.position),
      rotation: new Quaternion(...joint.rotation),
    }));
    /** The ground and then every link. */
    this.poses = bodies.map(() => ({ position: new Vector3(), rotation: new Quaternion() }));
    this.order = parentsFirst(this.joints);
    this.turn = new Quaternion();
  }

  /** Puts the links where they are at coordinates `q`, rad or m. */
  place(q) {
    for (const link of this.order) this.#carry(link, q);
  }

  /** The numbers of the links that carry a body, itself among them; none for the ground. */
  carriers(body) {
    const links = [];
    for (let at = body; at > 0; at = this.joints[at - 1].parent) links.push(at - 1);
    return links;
  }

  #carry(link, q) {
    const { parent, turn, slide, axis, offset, coordinate, position, rotation } = this.joints[link];
    const [carrier, pose] = [this.poses[parent], this.poses[link + 1]];
    const value = coordinate === null ? 0 : offset + q[coordinate];
    pose.rotation.copy(rotation);
    pose.position.set(0, 0, 0);
    if (turn) pose.rotation.multiply(this.turn.setFromAxisAngle(axis, turn * value));
    if (slide) pose.position.copy(axis).multiplyScalar(slide * value).applyQuaternion(rotation);
    pose.position.add(position).applyQuaternion(carrier.rotation).add(carrier.position);
    pose.rotation.premultiply(carrier.rotation);
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
