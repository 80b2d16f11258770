// Puts the page together: data, stage, and time with curves for a run, or sliders for a model.

import { Box3, Vector3, Quaternion } from "three";
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { Charts } from "./charts.js";
import { Linkage } from "./linkage.js";
import { Loops } from "./loops.js";
import { Motion } from "./motion.js";
import { Player } from "./player.js";
import { Posture } from "./posture.js";
import { Sliders } from "./sliders.js";
import { Stage } from "./stage.js";

const at = (id) => document.getElementById(id);
const data = JSON.parse(at("data").textContent);
const linkage = new Linkage(data.bodies);
document.title = `${data.name} – redysim`;
at("name").textContent = data.name;
at("facts").textContent = facts();

const { moved, start, advance, report } = data.motion ? playing() : posing();
const stage = makeStage();
const unread = (stage?.unread ?? []).map((name) => `the mesh ${name} cannot be read`);
at("notes").textContent = [...data.notes, ...unread].join(" · ");
start();

for (const button of document.querySelectorAll("[data-view]")) {
  button.addEventListener("click", () => stage?.view(button.dataset.view));
}
const follow = at("follow");
follow.checked = Boolean(stage?.following);
follow.parentElement.hidden = !stage?.canFollow;
follow.addEventListener("change", () => stage?.setFollowing(follow.checked));
for (const box of document.querySelectorAll("[data-layer]")) {
  const apply = () => stage?.setLayer(box.dataset.layer, box.checked);
  box.addEventListener("change", apply);
  box.parentElement.hidden = !stage?.hasLayer(box.dataset.layer);
  apply();
}

let before = performance.now();
requestAnimationFrame(function frame(now) {
  advance((now - before) / 1000);
  before = now;
  stage?.draw();
  requestAnimationFrame(frame);
});

/** What the page shows at present, for tests and for those who look into it from the console. */
window.redysim = Object.defineProperties(
  {
    /** Name, origin and centre of mass of every link in the base frame, m, as they are drawn. */
    links: () => data.bodies.slice(1).map(drawn),
    /** Body and corners in the base frame, m, of the box around each mesh. */
    meshes: () => (stage?.mechanism.layers.meshes ?? []).map(boxed),
    /** Arrows of contact forces and footprints, in the base frame, m, as they are drawn. */
    contacts: () => stage?.contacts?.drawn(),
    /** What is drawn, as the address of a PNG, and the names over it. */
    picture: () => stage.picture(),
    /** Where the camera is, m. */
    camera: () => stage.camera.position.toArray(),
    /** Where the camera looks, m. */
    target: () => stage.controls.target.toArray(),
  },
  Object.getOwnPropertyDescriptors(report),
);

/** A run: time goes on, and the curves go with it. */
function playing() {
  at("charts").hidden = at("playback").hidden = false;
  const motion = new Motion(data.motion, linkage);
  let charts = null;
  const player = new Player(motion, () => {
    stage?.show();
    charts?.show(motion.time);
  });
  const start = () => {
    charts = new Charts(at("charts"), data.charts, (time) => player.seek(time));
    player.seek(motion.start);
  };
  const report = {
    get time() {
      return motion.time;
    },
    get playing() {
      return player.playing;
    },
    frames: motion.t.length,
    seek: (time) => player.seek(time),
    play: () => player.play(),
    pause: () => player.pause(),
  };
  return { moved: motion, start, advance: (seconds) => player.advance(seconds), report };
}

/** A model: whoever looks at it moves its coordinates. */
function posing() {
  at("sliders").hidden = false;
  for (const layer of ["frames", "ellipsoids"]) document.querySelector(`[data-layer=${layer}]`).checked = true;
  const length = Math.max(...data.bodies.flatMap(({ ends, joint }) => [...ends, joint?.position ?? []]).map(long), 1e-6);
  const loops = new Loops(data.cuts, linkage, length);
  const posture = new Posture(data.sliders, linkage, loops, length);
  let sliders = null;
  const start = () => (sliders = new Sliders(at("sliders"), data.joints, posture, () => stage?.show()));
  const report = {
    get q() {
      return posture.q.slice();
    },
    /** How far the loops are from closed, m or a sine. */
    get gap() {
      return loops.gap(posture.q);
    },
    move: (coordinate, value) => sliders.move(coordinate, value),
    reset: () => sliders.reset(),
  };
  return { moved: posture, start, advance: () => {}, report };
}

function long(vector) {
  return Math.hypot(...vector);
}

function drawn({ name, com }, link) {
  const group = stage?.mechanism.groups[link + 1];
  const pose = linkage.poses[link + 1];
  const position = group?.getWorldPosition(new Vector3()) ?? pose.position;
  const rotation = group?.getWorldQuaternion(new Quaternion()) ?? pose.rotation;
  const placed = (point) => new Vector3(...point).applyQuaternion(rotation).add(position).toArray();
  return { name, origin: placed(data.frames[link].position), com: com && placed(com) };
}

function boxed(mesh) {
  const { min, max } = new Box3().setFromObject(mesh, true);
  return { body: stage.mechanism.groups.indexOf(mesh.parent), min: min.toArray(), max: max.toArray() };
}

function facts() {
  const count = (number, one, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;
  const { bodies, cuts } = data;
  const moving = bodies.filter(({ joint }) => joint && joint.coordinate !== null).length;
  const parts = [count(bodies.length - 1, "link"), count(moving, "joint that moves", "joints that move")];
  if (cuts.length) parts.push(count(cuts.length, "cut joint"));
  return parts.join(" · ");
}

function makeStage() {
  try {
    return new Stage(at("stage"), at("canvas"), data, linkage, moved);
  } catch (error) {
    // Without WebGL curves and sliders are still of use.
    console.warn(error);
    at("no-webgl").hidden = false;
    at("stage").classList.add("no-webgl");
    return null;
  }
}
