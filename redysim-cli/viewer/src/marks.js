// What marks a link beside its solids: frames, centre of mass, and the ellipsoid that has its mass and inertia.

import {
  AxesHelper, CanvasTexture, Mesh, MeshStandardMaterial, SphereGeometry, Sprite, SpriteMaterial, SRGBColorSpace,
} from "three";
import { CSS2DObject } from "three/addons/renderers/CSS2DRenderer.js";

/** The colours of x, y and z. */
export const AXES = ["#cc3311", "#117733", "#0044aa"];
/** A flat or slender body is drawn as thick as this part of its largest semi-axis. */
const THINNEST = 0.01;

/** Three axes of a length. */
export function axes({ position, rotation }, length) {
  const object = new AxesHelper(length).setColors(...AXES);
  object.material.depthTest = false;
  object.renderOrder = 1;
  object.position.set(...position);
  object.quaternion.set(...rotation);
  return object;
}

/** A name at a point. */
export function label(name, point) {
  const text = document.createElement("span");
  text.className = "link-name";
  text.textContent = name;
  const object = new CSS2DObject(text);
  object.position.set(...point);
  object.center.set(0.5, 1.4);
  return object;
}

/** A uniform ellipsoid about a centre of mass. */
export function ellipsoid(com, { semi_axes, rotation }, color) {
  const material = new MeshStandardMaterial({ color, transparent: true, opacity: 0.35, depthWrite: false });
  const object = new Mesh(new SphereGeometry(1, 40, 24), material);
  const least = THINNEST * Math.max(...semi_axes);
  object.scale.set(...semi_axes.map((semi) => Math.max(semi, least)));
  object.position.set(...com);
  object.quaternion.set(...rotation);
  return object;
}

/** Makes marks of centres of mass of a size: a circle with two of its quarters black. */
export function centreMarks(size) {
  const map = quartered();
  return (com) => {
    const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false }));
    sprite.position.set(...com);
    sprite.scale.setScalar(size);
    sprite.renderOrder = 2;
    return sprite;
  };
}

function quartered() {
  const canvas = Object.assign(document.createElement("canvas"), { width: 128, height: 128 });
  const draw = canvas.getContext("2d");
  const sector = (from, to, style) => {
    draw.fillStyle = style;
    draw.beginPath();
    draw.moveTo(64, 64);
    draw.arc(64, 64, 54, from, to);
    draw.fill();
  };
  sector(0, 2 * Math.PI, "#fff");
  sector(0, Math.PI / 2, "#111");
  sector(Math.PI, 1.5 * Math.PI, "#111");
  draw.lineWidth = 9;
  draw.strokeStyle = "#111";
  draw.beginPath();
  draw.arc(64, 64, 54, 0, 2 * Math.PI);
  draw.stroke();
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
