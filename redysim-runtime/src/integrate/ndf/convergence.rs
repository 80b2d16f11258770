//! Each formula alone, with steps of one size and an exact past.

extern crate std;

use std::println;

use super::coefficients::{BACKWARD_DIFFERENTIATION, NUMERICAL_DIFFERENTIATION};
use super::differences::Differences;
use super::formula::NdfFormula;
use crate::integrate::Tolerances;
use crate::integrate::algorithm::Formula;
use crate::integrate::integration::Integration;

const START: f64 = 0.5;
const END: f64 = 2.5;

/// ẏ₁ = −2 t y₁², ẏ₂ = cos(t) (1 + y₂²), with the solution 1/(1 + t²), tan(sin t).
fn nonlinear(t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
    *dydt = [-2.0 * t * y[0] * y[0], t.cos() * (1.0 + y[1] * y[1])];
}

fn exact(t: f64) -> [f64; 2] {
    [1.0 / (1.0 + t * t), t.sin().tan()]
}

fn error(t: f64, y: &[f64; 2]) -> f64 {
    exact(t).iter().zip(y).map(|(exact, y)| (y - exact).abs()).fold(0.0, f64::max)
}

/// The largest errors at and between the ends of steps, of the formula of `order` with `steps` steps.
fn errors(kappas: &'static [f64], order: usize, steps: u32) -> [f64; 2] {
    let tolerances = Tolerances::new(1e-13, 1e-13);
    let size = (END - START) / f64::from(steps);
    let mut ode = nonlinear;
    let mut integration = Integration::new(&mut ode, tolerances, START, exact(START)).unwrap();
    let mut formula = NdfFormula::new(kappas, &mut integration).unwrap();
    formula.set_past(Differences::from_past(order, size, |back| exact(START - size * back as f64)));
    let (mut at, mut between) = (0.0_f64, 0.0_f64);
    for step in 1..=steps {
        integration.progress.t_new = START + size * f64::from(step);
        formula.attempt(&mut integration).unwrap();
        let shown = formula.step(&integration.progress);
        at = at.max(error(shown.end().0, shown.end().1));
        for theta in [0.25, 0.5, 0.75] {
            let t = shown.start().0 + theta * size;
            between = between.max(error(t, &shown.at(t)));
        }
        integration.progress.accept();
        formula.advance(&mut integration, false).unwrap();
    }
    assert_eq!(integration.progress.statistics.steps, u64::from(steps));
    [at, between]
}

#[test]
fn each_formula_converges_with_its_order_at_and_between_the_ends_of_steps() {
    for kappas in [&NUMERICAL_DIFFERENTIATION, &BACKWARD_DIFFERENTIATION] {
        for (order, steps) in (1..=5).zip([6400, 800, 400, 200, 200]) {
            let (coarse, fine) = (errors(kappas, order, steps), errors(kappas, order, 2 * steps));
            let measured = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
            println!("order {order}: measured {:.3}, {:.3} between", measured[0], measured[1]);
            for p in measured {
                assert!((p - order as f64).abs() < 0.15, "order {order} is {p}");
            }
        }
    }
}

/// The errors of orders 1 to 4 are smaller by the ratio of κ γ_k + 1/(k + 1) to 1/(k + 1), 0.63 for order 1.
#[test]
fn numerical_differentiation_is_more_accurate_than_backward_differentiation() {
    for (order, steps, ratio) in [(1, 6400, 0.63), (2, 1600, 0.5), (3, 800, 0.396), (4, 400, 0.568)] {
        let [ndf, bdf] =
            [&NUMERICAL_DIFFERENTIATION, &BACKWARD_DIFFERENTIATION].map(|kappas| errors(kappas, order, steps)[0]);
        println!("order {order}: {:.3}", ndf / bdf);
        assert!((ndf / bdf / ratio - 1.0).abs() < 0.1, "order {order}: {} instead of {ratio}", ndf / bdf);
    }
}
