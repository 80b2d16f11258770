//! Lints: each is reported of a model that has what it is about, ends with `allow`, and is not reported of the models that
//! are shipped.

use redysim_model::{Diagnostic, GenericMechanism, Lint, Loaded, Model};
use redysim_runtime::MassMatrix;
use std::fs;
use std::path::{Path, PathBuf};

/// An arm without lints.
const ARM: &str = r#"
name = "arm"
gravity = [0.0, 0.0, -9.81]

[[link]]
name = "turret"
parent = "base"
joint = "revolute"
dh = { b = 0.3 }
mass = 8.0
com = [0.0, 0.05, 0.1]
inertia = { xx = 0.1, yy = 0.1, zz = 0.05 }
range = { position = ["-170 deg", 2.9], velocity = 1, acceleration = 1 }

[[link]]
name = "upper"
parent = "turret"
joint = "revolute"
dh = { a = 0.1, alpha = "90 deg" }
mass = 5.0
com = [0.2, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.1, zz = 0.1 }

[[link]]
name = "fore"
parent = "upper"
joint = "revolute"
dh = { a = 0.4 }
mass = 2.0
com = [0.15, 0.0, 0.0]
inertia = { xx = 0.002, yy = 0.02, zz = 0.02 }

[[link]]
name = "wrist"
parent = "fore"
joint = "revolute"
dh = { a = 0.05, alpha = "90 deg", b = 0.3 }
mass = 0.5
com = [0.01, 0.0, -0.05]
inertia = { xx = 0.001, yy = 0.001, zz = 0.0005 }
"#;

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")
}

fn load(text: &str) -> Loaded {
    Model::from_toml(text, "model.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

/// The names of what is reported of a model, each once.
fn lints(loaded: &Loaded) -> Vec<&'static str> {
    let mut names: Vec<_> = loaded.warnings.iter().chain(&loaded.notes).filter_map(Diagnostic::lint).collect();
    names.dedup();
    names
}

/// The arm with each text replaced by another, which must be there.
fn arm(replaced: &[(&str, &str)]) -> String {
    replaced.iter().fold(ARM.to_string(), |text, (old, new)| {
        assert!(text.contains(old), "{old}");
        text.replace(old, new)
    })
}

fn without_inertias() -> String {
    ARM.lines().filter(|line| !line.starts_with("inertia")).map(|line| format!("{line}\n")).collect()
}

/// Masses in g, and inertias in g m².
fn in_grams() -> String {
    arm(&[
        ("mass = 8.0", "mass = 8000"),
        ("mass = 5.0", "mass = 5000"),
        ("mass = 2.0", "mass = 2000"),
        ("mass = 0.5", "mass = 500"),
        ("{ xx = 0.1, yy = 0.1, zz = 0.05 }", "{ xx = 100, yy = 100, zz = 50 }"),
        ("{ xx = 0.01, yy = 0.1, zz = 0.1 }", "{ xx = 10, yy = 100, zz = 100 }"),
        ("{ xx = 0.002, yy = 0.02, zz = 0.02 }", "{ xx = 2, yy = 20, zz = 20 }"),
        ("{ xx = 0.001, yy = 0.001, zz = 0.0005 }", "{ xx = 1, yy = 1, zz = 0.5 }"),
    ])
}

/// A chain of revolute joints with rows (a, alpha in degrees, d or b) under `key`; joints in `slides` are prismatic.
fn chain(key: &str, rows: &[[f64; 3]], slides: &[usize]) -> String {
    let along = if key == "dh" { "b" } else { "d" };
    let link = |(i, [a, alpha, d]): (usize, &[f64; 3])| {
        let parent = i.checked_sub(1).map_or("base".into(), |parent| format!("link{parent}"));
        let joint = if slides.contains(&i) { "prismatic" } else { "revolute" };
        format!(
            "[[link]]\nname = 'link{i}'\nparent = '{parent}'\njoint = '{joint}'\n\
             {key} = {{ a = {a:?}, alpha = '{alpha} deg', {along} = {d:?} }}\nmass = 2.0\ncom = [0.01, 0.02, 0.03]\n\
             inertia = {{ xx = 0.02, yy = 0.02, zz = 0.02 }}\n"
        )
    };
    let links: String = rows.iter().enumerate().map(link).collect();
    format!("name = 'chain'\ngravity = [0, 0, -9.81]\n{links}")
}

/// A robot, its rows, and its joints that slide.
type Rows = (&'static str, &'static [[f64; 3]], &'static [usize]);

/// Standard rows as published.
const PUBLISHED: [Rows; 7] = [
    (
        "UR5, data sheet",
        &[
            [0.0, 90.0, 0.089159],
            [-0.425, 0.0, 0.0],
            [-0.39225, 0.0, 0.0],
            [0.0, 90.0, 0.10915],
            [0.0, -90.0, 0.09465],
            [0.0, 0.0, 0.0823],
        ],
        &[],
    ),
    (
        "UR10, data sheet",
        &[
            [0.0, 90.0, 0.1273],
            [-0.612, 0.0, 0.0],
            [-0.5723, 0.0, 0.0],
            [0.0, 90.0, 0.163941],
            [0.0, -90.0, 0.1157],
            [0.0, 0.0, 0.0922],
        ],
        &[],
    ),
    (
        "PUMA 560, Corke",
        &[
            [0.0, 90.0, 0.0],
            [0.4318, 0.0, 0.0],
            [0.0203, -90.0, 0.15005],
            [0.0, 90.0, 0.4318],
            [0.0, -90.0, 0.0],
            [0.0, 0.0, 0.0],
        ],
        &[],
    ),
    (
        "Stanford arm, Paul",
        &[
            [0.0, -90.0, 0.412],
            [0.0, 90.0, 0.154],
            [0.0, 0.0, 0.3],
            [0.0, -90.0, 0.0],
            [0.0, 90.0, 0.0],
            [0.0, 0.0, 0.263],
        ],
        &[2],
    ),
    (
        "KUKA LBR iiwa 7",
        &[
            [0.0, -90.0, 0.34],
            [0.0, 90.0, 0.0],
            [0.0, 90.0, 0.4],
            [0.0, -90.0, 0.0],
            [0.0, -90.0, 0.4],
            [0.0, 90.0, 0.0],
            [0.0, 0.0, 0.126],
        ],
        &[],
    ),
    (
        "Kinova Gen3 6DOF",
        &[
            [0.0, 90.0, 0.2433],
            [0.28, 180.0, 0.03],
            [0.0, 90.0, 0.02],
            [0.0, 90.0, 0.245],
            [0.0, 90.0, 0.057],
            [0.0, 180.0, 0.235],
        ],
        &[],
    ),
    ("three links in a plane", &[[0.3, 0.0, 0.0], [0.4, 0.0, 0.0], [0.0, 0.0, 0.0]], &[]),
];

/// Rows of Khalil and Kleinfinger for the robot of standard rows: each has the a and alpha of the one before.
fn khalil_kleinfinger(standard: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let before = std::iter::once(&[0.0; 3]).chain(standard);
    before.zip(standard).map(|([a, alpha, _], [_, _, d])| [*a, *alpha, *d]).collect()
}

#[test]
fn an_arm_in_si_units_has_no_lints() {
    assert_eq!(lints(&load(ARM)), [""; 0]);
}

/// The arm with a spring between two points.
fn sprung(ends: &str) -> String {
    format!("{ARM}\n[[spring]]\n{ends}\nstiffness = 100.0\nlength = 0.2\n")
}

/// For each lint, a model that has what it is about and nothing else.
fn cases() -> Vec<(Lint, String)> {
    let warn = |name: &str| fs::read_to_string(models().join(format!("warn/{name}.toml"))).unwrap();
    vec![
        (Lint::AngleUnits, arm(&[("a = 0.1, alpha = \"90 deg\"", "a = 0.1, alpha = 90")])),
        (Lint::AngleUnits, arm(&[("mass = 0.5", "mass = 0.5\nstiffness = 10\nrest = 90")])),
        (
            Lint::AngleUnits,
            arm(&[("dh = { a = 0.05, alpha = \"90 deg\", b = 0.3 }", "origin = {}\naxis = [0, 0, 1]\noffset = 90")]),
        ),
        (Lint::AngleUnits, arm(&[("mass = 0.5", "mass = 0.5\nmimic = { joint = 'fore', offset = 90 }")])),
        (Lint::RoundedAngle, arm(&[("a = 0.1, alpha = \"90 deg\"", "a = 0.1, alpha = 1.5708")])),
        (Lint::RangeUnits, arm(&[("[\"-170 deg\", 2.9]", "[-170, 170]")])),
        (Lint::LengthUnits, arm(&[("a = 0.4 ", "a = 400 ")])),
        (Lint::LengthUnits, arm(&[("com = [0.15, ", "com = [150, ")])),
        // Small enough in millimetres not to be far too long in metres.
        (
            Lint::LengthUnits,
            arm(&[
                ("0.3", "15"),
                ("a = 0.1,", "a = 10,"),
                ("a = 0.4", "a = 30"),
                ("8.0", "0.8"),
                ("5.0", "0.5"),
                ("2.0", "0.2"),
            ]),
        ),
        (
            Lint::MassUnits,
            arm(&[
                ("mass = 0.5", "mass = 5e-5"),
                ("{ xx = 0.001, yy = 0.001, zz = 0.0005 }", "{ xx = 1e-8, yy = 1e-8, zz = 1e-8 }"),
            ]),
        ),
        (Lint::MassUnits, in_grams()),
        (Lint::RadiusOfGyration, arm(&[("mass = 5.0", "mass = 5000.0")])),
        (Lint::RadiusOfGyration, arm(&[("{ xx = 0.01, yy = 0.1, zz = 0.1 }", "{ xx = 1e4, yy = 1e5, zz = 1e5 }")])),
        (Lint::RadiusOfGyration, arm(&[("{ xx = 0.01, yy = 0.1, zz = 0.1 }", "{ xx = 1e-8, yy = 1e-7, zz = 1e-7 }")])),
        // In kg dm²: no larger than the arm, but than the wrist that it carries 0.3 m away, and than the way to the last link.
        (Lint::RadiusOfGyration, arm(&[("{ xx = 0.002, yy = 0.02, zz = 0.02 }", "{ xx = 0.5, yy = 5.0, zz = 5.0 }")])),
        (
            Lint::RadiusOfGyration,
            arm(&[("{ xx = 0.001, yy = 0.001, zz = 0.0005 }", "{ xx = 0.9, yy = 0.9, zz = 0.5 }")]),
        ),
        (Lint::InertiaTriangle, arm(&[("{ xx = 0.01, yy = 0.1, zz = 0.1 }", "{ xx = 0.01, yy = 0.1, zz = 0.2 }")])),
        (Lint::NegativeMoment, with_antenna("wrist", -1e-7)),
        (Lint::NegativeMoment, with_antenna("base", -0.5)),
        (Lint::MissingInertia, arm(&[("inertia = { xx = 0.01, yy = 0.1, zz = 0.1 }", "")])),
        (Lint::GravityUnits, arm(&[("-9.81", "-9810.0")])),
        (Lint::GravityUnits, arm(&[("-9.81", "-32.174")])),
        (Lint::GravityUp, arm(&[("-9.81", "9.81")])),
        (Lint::GravityUp, arm(&[("0.0, -9.81", "9.81, 0.0")])),
        (Lint::DhConvention, chain("dh", PUBLISHED[0].1, &[])),
        (Lint::DhConvention, chain("dh_standard", &khalil_kleinfinger(PUBLISHED[0].1), &[])),
        (Lint::LengthUnits, sprung("link_b = 'fore'\nlink_a = 'turret'").replace("length = 0.2", "length = 200")),
        (Lint::SpringWithoutEffect, sprung("link_b = 'upper'\nlink_a = 'turret'\npoint_a = [0.1, 0, 0.2]")),
        (
            Lint::SpringDirection,
            sprung("link_b = 'fore'\nlink_a = 'upper'\npoint_b = [0, 0.1, 0]\npoint_a = [0.4, 0.1, 0]"),
        ),
        (Lint::LoopOpen, warn("loop_stays_open")),
        (Lint::LoopWithoutConstraints, warn("loop_without_constraints")),
        (Lint::RedundantConstraints, warn("redundant_rows")),
        (Lint::NoMobility, warn("no_mobility")),
        (Lint::OverActuated, warn("over_actuated")),
        (Lint::NoGravity, arm(&[("-9.81", "0.0")])),
        (Lint::OtherGravity, arm(&[("-9.81", "-1.62")])),
        (Lint::PointMasses, without_inertias()),
        (Lint::UnderActuated, arm(&[("mass = 0.5", "mass = 0.5\nactuated = false")])),
    ]
}

#[test]
fn each_lint_is_reported_once_of_a_model_that_has_it_and_ends_with_allow() {
    let cases = cases();
    for (lint, text) in &cases {
        let loaded = load(text);
        let found: Vec<&Diagnostic> =
            loaded.warnings.iter().chain(&loaded.notes).filter(|found| found.lint() == Some(lint.name())).collect();
        let [found] = found[..] else { panic!("{lint}: {:?} of\n{text}", lints(&loaded)) };
        // The shortest models, of loops, have points of mass.
        let others: Vec<_> =
            lints(&loaded).into_iter().filter(|name| ![lint.name(), "point-masses"].contains(name)).collect();
        assert!(others.is_empty(), "{lint}: {others:?} of\n{text}");
        assert!(found.position().is_some(), "{found}");
        let way_out = format!("`allow = [\"{lint}\"]`");
        let itself = [Lint::AngleUnits, Lint::RoundedAngle].contains(lint);
        assert!(itself || found.help().contains(&way_out), "{found}");

        let allowed = load(&format!("allow = ['{lint}']\n{text}"));
        assert!(!lints(&allowed).contains(&lint.name()), "{lint}");
    }
    for lint in Lint::ALL {
        assert!(cases.iter().any(|(case, _)| *case == lint), "{lint} has no case");
    }
}

#[test]
fn a_wheel_with_its_centre_of_mass_next_to_its_joint_is_larger_than_what_its_joint_shows() {
    let wheel = "\n[[link]]\nname = 'wheel'\nparent = 'turret'\njoint = 'revolute'\naxis = [0, 1, 0]\n\
                 origin = { xyz = [0, 0.2, 0] }\nmass = 4\ncom = [0.001, 0.02, 0]\ninertia = { xx = 0.15, yy = 0.3, zz = 0.15 }\n";
    assert_eq!(lints(&load(&format!("{ARM}{wheel}"))), [""; 0]);
}

/// The arm with a link that is fixed to another, and that has a principal moment of `smallest`.
fn with_antenna(parent: &str, smallest: f64) -> String {
    format!(
        "{ARM}\n[[link]]\nname = 'antenna'\nparent = '{parent}'\njoint = 'fixed'\norigin = {{ xyz = [0, 0, 0.1] }}\n\
         mass = 0.2\ninertia = {{ xx = 1e-3, yy = 1e-3, zz = {smallest:?} }}\n"
    )
}

/// The wrist has moments of 5e-4 to 1e-3 kg m²; with the antenna, whose mass is beside it, the largest is about 0.005.
#[test]
fn a_negative_moment_of_a_link_that_is_not_small_beside_those_of_its_rigid_body_is_an_error() {
    load(&with_antenna("wrist", -1e-6));
    let negative = |text: &str| {
        let faults = Model::from_toml(text, "model.toml").unwrap_err();
        let titles: Vec<_> = faults.errors().map(Diagnostic::title).collect();
        assert!(titles.iter().any(|title| title.contains("has a negative principal moment")), "{titles:?}");
    };
    negative(&with_antenna("wrist", -1e-4));
    // Alone on its joint, it may make the mass matrix indefinite, however small it is.
    negative(&with_antenna("wrist", -1e-7).replace("'fixed'", "'revolute'\naxis = [0, 0, 1]"));
    // Also where another fault leaves no tree to look at.
    negative(&with_antenna("wrst", -1e-7));
}

/// Every motion of the arm that carries the antenna has kinetic energy: the pivots of its mass matrix are positive.
#[test]
fn the_mass_matrix_of_a_model_with_a_negative_moment_that_is_accepted_is_positive_definite() {
    let mechanism = GenericMechanism::new(load(&with_antenna("wrist", -1e-6)).model);
    for position in 0..20 {
        let mut matrix = mechanism.mass_matrix(&mechanism.tree().sample(position));
        for k in (0..matrix.len()).rev() {
            assert!(matrix[k][k] > 0.0, "position {position}, pivot {k}: {}", matrix[k][k]);
            let row = matrix[k].clone();
            for above in matrix.iter_mut().take(k) {
                let factor = above[k] / row[k];
                above.iter_mut().zip(&row).for_each(|(element, pivot)| *element -= factor * pivot);
            }
        }
    }
}

#[test]
fn notes_are_not_among_the_warnings() {
    let moon = load(&arm(&[("-9.81", "-1.62")]));
    assert!(moon.warnings.is_empty() && moon.notes.len() == 1);
}

#[test]
fn rows_of_published_robots_are_told_apart_from_those_of_the_other_convention() {
    for (robot, rows, slides) in PUBLISHED {
        let modified = khalil_kleinfinger(rows);
        let dh_convention = [Lint::DhConvention.name()];
        assert_eq!(lints(&load(&chain("dh_standard", rows, slides))), [""; 0], "{robot}");
        assert_eq!(lints(&load(&chain("dh", &modified, slides))), [""; 0], "{robot}");
        assert_eq!(lints(&load(&chain("dh", rows, slides))), dh_convention, "{robot}");
        // The first two axes are one only where the first row vanishes, as that of every robot on a vertical axis does.
        assert_eq!(lints(&load(&chain("dh_standard", &modified, slides))), dh_convention, "{robot}");
    }
}

/// A leg has a twist before its first joint, and parallel axes at its end; a mechanism whose first axis lies in the base
/// frame's x-y plane has one as well.
#[test]
fn twists_before_the_first_joint_are_no_sign_of_standard_rows() {
    for rows in [
        &[[0.0, 90.0, 0.1], [0.08, 90.0, 0.0], [0.35, 0.0, 0.0]][..],
        &[[0.0, 90.0, 0.0], [0.4, 0.0, 0.0], [0.4, 0.0, 0.0], [0.1, 0.0, 0.0]],
        &[[0.0, -90.0, 0.0], [0.0, 90.0, 0.0], [0.0, -90.0, 0.0]],
    ] {
        assert_eq!(lints(&load(&chain("dh", rows, &[]))), [""; 0], "{rows:?}");
    }
}

/// Models whose warnings are what they are for.
const WARNED: [(&str, Lint); 2] = [("kr5_table2", Lint::InertiaTriangle), ("bricard", Lint::RedundantConstraints)];

#[test]
fn shipped_models_have_no_lints() {
    let mut seen = 0;
    for folder in ["", "test", "peers"] {
        let files = fs::read_dir(models().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        for path in files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")) {
            let loaded = Model::load(&path).unwrap_or_else(|faults| panic!("{faults}"));
            let name = path.file_stem().unwrap().to_str().unwrap();
            let warned = WARNED.iter().filter(|(model, _)| *model == name).map(|(_, lint)| lint.name());
            assert_eq!(lints(&loaded), warned.collect::<Vec<_>>(), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 30, "{seen}");
}

#[test]
fn an_unknown_lint_in_allow_is_an_error_with_the_nearest_name() {
    let faults = Model::from_toml(format!("allow = ['gravity-upp']\n{ARM}"), "model.toml").unwrap_err();
    let [error] = &faults.errors().collect::<Vec<_>>()[..] else { panic!("{faults}") };
    assert_eq!(error.title(), "model `arm`: unknown lint `gravity-upp` in `allow`");
    assert!(error.help().starts_with("did you mean `gravity-up`? "), "{error}");
}
