// Puts the page together: data, time, stage and curves.

import { Vector3, Quaternion } from "three";
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { Charts } from "./charts.js";
import { Motion } from "./motion.js";
import { Player } from "./player.js";
import { Stage } from "./stage.js";

const at = (id) => document.getElementById(id);
const animation = JSON.parse(at("data").textContent);
const motion = new Motion(animation.motion, animation.bodies);
document.title = `${animation.name} – redysim`;
at("name").textContent = animation.name;
at("facts").textContent = facts();
at("notes").textContent = animation.notes.join(" · ");

const stage = makeStage();
const player = new Player(motion, show);
const charts = new Charts(at("charts"), animation.charts, (time) => player.seek(time));
player.seek(motion.start);

for (const button of document.querySelectorAll("[data-view]")) {
  button.addEventListener("click", () => stage?.view(button.dataset.view));
}
for (const box of document.querySelectorAll("[data-layer]")) {
  const apply = () => stage?.setLayer(box.dataset.layer, box.checked);
  box.addEventListener("change", apply);
  apply();
}

let before = performance.now();
requestAnimationFrame(function frame(now) {
  player.advance((now - before) / 1000);
  before = now;
  stage?.draw();
  requestAnimationFrame(frame);
});

/** What the page shows at present, for tests and for those who look into it from the console. */
window.redysim = {
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
  /** Name, origin and centre of mass of every link in the base frame, m, as they are drawn. */
  links: () => animation.bodies.slice(1).map(drawn),
  /** Where the camera is, m. */
  camera: () => stage.camera.position.toArray(),
};

function show() {
  stage?.show();
  charts.show(motion.time);
}

function drawn({ name, com }, link) {
  const object = stage?.mechanism.groups[link + 1];
  const origin = new Vector3();
  const rotation = new Quaternion();
  if (object) {
    object.getWorldPosition(origin);
    object.getWorldQuaternion(rotation);
  } else {
    origin.copy(motion.poses[link + 1].position);
    rotation.copy(motion.poses[link + 1].rotation);
  }
  const centre = com && new Vector3(...com).applyQuaternion(rotation).add(origin).toArray();
  return { name, origin: origin.toArray(), com: centre };
}

function facts() {
  const count = (number, one, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;
  const { bodies, joints, cuts } = animation;
  const parts = [count(bodies.length - 1, "link"), count(joints.length, "joint that moves", "joints that move")];
  if (cuts.length) parts.push(count(cuts.length, "cut joint"));
  return parts.join(" · ");
}

function makeStage() {
  try {
    return new Stage(at("stage"), at("canvas"), animation, motion);
  } catch (error) {
    // Without WebGL the curves are still of use.
    console.warn(error);
    at("no-webgl").hidden = false;
    at("stage").classList.add("no-webgl");
    return null;
  }
}
