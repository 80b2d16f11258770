//! The program that checks the code finds no fault in what compilers make of it, and the header is one of C++.

use super::builds;
use super::compilers::compilers;
use super::program::InC;
use rayon::prelude::*;
use redysim_codegen::CScalar;

/// Its square roots are those of four legs.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn friction_in_four_legs_side_by_side_is_within_the_stated_roundings_in_c() {
    let file = format!("{}/models/quadruped.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(file).expect("the model");
    let joint = "joint = \"revolute\"\n";
    let rough = text.replace(joint, &format!("{joint}friction = 0.3\nfriction_velocity = 0.02\n"));
    for scalar in [CScalar::F64, CScalar::F32] {
        let options = "functions = [\"inverse_dynamics\", \"forward_dynamics\"]";
        let in_c = InC::of_text(&rough, "rough_quadruped", options, scalar);
        assert!(in_c.source().contains("REDYSIM_FOUR_SQUARE_ROOT(REDYSIM_FOUR_MULTIPLY_ADD("));
        for (compiler, build) in
            compilers().iter().flat_map(|compiler| builds().iter().map(move |build| (compiler, build)))
        {
            in_c.check(compiler, &[&["-O1"], *build].concat());
        }
    }
}

/// Far from the origin, too, where a free body's momentum is a small difference.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn the_check_of_every_shipped_model_finds_no_fault() {
    let folder = format!("{}/models", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).expect("the models").map(|entry| entry.expect("an entry").path());
    let models: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(models.len() > 30);
    let compiler = &compilers()[0];
    models.par_iter().for_each(|path| {
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name");
        for scalar in [CScalar::F64, CScalar::F32] {
            InC::new(name, "", scalar).check(compiler, &["-O0"]);
        }
    });
}

#[test]
fn the_header_is_one_of_cpp_too() {
    let options = "parameters = [\"gravity\", \"link6.mass\"]";
    for (model, options) in [("kr5_tool", options), ("test/frames", "")] {
        let in_c = InC::new(model, options, CScalar::F64);
        compilers().iter().for_each(|compiler| in_c.read_by_cpp(compiler));
    }
}

/// Within the bounds that the program has, which hold for sines of one unit in the last place.
#[test]
fn sines_of_the_c_library_stay_within_the_stated_roundings() {
    let in_c = InC::new("gripper", "", CScalar::F64);
    for compiler in compilers() {
        in_c.check(compiler, &["-O1", "-DREDYSIM_LIBM"]);
        in_c.check(compiler, &["-O1", "-DREDYSIM_SINCOS(x, s, c)=(*(s) = sin(x), *(c) = cos(x))"]);
    }
}
