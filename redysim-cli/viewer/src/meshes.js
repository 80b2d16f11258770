// The meshes of links, from the files in the page: STL, Collada and Wavefront OBJ, without their textures.

import { Box3, Color, Group, Mesh, MeshStandardMaterial, SRGBColorSpace } from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";

const PAINT = [0.79, 0.81, 0.83, 1];
/** The skeleton shows through. */
const OPACITY = 0.6;
/** Images stand in files of their own, which the page has not. */
const TEXTURE = /<texture\b[^>]*?(\/>|>[\s\S]*?<\/texture>)/g;

const READ = {
  stl: (bytes) => {
    const geometry = new STLLoader().parse(bytes.buffer);
    // Those in the file are often zero.
    geometry.computeVertexNormals();
    return new Mesh(geometry);
  },
  obj: (bytes) => new OBJLoader().parse(text(bytes)),
  dae: (bytes) => {
    const { scene } = new ColladaLoader().parse(text(bytes).replace(TEXTURE, "<color>0.8 0.8 0.8 1</color>"), "");
    // As other programs that show a URDF: lengths in the file's unit, axes as they are.
    scene.rotation.set(0, 0, 0);
    return scene;
  },
};

/** An object for each of `meshes` with its body, and the box around it there; calls `fail` with the name of each file that cannot be read. */
export function meshes({ meshes, files }, fail) {
  const read = files.map((file) => object(file, fail));
  return meshes.flatMap(({ body, position, rotation, scale, colour, file }) => {
    if (!read[file]) return [];
    const paint = painter(colour, files[file].format === "dae");
    const placed = new Group().add(painted(read[file].clone(), paint));
    placed.position.set(...position);
    placed.quaternion.set(...rotation);
    placed.scale.set(...scale);
    return [{ body, object: placed, box: new Box3().setFromObject(placed) }];
  });
}

function object({ name, format, base64 }, fail) {
  try {
    const object = READ[format](Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)));
    const solid = [];
    object.traverse((part) => part.isMesh && part.geometry.getAttribute("position")?.count && solid.push(part));
    if (solid.length) return object;
    fail(name);
  } catch (error) {
    console.warn(name, error);
    fail(name);
  }
  return null;
}

/** With materials that `paint` makes of its own, and without what is not solid. */
function painted(object, paint) {
  const unseen = [];
  object.traverse((part) => {
    if (part.isLight || part.isCamera || part.isLine) unseen.push(part);
    if (!part.isMesh) return;
    const { material } = part;
    part.material = Array.isArray(material) ? material.map(paint) : paint(material);
    if (!part.geometry.getAttribute("normal")) part.geometry.computeVertexNormals();
  });
  unseen.forEach((part) => part.removeFromParent());
  return object;
}

/** Makes materials of those of a file: of their colours if it `has` any, of the URDF's otherwise. */
function painter(colour, has) {
  const [red, green, blue, opacity] = colour ?? PAINT;
  const urdfs = { color: new Color().setRGB(red, green, blue, SRGBColorSpace), opacity };
  return (own) => {
    // Where a Collada file has no colour, its loader makes a basic material.
    const { color, opacity } = has && !own.isMeshBasicMaterial ? own : urdfs;
    const look = { transparent: true, roughness: 0.7, side: own.side };
    return new MeshStandardMaterial({ color, opacity: OPACITY * opacity, ...look });
  };
}

function text(bytes) {
  return new TextDecoder().decode(bytes);
}
