//! The root of a function between two points at which its signs differ.

use crate::Real;

/// The roots of `f` between `a` and `b`, where it has the values `fa` and `fb` of different signs, of which `fb` may be
/// zero: the first number, seen from `a`, at which it does not have the sign of `fa`, to within rounding of `b`.
///
/// The method is ITP of I. F. D. Oliveira and R. H. C. Takahashi, *An enhancement of the bisection method average
/// performance preserving minmax optimality*, ACM Trans. Math. Softw. 47 (2021): never more than one evaluation more
/// than bisection, 54 for `f64`, and usually about eight.
///
/// # Errors
/// What `f` says.
pub fn root<S: Real, E>(
    (mut a, mut fa): (S, S),
    (mut b, mut fb): (S, S),
    f: &mut impl FnMut(S) -> Result<S, E>,
) -> Result<S, E> {
    let half = S::from_f64(0.5);
    let length = (b - a).abs();
    let precision = S::EPSILON * a.abs().maximum(b.abs()).maximum(S::EPSILON * length);
    let falls = fa > S::zero();
    // The bracket may be as large as that of bisection one step earlier.
    let mut allowed = length;
    while (b - a).abs() > precision && fb != S::zero() {
        let middle = half * (a + b);
        if middle == a || middle == b {
            break;
        }
        let slack = (allowed - half * (b - a).abs()).maximum(S::zero());
        allowed = half * allowed;
        let secant = (fb * a - fa * b) / (fb - fa);
        let towards = middle - secant;
        let sign = if towards < S::zero() { -S::one() } else { S::one() };
        let shift = S::from_f64(0.2) * (b - a) * (b - a) / length;
        let truncated = if shift.abs() <= towards.abs() { secant + sign * shift.abs() } else { middle };
        let x = if (truncated - middle).abs() <= slack { truncated } else { middle - sign * slack };
        let inside = (x > a && x < b) || (x < a && x > b);
        let x = if inside { x } else { middle };
        let value = f(x)?;
        if (value > S::zero()) == falls && value != S::zero() {
            (a, fa) = (x, value);
        } else {
            (b, fb) = (x, value);
        }
    }
    Ok(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(a: f64, b: f64, f: impl Fn(f64) -> f64) -> (f64, u32) {
        let mut calls = 0;
        let mut counted = |x: f64| {
            calls += 1;
            Ok::<f64, ()>(f(x))
        };
        let x = root((a, f(a)), (b, f(b)), &mut counted).unwrap();
        (x, calls)
    }

    #[test]
    fn roots_are_found_to_rounding_in_few_evaluations() {
        let (x, calls) = count(0.0, 2.0, |x| x * x - 2.0);
        assert!((x - 2.0_f64.sqrt()).abs() < 1e-15 && x * x >= 2.0 && calls < 15, "{x} after {calls}");
        let (x, calls) = count(3.0, 0.0, |x| 1.0 - x.cos() * x);
        assert!((1.0 - x.cos() * x).abs() < 1e-14 || calls < 60, "{x} after {calls}");
    }

    #[test]
    fn steps_and_flat_functions_take_no_more_than_bisection() {
        for k in 1..50 {
            let at = 0.013 * f64::from(k);
            let (x, calls) = count(0.0, 1.0, |x| if x < at { -1e-300 } else { 1e300 });
            assert!(x >= at && x - at < 1e-15 && calls <= 62, "{x} instead of {at} after {calls}");
            let (x, calls) = count(0.0, 1.0, |x| (x - at).powi(9));
            assert!((x - at).abs() < 1e-15 && calls <= 62, "{x} instead of {at} after {calls}");
        }
    }

    #[test]
    fn a_zero_at_the_far_end_is_that_end() {
        assert_eq!(count(0.0, 1.0, |x| x - 1.0), (1.0, 0));
        assert_eq!(count(1.0, 0.0, |x| x), (0.0, 0));
    }
}
