//! A robot whose links have meshes: boxes, each in another format.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

type Corners = [[f64; 3]; 2];

/// Writes a package `arm_description` with meshes into `folder`, and returns the path of its URDF.
///
/// The base is a box of 0.2 by 0.2 by 0.1 m on the ground (binary STL, from the URDF's folder). The arm turns about z,
/// 0.1 m above, and is a box of 0.4 by 0.06 by 0.08 m (Collada in cm, from the package, with a texture). The tool
/// slides along the arm from 0.4 m on; its box (OBJ in mm) stands 0.05 m further, turned by 90° about z.
pub fn robot(folder: &Path) -> PathBuf {
    let package = folder.join("arm_description");
    ["urdf", "meshes"].iter().for_each(|name| fs::create_dir_all(package.join(name)).unwrap());
    fs::write(package.join("meshes/base.stl"), stl([[-0.1, -0.1, 0.0], [0.1, 0.1, 0.1]])).unwrap();
    fs::write(package.join("meshes/arm.dae"), dae([[0.0, -3.0, -3.0], [40.0, 3.0, 5.0]])).unwrap();
    fs::write(package.join("meshes/tool.OBJ"), obj([[0.0, -20.0, -20.0], [100.0, 20.0, 20.0]])).unwrap();
    let path = package.join("urdf/robot.urdf");
    fs::write(&path, URDF).unwrap();
    path
}

const URDF: &str = r#"<robot name="robot">
<material name="orange"><color rgba="1 0.5 0 1"/></material>
<link name="base"><visual><geometry><mesh filename="../meshes/base.stl"/></geometry><material name="orange"/></visual></link>
<link name="arm">
  <inertial><mass value="2"/><origin xyz="0.2 0 0"/>
  <inertia ixx="0.002" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><mesh filename="package://arm_description/meshes/arm.dae"/></geometry></visual>
</link>
<link name="tool">
  <inertial><mass value="1"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><origin xyz="0.05 0 0" rpy="0 0 1.5707963267948966"/>
  <geometry><mesh filename="../meshes/tool.OBJ" scale="0.001 0.001 0.001"/></geometry></visual>
</link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
<joint name="rail" type="prismatic"><parent link="arm"/><child link="tool"/><origin xyz="0.4 0 0"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.3" velocity="1" effort="1"/></joint>
</robot>
"#;

fn vertices([least, most]: Corners) -> Vec<[f64; 3]> {
    let pick = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { least[axis] } else { most[axis] };
    (0..8).map(|corner| [0, 1, 2].map(|axis| pick(corner, axis))).collect()
}

/// Two triangles for each side, seen from outside against the clock.
const TRIANGLES: [[usize; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

fn stl(corners: Corners) -> Vec<u8> {
    let points = vertices(corners);
    let mut bytes = [0; 80].to_vec();
    bytes.extend(12_u32.to_le_bytes());
    for triangle in TRIANGLES {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flat_map(|&point| points[point]).flat_map(|x| (x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn obj(corners: Corners) -> String {
    let mut text = String::from("mtllib none.mtl\no box\nusemtl steel\n");
    vertices(corners).iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
    TRIANGLES.iter().for_each(|[a, b, c]| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap());
    text
}

/// Up is z and a unit is a centimetre; there is a light, and a texture that is not in the page.
fn dae(corners: Corners) -> String {
    let positions: Vec<String> = vertices(corners).iter().flatten().map(f64::to_string).collect();
    let indices: Vec<String> = TRIANGLES.iter().flatten().map(usize::to_string).collect();
    format!(
        r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="skin"><init_from>skin.png</init_from></image></library_images>
<library_effects><effect id="look"><profile_COMMON>
<newparam sid="surface"><surface type="2D"><init_from>skin</init_from></surface></newparam>
<newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
<technique sid="common"><phong><diffuse><texture texture="sampler" texcoord="UV"/></diffuse></phong></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="skinned"><instance_effect url="#look"/></material></library_materials>
<library_lights><light id="sun"><technique_common><point><color>1 1 1</color></point></technique_common></light></library_lights>
<library_geometries><geometry id="box"><mesh>
<source id="points"><float_array id="array" count="24">{}</float_array>
<technique_common><accessor source="#array" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="vertices"><input semantic="POSITION" source="#points"/></vertices>
<triangles count="12" material="m"><input semantic="VERTEX" source="#vertices" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node id="lamp"><instance_light url="#sun"/></node>
<node id="node"><instance_geometry url="#box"><bind_material><technique_common>
<instance_material symbol="m" target="#skinned"/></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"##,
        positions.join(" "),
        indices.join(" ")
    )
}

/// A crank and a rocker about axes that are not parallel, and a coupler between them with a ball at either end.
pub const BALLS: &str = "name = 'balls'\ngravity = [0, 0, -9.81]\nallow = ['under-actuated']\n\
    [[link]]\nname = 'crank'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\norigin = {}\nmass = 1\n\
    com = [0.1, 0, 0]\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }\n\
    [[link]]\nname = 'rocker'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 1, 0]\norigin = { xyz = [1, 0, 0] }\n\
    mass = 1\nactuated = false\ncom = [0, 0, 0.3]\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }\n\
    [[link]]\nname = 'coupler'\nparent = 'rocker'\njoint = 'spherical'\norigin = { xyz = [0, 0, 0.6] }\nmass = 1\n\
    actuated = false\ncom = [-0.5, 0, 0]\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }\n\
    [[loop]]\nname = 'ball'\njoint = 'spherical'\nlink_a = 'crank'\npoint_a = [0.2, 0, 0]\nlink_b = 'coupler'\n\
    point_b = [-1, 0, 0]\n";
