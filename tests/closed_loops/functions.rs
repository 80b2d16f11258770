//! Residual, Jacobian and bias of every loop model: compiled as generic, consistent with each other, and no row too
//! many.
//!
//! As in `tests/targets/compiled_against_generic.rs` everything runs in double-double, so that nothing but mistakes is left to see.
#![cfg(feature = "generic")]

use crate::balls::BallPlatform;
use crate::common::call::{coordinate_rates, loop_bias, loop_jacobian, loop_residual};
use crate::common::comparison::Comparison;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::dual::{Dual, moving};
use crate::common::models::generic;
use crate::common::random::Random;
use crate::linkages::{Andrews, BallFourbar, Fourbar, FourbarGui, Leg, NFourbar2, SliderCrank, ThreeRrr};
use crate::redundant::{Bricard, FourbarSpatial};
use redysim::generic::GenericMechanism;
use redysim::{ConfigurationSpace, LoopClosure, LoopRows, Mechanism, redysim};
use std::f64::consts::PI;

redysim! {
    /// Cuts of the kinds that the others lack, between links on spherical and free joints.
    struct Cuts("models/test/cuts.toml", functions = [loop_residual, loop_jacobian, loop_bias]);
}

const STATES: usize = if cfg!(debug_assertions) { 50 } else { 200 };

/// Coordinates, with quaternions of any length, and velocities.
fn states<M: Mechanism>(mechanism: &M) -> impl Iterator<Item = [Vec<DoubleDouble>; 2]> + use<M> {
    let (mut random, nq, nv) = (Random::new(3), mechanism.nq(), mechanism.nv());
    (0..STATES).map(move |_| [random.vector(nq, PI), random.vector(nv, 3.0)].map(|values| exact(&values)))
}

/// Calls `$check` with the compiled type and the generic mechanism of each model.
macro_rules! on_every_model {
    ($check:ident) => {
        $check(&Fourbar, &generic("fourbar"));
        $check(&FourbarGui, &generic("fourbar_gui"));
        $check(&FourbarSpatial, &generic("test/fourbar_spatial"));
        $check(&Bricard, &generic("test/bricard"));
        $check(&SliderCrank, &generic("slider_crank"));
        $check(&ThreeRrr, &generic("three_rrr"));
        $check(&Leg, &generic("leg"));
        $check(&Andrews, &generic("andrews"));
        $check(&NFourbar2, &generic("n_fourbar_2"));
        $check(&BallFourbar, &generic("ball_fourbar"));
        $check(&BallPlatform, &generic("ball_platform"));
        $check(&Cuts, &generic("test/cuts"));
    };
}

#[test]
fn compiled_is_generic() {
    fn check<M>(compiled: &M, generic: &GenericMechanism)
    where
        M: ConfigurationSpace<DoubleDouble> + LoopClosure<DoubleDouble, M>,
    {
        let name = compiled.name();
        let new = |function: &str| Comparison::new(format!("{name} {function}"));
        let [mut residual, mut jacobian, mut bias] = ["residual", "jacobian", "bias"].map(new);
        for [q, v] in states(compiled) {
            residual.add(&rounded(loop_residual(compiled, &q)), &rounded(loop_residual(generic, &q)));
            let by_rows = loop_jacobian(generic, &q);
            assert_eq!(by_rows.len(), compiled.nc(), "{name}");
            jacobian.add(&rounded(loop_jacobian(compiled, &q).concat()), &rounded(by_rows.concat()));
            bias.add(&rounded(loop_bias(compiled, &q, &v)), &rounded(loop_bias(generic, &q, &v)));
        }
        [residual, jacobian, bias].iter().for_each(|comparison| comparison.assert_within(1e-12));
    }
    on_every_model!(check);
}

/// J v is how the residual changes along v, and J̇ v how J v does.
fn assert_derivatives<M>(mechanism: &M, states: impl Iterator<Item = [Vec<DoubleDouble>; 2]>)
where
    M: ConfigurationSpace<DoubleDouble> + LoopClosure<DoubleDouble, M>,
    M: ConfigurationSpace<Dual<DoubleDouble>> + LoopClosure<Dual<DoubleDouble>, M>,
{
    let name = mechanism.name();
    let new = |function: &str| Comparison::new(format!("{name} {function}"));
    let [mut jacobian, mut bias] = ["J v", "J̇ v"].map(new);
    let times = |rows: Vec<Vec<DoubleDouble>>, v: &[DoubleDouble]| -> Vec<DoubleDouble> {
        let zero = exact(&[0.0])[0];
        rows.iter().map(|row| row.iter().zip(v).fold(zero, |sum, (&j, &v)| sum + j * v)).collect()
    };
    for [q, v] in states {
        let moving = moving(&q, &coordinate_rates(mechanism, &q, &v));
        let rates: Vec<DoubleDouble> = loop_residual(mechanism, &moving).iter().map(|row| row.rate).collect();
        jacobian.add(&rounded(times(loop_jacobian(mechanism, &q), &v)), &rounded(rates));
        let rates = loop_jacobian(mechanism, &moving).iter().map(|row| row.iter().map(|j| j.rate).collect()).collect();
        bias.add(&rounded(loop_bias(mechanism, &q, &v)), &rounded(times(rates, &v)));
    }
    // The rotation in `fourbar_spatial` is one to 16 digits, not to 31.
    jacobian.assert_within(1e-12);
    bias.assert_within(1e-12);
}

#[test]
fn jacobian_and_bias_are_the_derivatives_of_the_residual() {
    fn check<M>(compiled: &M, generic: &GenericMechanism)
    where
        M: ConfigurationSpace<DoubleDouble> + LoopClosure<DoubleDouble, M>,
        M: ConfigurationSpace<Dual<DoubleDouble>> + LoopClosure<Dual<DoubleDouble>, M>,
    {
        assert_derivatives(compiled, states(compiled));
        assert_derivatives(generic, states(generic));
    }
    on_every_model!(check);
    let long = generic("n_fourbar_40");
    assert_derivatives(&long, states(&long).take(3));
}

#[test]
fn only_rows_that_vary_are_kept() {
    // Two a loop in the plane.
    assert_eq!((Fourbar::NC, FourbarGui::NC, SliderCrank::NC), (2, 2, 2));
    assert_eq!((ThreeRrr::NC, Leg::NC, Andrews::NC, NFourbar2::NC), (4, 6, 6, 4));
    assert_eq!(generic("n_fourbar_40").nc(), 80);
    // In the axes of an oblique base frame no component of the gap vanishes, but the axes are still parallel.
    assert_eq!(FourbarSpatial::NC, 3);
    assert_eq!(Bricard::NC, 5);
    // Of a universal joint four, of three balls nine; of a universal, a planar, a cylindrical and a prismatic cut all.
    assert_eq!((BallFourbar::NC, BallPlatform::NC, Cuts::NC), (4, 9, 4 + 3 + 4 + 5));
}
