//! Mass and inertia that a body can have.

use super::lints;
use crate::inertia::Sym3;
use crate::lint::Lint;
use crate::messages;
use crate::model::{Inertia, Link, Model};
use crate::pseudo::PseudoInertia;
use crate::schema::Document;
use crate::spatial::Vec3;
use crate::tree::Tree;
use redysim_toml::{Findings, Spanned};

/// Roundoff allowed below zero, relative to the largest principal moment.
const DEFINITE: f64 = 1e-12;

/// Excess allowed over the triangle inequality, relative to the largest principal moment: rods lie on its edge.
const TRIANGLE: f64 = 1e-9;

/// A negative principal moment of a link is small below this share of the largest one of the rigid body that it is part of:
/// inertias are rarely known to so many digits.
const SMALL: f64 = 1e-3;

/// Reports negative masses and inertias that no rigid body has.
pub(super) fn check(
    document: &Document,
    links: &[Option<Link>],
    parents: Option<&[Option<usize>]>,
    findings: &mut Findings,
) {
    let mut negative = Vec::new();
    for (index, table) in document.links.iter().enumerate() {
        if let Some(mass) = table.mass.spanned().filter(|mass| *mass.get_ref() < 0.0) {
            findings.error(mass.span(), messages::negative_mass(&table.item, *mass.get_ref()));
        }
        let Some(inertia) = table.inertia.spanned() else { continue };
        let Some(moments) = principal_moments(inertia.get_ref()) else { continue };
        let [smallest, middle, largest] = moments;
        let excess = largest - (smallest + middle);
        if is_negative(moments) {
            negative.push((index, smallest));
        } else if excess > TRIANGLE * largest {
            let message = messages::triangle(&table.item, largest, excess);
            lints::report(findings, Lint::InertiaTriangle, inertia.span(), message);
        }
    }
    if !negative.is_empty() {
        let tree = parents.and_then(|parents| Some(Tree::new(&tree_of(document, links, parents)?)));
        negative
            .into_iter()
            .for_each(|(index, smallest)| report_negative(document, tree.as_ref(), index, smallest, findings));
    }
}

/// Reports a link with a negative principal moment: an error, for the mass matrix may be indefinite, unless the link is
/// rigidly joined to others in `tree`, which is `None` if it has faults itself.
///
/// What moves is the rigid body that a link and those fixed to it are together. With no negative principal moment about
/// its centre of mass, the kinetic energy of the body is not negative in any motion, so that the mass matrix is positive
/// semi-definite whatever the parts are; a part of the ground has no kinetic energy at all. So it is a warning where the
/// link's negative moment is that small beside those of its body, or the link does not move.
fn report_negative(document: &Document, tree: Option<&Tree>, link: usize, smallest: f64, findings: &mut Findings) {
    let table = &document.links[link];
    let place = table.inertia.spanned().map_or(table.place(), Spanned::span);
    let whole = tree.map(|tree| tree.links[link].body.map(|body| central_moments(tree.bodies[body].inertia)));
    let possible = match whole {
        Some(None) => messages::negative_moment_of_ground(&table.item, smallest),
        Some(Some(whole)) if !is_negative(whole) && -smallest <= SMALL * whole[2] => {
            messages::negative_moment_of_part(&table.item, smallest, whole)
        }
        _ => return findings.error(place, messages::indefinite_inertia(&table.item, smallest)),
    };
    lints::report(findings, Lint::NegativeMoment, place, possible);
}

/// Links and joints alone, with joints locked.
fn tree_of(document: &Document, links: &[Option<Link>], parents: &[Option<usize>]) -> Option<Model> {
    let links: Option<Vec<Link>> = links.iter().cloned().collect();
    Some(Model { links: super::placed(document, links?, parents), ..Model::new("", Vec3::zero()) })
}

/// The principal moments of a body about its centre of mass, from smallest to largest.
fn central_moments(body: PseudoInertia<f64>) -> [f64; 3] {
    let com = if body.mass == 0.0 { Vec3::zero() } else { body.moment.scale(1.0 / body.mass) };
    body.translated(com.scale(-1.0)).to_rigid().tensor.eigenvalues()
}

/// Whether the smallest of principal moments is negative by more than roundoff.
fn is_negative([smallest, _, largest]: [f64; 3]) -> bool {
    smallest < -DEFINITE * largest.abs().max(smallest.abs())
}

/// The eigenvalues of the tensor, from smallest to largest; `None` for the zero tensor.
fn principal_moments(inertia: &Inertia) -> Option<[f64; 3]> {
    let tensor = Sym3::from(*inertia);
    // Scaled, so that the iteration works on numbers near one.
    let scale = tensor.full().0.as_flattened().iter().fold(0.0, |largest: f64, element| largest.max(element.abs()));
    if scale == 0.0 {
        return None;
    }
    Some(tensor.map(|element| element / scale).eigenvalues().map(|moment| moment * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(xx: f64, yy: f64, zz: f64, xy: f64, yz: f64, xz: f64) -> [f64; 3] {
        principal_moments(&Inertia { xx, yy, zz, xy, yz, xz }).unwrap()
    }

    #[test]
    fn principal_moments_are_eigenvalues() {
        assert_eq!(moments(3.0, 1.0, 2.0, 0.0, 0.0, 0.0), [1.0, 2.0, 3.0]);
        let expected = [1.0, 2.0, 3.0]; // of [[2,1],[1,2]] and 2
        for (found, expected) in moments(2.0, 2.0, 2.0, 1.0, 0.0, 0.0).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(principal_moments(&Inertia::default()), None);
    }

    #[test]
    fn principal_moments_of_extreme_sizes_do_not_overflow() {
        for scale in [1e-300, 1e300] {
            let [a, _, c] = moments(2.0 * scale, 2.0 * scale, 2.0 * scale, scale, 0.0, 0.0);
            assert!((a / scale - 1.0).abs() < 1e-15 && (c / scale - 3.0).abs() < 1e-14);
        }
        assert!(principal_moments(&Inertia { xx: f64::MAX, xy: f64::MAX, ..Default::default() }).is_some());
    }
}
