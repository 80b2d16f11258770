//! Mass and inertia that a body can have.

use super::lints;
use crate::inertia::Sym3;
use crate::lint::Lint;
use crate::messages;
use crate::model::Inertia;
use crate::schema::LinkTable;
use redysim_toml::Findings;

/// Roundoff allowed below zero, relative to the largest principal moment.
const DEFINITE: f64 = 1e-12;

/// Excess allowed over the triangle inequality, relative to the largest principal moment: rods lie on its edge.
const TRIANGLE: f64 = 1e-9;

pub(super) fn check(link: &LinkTable, findings: &mut Findings) {
    if let Some(mass) = link.mass.spanned().filter(|mass| *mass.get_ref() < 0.0) {
        findings.error(mass.span(), messages::negative_mass(&link.item, *mass.get_ref()));
    }
    let Some(inertia) = link.inertia.spanned() else { return };
    let Some([smallest, middle, largest]) = principal_moments(inertia.get_ref()) else {
        return;
    };
    let excess = largest - (smallest + middle);
    if smallest < -DEFINITE * largest.abs().max(smallest.abs()) {
        findings.error(inertia.span(), messages::indefinite_inertia(&link.item, smallest));
    } else if excess > TRIANGLE * largest {
        let message = messages::triangle(&link.item, largest, excess);
        lints::report(findings, Lint::InertiaTriangle, inertia.span(), message);
    }
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
