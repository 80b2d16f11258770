//! The crates as other programs build them: what a person reads who gets a model or a declaration wrong, which is in the
//! expected messages beside the cases; without `std`; and after a change of a model.

mod no_std;
mod rebuild;

#[cfg(feature = "cases")]
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn faults_are_compile_errors_that_show_the_line_of_the_model() {
    trybuild::TestCases::new().compile_fail("cases/*.rs");
}
