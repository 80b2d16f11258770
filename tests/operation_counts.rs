//! What each function costs, so that no change makes one dearer unseen.
//!
//! After a change that is meant to alter the counts, `INSTA_UPDATE=always cargo test --test operation_counts` writes
//! the new ones to `tests/snapshots`.

use redysim::{OperationCount, Operations, redysim};

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
}

redysim! {
    /// The same with the paper's rounded digits, which belong to no body.
    #[allow(deprecated)]
    pub struct Kr5Table2("models/kr5_table2.toml");
}

redysim! {
    /// Two fingers in the plane.
    pub struct Gripper("models/gripper.toml");
}

redysim! {
    /// One loop in the plane.
    pub struct Fourbar("models/fourbar.toml");
}

redysim! {
    /// Another.
    pub struct FourbarGui("models/fourbar_gui.toml");
}

redysim! {
    /// A loop with a slider.
    pub struct SliderCrank("models/slider_crank.toml");
}

redysim! {
    /// Three legs and a platform.
    pub struct ThreeRrr("models/three_rrr.toml");
}

redysim! {
    /// Three loops.
    pub struct Leg("models/leg.toml");
}

redysim! {
    /// Three loops at one point.
    pub struct Andrews("models/andrews.toml");
}

redysim! {
    /// Two windows.
    pub struct NFourbar2("models/n_fourbar_2.toml");
}

/// A row for each function that the mechanism has.
fn table(operations: &Operations) -> String {
    let Operations {
        inverse_dynamics,
        forward_dynamics,
        mass_matrix,
        bias_forces,
        gravity_forces,
        energy,
        link_kinematics,
        loop_residual,
        loop_jacobian,
        loop_bias,
    } = operations;
    let rows = [
        ("inverse_dynamics", inverse_dynamics),
        ("forward_dynamics", forward_dynamics),
        ("mass_matrix", mass_matrix),
        ("bias_forces", bias_forces),
        ("gravity_forces", gravity_forces),
        ("energy", energy),
        ("link_kinematics", link_kinematics),
        ("loop_residual", loop_residual),
        ("loop_jacobian", loop_jacobian),
        ("loop_bias", loop_bias),
    ];
    let head = format!("{:<16} {:>5} {:>5} {:>4} {:>5} {:>6}", "function", "add", "mul", "div", "trig", "flops");
    let row = |(name, count): (&str, &OperationCount)| {
        let OperationCount { additions, multiplications, divisions, trig } = count;
        format!("{name:<16} {additions:>5} {multiplications:>5} {divisions:>4} {trig:>5} {:>6}", count.flops())
    };
    let present = rows.into_iter().filter(|(_, count)| **count != OperationCount::NONE);
    std::iter::once(head).chain(present.map(row)).collect::<Vec<_>>().join("\n")
}

#[test]
fn kr5() {
    insta::assert_snapshot!(table(&Kr5::OPS));
}

#[test]
fn kr5_table2() {
    insta::assert_snapshot!(table(&Kr5Table2::OPS));
}

#[test]
fn gripper() {
    insta::assert_snapshot!(table(&Gripper::OPS));
}

#[test]
fn inverse_dynamics_of_kr5_takes_at_most_450_operations() {
    const { assert!(Kr5::OPS.inverse_dynamics.flops() <= 450) }
    const { assert!(Kr5Table2::OPS.inverse_dynamics.flops() <= 450) }
}

#[test]
fn fourbar() {
    insta::assert_snapshot!(table(&Fourbar::OPS));
}

#[test]
fn fourbar_gui() {
    insta::assert_snapshot!(table(&FourbarGui::OPS));
}

#[test]
fn slider_crank() {
    insta::assert_snapshot!(table(&SliderCrank::OPS));
}

#[test]
fn three_rrr() {
    insta::assert_snapshot!(table(&ThreeRrr::OPS));
}

#[test]
fn leg() {
    insta::assert_snapshot!(table(&Leg::OPS));
}

#[test]
fn andrews() {
    insta::assert_snapshot!(table(&Andrews::OPS));
}

#[test]
fn n_fourbar_2() {
    insta::assert_snapshot!(table(&NFourbar2::OPS));
}
