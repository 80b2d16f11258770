//! Passes are verified while a mechanism compiles; a difference that is only rounding is accepted.

use redysim_codegen::functions::trace;
use redysim_model::{Model, Tree};

/// Two links that a revolute loop closes at once: every number of the loop's residual and bias is roundoff or zero.
#[test]
fn outputs_that_are_only_roundoff_may_change() {
    for (at, tilt) in [(0.3, 0.1), (0.7, 1.3), (0.1, 2.9)] {
        let text = format!(
            r#"
            name = "pair"
            gravity = [0.0, 0.0, -9.81]
            [[link]]
            name = "crank"
            parent = "base"
            joint = "revolute"
            origin = {{ xyz = [0.1, 0.2, 0.3], rpy = [{tilt}, 0.2, 0.7] }}
            axis = [0.0, 0.6, 0.8]
            mass = 1.0
            com = [{at}, 0.1, 0.0]
            inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}
            [[link]]
            name = "coupler"
            parent = "crank"
            joint = "revolute"
            origin = {{ xyz = [{at}, 0.0, 0.1], rpy = [0.3, {tilt}, 0.0] }}
            axis = [0.6, 0.0, 0.8]
            mass = 1.0
            com = [0.1, {at}, 0.0]
            inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}
            [[loop]]
            name = "closure"
            joint = "revolute"
            link_a = "crank"
            point_a = [{at}, 0.0, 0.1]
            axis_a = [0.0, 0.6, 0.8]
            link_b = "coupler"
            point_b = [0.0, 0.0, 0.0]
            axis_b = [0.6, 0.0, 0.8]
            "#
        );
        let model = Model::from_toml(text, "pair.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
        assert!(trace(&Tree::new(&model)).is_ok());
    }
}

/// Numbers from the smallest to the largest that a model may have: products of them overflow and vanish.
#[test]
fn numbers_that_overflow_do_not_fail_the_verification() {
    for (mass, length) in [(1e300, 1e100), (1e-300, 1e-100), (1e150, 1e-150), (1e-150, 1e150), (1e308, 1.0)] {
        let mut text = String::from("name = \"extreme\"\ngravity = [1.0, -9.0, 3.0]\n");
        for (index, parent) in ["base", "link0", "link1", "link0"].into_iter().enumerate() {
            text += &format!(
                "[[link]]\nname = \"link{index}\"\nparent = \"{parent}\"\njoint = \"revolute\"\n\
                 origin = {{ xyz = [{length:e}, {length:e}, 0.3], rpy = [0.1, 0.2, {index}.5] }}\naxis = [0.0, 0.0, 1.0]\n\
                 mass = {mass:e}\ncom = [{length:e}, 0.1, 0.2]\n"
            );
        }
        // A model that is refused needs no code.
        if let Ok(loaded) = Model::from_toml(text, "extreme.toml") {
            assert_eq!(trace(&Tree::new(&loaded.model)).err(), None, "{mass:e} kg, {length:e} m");
        }
    }
}
