//! One's own closure takes the place of the generated one: here that of the paper's four-bar, written out by hand as in
//! ReDySim's `jacobian.m`.

use crate::linkages::Fourbar;
use redysim::{ClosedLoop, LoopClosure, LoopRows};

/// Lengths of crank, rocker and coupler, and where the rocker's pivot is, m.
const CRANK: f64 = 0.038;
const ROCKER: f64 = 0.1152;
const COUPLER: f64 = 0.1152;
const PIVOT: f64 = -0.0895;

struct ByHand;

impl LoopRows for ByHand {
    fn nc(&self) -> usize {
        2
    }
}

impl LoopClosure<f64, Fourbar> for ByHand {
    type Rows = [f64; 2];
    type Jacobian = [[f64; 3]; 2];
    type Gram = [[f64; 2]; 2];

    fn loop_residual(&self, q: &[f64; 3]) -> [f64; 2] {
        let (crank, rocker, coupler) = (q[0], q[1], q[1] + q[2]);
        [
            PIVOT + ROCKER * rocker.cos() + COUPLER * coupler.cos() - CRANK * crank.cos(),
            ROCKER * rocker.sin() + COUPLER * coupler.sin() - CRANK * crank.sin(),
        ]
    }
    fn loop_jacobian(&self, q: &[f64; 3]) -> [[f64; 3]; 2] {
        let [(s1, c1), (s2, c2), (s3, c3)] = [q[0], q[1], q[1] + q[2]].map(f64::sin_cos);
        [
            [CRANK * s1, -ROCKER * s2 - COUPLER * s3, -COUPLER * s3],
            [-CRANK * c1, ROCKER * c2 + COUPLER * c3, COUPLER * c3],
        ]
    }
    fn loop_bias(&self, q: &[f64; 3], v: &[f64; 3]) -> [f64; 2] {
        let [(s1, c1), (s2, c2), (s3, c3)] = [q[0], q[1], q[1] + q[2]].map(f64::sin_cos);
        let [crank, rocker, coupler] = [v[0], v[1], v[1] + v[2]].map(|rate| rate * rate);
        [
            CRANK * c1 * crank - ROCKER * c2 * rocker - COUPLER * c3 * coupler,
            CRANK * s1 * crank - ROCKER * s2 * rocker - COUPLER * s3 * coupler,
        ]
    }
}

#[test]
fn a_closure_by_hand_and_the_generated_one_move_the_four_bar_alike() {
    let (generated, own) = (ClosedLoop::new(&Fourbar), ClosedLoop::with_closure(&Fourbar, &ByHand));
    let (guess, rates) = ([0.4, 1.0, 4.3], [2.0, 0.0, 0.0]);
    let ours = own.assemble(&guess, &rates, &[0]).expect("it closes");
    let theirs = generated.assemble(&guess, &rates, &[0]).expect("it closes");
    for i in 0..3 {
        assert!((ours.q[i] - theirs.q[i]).abs() < 1e-14 && (ours.v[i] - theirs.v[i]).abs() < 1e-12);
    }
    let ours = own.dynamics(&theirs.q, &theirs.v, &[0.1, 0.0, 0.0]).expect("it moves");
    let theirs = generated.dynamics(&theirs.q, &theirs.v, &[0.1, 0.0, 0.0]).expect("it moves");
    for i in 0..3 {
        let (a, b) = (ours.accelerations[i], theirs.accelerations[i]);
        assert!((a - b).abs() <= 1e-10 * (1.0 + b.abs()), "{a} {b}");
    }
    for (a, b) in ours.multipliers.iter().zip(theirs.multipliers) {
        assert!((a - b).abs() <= 1e-10 * (1.0 + b.abs()), "{a} {b}");
    }
    assert_eq!(ByHand.loop_name(0), None);
}
