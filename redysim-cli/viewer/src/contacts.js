// The forces of the ground on the mechanism, as arrows, and footprints where it touched down.

import { ArrowHelper, CircleGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3 } from "three";
import { indexAt } from "./motion.js";

const FORCE = "#cc3311";
const FOOTPRINT = "#555e68";
const Z = new Vector3(0, 0, 1);

export class Contacts {
  /** `size` is the radius of all that the mechanism ever reaches, m. */
  constructor({ planes, t, places }, linkage, size) {
    Object.assign(this, { t, places, linkage, size });
    this.root = new Group();
    const sizes = places.flatMap(({ forces }) => forces.map((force) => Math.hypot(...force))).filter((force) => force > 0);
    sizes.sort((a, b) => a - b);
    // A force of usual size is a quarter as long.
    this.scale = sizes.length ? (0.25 * size) / sizes[sizes.length >> 1] : 0;
    this.arrows = places.map(() => seenThrough(new ArrowHelper(Z, new Vector3(), 1, FORCE)));
    const disc = new CircleGeometry(0.02 * size, 24);
    const material = new MeshBasicMaterial({ color: FOOTPRINT, transparent: true, opacity: 0.5, side: DoubleSide });
    this.footprints = places.flatMap(({ plane, footprints }) => {
      const upward = new Vector3(...planes[plane].normal);
      return footprints.map(([time, ...place]) => {
        const mark = new Mesh(disc, material);
        mark.quaternion.setFromUnitVectors(Z, upward);
        mark.position.set(...place).addScaledVector(upward, 1e-3 * size);
        return { time, mark };
      });
    });
    this.root.add(...this.arrows, ...this.footprints.map(({ mark }) => mark));
  }

  /** Shows what there is at `time`, where the links are. */
  update(time) {
    const frame = indexAt(this.t, time);
    this.places.forEach(({ body, position, forces }, index) => {
      const [arrow, force] = [this.arrows[index], new Vector3(...forces[frame])];
      const length = Math.min(this.scale * force.length(), this.size);
      arrow.visible = length > 0;
      if (!arrow.visible) return;
      const pose = this.linkage.poses[body];
      arrow.position.set(...position).applyQuaternion(pose.rotation).add(pose.position);
      arrow.setDirection(force.normalize());
      arrow.setLength(length, Math.min(0.06 * this.size, 0.4 * length), 0.03 * this.size);
    });
    for (const { time: begun, mark } of this.footprints) mark.visible = begun <= time;
  }

  /** What is drawn, in the base frame, m: start and tip of the arrow of each place, null where there is none, and the places
   * of the footprints. */
  drawn() {
    const at = (object) => object.getWorldPosition(new Vector3()).toArray();
    const arrows = this.arrows.map((arrow) => (isSeen(arrow) ? { start: at(arrow), tip: at(arrow.cone) } : null));
    return { arrows, footprints: this.footprints.filter(({ mark }) => isSeen(mark)).map(({ mark }) => at(mark)) };
  }
}

/** Whether an object is in a scene and visible there. */
function isSeen({ visible, parent, isScene }) {
  return visible && (isScene || (parent !== null && isSeen(parent)));
}

/** An arrow that no limb hides, for it lies along the one that it acts on. */
function seenThrough(arrow) {
  for (const part of [arrow.line, arrow.cone]) {
    part.material.depthTest = false;
    part.renderOrder = 1;
  }
  return arrow;
}
