//! Compiled functions allocate nothing.

use redysim::{LinkState, redysim};
use std::hint::black_box;

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
}

redysim! {
    /// Prismatic, fixed and oblique joints, branching.
    pub struct Gantry("models/test/gantry.toml");
}

fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

#[test]
fn allocations_are_seen() {
    assert_eq!(allocations(|| drop(black_box(vec![1.0_f64; 6]))), 1);
}

macro_rules! assert_nothing_allocated {
    ($mechanism:ident, $scalar:ty) => {
        let (q, v, x) = black_box(([0.1 as $scalar; $mechanism::NV], [0.2; $mechanism::NV], [0.3; $mechanism::NV]));
        let calls: [(&str, &dyn Fn()); 7] = [
            ("inverse_dynamics", &|| _ = black_box($mechanism::inverse_dynamics(&q, &v, &x))),
            ("forward_dynamics", &|| _ = black_box($mechanism::forward_dynamics(&q, &v, &x))),
            ("mass_matrix", &|| _ = black_box($mechanism::mass_matrix(&q))),
            ("bias_forces", &|| _ = black_box($mechanism::bias_forces(&q, &v))),
            ("gravity_forces", &|| _ = black_box($mechanism::gravity_forces(&q))),
            ("energy", &|| _ = black_box($mechanism::energy(&q, &v))),
            ("link_kinematics", &|| {
                let links: [LinkState<$scalar>; $mechanism::NL] = $mechanism::link_kinematics(&q, &v);
                black_box(&links);
            }),
        ];
        for (function, call) in calls {
            assert_eq!(allocations(call), 0, "{} {function}", $mechanism::NAME);
        }
    };
}

#[test]
fn functions_allocate_nothing() {
    assert_nothing_allocated!(Kr5, f64);
    assert_nothing_allocated!(Kr5, f32);
    assert_nothing_allocated!(Gantry, f64);
    assert_nothing_allocated!(Gantry, f32);
}
