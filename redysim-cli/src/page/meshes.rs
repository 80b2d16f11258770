//! The meshes of a URDF: their files, embedded in the page.

use std::fs;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use super::bodies::Body;
use super::quaternion;
use crate::failure::Failure;
use crate::urdf::{self, Visual};

/// The files of a page have at most so many bytes together.
pub const MAX_BYTES: u64 = 20_000_000;
/// What the page reads, by the endings of names.
const FORMATS: [&str; 3] = ["stl", "dae", "obj"];

/// The meshes of the links, each with its file.
#[derive(Default, Serialize)]
pub struct Meshes {
    meshes: Vec<Mesh>,
    files: Vec<File>,
    /// What is left out, and what to do about it.
    #[serde(skip)]
    pub missing: Vec<Failure>,
}

#[derive(Serialize)]
struct Mesh {
    body: usize,
    /// The mesh in the link's frame: origin, m, and quaternion x, y, z, w.
    position: [f64; 3],
    rotation: [f64; 4],
    /// Factors along the mesh's axes.
    scale: [f64; 3],
    /// Red, green, blue and opacity from 0 to 1, for files that have none.
    colour: Option<[f64; 4]>,
    /// The number of its file.
    file: usize,
}

/// A file, once for all links that show it.
#[derive(Serialize)]
struct File {
    name: String,
    format: String,
    base64: String,
    #[serde(skip)]
    path: PathBuf,
    #[serde(skip)]
    bytes: u64,
}

impl Meshes {
    /// The meshes of the URDF at `path`, of which a model with these bodies was made.
    pub fn of_urdf(path: &Path, bodies: &[Body]) -> Meshes {
        let mut meshes = Meshes::default();
        match urdf::visuals(path) {
            Ok(visuals) => visuals.iter().for_each(|visual| meshes.add(visual, path, bodies)),
            Err(failure) => meshes.missing.push(failure),
        }
        meshes
    }

    fn add(&mut self, visual: &Visual, urdf: &Path, bodies: &[Body]) {
        let body = visual.link.map_or(0, |link| link + 1);
        // The name of the ground is taken, and the root has another.
        let same = |of: &Body| [of.name(), "base"].contains(&visual.name.as_str());
        let known = body == 0 || bodies.get(body).is_some_and(same);
        match if known { self.embed(visual, urdf) } else { Err(changed()) } {
            Ok(file) => self.meshes.push(Mesh {
                body,
                position: visual.pose.position.0,
                rotation: quaternion(visual.pose.rotation),
                scale: visual.scale,
                colour: visual.colour,
                file,
            }),
            Err((why, help)) => {
                let Visual { name, line, file, .. } = visual;
                let place = format!("{}:{line}", urdf.display());
                let message = format!("{place}: link `{name}` is drawn without its mesh `{file}`: {why}");
                self.missing.push(Failure::input(message).help(help));
            }
        }
    }

    /// The number of the file of a mesh; or why it cannot be embedded, and what to do.
    fn embed(&mut self, visual: &Visual, urdf: &Path) -> Result<usize, (String, String)> {
        let format = Path::new(&visual.file).extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if !FORMATS.contains(&format.as_str()) {
            return Err((format!("`.{format}` is not read"), "convert it: the page reads STL, DAE and OBJ".into()));
        }
        let places = places(&visual.file, urdf);
        let path = places.iter().find(|path| path.is_file()).ok_or_else(|| not_found(&visual.file, &places))?;
        if let Some(file) = self.files.iter().position(|file| file.path == *path) {
            return Ok(file);
        }
        let unreadable = |error: std::io::Error| (format!("cannot read {}: {error}", path.display()), READABLE.into());
        let bytes = fs::metadata(path).map_err(unreadable)?.len();
        let before: u64 = self.files.iter().map(|file| file.bytes).sum();
        if before + bytes > MAX_BYTES {
            let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 * 1e-6);
            let [size, before, limit] = [bytes, before, MAX_BYTES].map(megabytes);
            let why = format!("its {size} exceed the limit of {limit} together with {before} already embedded");
            return Err((why, format!("reduce the meshes: a page has room for {limit} of them")));
        }
        let base64 = STANDARD.encode(fs::read(path).map_err(unreadable)?);
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.files.push(File { name, format, base64, path: path.clone(), bytes });
        Ok(self.files.len() - 1)
    }
}

fn changed() -> (String, String) {
    ("the model has no such link".into(), "is the URDF the one of the run? Run the scenario again".into())
}

const READABLE: &str = "make the file readable";

fn not_found(file: &str, places: &[PathBuf]) -> (String, String) {
    match package(file) {
        Some((package, _)) => (
            format!("the package `{package}` is not found, or has no such file"),
            format!(
                "put the folder `{package}` beside the URDF's folder or above, or name the folder that holds it in \
                 ROS_PACKAGE_PATH, or the one whose `share` holds it in AMENT_PREFIX_PATH"
            ),
        ),
        None => {
            let path = places.first().map_or(String::new(), |path| path.display().to_string());
            (format!("the file {path} does not exist"), "relative paths start at the URDF's folder".into())
        }
    }
}

/// Package and path of `package://package/path`.
fn package(file: &str) -> Option<(&str, &str)> {
    let path = ["package://", "model://"].iter().find_map(|scheme| file.strip_prefix(scheme))?;
    path.split_once('/')
}

/// Where the file of a mesh may be: from the URDF's folder; of a package, in the folder of its name that is the URDF's,
/// is above it or beside one of these, or on ROS's paths.
fn places(file: &str, urdf: &Path) -> Vec<PathBuf> {
    let urdf = fs::canonicalize(urdf).unwrap_or_else(|_| urdf.to_owned());
    let folder = urdf.parent().unwrap_or(Path::new(""));
    let Some((package, path)) = package(file) else {
        return vec![folder.join(file.strip_prefix("file://").unwrap_or(file))];
    };
    let listed = |variable| std::env::var_os(variable).unwrap_or_default();
    let of_ros = listed("ROS_PACKAGE_PATH");
    let of_ament = listed("AMENT_PREFIX_PATH");
    let around = folder.ancestors().map(Path::to_owned);
    let named = folder.ancestors().filter(|above| above.file_name().is_some_and(|name| name == package));
    let holders = around.chain(std::env::split_paths(&of_ros));
    let shares = std::env::split_paths(&of_ament).map(|prefix| prefix.join("share"));
    let packages = named.map(Path::to_owned).chain(holders.chain(shares).map(|holder| holder.join(package)));
    packages.map(|package| package.join(path)).collect()
}
