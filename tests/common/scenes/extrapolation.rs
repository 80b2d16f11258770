//! Extrapolation of the midpoint rule, over any scalar: a judge that shares no code with the integrators.

use redysim::Scalar;

/// y at `end` of ẏ = f(y) from `start` at zero, by `steps` steps in each of which the midpoint rule with 2, 4, … 2 `columns`
/// substeps is extrapolated to substeps of zero: of order 2 `columns`.
///
/// Source: E. Hairer, S. P. Nørsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., Springer (1993),
/// section II.9.
pub fn extrapolated<S: Scalar>(
    f: impl Fn(&[S]) -> Vec<S>,
    start: Vec<S>,
    end: S,
    (steps, columns): (u32, u32),
) -> Vec<S> {
    let size = end / whole(steps);
    (0..steps).fold(start, |y, _| {
        // The last row of the tableau of Aitken and Neville.
        let mut row: Vec<Vec<S>> = Vec::new();
        for j in 1..=columns {
            let mut improved = midpoint(&f, &y, size / whole(2 * j), 2 * j);
            for (k, lower) in (1..j).zip(row.iter_mut()) {
                // `lower` is the entry k of the row before; substeps of the two ends are 2 j and 2 (j − k).
                let ratio = whole::<S>(j) / whole(j - k);
                let share = whole::<S>(1) / (ratio * ratio - whole(1));
                let next = combined(&improved, share, &combined(&improved, whole::<S>(0) - whole(1), lower));
                *lower = std::mem::replace(&mut improved, next);
            }
            row.push(improved);
        }
        row.pop().unwrap_or(y)
    })
}

/// `count` substeps of size `size` of the explicit midpoint rule, an even number.
fn midpoint<S: Scalar>(f: impl Fn(&[S]) -> Vec<S>, y: &[S], size: S, count: u32) -> Vec<S> {
    let (mut before, mut now) = (y.to_vec(), combined(y, size, &f(y)));
    for _ in 1..count {
        let next = combined(&before, size + size, &f(&now));
        before = std::mem::replace(&mut now, next);
    }
    now
}

/// a + `share` · b.
fn combined<S: Scalar>(a: &[S], share: S, b: &[S]) -> Vec<S> {
    a.iter().zip(b).map(|(&a, &b)| a + share * b).collect()
}

fn whole<S: Scalar>(count: u32) -> S {
    S::from_f64(f64::from(count))
}
