//! The program that checks the code finds no fault in what compilers make of it, and the header is one of C++.

use super::compilers::{compilers, is_native};
use super::parameters::OF_GIVEN;
use super::program::InC;
use super::{FOR_HERE, builds};
use crate::NATIVE;
use rayon::prelude::*;
use redysim::Function;
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

/// Loops, frames, quaternions with hybrid dynamics, joints with drives, long functions in loops, and run-time parameters.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn every_compiler_optimises_every_kind_of_mechanism_within_the_stated_roundings() {
    let kinds = [
        ("fourbar", ""),
        ("test/frames", ""),
        ("kr5_floating", "functions = [\"forward_dynamics\", \"hybrid_dynamics\", \"momentum\"]"),
        ("kr5_drives", "functions = [\"inverse_dynamics\", \"forward_dynamics\", \"passive_forces\"]"),
        ("gripper", OF_GIVEN),
        ("peers/chain40", "functions = [\"inverse_dynamics\", \"forward_dynamics\"]"),
    ];
    let cases = kinds.into_iter().flat_map(|kind| [CScalar::F64, CScalar::F32].map(|scalar| (kind, scalar)));
    cases.collect::<Vec<_>>().par_iter().for_each(|&((model, options), scalar)| {
        let in_c = InC::new(model, options, scalar);
        compilers().iter().for_each(|compiler| in_c.check(compiler, &["-O2"]));
    });
}

/// The functions of `math.h` that the code may call in each build; a compiler may make one call of a sine and its cosine.
#[cfg(target_os = "linux")]
const MATH: [(&[&str], &[&str]); 3] = [
    (&["-O1"], &["sqrt"]),
    (&["-O1", "-DREDYSIM_FMA"], &["sqrt", "fma"]),
    (&["-O1", "-DREDYSIM_LIBM"], &["sqrt", "sin", "cos", "sincos"]),
];

/// What compilers call by themselves, for assignments of arrays and structs.
#[cfg(target_os = "linux")]
const COPIES: [&str; 2] = ["memcpy", "memset"];

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn the_objects_call_nothing_but_math_h_and_have_no_data_that_can_be_written() {
    let mechanisms = [("gripper", OF_GIVEN), ("fourbar", ""), ("test/frames", "")];
    let cases = mechanisms.into_iter().flat_map(|case| [CScalar::F64, CScalar::F32].map(|scalar| (case, scalar)));
    cases.collect::<Vec<_>>().par_iter().for_each(|&((model, options), scalar)| {
        let in_c = InC::new(model, options, scalar);
        // The builds differ in the same way in single precision.
        let (suffix, builds) = if scalar == CScalar::F32 { ("f", &MATH[..1]) } else { ("", &MATH[..]) };
        for (compiler, (flags, math)) in
            compilers().iter().flat_map(|compiler| builds.iter().map(move |build| (compiler, build)))
        {
            let symbols = in_c.symbols(compiler, flags);
            assert!(symbols.len() > in_c.functions().len());
            for (name, kind) in symbols {
                let is_expected = match kind.as_str() {
                    "U" => {
                        COPIES.contains(&&*name) || math.iter().any(|function| name == format!("{function}{suffix}"))
                    }
                    // Code and constants.
                    kind => ["T", "t", "R", "r"].contains(&kind),
                };
                assert!(is_expected, "{model} by {compiler} {flags:?}: {kind} {name}");
            }
        }
    });
}

/// The source where the first constant by which a function multiplies is larger by a millionth.
fn with_a_wrong_constant(source: &str, function: Function) -> String {
    let start = source.find(&format!("gripper_{function}_inlined(")).expect("the function");
    let (before, body) = source.split_at(start);
    let constant = |(end, _): (usize, &str)| {
        let first = body[..end].rfind([' ', '(', '-']).expect("it does not begin the function") + 1;
        body[first..end].parse::<f64>().ok().map(|constant| (first, end, constant))
    };
    let (first, end, constant) = body.match_indices(" * ").find_map(constant).expect("a constant");
    format!("{before}{}{:?}{}", &body[..first], constant * (1.0 + 1e-6), &body[end..])
}

#[test]
fn the_check_names_the_function_in_which_a_constant_is_wrong_and_no_other() {
    let in_c = InC::new("gripper", "", CScalar::F64);
    let source = in_c.source();
    let functions = [Function::InverseDynamics, Function::MassMatrix, Function::LinkKinematics];
    for wrong in &functions[..if NATIVE { 3 } else { 1 }] {
        in_c.set_source(&with_a_wrong_constant(&source, *wrong));
        let Some(compiler) = compilers().first() else { return };
        let output = in_c.run_check(compiler, &["-O0"]);
        let faults = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(1), "{wrong}: {faults}");
        let called = [format!("gripper_{wrong}: state "), format!("gripper_{wrong}_with_trig: state ")];
        let names = |line: &str| called.iter().any(|called| line.starts_with(called));
        assert!(faults.lines().count() > 1 && faults.lines().all(names), "{faults}");
    }
}

/// Within the bounds that the program has, which hold for sines of one unit in the last place.
#[test]
fn sines_of_the_c_library_stay_within_the_stated_roundings() {
    let in_c = InC::new("gripper", "", CScalar::F64);
    let in_single = InC::new("gripper", "", CScalar::F32);
    for compiler in compilers() {
        in_c.check(compiler, &["-O1", "-DREDYSIM_LIBM"]);
        in_c.check(compiler, &["-O1", "-DREDYSIM_SINCOS(x, s, c)=(*(s) = sin(x), *(c) = cos(x))"]);
        in_single.check(compiler, &["-O1", "-DREDYSIM_LIBM"]);
    }
}

/// As compilers do by default where their language is GNU's C.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn products_and_sums_that_the_compiler_fuses_stay_within_the_stated_roundings() {
    let for_here: &[&str] = if is_native() { &[FOR_HERE] } else { &[] };
    let flags = [&["-O1", "-std=gnu99", "-ffp-contract=fast"], for_here].concat();
    for scalar in [CScalar::F64, CScalar::F32] {
        let in_c = InC::new("gripper", "", scalar);
        compilers().iter().for_each(|compiler| in_c.check(compiler, &flags));
    }
}

/// As on processors with arithmetic of 16 bits (`-march=sapphirerapids`), and on the x87.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn excess_precision_of_narrower_types_is_accepted_and_of_the_own_type_reported() {
    for (scalar, own, accepted, refused) in
        [(CScalar::F64, "double", &[0, 1, 16, 32][..], &[2, -1][..]), (CScalar::F32, "float", &[0, 16], &[1, 2, -1])]
    {
        let in_c = InC::new("pppr", "", scalar);
        let source = in_c.source();
        for compiler in compilers() {
            let compile = |method| {
                let define = format!("#undef FLT_EVAL_METHOD\n#define FLT_EVAL_METHOD ({method})\n");
                in_c.set_source(&format!("#include <float.h>\n{define}{source}"));
                in_c.compile_source(compiler)
            };
            for method in accepted {
                let output = compile(method);
                assert!(output.status.success(), "{compiler} {method}: {}", String::from_utf8_lossy(&output.stderr));
            }
            for method in refused {
                let output = compile(method);
                let errors = String::from_utf8_lossy(&output.stderr);
                let message = format!("{own} is computed with excess precision: compile with -msse2 -mfpmath=sse");
                assert!(!output.status.success() && errors.contains(&message), "{compiler} {method}: {errors}");
            }
        }
    }
}
