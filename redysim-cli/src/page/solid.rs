//! How large a link is, as far as its mass and inertia tell.

use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};
use redysim_model::Link;
use redysim_model::inertia::Sym3;
use serde::Serialize;

/// How the mass of a link lies about its centre, in the frame of its body.
///
/// With Σ = ½ tr(I) 1 − I = ∫ r rᵀ dm, the variances of the mass along the principal axes are the eigenvalues of Σ / m.
pub struct Solid {
    /// Centre of mass, m.
    pub com: Vector3<f64>,
    /// Standard deviations along the principal axes, m: √3 of the halves of a uniform box, √5 of the semi-axes of a
    /// uniform ellipsoid go into them.
    spread: Vector3<f64>,
    /// Takes vectors along the principal axes to the frame of the body.
    axes: Rotation3<f64>,
}

/// An ellipsoid about a centre of mass.
#[derive(Serialize)]
pub struct Ellipsoid {
    /// m.
    semi_axes: [f64; 3],
    /// Its axes in the body's frame: quaternion x, y, z, w.
    rotation: [f64; 4],
}

impl Solid {
    /// The solid of a link; without mass or inertia, a point.
    pub fn of(link: &Link) -> Solid {
        let tensor = Sym3::from(link.inertia).rotated(link.frame.rotation);
        let com = Vector3::from(link.frame.transform(link.com).0);
        if link.mass <= 0.0 {
            return Solid { com, spread: Vector3::zeros(), axes: Rotation3::identity() };
        }
        let inertia = Matrix3::from(tensor.full().0);
        let second = (Matrix3::from_diagonal_element(0.5 * inertia.trace()) - inertia) / link.mass;
        let SymmetricEigen { eigenvalues, mut eigenvectors } = second.symmetric_eigen();
        if eigenvectors.determinant() < 0.0 {
            eigenvectors.column_mut(0).neg_mut();
        }
        // What roundoff of flat and slender bodies leaves below zero is zero.
        let spread = eigenvalues.map(|variance| variance.max(0.0).sqrt());
        Solid { com, spread, axes: Rotation3::from_matrix_unchecked(eigenvectors) }
    }

    /// The uniform ellipsoid with the same mass and inertia; none of a point.
    pub fn ellipsoid(&self) -> Option<Ellipsoid> {
        let rotation = || UnitQuaternion::from_rotation_matrix(&self.axes).coords.into();
        let semi_axes = (5.0_f64.sqrt() * self.spread).into();
        (self.spread != Vector3::zeros()).then(|| Ellipsoid { semi_axes, rotation: rotation() })
    }

    /// Where the uniform box with the same mass and inertia ends, beyond the centre of mass as seen from the joint: for
    /// a uniform rod, the rod's end. A body whose centre of mass is in its joint has two ends, along the box.
    pub fn ends(&self) -> Vec<[f64; 3]> {
        let half = 3.0_f64.sqrt() * self.spread;
        let distance = self.com.norm();
        if distance > 0.0 {
            let along = self.com / distance;
            let beyond = half.dot(&self.axes.inverse_transform_vector(&along).abs());
            return vec![(along * (distance + beyond)).into()];
        }
        let longest = half.imax();
        let end = self.axes.matrix().column(longest) * half[longest];
        if half[longest] > 0.0 { vec![(-end).into(), end.into()] } else { vec![[0.0; 3]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use redysim_model::Model;

    fn solid(body: &str) -> Solid {
        let text = format!(
            "name = 'one'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'body'\nparent = 'base'\njoint = 'revolute'\n\
             axis = [0, 0, 1]\n{body}\n"
        );
        let loaded = Model::from_toml(text, "one.toml").unwrap_or_else(|faults| panic!("{faults}"));
        Solid::of(&loaded.model.links[0])
    }

    fn near(found: [f64; 3], expected: [f64; 3]) {
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-15, "{found:?} instead of {expected:?}");
    }

    #[test]
    fn the_end_of_a_uniform_rod_is_exact() {
        // 2 kg, 0.6 m along (0.6, 0, 0.8), from the joint on: m l²/12 = 0.06 across.
        let rod = "mass = 2.0\ncom = [0.18, 0, 0.24]\ninertia = { xx = 0.0384, yy = 0.06, zz = 0.0216, xz = -0.0288 }";
        let ends = solid(rod).ends();
        assert_eq!(ends.len(), 1);
        near(ends[0], [0.36, 0.0, 0.48]);
    }

    #[test]
    fn a_point_mass_ends_at_its_centre_and_has_no_ellipsoid() {
        let point = solid("mass = 2.0\ncom = [0.3, 0, 0.4]");
        near(point.ends()[0], [0.3, 0.0, 0.4]);
        assert!(point.ellipsoid().is_none());
    }

    #[test]
    fn a_bar_about_its_centre_of_mass_ends_on_both_sides() {
        // 3 kg, 0.2 by 0.4 by 0.1 m: m (b² + c²)/12.
        let bar = solid("mass = 3.0\ninertia = { xx = 0.0425, yy = 0.0125, zz = 0.05 }");
        let [first, second] = bar.ends().try_into().expect("two ends");
        near(first.map(f64::abs), [0.0, 0.2, 0.0]);
        near([0, 1, 2].map(|axis| first[axis] + second[axis]), [0.0; 3]);
    }

    /// Semi-axes 0.1, 0.2 and 0.4 m of 5 kg, m (b² + c²)/5, turned by the rotation with cosine 0.6 about z.
    #[test]
    fn the_ellipsoid_of_an_ellipsoid_is_itself() {
        let inertia = "xx = 0.1808, yy = 0.1892, zz = 0.05, xy = 0.0144";
        let ellipsoid = solid(&format!("mass = 5.0\ninertia = {{ {inertia} }}")).ellipsoid().expect("not a point");
        let mut found = ellipsoid.semi_axes;
        found.sort_by(f64::total_cmp);
        near(found, [0.1, 0.2, 0.4]);
        let [x, y, z, w] = ellipsoid.rotation;
        let axes = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        let shortest = (0..3).find(|&axis| (ellipsoid.semi_axes[axis] - 0.1).abs() < 1e-12).expect("one of them");
        let along = axes.to_rotation_matrix().matrix().column(shortest).into_owned();
        let turned = along[0].abs() * 0.6 + along[1].abs() * 0.8;
        assert!((turned - 1.0).abs() < 1e-14 && along[0] * along[1] > 0.0, "{along}");
    }
}
