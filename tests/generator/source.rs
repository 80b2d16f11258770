//! The generated code as people see it: the same every time, whole, and readable.

use redysim_codegen::{CFiles, COptions, c_files, implementation, source_file, source_file_with, stub};
use redysim_model::{CodegenOptions, Function, Functions, Loaded, Model, MovingJoint, PublicInterface};
use std::path::PathBuf;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn model(name: &str) -> Model {
    Model::load(root().join("models").join(name)).unwrap_or_else(|faults| panic!("{faults}")).model
}

/// `tests/generated/gripper.rs` is compiled by a test of the root package. After a change that is meant, write it anew
/// with `BLESS=1 cargo test --test generator source::`, and look at the difference.
#[test]
fn the_source_file_of_the_gripper_is_the_one_in_the_repository() {
    let path = root().join("tests/generated/gripper.rs");
    let source = source_file(&model("gripper.toml"), "Gripper").unwrap();
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &source).unwrap();
    }
    assert!(source == std::fs::read_to_string(&path).unwrap(), "{} is out of date", path.display());
}

/// A robot whose C code is short enough to be read: two links, a frame and two functions.
const ELBOW: &str = "name = 'elbow'\ngravity = [0, -9.81, 0]\nfunctions = ['inverse_dynamics', 'frame_kinematics']\n\
    [[link]]\nname = 'upper'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\nmass = 2.0\ncom = [0.2, 0, 0]\n\
    inertia = { zz = 0.03 }\n[[link]]\nname = 'fore'\nparent = 'upper'\njoint = 'revolute'\naxis = [0, 0, 1]\n\
    origin = { xyz = [0.4, 0, 0], rpy = [0, 0, 0] }\nmass = 1.0\ncom = [0.15, 0, 0]\ninertia = { zz = 0.01 }\n\
    [[frame]]\nname = 'hand'\nlink = 'fore'\norigin = { xyz = [0.3, 0, 0], rpy = [0, 0, 0] }";

fn elbow() -> CFiles {
    let Loaded { model, options, .. } = Model::from_toml(ELBOW, "elbow.toml").unwrap();
    c_files(&model, &COptions::default(), &options).unwrap()
}

/// Written anew as the file above. Most of the source, redysim's sine and cosine, is read where it stands.
#[test]
fn the_c_code_of_an_elbow_is_the_one_in_the_repository() {
    let CFiles { header, source, .. } = elbow();
    let start = source.find("const char *const elbow_joint_names").unwrap();
    let text = format!("{header}\n{}", &source[start..]);
    let path = root().join("tests/generated/elbow.c");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert!(text == std::fs::read_to_string(&path).unwrap(), "{} is out of date", path.display());
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    for name in ["kr5.toml", "gripper.toml"] {
        let model = model(name);
        assert_eq!(source_file(&model, "Robot").unwrap(), source_file(&model, "Robot").unwrap());
    }
    assert_eq!(elbow(), elbow());
}

#[test]
fn names_of_a_model_stay_in_strings_and_comments_of_c() {
    let text = ELBOW.replace("'elbow'", "\"for */ \\\"x\\\" ??/\"").replace("'upper'", "\"a\\u001b*/b\"");
    let Loaded { model, options, .. } = Model::from_toml(&text, "elbow.toml").unwrap();
    let CFiles { prefix, header, source, .. } = c_files(&model, &COptions::default(), &options).unwrap();
    assert_eq!(prefix, "for_x");
    assert!(header.contains("#define FOR_X_NAME \"for */ \\\"x\\\" \\?\\?/\""), "{header}");
    assert!(source.contains("\"a\\033*/b\""));
    let comments = source.split("/*").skip(1).filter_map(|rest| rest.split("*/").next());
    assert!(comments.clone().count() > 10 && comments.clone().all(|text| !text.contains('\u{1b}')));
    assert!(source.starts_with("/*\n * The mechanism `for * / "));
}

#[test]
fn temporaries_are_named_for_what_they_hold_and_the_link() {
    let source = source_file(&model("kr5.toml"), "Kr5").unwrap();
    for line in [
        ") = S::sin_cos_all([q[1], q[2], q[3], q[4], q[5]]);",
        "let w_link2_x = v[0] * sin_link2;",
        "let w_link3_z = v[1] + v[2];",
    ] {
        assert!(source.contains(line), "{line}");
    }
}

#[test]
fn functions_document_their_operations() {
    let source = source_file(&model("kr5.toml"), "Kr5").unwrap();
    let generated = implementation(&model("kr5.toml"), &quote::format_ident!("Kr5"), &quote::quote!(::redysim_runtime))
        .expect("no pass changes a value");
    // Those that every mechanism has are documented by their trait.
    for (function, count) in generated.operations.into_iter().filter(|(function, _)| !function.is_always_present()) {
        let cost = format!("/// {} flops: {} additions", count.flops(), count.additions);
        assert!(source.contains(&cost), "{function}: {cost}");
    }
}

#[test]
fn an_invalid_type_name_is_an_error() {
    let error = source_file(&model("gripper.toml"), "6-axis robot").unwrap_err();
    assert_eq!(error.to_string(), "`6-axis robot` is not a valid name for a Rust type; write for example `Robot`");
}

#[test]
fn only_selected_functions_and_their_traits_are_generated() {
    let functions = Functions::named(["gravity_forces", "loop_residual", "loop_jacobian"]).unwrap();
    let options = CodegenOptions { functions, ..CodegenOptions::default() };
    let source = source_file_with(&model("fourbar.toml"), "Fourbar", &options).unwrap();
    for &function in Function::ALL {
        let name = function.name();
        let [own, always] = [functions.contains(function), function.is_always_present()];
        for (form, there) in [
            (format!("pub fn {name}<"), own),
            (format!("pub fn {name}_with_trig<"), own),
            (format!("    fn {name}(&self"), always || function == Function::GravityForces),
            (format!("// {name} "), own || always),
        ] {
            assert_eq!(source.contains(&form), there, "{form}");
        }
    }
    // Of the closure one function is missing.
    for (trait_name, there) in
        [("GravityForces", true), ("ConfigurationSpace", true), ("MassMatrix", false), ("LoopClosure", false)]
    {
        assert_eq!(source.contains(&format!("::{trait_name}<S")), there, "{trait_name}");
    }
}

#[test]
fn a_stub_of_a_valid_model_has_the_selected_functions_only() {
    let functions = Functions::named(["energy"]).unwrap();
    let interface = PublicInterface { is_valid: true, functions, ..PublicInterface::default() };
    let stub = text_of_stub(&interface);
    assert!(
        stub.contains("pub fn energy")
            && stub.contains("pub fn energy_with_trig")
            && stub.contains("MechanicalEnergy < S >")
    );
    assert!(!stub.contains("mass_matrix") && !stub.contains("MassMatrix") && !stub.contains("LoopClosure"));
}

fn text_of_stub(interface: &PublicInterface) -> String {
    let (name, runtime) = (quote::format_ident!("Robot"), quote::quote!(::redysim_runtime));
    stub(interface, &name, &runtime, &quote::quote!(compile_error!("a fault"))).impls.to_string()
}

#[test]
fn a_stub_of_a_model_with_faults_has_every_function_and_no_size_but_the_fault() {
    let functions = Functions::named(["energy"]).unwrap();
    let text = text_of_stub(&PublicInterface { functions, links: vec!["arm".into()], ..PublicInterface::default() });
    for function in Function::ALL {
        assert!(text.contains(&format!("fn {} ", function.name())), "{}", function.name());
    }
    assert_eq!(text.matches("compile_error").count(), 1);
    let lengths = text.split("; ").skip(1).filter_map(|rest| rest.split_once(']')).map(|(length, _)| length.trim());
    let numbers: Vec<_> = lengths.filter(|length| length.parse::<usize>().is_ok()).collect();
    assert!(numbers.is_empty(), "{numbers:?} in {text}");
}

/// A base with the sizes of a free joint, and an arm on it.
#[test]
fn sizes_and_actuators_follow_the_joints_own_numbers_of_coordinates_and_velocities() {
    let names = |name: &str, components: usize| (0..components).map(|i| format!("{name}.{i}")).collect();
    let joint = |name: &str, nq, nv, actuated| {
        let (coordinates, velocities) = (names(name, nq), names(name, nv));
        MovingJoint { name: name.to_string(), coordinates, velocities, actuated }
    };
    let interface = PublicInterface {
        is_valid: true,
        joints: vec![joint("base", 7, 6, vec![false; 6]), joint("arm", 1, 1, vec![true])],
        functions: Functions::named(["mass_matrix", "inverse_dynamics"]).unwrap(),
        ..PublicInterface::default()
    };
    let text = text_of_stub(&interface);
    let text: String = text.split_whitespace().collect();
    for part in [
        "constNQ:usize=8;",
        "constNV:usize=7;",
        "JOINT_NAMES:[&'staticstr;2]=[\"base\",\"arm\"];",
        "ACTUATED:[bool;7]=[false,false,false,false,false,false,true];",
        "fnmass_matrix<S:::redysim_runtime::Scalar>(q:&[S;8])->[[S;7];7]",
        "(q:&[S;8],v:&[S;7],a:&[S;7])->[S;7]",
        "typeCoordinates=[S;8];typeVelocities=[S;7];typeState=[S;16];typeMatrix=[[S;7];7];",
        "fnintegrate(&self,q:&[S;8],dv:&[S;7])->[S;8]",
        "fndifference(&self,q0:&[S;8],q1:&[S;8])->[S;7]",
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}

#[test]
fn every_function_can_be_asked_for_by_its_name() {
    for &function in Function::ALL {
        let functions = Functions::named([function.name()]).unwrap();
        assert_eq!(functions.iter().collect::<Vec<_>>(), [function]);
    }
    assert!(Functions::named(["inverse_kinematics"]).is_err());
}
