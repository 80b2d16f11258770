// The room that the mechanism moves in: camera, light, ground, and how to look around.

import {
  AxesHelper, Box3, DirectionalLight, GridHelper, Group, HemisphereLight, Mesh, PerspectiveCamera, PlaneGeometry,
  Quaternion, Scene, ShadowMaterial, Sphere, Spherical, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { CSS2DRenderer } from "three/addons/renderers/CSS2DRenderer.js";
import { movingBase } from "./base.js";
import { Contacts } from "./contacts.js";
import { AXES } from "./marks.js";
import { Mechanism } from "./mechanism.js";
import { meshes } from "./meshes.js";

const Y = new Vector3(0, 1, 0);
/** Angle by which a key turns the view, and factor by which it comes closer. */
const TURN = Math.PI / 24;
const ZOOM = 0.9;
/** Cells of the ground at most, along the radius of all that the mechanism ever reaches. */
const CELLS = 100;

export class Stage {
  /** `moved`, a motion or a posture, has moved `linkage`. Throws if the browser has no WebGL. */
  constructor(place, canvas, data, linkage, moved) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setClearColor("#ffffff");
    this.renderer.shadowMap.enabled = true;
    this.names = new CSS2DRenderer();
    this.names.domElement.className = "names";
    canvas.after(this.names.domElement);
    this.place = place;
    this.scene = new Scene();
    this.up = upward(data.gravity);
    /** The names of files that cannot be read. */
    this.unread = [];
    const solids = meshes(data, (name) => this.unread.push(name));
    const points = data.bodies.map(({ ends }) => ends.map((end) => new Vector3(...end)));
    for (const { body, box } of solids) points[body].push(...corners(box));
    const everywhere = (see, wanted) => moved.visit(() => everyPoint(points, linkage, see, wanted));
    this.sphere = reach(everywhere);
    this.#base(data, linkage, everywhere);
    // What is drawn is as large as it must be to be seen from where the camera starts.
    this.size = this.following ? this.own.radius : this.sphere.radius;
    this.mechanism = new Mechanism(data, solids, linkage, data.motion && moved, this.size);
    this.scene.add(this.mechanism.root);
    if (data.contacts) {
      this.contacts = new Contacts(data.contacts, linkage, this.size);
      this.moved = moved;
      this.scene.add(this.contacts.root);
    }
    const level = () => this.#level(lowest((see) => moved.stand(() => everyPoint(points, linkage, see)), this.up));
    this.#ground(data.contacts?.planes ?? [level()]);
    this.#light();
    this.camera = new PerspectiveCamera(30, 1, this.size / 50, this.sphere.radius * 100);
    // The controls turn about the camera's own upward direction, and ask for it only now.
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => (this.stale = true));
    this.start = firstView(data, linkage, this.up);
    new ResizeObserver(() => this.#resize()).observe(place);
    this.#resize();
    this.view("start");
    canvas.addEventListener("keydown", (event) => this.#key(event));
    this.show();
  }

  /** Moves the mechanism to where the links are. */
  show() {
    this.mechanism.update();
    this.#follow();
    this.contacts?.update(this.moved.time);
    this.stale = true;
  }

  /** Draws, if anything has changed since. */
  draw() {
    if (!this.stale) return;
    this.stale = false;
    this.renderer.render(this.scene, this.camera);
    this.names.render(this.scene, this.camera);
  }

  /** What is drawn, as the address of a PNG, and the names over it. */
  picture() {
    this.stale = true;
    this.draw();
    return [this.renderer.domElement.toDataURL(), this.names.domElement.innerText];
  }

  /** Whether there is anything in a layer. */
  hasLayer(name) {
    if (name === "contacts") return Boolean(this.contacts);
    return name === "ground" || this.mechanism.layers[name].length > 0;
  }

  setLayer(name, shown) {
    if (name === "ground") this.ground.visible = shown;
    else if (name === "contacts") this.contacts && (this.contacts.root.visible = shown);
    else this.mechanism.setLayer(name, shown);
    this.stale = true;
  }

  /** Whether there is a base that the camera can follow. */
  get canFollow() {
    return Boolean(this.base);
  }

  /** Has the camera follow the base, or stand still; it looks in the same direction as before. */
  setFollowing(following) {
    this.following = following && this.canFollow;
    this.#fit(this.camera.position.clone().sub(this.controls.target));
  }

  /** Shows everything from "start", "front", "side" or "top"; of a base that the camera follows, what is around it. */
  view(name) {
    const { front, side } = horizontal(this.up);
    // Straight from above, the way up would not be defined.
    const top = this.up.clone().addScaledVector(front, 1e-3);
    const from = { start: this.start, front, side, top }[name];
    this.#fit(from.clone());
  }

  /** The base that moves, what it carries as seen from it, and whether the camera follows: by default where the way of the
   * base is longer than the mechanism reaches beside it. `every` sees the points of all bodies, or of those wanted. */
  #base(data, linkage, every) {
    this.base = data.motion ? movingBase(data, linkage) : null;
    this.following = false;
    if (!this.canFollow) return;
    let longest = 0;
    const fromBase = (wanted) =>
      reach((see) => {
        const own = new Vector3();
        every((point) => {
          const travel = this.base.travel();
          longest = Math.max(longest, travel.length());
          see(own.copy(point).sub(travel));
        }, wanted);
      });
    this.own = fromBase(this.base.carried);
    const { radius } = fromBase();
    this.followed = this.base.travel();
    this.following = data.camera ? data.camera === "follow" : longest > radius;
  }

  /** Moves the camera as far as the base has moved since. */
  #follow() {
    if (!this.following) return;
    const travel = this.base.travel();
    const moved = travel.clone().sub(this.followed);
    this.followed = travel;
    this.camera.position.add(moved);
    this.controls.target.add(moved);
    this.controls.update();
    this.#shine();
  }

  /** Shows everything along a direction. */
  #fit(from) {
    const { radius } = this.following ? this.own : this.sphere;
    if (this.following) this.followed = this.base.travel();
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (1.12 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.copy(this.#middle());
    this.camera.position.copy(this.controls.target).addScaledVector(from.normalize(), distance);
    this.controls.update();
    this.#shine();
    this.stale = true;
  }

  /** What the camera looks at. */
  #middle() {
    return this.following ? this.own.center.clone().add(this.followed) : this.sphere.center;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.names.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.stale = true;
  }

  /** The level ground at a height. */
  #level(height) {
    return { point: this.up.clone().multiplyScalar(height).toArray(), normal: this.up.toArray() };
  }

  /** The ground and other planes, and the axes of the base. */
  #ground(planes) {
    const base = new AxesHelper(0.22 * this.size).setColors(...AXES);
    base.material.depthTest = false;
    base.renderOrder = 1;
    this.ground = new Group().add(...planes.map((plane) => this.#plane(plane)), base);
    this.scene.add(this.ground);
  }

  /** The plane through `point` with the outward `normal`. */
  #plane(plane) {
    const [point, normal] = [plane.point, plane.normal].map((vector) => new Vector3(...vector));
    const { radius, center } = this.sphere;
    const cell = roundLength(Math.max(this.size / 4, radius / CELLS));
    const cells = 2 * Math.ceil((2 * radius) / cell);
    const grid = new GridHelper(cells * cell, cells, "#b9c1c9", "#dde2e7");
    const floor = new Mesh(new PlaneGeometry(cells * cell, cells * cell), new ShadowMaterial({ opacity: 0.12 }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -1e-3 * this.size;
    floor.receiveShadow = true;
    const level = new Group().add(grid, floor);
    level.quaternion.setFromUnitVectors(Y, normal);
    // Below the middle of the motion, on whole cells of the base frame.
    const middle = center.clone().addScaledVector(normal, -center.dot(normal));
    middle.divideScalar(cell).round().multiplyScalar(cell).addScaledVector(normal, -middle.dot(normal));
    level.position.copy(middle).addScaledVector(normal, point.dot(normal));
    return level;
  }

  #light() {
    const sun = new DirectionalLight("#ffffff", 2.2);
    sun.castShadow = true;
    sun.shadow.mapSize.setScalar(2048);
    this.sun = sun;
    const sky = new HemisphereLight("#ffffff", "#aab2bb", 1.9);
    sky.position.copy(this.up);
    this.scene.add(sun, sun.target, sky);
  }

  /** Has the sun light what the camera looks at. */
  #shine() {
    const { radius } = this.following ? this.own : this.sphere;
    const { front, side } = horizontal(this.up);
    const from = this.up.clone().multiplyScalar(4).addScaledVector(front, 2).add(side);
    const { position, target, shadow } = this.sun;
    target.position.copy(this.#middle());
    position.copy(target.position).addScaledVector(from, radius);
    const reach = 2 * radius;
    const lit = { left: -reach, right: reach, top: reach, bottom: -reach, near: radius / 10, far: 12 * radius };
    Object.assign(shadow.camera, lit);
    shadow.camera.updateProjectionMatrix();
  }

  /** W, A, S, D turn; plus and minus zoom; 0 shows all: what a mouse can, for keys. */
  #key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const keys = {
      a: () => this.#turn(-TURN, 0),
      d: () => this.#turn(TURN, 0),
      w: () => this.#turn(0, -TURN),
      s: () => this.#turn(0, TURN),
      "+": () => this.#zoom(ZOOM),
      "=": () => this.#zoom(ZOOM),
      "-": () => this.#zoom(1 / ZOOM),
      0: () => this.view("start"),
    };
    keys[event.key.toLowerCase()]?.();
  }

  #turn(around, over) {
    const upright = new Quaternion().setFromUnitVectors(this.up, Y);
    const offset = this.camera.position.clone().sub(this.controls.target).applyQuaternion(upright);
    const angles = new Spherical().setFromVector3(offset);
    angles.theta += around;
    angles.phi += over;
    offset.setFromSpherical(angles.makeSafe()).applyQuaternion(upright.invert());
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  #zoom(factor) {
    const { camera, controls } = this;
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
  }
}

/** Against gravity; z where there is none. */
function upward(gravity) {
  const down = new Vector3(...gravity);
  return down.length() > 0 ? down.normalize().negate() : new Vector3(0, 0, 1);
}

/** Two horizontal directions, along axes of the base frame as far as that can be. */
function horizontal(up) {
  const axis = Math.abs(up.z) > 0.9 ? new Vector3(0, -1, 0) : new Vector3(0, 0, 1);
  const front = axis.addScaledVector(up, -axis.dot(up)).normalize();
  return { front, side: new Vector3().crossVectors(up, front) };
}

/** A planar mechanism is looked at along its joint axes, a little from the side; any other one from a corner. */
function firstView({ bodies }, linkage, up) {
  const { front, side } = horizontal(up);
  const corner = front.clone().addScaledVector(side, 0.75).addScaledVector(up, 0.55);
  const axes = [];
  bodies.forEach(({ joint }, index) => {
    if (joint?.kind !== "revolute") return;
    axes.push(new Vector3(...joint.axis).applyQuaternion(linkage.poses[index].rotation));
  });
  const inSpace = bodies.some(({ joint }) => joint?.orientation);
  const planar = !inSpace && axes.length > 0 && axes.every((axis) => Math.abs(axis.dot(axes[0])) > 1 - 1e-6);
  if (!planar) return corner;
  const across = axes[0].clone();
  if (Math.abs(across.dot(up)) > 0.9) return corner.addScaledVector(up, 1);
  if (across.dot(front) < 0 || (across.dot(front) === 0 && across.dot(side) < 0)) across.negate();
  return across.addScaledVector(up, 0.16).addScaledVector(new Vector3().crossVectors(up, across), 0.16);
}

function corners({ min, max }) {
  const pick = (corner, axis) => ((corner >> axis) & 1 ? max : min).getComponent(axis);
  return [...Array(8).keys()].map((corner) => new Vector3(pick(corner, 0), pick(corner, 1), pick(corner, 2)));
}

/** Calls `see` with the origins of the bodies, of all or of those that are `wanted`, and the `points` of each where the
 * links are. */
function everyPoint(points, linkage, see, wanted) {
  const point = new Vector3();
  linkage.poses.forEach(({ position, rotation }, body) => {
    if (wanted && !wanted[body]) return;
    see(point.copy(position));
    for (const own of points[body]) see(point.copy(own).applyQuaternion(rotation).add(position));
  });
}

/** A sphere around all points that `visit` sees. */
function reach(visit) {
  const box = new Box3();
  visit((point) => box.expandByPoint(point));
  const sphere = new Sphere(box.getCenter(new Vector3()), 1e-6);
  visit((point) => (sphere.radius = Math.max(sphere.radius, sphere.center.distanceTo(point))));
  return sphere;
}

/** The height of the ground: of the base, or below the points that `visit` sees. */
function lowest(visit, up) {
  let height = 0;
  visit((point) => (height = Math.min(height, point.dot(up))));
  return height;
}

/** The largest of 1, 2, 5 times a power of ten that is not above `length`. */
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((digit) => digit * power).find((round) => round <= length) ?? power;
}
