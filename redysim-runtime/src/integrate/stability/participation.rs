//! Which component of the state an eigenvalue belongs to.

use crate::integrate::complex::Complex;
use crate::integrate::implicit::lu::Lu;
use crate::integrate::integration::zeros;
use crate::vector::entry;
use crate::{Real, Vector};

/// The component among those from `first` on that takes part most in the mode of `eigenvalue`: the largest
/// |w_i u_i| with the right eigenvector u and the left one w. Unlike the size of u_i alone, this does not depend on the
/// units of the components: I. J. Pérez-Arriaga, G. C. Verghese and F. C. Schweppe, *Selective modal analysis with
/// applications to electric power systems*, IEEE Trans. Power App. Syst. PAS-101 (1982).
pub fn dominant_component<S: Real, Y: Vector<S>>(
    jacobian: &Y::Of<Y>,
    eigenvalue: Complex<S>,
    first: usize,
) -> Option<usize> {
    let len = jacobian.as_ref().len();
    let like = jacobian.as_ref().first()?;
    let transposed = Y::Of::<Y>::from_fn(len, |i| Y::from_fn(len, |j| element::<S, Y>(jacobian, j, i)));
    let (right, left) = (magnitudes(jacobian, eigenvalue, like)?, magnitudes(&transposed, eigenvalue, like)?);
    let shares = right.as_ref().iter().zip(left.as_ref()).map(|(&u, &w)| u * w);
    let (component, share) = shares.enumerate().skip(first).fold((None, S::zero()), |(best, largest), (i, share)| {
        if share > largest { (Some(i), share) } else { (best, largest) }
    });
    share.is_finite().then_some(component).flatten()
}

/// |u_i| of the eigenvector, by inverse iteration in real numbers: for λ = a + i b it lies in the null space of
/// (J − a)² + b², and a vector x of that space belongs to the eigenvector x + i (a − J) x / b.
fn magnitudes<S: Real, Y: Vector<S>>(jacobian: &Y::Of<Y>, eigenvalue: Complex<S>, like: &Y) -> Option<Y> {
    let len = jacobian.as_ref().len();
    // A little beside the eigenvalue, so that the matrix is not singular.
    let beside = eigenvalue.re + S::EPSILON.powf(S::from_f64(0.75)) * eigenvalue.abs();
    let shifted = |i: usize, j: usize| element::<S, Y>(jacobian, i, j) - if i == j { beside } else { S::zero() };
    let is_real = eigenvalue.im == S::zero();
    let square = eigenvalue.im * eigenvalue.im;
    let rows = Y::Of::<Y>::from_fn(len, |i| {
        Y::from_fn(len, |j| {
            if is_real {
                return shifted(i, j);
            }
            let product = (0..len).fold(S::zero(), |sum, k| sum + shifted(i, k) * shifted(k, j));
            if i == j { product + square } else { product }
        })
    });
    let lu = Lu::<S, Y>::new(rows)?;
    let mut x = zeros(like);
    for (i, x) in x.as_mut().iter_mut().enumerate() {
        // No symmetry of a mechanism makes this orthogonal to a mode.
        *x = S::one() + S::from_f64(0.618 * i as f64 % 1.0);
    }
    for _ in 0..4 {
        lu.solve(&mut x);
        let size = x.as_ref().iter().fold(S::zero(), |size, x| size.maximum(x.abs()));
        x.as_mut().iter_mut().for_each(|x| *x = *x / size);
    }
    let imaginary = |i: usize| {
        if is_real {
            return S::zero();
        }
        (0..len).fold(S::zero(), |sum, k| sum - shifted(i, k) * entry(&x, k)) / eigenvalue.im
    };
    Some(Y::from_fn(len, |i| Complex { re: entry(&x, i), im: imaginary(i) }.abs()))
}

fn element<S: Real, Y: Vector<S>>(rows: &Y::Of<Y>, i: usize, j: usize) -> S {
    rows.as_ref().get(i).map_or(S::zero(), |row| entry(row, j))
}
