//! `redysim show`: the page, and what is reported where none can be made. What the page does in a browser is tested in
//! `viewer_show.rs`.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use crate::common::{call, data, fail, model, names, scenario, scratch, succeed};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::LoopClosure;
use serde_json::{Value, json};

/// The data of the page of a model.
fn shown(name: &str, model: &str) -> Value {
    let folder = scratch(&format!("show-{name}"));
    succeed(&folder, &["show", model, "-o", "page.html"]);
    data(&fs::read_to_string(folder.join("page.html")).unwrap())
}

/// The data of the page of a model of this text.
fn of_text(name: &str, text: &str) -> Value {
    let folder = scratch(&format!("show-{name}-model"));
    let path = folder.join("model.toml");
    fs::write(&path, text).unwrap();
    shown(name, path.to_str().unwrap())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// Where the sliders of a page end, and where they begin.
fn sliders(data: &Value) -> Vec<[f64; 3]> {
    let sliders = data["sliders"].as_array().unwrap();
    sliders.iter().map(|slider| ["least", "start", "largest"].map(|key| number(&slider[key]))).collect()
}

const TWO: &str = "name = 'two'\ngravity = [0, 0, -9.81]\n\
    [[link]]\nname = 'arm'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 1, 0]\norigin = { xyz = [0, 0, 3] }\nmass = 1\n\
    com = [0.5, 0, 0]\nREST\n";

#[test]
fn sliders_go_over_the_ranges_of_the_joints() {
    let found = sliders(&shown("ranges", &model("test/kr5_ranges.toml")));
    let degrees = |range: [f64; 2]| range.map(f64::to_radians);
    for (index, expected) in [(0, degrees([-155.0, 155.0])), (1, degrees([-180.0, 65.0]))] {
        let [least, start, largest] = found[index];
        assert_eq!(([least, largest], start), (expected, 0.0));
    }
}

#[test]
fn a_coordinate_whose_range_excludes_zero_starts_at_the_nearest_end() {
    let range = "range = { position = [-2.5, -0.1], velocity = 1 }";
    assert_eq!(sliders(&of_text("off-zero", &TWO.replace("REST", range))), [[-2.5, -0.1, -0.1]]);
}

/// The slide stands 4 m along the arm, 3 m above the base, and its mass is 1 m further.
#[test]
fn without_a_range_joints_turn_around_or_slide_as_far_as_the_mechanism_reaches() {
    let slide = "[[link]]\nname = 'slide'\nparent = 'arm'\njoint = 'prismatic'\naxis = [1, 0, 0]\n\
                 origin = { xyz = [4, 0, 0] }\nmass = 1\ncom = [0, 0, 1]";
    let data = of_text("reach", &TWO.replace("REST", slide));
    assert_eq!(sliders(&data), [[-PI, 0.0, PI], [-8.0, 0.0, 8.0]]);
    let kinds = |key: &str| -> Vec<_> { (0..2).map(|joint| data["sliders"][joint][key].clone()).collect() };
    assert_eq!(kinds("limits"), ["turn", "size"]);
    assert_eq!(kinds("unit"), ["rad", "m"]);
    assert_eq!(data["motion"], Value::Null);
}

#[test]
fn closed_loops_are_shown_closed() {
    for name in ["fourbar.toml", "slider_crank.toml", "andrews.toml", "three_rrr.toml", "test/bricard.toml"] {
        let path = model(name);
        let start: Vec<f64> = sliders(&shown("closed", &path)).iter().map(|slider| slider[1]).collect();
        let mechanism = GenericMechanism::new(Model::load(&path).unwrap().model);
        let residual: Vec<f64> = mechanism.loop_residual(&start);
        assert!(residual.iter().all(|row| row.abs() < 1e-13), "{name}: {residual:?}");
    }
}

#[test]
fn loops_that_cannot_be_closed_are_shown_open_and_that_is_reported() {
    let folder = scratch("show-open");
    let path = model("warn/loop_stays_open.toml");
    let output = call(&folder, &["show", &path, "-o", "page.html"]).output();
    assert!(output.contains("note: the loops are shown open: "), "{output}");
    let data = data(&fs::read_to_string(folder.join("page.html")).unwrap());
    assert!(data["notes"][0].as_str().unwrap().starts_with("the loops are shown open: "), "{data}");
}

#[test]
fn the_page_has_the_frames_of_links_and_those_of_interest() {
    let data = shown("frames", &model("test/frames.toml"));
    let frames = data["frames"].as_array().unwrap();
    let of_interest: Vec<_> = frames.iter().filter(|frame| frame["of_link"] == false).collect();
    let names: Vec<_> = of_interest.iter().map(|frame| frame["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["tool", "camera", "elbow", "rim", "bench"]);
    assert_eq!(frames.len(), 6 + 5);
    assert_eq!((&of_interest[4]["body"], &of_interest[4]["position"]), (&json!(0), &json!([1.0, 2.0, 0.5])));
}

/// Bars of 0.3 and 0.25 m.
#[test]
fn a_link_that_carries_no_other_is_drawn_to_its_size() {
    let data = shown("leaf", &model("two_link.toml"));
    let ends = |body: usize| data["bodies"][body]["ends"].clone();
    assert_eq!(ends(1), json!([[0.3, 0.0, 0.0]]));
    assert!((number(&ends(2)[0][0]) - 0.25).abs() < 2e-4, "{}", ends(2));
    // A point mass of which nothing is known but where it is.
    assert_eq!(of_text("point", &TWO.replace("REST", ""))["bodies"][1]["ends"], json!([[0.5, 0.0, 0.0]]));
}

#[test]
fn the_page_is_named_after_the_model_and_lies_in_the_current_folder() {
    let folder = scratch("show-named");
    let output = succeed(&folder, &["show", &model("two_link.toml")]);
    assert!(output.starts_with("two_link.html (") && output.contains("open it in a browser"), "{output}");
    assert_eq!(names(&folder), ["two_link.html"]);
}

#[test]
fn what_is_missing_or_wrong_is_reported() {
    let folder = scratch("show-missing");
    fs::write(folder.join("mine.html"), "mine").unwrap();
    fs::copy(model("two_link.toml"), folder.join("model.toml")).unwrap();
    fs::write(folder.join("faulty.toml"), TWO.replace("mass = 1", "mass = -1").replace("REST", "")).unwrap();
    scenario(&folder, "two_link.toml", "");
    for (code, arguments, wrong, help) in [
        (3, &["show", "nowhere.toml"][..], "nowhere.toml", "help:"),
        (1, &["show", "faulty.toml"], "faulty.toml:9", "help:"),
        (1, &["show", "trial.toml"], "trial.toml is a scenario, not a model", "name its model"),
        (3, &["show", "model.toml", "-o", "mine.html"], "mine.html is there already", "--force"),
        (2, &["show", "model.toml", "-o", "model.toml"], "model.toml is what it would be made of", "--output"),
        (3, &["show", "model.toml", "-o", "no/page.html"], "cannot write no/page.html", "is the path right?"),
    ] {
        let output = fail(&folder, arguments, code);
        assert!(output.contains(wrong) && output.contains(help), "{arguments:?}: {output}");
    }
    assert_eq!(names(Path::new(&folder)), ["faulty.toml", "mine.html", "model.toml", "trial.toml"]);
    assert_eq!(fs::read_to_string(folder.join("mine.html")).unwrap(), "mine");
    succeed(&folder, &["show", "model.toml", "-o", "mine.html", "--force"]);
}

#[test]
fn a_free_base_has_sliders_for_its_position_and_for_roll_pitch_and_yaw() {
    let data = shown("free", &model("kr5_floating.toml"));
    let names: Vec<&str> = data["joints"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert_eq!(names[..7], ["base.x", "base.y", "base.z", "base.roll", "base.pitch", "base.yaw", "joint1"]);
    let found = sliders(&data);
    assert_eq!(found.len(), 12);
    assert!(found.iter().all(|[least, start, largest]| least < start && *start == 0.0 && start < largest), "{found:?}");
    assert_eq!(found[3], [-PI, 0.0, PI]);
    assert_eq!(data["bodies"][1]["joint"]["orientation"], json!("rpy"));
    assert_eq!(data["bodies"][2]["joint"]["coordinate"], json!(6));
}
