// The base of a mechanism that floats or drives, which the camera can follow.

import { Vector3 } from "three";

export class Base {
  /** Of a mechanism that touches the ground, `normal` is that of the ground. */
  constructor(body, linkage, normal) {
    /** For every body, whether the base carries it, as it does itself. */
    this.carried = linkage.poses.map((_, other) => linkage.carriers(other).includes(body - 1));
    this.position = linkage.poses[body].position;
    this.start = this.position.clone();
    this.normal = normal && new Vector3(...normal);
  }

  /** How far the base is from where it starts, m, in the base frame; over the ground alone, if there is a `normal`. */
  travel() {
    const way = this.position.clone().sub(this.start);
    return this.normal ? way.addScaledVector(this.normal, -way.dot(this.normal)) : way;
  }
}

/** The base that moves, with the mechanism at its start; null where there is none. */
export function movingBase({ base, contacts }, linkage) {
  return base === null ? null : new Base(base, linkage, contacts?.ground ? contacts.planes[0].normal : undefined);
}
