// The base of a mechanism that floats, which the camera can follow.

import { Vector3 } from "three";

export class Base {
  /** Of a mechanism that touches the ground, `normal` is that of the ground. */
  constructor(body, linkage, normal) {
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

/** The base that floats, with the mechanism at its start: of several, the one that carries the most links. */
export function floatingBase({ bodies, contacts }, linkage) {
  const floats = ({ joint }) => joint?.kind === "free" && joint.coordinate !== null && joint.parent === 0;
  const carried = bodies.map(() => 0);
  for (const body of bodies.keys()) for (const link of linkage.carriers(body)) carried[link + 1] += 1;
  const bases = [...bodies.keys()].filter((body) => floats(bodies[body])).sort((a, b) => carried[b] - carried[a]);
  return bases.length ? new Base(bases[0], linkage, contacts?.normal) : null;
}
