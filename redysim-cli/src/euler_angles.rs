//! Euler angles of a rotation.

use redysim_model::joint::EulerSequence;
use redysim_model::spatial::Mat3;

/// Of the sine or cosine of the second angle, what is roundoff: the first and the third axis are parallel then.
const ROUNDOFF: f64 = 8.0 * f64::EPSILON;

/// The angles φ, θ, ψ of `sequence` whose rotation R₁(φ) R₂(θ) R₃(ψ) is `rotation`, rad.
///
/// φ and ψ are from −π to π, θ is from −π/2 to π/2 if the three axes of the sequence are different, else from 0 to π. Where
/// the first and the third axis are parallel (the gimbal: θ = ±π/2, else θ = 0 and θ = π), only the sum or the difference of φ
/// and ψ matters, and ψ is 0.
pub fn euler_angles(rotation: &Mat3<f64>, sequence: EulerSequence) -> [f64; 3] {
    let [first, second, third] = sequence.axes();
    let proper = first == third;
    // The axis that is neither the second nor the third one, and the sign for which third × second = sign other.
    let other = 3 - second - third;
    let sign = if (second + 1) % 3 == other { 1.0 } else { -1.0 };
    let row = rotation.0[first];
    // The part of the first axis across the third one, in the frame that R₁ R₂ R₃ turns: R₃ has turned it by −ψ. Its length is
    // cos θ of three different axes, else sin θ, neither of which is negative.
    let across = if proper { [sign * row[other], row[second]] } else { [row[other], sign * row[second]] };
    let length = across[0].hypot(across[1]);
    let psi = if length > ROUNDOFF { across[1].atan2(across[0]) } else { 0.0 };
    let theta = if proper { length.atan2(row[third]) } else { (-sign * row[third]).atan2(length) };
    // R₁ R₂ R₃ R₃⁻¹ takes the second axis to where R₁ does.
    let (sin, cos) = psi.sin_cos();
    let second_axis = rotation.column(second).scale(cos) + rotation.column(other).scale(-sign * sin);
    let beside = 3 - first - second;
    let turned = if (first + 1) % 3 == second { 1.0 } else { -1.0 };
    [(turned * second_axis[beside]).atan2(second_axis[second]), theta, psi]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use redysim_model::rotation::{about_x, about_y, about_z};

    fn rotation(angles: [f64; 3], sequence: EulerSequence) -> Mat3<f64> {
        let about = [about_x, about_y, about_z];
        let [first, second, third] = sequence.axes().map(|axis| about[axis]);
        first(angles[0]) * second(angles[1]) * third(angles[2])
    }

    fn distance(a: &Mat3<f64>, b: &Mat3<f64>) -> f64 {
        a.0.as_flattened().iter().zip(b.0.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Angles spread over −π to π.
    fn angles(sample: u32) -> [f64; 3] {
        [0.754_877_67, 0.569_840_29, 0.430_159_71].map(|step| (f64::from(sample) * step).fract() * 2.0 * PI - PI)
    }

    #[test]
    fn angles_of_every_sequence_give_the_rotation_that_they_are_of() {
        for (name, sequence) in EulerSequence::ALL {
            for sample in 0..2000 {
                let rotation_of_sample = rotation(angles(sample), EulerSequence::Zyx);
                let [phi, theta, psi] = euler_angles(&rotation_of_sample, sequence);
                let off = distance(&rotation([phi, theta, psi], sequence), &rotation_of_sample);
                assert!(off < 2e-15, "{name}: {sample}: {off:e}");
                let [first, _, third] = sequence.axes();
                let range = if first == third { 0.0..=PI } else { -FRAC_PI_2..=FRAC_PI_2 };
                assert!(range.contains(&theta) && phi.abs() <= PI && psi.abs() <= PI, "{name}: {phi} {theta} {psi}");
            }
        }
    }

    #[test]
    fn angles_within_the_ranges_of_every_sequence_are_found_again() {
        for (name, sequence) in EulerSequence::ALL {
            let [first, _, third] = sequence.axes();
            let theta = if first == third { 2.1 } else { -1.1 };
            let given = [-2.9, theta, 3.0];
            let found = euler_angles(&rotation(given, sequence), sequence);
            assert!(given.iter().zip(found).all(|(given, found)| (given - found).abs() < 1e-14), "{name}: {found:?}");
        }
    }

    #[test]
    fn in_the_gimbal_of_every_sequence_the_third_angle_is_zero() {
        for (name, sequence) in EulerSequence::ALL {
            let [first, _, third] = sequence.axes();
            let thetas = if first == third { [0.0, PI] } else { [-FRAC_PI_2, FRAC_PI_2] };
            for theta in thetas {
                for sample in 0..100 {
                    let [phi, _, psi] = angles(sample);
                    let given = rotation([phi, theta, psi], sequence);
                    let found = euler_angles(&given, sequence);
                    assert_eq!(found[1..], [theta, 0.0], "{name}");
                    let off = distance(&rotation(found, sequence), &given);
                    assert!(off < 2e-15, "{name}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn beside_the_gimbal_of_every_sequence_the_rotation_is_as_exact_as_elsewhere() {
        for (name, sequence) in EulerSequence::ALL {
            let [first, _, third] = sequence.axes();
            let gimbal = if first == third { 0.0 } else { FRAC_PI_2 };
            for off_gimbal in [1e-3, 1e-8, 1e-12, 1e-15, 1e-17] {
                let given = rotation([0.7, gimbal - off_gimbal, -1.9], sequence);
                let off = distance(&rotation(euler_angles(&given, sequence), sequence), &given);
                assert!(off < 4e-15, "{name}: {off_gimbal:e}: {off:e}");
            }
        }
    }
}
