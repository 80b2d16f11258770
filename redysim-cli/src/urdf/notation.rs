//! Vectors and inertias in the notation of model files.

use redysim_model::inertia::Sym3;

use super::inertial::Inertial;

/// Centre of mass and inertia of what the model does not have.
pub fn inertial(body: Inertial) -> String {
    format!("com = {} m, inertia = {} kg m²", vector(body.com.0), inertia(body.inertia))
}

/// An inertia tensor, without the elements that are zero.
pub fn inertia(i: Sym3<f64>) -> String {
    let elements = [("xx", i.xx), ("yy", i.yy), ("zz", i.zz), ("xy", i.xy), ("yz", i.yz), ("xz", i.xz)];
    let there = elements.into_iter().filter(|(_, value)| *value != 0.0);
    let entries: Vec<String> = there.map(|(name, value)| format!("{name} = {value:?}")).collect();
    format!("{{ {} }}", entries.join(", "))
}

/// A vector.
pub fn vector(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(|x| x + 0.0);
    format!("[{x:?}, {y:?}, {z:?}]")
}
