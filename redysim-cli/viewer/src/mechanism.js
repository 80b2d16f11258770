// The mechanism as solids: links from joint to joint, joints, what marks them, and the traces of free ends.

import {
  BoxGeometry, BufferGeometry, CapsuleGeometry, CylinderGeometry, Float32BufferAttribute, Group, Line,
  LineBasicMaterial, Mesh, MeshStandardMaterial, SphereGeometry, Vector3,
} from "three";
import { axes, centreMarks, ellipsoid, label } from "./marks.js";
import { colour, GROUND } from "./palette.js";

const Y = new Vector3(0, 1, 0);
const JOINT = "#3b434c";
/** Points of a trace at least, so that it is smooth. */
const TRACE = 1000;

export class Mechanism {
  /** `size` is the radius of all that it ever reaches, m; without a `motion` it leaves no traces. */
  constructor({ bodies, cuts, frames }, meshes, linkage, motion, size) {
    Object.assign(this, { linkage, motion });
    this.root = new Group();
    this.layers = { links: [], axes: [], coms: [], ellipsoids: [], frames: [], names: [], trace: [], meshes: [] };
    this.rails = [];
    this.thick = thickness(bodies, size);
    this.mark = centreMarks(2.6 * this.thick);
    this.groups = bodies.map((body, index) => this.#body(body, index));
    bodies.forEach((body, index) => body.joint?.rail && this.#rail(body.joint.rail, index));
    for (const { a, kind } of cuts) this.groups[a.body].add(this.#joint(kind, a.axis, new Vector3(...a.point)));
    for (const frame of frames) this.#frame(frame);
    if (motion) this.#traces(bodies);
    for (const { body, object } of meshes) this.#add("meshes", this.groups[body], object);
  }

  /** Moves everything to where the links are. */
  update() {
    const { linkage, groups } = this;
    linkage.poses.forEach(({ position, rotation }, body) => {
      groups[body].position.copy(position);
      groups[body].quaternion.copy(rotation);
    });
    this.root.updateMatrixWorld(true);
    for (const { rod, from, body, point } of this.rails) {
      stretch(rod, groups[from].localToWorld(point.clone()), groups[body].position);
    }
    for (const line of this.layers.trace) line.geometry.setDrawRange(0, this.#traced() + 1);
  }

  setLayer(name, shown) {
    for (const object of this.layers[name] ?? []) object.visible = shown;
  }

  /** Adds an object to a layer, and to a body. */
  #add(layer, body, object) {
    this.layers[layer].push(object);
    body.add(object);
  }

  #body({ name, joint, ends, com, ellipsoid: solid }, index) {
    const group = new Group();
    this.root.add(group);
    const paint = index === 0 ? GROUND : joint.coordinate === null ? "#8b949e" : colour(joint.coordinate);
    const material = new MeshStandardMaterial({ color: paint, roughness: 0.55 });
    const thick = index === 0 ? 0.8 * this.thick : this.thick;
    for (const end of ends) {
      const to = new Vector3(...end);
      if (to.length() < 1e-3 * this.thick) continue;
      const rod = new Mesh(new CapsuleGeometry(thick, to.length(), 6, 20), material);
      rod.quaternion.setFromUnitVectors(Y, to.clone().normalize());
      rod.position.copy(to).multiplyScalar(0.5);
      rod.castShadow = true;
      this.#add("links", group, rod);
    }
    if (joint) group.add(this.#joint(joint.kind, joint.axis, new Vector3()));
    if (com) this.#add("coms", group, this.mark(com));
    if (solid) this.#add("ellipsoids", group, ellipsoid(com, solid, paint));
    if (index > 0) {
      const middle = ends.length ? ends[ends.length - 1] : com ?? [0, 0, 0];
      this.#add("names", group, label(name, middle.map((x) => 0.5 * x)));
    }
    return group;
  }

  /** Frames of interest are larger than those of links, and have names. */
  #frame({ name, of_link, body, position, rotation }) {
    const group = this.groups[body];
    this.#add("frames", group, axes({ position, rotation }, (of_link ? 5 : 8) * this.thick));
    if (!of_link) this.#add("names", group, label(name, position));
  }

  /** A pin or block along the axis, and the axis as a line; a ball for a joint about several axes. */
  #joint(kind, axis, at) {
    const group = new Group();
    group.position.copy(at);
    group.quaternion.setFromUnitVectors(Y, new Vector3(...axis).normalize());
    const r = this.thick;
    const shapes = {
      revolute: () => new CylinderGeometry(1.35 * r, 1.35 * r, 3.4 * r, 28),
      helical: () => new CylinderGeometry(1.35 * r, 1.35 * r, 3.4 * r, 28),
      prismatic: () => new BoxGeometry(3 * r, 4.4 * r, 3 * r),
      cylindrical: () => new CylinderGeometry(1.35 * r, 1.35 * r, 4.4 * r, 28),
      universal: () => new SphereGeometry(1.6 * r, 24, 16),
      spherical: () => new SphereGeometry(1.6 * r, 24, 16),
    };
    const shape = shapes[kind];
    if (shape) {
      const solid = new Mesh(shape(), new MeshStandardMaterial({ color: JOINT, roughness: 0.5 }));
      solid.castShadow = true;
      this.#add("links", group, solid);
    }
    if (["revolute", "prismatic", "helical", "cylindrical"].includes(kind)) {
      const thread = new CylinderGeometry(0.12 * r, 0.12 * r, 13 * r, 8);
      const line = new Mesh(thread, new MeshStandardMaterial({ color: JOINT }));
      this.#add("axes", group, line);
    }
    return group;
  }

  #rail({ body: from, point }, body) {
    const rod = new Mesh(
      new CylinderGeometry(0.5 * this.thick, 0.5 * this.thick, 1, 16),
      new MeshStandardMaterial({ color: "#9aa3ad", roughness: 0.4 }),
    );
    this.#add("links", this.root, rod);
    this.rails.push({ rod, from, body, point: new Vector3(...point) });
  }

  /** The number of the last point of the traces that is not ahead of the present. */
  #traced() {
    const { frame, part } = this.motion;
    return Math.floor((frame + part) * this.parts + 1e-9);
  }

  /** The paths of the ends of links that carry no others. */
  #traces(bodies) {
    const { motion, linkage } = this;
    const tips = bodies.map((body, index) => ({ ...body, index, points: [] })).filter(({ tip }) => tip);
    this.parts = Math.ceil(TRACE / motion.t.length);
    const end = new Vector3();
    motion.t.forEach((time, frame) => {
      const after = motion.t[frame + 1] ?? time;
      for (let part = 0; part < this.parts; part++) {
        motion.seek(time + ((after - time) * part) / this.parts);
        for (const { index, ends, points } of tips) {
          const { position, rotation } = linkage.poses[index];
          points.push(...end.fromArray(ends[ends.length - 1]).applyQuaternion(rotation).add(position).toArray());
        }
      }
    });
    for (const { joint, points } of tips) {
      const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(points, 3));
      const paint = joint.coordinate === null ? GROUND : colour(joint.coordinate);
      const line = new Line(geometry, new LineBasicMaterial({ color: paint, transparent: true, opacity: 0.7 }));
      line.frustumCulled = false;
      this.#add("trace", this.root, line);
    }
    motion.seek(motion.start);
  }
}

/** Radius of the links: seen from where all is seen, and slender even where links are many and short. */
function thickness(bodies, size) {
  const lengths = bodies.slice(1).flatMap(({ ends }) => ends.map((end) => Math.hypot(...end)));
  const rods = lengths.filter((length) => length > 0).sort((a, b) => a - b);
  const middle = rods[rods.length >> 1] ?? size;
  return Math.max(Math.min(0.022 * size, 0.11 * middle), 0.004 * size);
}

/** Lays a rod of length 1 between two points. */
function stretch(rod, from, to) {
  const along = to.clone().sub(from);
  const length = Math.max(along.length(), 1e-9);
  rod.position.copy(from).addScaledVector(along, 0.5);
  if (length > 1e-9) rod.quaternion.setFromUnitVectors(Y, along.divideScalar(length));
  rod.scale.set(1, length, 1);
}
