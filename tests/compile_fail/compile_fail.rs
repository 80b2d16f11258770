//! What a person reads who gets a model or a declaration wrong. The expected messages stand beside the cases.

#[test]
fn faults_are_compile_errors_that_show_the_line_of_the_model() {
    trybuild::TestCases::new().compile_fail("cases/*.rs");
}
