//! A program that uses every function of a mechanism.

mod robot;
mod speed;

use robot::Robot;
use std::hint::black_box;

#[inline(never)]
fn mass_matrix(q: &[f64; Robot::NV]) -> [[f64; Robot::NV]; Robot::NV] {
    Robot::mass_matrix(q)
}

fn main() {
    let [q, v, _] = &speed::states::<f64>()[0];
    black_box(mass_matrix(black_box(q)));
    black_box(Robot::bias_forces(black_box(q), black_box(v)));
    black_box(Robot::gravity_forces(black_box(q)));
    black_box(Robot::energy(black_box(q), black_box(v)));
    black_box(Robot::link_kinematics(black_box(q), black_box(v)));
    speed::print::<f64>();
}
