//! Runs on the ground: motion against a separate integration, tables, the balance of energy, and refusals.

use redysim_model::GenericMechanism;
use redysim_runtime::{Frames, Real};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;

use redysim_cli::{Contact, Forward, FrameNames, Ground, Results, Scenario};

use crate::common::{Table, call, data, model, refuses_in, root, scenario, scratch, shipped, succeed};

/// The lower corners of the parcel of 3 kg, which stands on them.
const CORNERS: &str =
    "frame = ['bottom_right_rear', 'bottom_right_front', 'bottom_left_rear', 'bottom_left_front']\nfriction = 0.5\n";
const HUNT_CROSSLEY: &str = "law = 'hunt-crossley'\nstiffness = 5e4\ndamping = 0.3\nslip_velocity = 0.01\n";
const REDYSIM: &str = "law = 'redysim'\nstiffness = 5000\ndamping = 20\nleaving_speed = 5\nsliding_damping = 100\n";

/// The parcel falls flat, its corners 0.3 m above the ground, for a second.
fn fall(law: &str) -> String {
    format!(
        "initial = {{ q = {{ parcel = {{ xyz = [0, 0, 0.4] }} }} }}\n[forward]\nend = 1.0\nstep = 0.01\n\
         integrator = {{ method = 'Ode45', rtol = 1e-11, atol = 1e-13 }}\n[[contact]]\n{CORNERS}{law}"
    )
}

/// The height of the corners after each hundredth of a second of that second, by the classical Runge-Kutta rule with
/// steps of two microseconds, under `force`, in N of one corner, at a height and its rate.
fn separately(force: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let rate = |[z, v]: [f64; 2]| [v, 4.0 * force(z, v) / 3.0 - 9.81];
    let h = 2e-6;
    let mut y = [0.3, 0.0];
    let mut heights = vec![y[0]];
    for step in 1..=500_000 {
        let moved = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let k1 = rate(y);
        let k2 = rate(moved(k1, h / 2.0));
        let k3 = rate(moved(k2, h / 2.0));
        let k4 = rate(moved(k3, h));
        y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if step % 5000 == 0 {
            heights.push(y[0]);
        }
    }
    heights
}

/// Steps across a touch-down err by its jump times a step: C_v u/m h = 1e-4 m/s for ReDySim's law, and a hundredth of that in
/// the mean over the four or five of them; without a jump by far less.
#[test]
fn a_parcel_falls_on_four_corners_as_in_a_separate_integration() {
    let hunt_crossley = separately(|z, v| {
        let p = (-z).max(0.0);
        (5e4 * p.powf(1.5) * (1.0 - 0.3 * v)).max(0.0)
    });
    let redysim = separately(|z, v| {
        let (p, full) = (-z, 1.2 * 5.0 * 20.0 / 5000.0);
        if p < 1e-5 {
            return 0.0;
        }
        let s = p / full;
        let c = if v > 0.0 && s <= 1.0 { 20.0 * s * s * (3.0 - 2.0 * s) } else { 20.0 };
        5000.0 * p - c * v
    });
    for (name, law, reference, tolerance) in
        [("hunt", HUNT_CROSSLEY, hunt_crossley, 1e-8), ("redysim", REDYSIM, redysim, 1e-4)]
    {
        let folder = scratch(&format!("contact-{name}"));
        succeed(&folder, &["forward", &scenario(&folder, "parcel.toml", &fall(law)), "-o", "run", "--quiet"]);
        let state = Table::csv(&folder.join("run/statevar.csv"));
        assert_eq!(state.rows.len(), reference.len());
        let errors = state.rows.iter().zip(&reference).map(|(row, height)| (row[3] - 0.1 - height).abs());
        let worst = errors.fold(0.0, Real::maximum);
        assert!(worst < tolerance, "{name}: {worst}");
        assert!(reference.iter().filter(|height| **height < 0.0).count() > 5, "it touches down");
    }
}

/// The parcel that is shipped: at the end it rests on four corners, which carry its weight, and what it has lost is what the
/// ground has taken.
#[test]
fn a_parcel_that_is_thrown_comes_to_rest_with_its_weight_on_four_corners() {
    let folder = scratch("contact-parcel");
    let output = succeed(&folder, &["forward", &shipped("parcel"), "-o", "run"]);
    assert!(output.contains("8 contacts, 13 touch-downs"), "{output}");
    let contacts = Table::csv(&folder.join("run/contacts.csv"));
    assert_eq!(contacts.headers.len(), 1 + 8 * 6);
    let first = ["force_x", "force_y", "force_z", "normal"].map(|symbol| format!("{symbol} bottom_right_rear [N]"));
    assert_eq!(contacts.headers[1..5], first);
    assert_eq!(contacts.headers[5..7], ["penetration bottom_right_rear [m]", "touching bottom_right_rear [1]"]);
    let last = contacts.rows.last().unwrap();
    let corners: Vec<_> = last[1..].chunks(6).collect();
    let carried: f64 = corners.iter().map(|corner| corner[2]).sum();
    // The parcel rocks by a micrometre yet.
    assert!((carried - 3.0 * 9.81).abs() < 0.1, "{carried}");
    assert_eq!(corners.iter().map(|corner| corner[5]).sum::<f64>(), 4.0);
    assert!(corners.iter().all(|corner| (corner[4] >= 0.0) == (corner[5] == 1.0) && corner[3] >= 0.0));
    let energy = Table::csv(&folder.join("run/energy.csv"));
    assert_eq!(energy.headers[6..], ["ground [J]", "ground_loss [J]"]);
    for row in &energy.rows {
        let [kinetic, potential, total, work, drift, ground, loss] = row[1..].try_into().unwrap();
        assert!((kinetic + potential + ground - total).abs() < 1e-12 && work.abs() < 1e-9, "{row:?}");
        assert!(
            (total + loss - energy.rows[0][3] - drift).abs() < 1e-9 && drift.abs() < 1e-4 && loss >= 0.0,
            "{row:?}"
        );
    }
    assert!(fs::read_to_string(folder.join("run/run.toml")).unwrap().contains("touch_downs = 13"));
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    for table in ["contacts.csv", "statevar.csv", "energy.csv"] {
        let [run, again] = ["run", "again"].map(|name| fs::read(folder.join(name).join(table)).unwrap());
        assert!(run == again, "{table}");
    }
    let results = Results::load(folder.join("run")).unwrap();
    assert_eq!(results.tables["contacts"].columns.len(), 48);
    assert_eq!(results.run.touch_downs, Some(13));
}

/// Rows are so close that each contact is seen to begin in one: there the touch-down was, as far as the frame moves between
/// two rows.
#[test]
fn touch_downs_csv_has_when_and_where_each_contact_begins() {
    let folder = scratch("contact-touch-downs");
    let shipped = fs::read_to_string(shipped("parcel")).unwrap();
    let rows = shipped.replace("step = 0.01", "step = 0.0005").replace("end = 3.0", "end = 1.5");
    let path = folder.join("parcel.toml");
    fs::write(&path, rows.replace("../models/parcel.toml", &model("parcel.toml"))).unwrap();
    succeed(&folder, &["forward", path.to_str().unwrap(), "-o", "run", "--quiet"]);
    let [record, contacts, state] =
        ["touch_downs", "contacts", "statevar"].map(|name| Table::csv(&folder.join(format!("run/{name}.csv"))));
    assert_eq!(record.headers, ["t [s]", "contact [1]", "x [m]", "y [m]", "z [m]"]);
    let results = Results::load(folder.join("run")).unwrap();
    assert_eq!(results.run.touch_downs, Some(record.rows.len() as u64));
    assert!(record.rows.len() > 5, "it touches down");
    let mechanism = GenericMechanism::new(results.model);
    for touch_down in &record.rows {
        let [t, contact, ref place @ ..] = touch_down[..] else { panic!("{touch_down:?}") };
        let after = contacts.rows.iter().position(|row| row[0] > t).unwrap();
        let touching = |row: usize| contacts.rows[row][6 * (contact as usize + 1)];
        assert_eq!((touching(after - 1), touching(after)), (0.0, 1.0), "{touch_down:?}");
        assert!(place[2].abs() < 1e-12, "{touch_down:?} is on the ground");
        let q = state.rows[after][1..8].to_vec();
        let origin = mechanism.frame_kinematics(&q, &vec![0.0; 6])[contact as usize].origin;
        // It moves by less than 10 m/s.
        assert!((0..3).all(|axis| (origin[axis] - place[axis]).abs() < 0.005), "{touch_down:?}, not {origin:?}");
    }
}

#[test]
fn a_wall_is_the_ground_with_another_point_and_normal() {
    let folder = scratch("contact-wall");
    let rest = "initial = { q = { parcel = { xyz = [0, 0, 1] } }, v = { parcel = [2, 0, 0, 0, 0, 0] } }\n\
                ground = { point = [1, 0, 0], normal = [-2, 0, 0] }\n[forward]\nend = 1.0\nstep = 0.1\n\
                integrator = { method = 'Ode45', rtol = 1e-8, atol = 1e-10 }\n[[contact]]\n\
                frame = ['bottom_right_front', 'bottom_left_front', 'top_right_front', 'top_left_front']\n\
                law = 'hunt-crossley'\nstiffness = 1e5\ndamping = 0\nfriction = 0\nslip_velocity = 0.01\n";
    succeed(&folder, &["forward", &scenario(&folder, "parcel.toml", rest), "-o", "run", "--quiet"]);
    let state = Table::csv(&folder.join("run/statevar.csv"));
    // Without damping and friction it flies back as fast as it came.
    let last = state.rows.last().unwrap();
    assert!((last[8] + 2.0).abs() < 1e-6 && last[1] < 0.3, "{last:?}");
}

/// Without gravity what happens at the floor happens at the wall, as the ball is as far from both and comes as fast to both.
#[test]
fn a_ball_leaves_a_wall_as_it_leaves_the_floor() {
    let folder = scratch("contact-corner");
    let model = "name = 'ball'\ngravity = [0, 0, 0]\nallow = ['under-actuated']\n[[link]]\nname = 'ball'\nparent = 'base'\n\
                 joint = 'free'\norigin = {}\nmass = 0.5\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }\n\
                 [[frame]]\nname = 'center'\nlink = 'ball'\n";
    fs::write(folder.join("ball.toml"), model).unwrap();
    let law =
        "frame = 'center'\nlaw = 'hunt-crossley'\nstiffness = 1e5\ndamping = 0.2\nfriction = 0\nslip_velocity = 0.01\n";
    let rest = format!(
        "model = 'ball.toml'\ninitial = {{ q = {{ ball = {{ xyz = [1, 0, 1] }} }}, v = {{ ball = [2, 0, -2, 0, 0, 0] }} }}\n\
         [forward]\nend = 1.0\nstep = 0.002\nintegrator = {{ method = 'Dop853', rtol = 1e-10, atol = 1e-12 }}\n\
         [[contact]]\nname = 'floor'\n{law}[[contact]]\nname = 'wall'\n{law}\
         ground = {{ point = [2, 5, 5], normal = [-3, 0, 0] }}\n"
    );
    fs::write(folder.join("trial.toml"), rest).unwrap();
    let output = succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    assert!(output.contains("2 contacts, 2 touch-downs"), "{output}");
    let [state, contacts, energy] =
        ["statevar", "contacts", "energy"].map(|name| Table::csv(&folder.join(format!("run/{name}.csv"))));
    let difference = |row: &Vec<f64>| [row[1] + row[3] - 2.0, row[8] + row[10]].map(f64::abs);
    assert!(state.rows.iter().flat_map(difference).all(|off| off < 1e-12));
    let [floor, wall] =
        [("z", "floor"), ("x", "wall")].map(|(axis, name)| contacts.column(&format!("force_{axis} {name} [N]")));
    let most = floor.iter().copied().fold(0.0, f64::max);
    assert!(most > 100.0, "{most} N");
    assert!(floor.iter().zip(&wall).all(|(up, back)| (up + back).abs() < 1e-9 * most));
    // It leaves more slowly than it has come, by what the damping of both has taken.
    let last = state.rows.last().unwrap();
    assert!((-2.0..-1.5).contains(&last[8]), "{last:?}");
    let drift = energy.column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-8), "{drift:?}");
    succeed(&folder, &["animate", "run", "--quiet"]);
    let page = data(&fs::read_to_string(folder.join("run/animation.html")).unwrap());
    let [ground, wall] = [([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), ([2.0, 5.0, 5.0], [-1.0, 0.0, 0.0])]
        .map(|(point, normal)| serde_json::json!({ "point": point, "normal": normal }));
    assert_eq!(page["contacts"]["planes"], serde_json::json!([ground, wall]));
    // What the run has read is what it writes.
    let again = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    assert!(again.contains("normal = [-3, 0, 0]"), "{again}");
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let [run, again] = ["run", "again"].map(|name| fs::read(folder.join(name).join("contacts.csv")).unwrap());
    assert!(run == again);
}

/// Contacts are written as tables or as an array within a line.
#[test]
fn a_run_records_the_defaults_of_a_contact_and_of_its_own_ground() {
    let law = "frame = 'top_left_front', law = 'hunt-crossley', stiffness = 1e5, damping = 0.1, friction = 0, slip_velocity = 0.01";
    let end = "[forward]\nend = 0.1\nstep = 0.05\n";
    let wall = "ground = { normal = [-1, 0, 0] }";
    let tables = format!("{end}[[contact]]\n{}\n{wall}\n", law.replace(", ", "\n"));
    let line = format!("contact = [{{ {law}, {wall} }}]\n{end}");
    for (name, rest) in [("tables", tables), ("line", line)] {
        let folder = scratch(&format!("contact-defaults-{name}"));
        succeed(&folder, &["forward", &scenario(&folder, "parcel.toml", &rest), "-o", "run", "--quiet"]);
        let recorded = fs::read_to_string(folder.join("run/run.toml")).unwrap();
        let contact = &recorded.parse::<toml::Table>().unwrap()["contact"][0];
        assert_eq!(contact["exponent"].as_float(), Some(1.5), "{recorded}");
        assert_eq!(contact["ground"]["point"].to_string(), "[0.0, 0.0, 0.0]", "{recorded}");
        assert_eq!(contact["ground"]["normal"].to_string(), "[-1, 0, 0]", "{recorded}");
        succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
        let [run, again] = ["run", "again"].map(|name| fs::read(folder.join(name).join("contacts.csv")).unwrap());
        assert!(run == again);
    }
}

#[test]
fn a_ground_that_no_contact_meets_is_warned_of() {
    let folder = scratch("contact-ground-unmet");
    let own = "ground = { point = [0, 0, -1] }\n";
    let rest = format!(
        "ground = {{ point = [0, 0, 1] }}\n[forward]\nend = 0.1\nstep = 0.1\n[[contact]]\n{CORNERS}{HUNT_CROSSLEY}{own}"
    );
    let run = call(&folder, &["forward", &scenario(&folder, "parcel.toml", &rest), "-o", "run"]);
    assert_eq!(run.code, 0, "{}", run.output());
    assert!(
        run.stderr.contains("`ground` applies only to contacts, and each has a `ground` of its own"),
        "{}",
        run.stderr
    );
}

#[test]
fn contacts_that_cannot_be_are_refused_where_they_stand() {
    let trial = |name: &str, from: &str, to: &str, words: &[&str]| {
        let folder = scratch(&format!("contact-fault-{name}"));
        let rest = fall(HUNT_CROSSLEY);
        assert!(rest.contains(from), "{from}");
        refuses_in(&folder, "forward", &scenario(&folder, "parcel.toml", &rest.replacen(from, to, 1)), 1, words);
    };
    trial(
        "frame",
        "bottom_left_rear",
        "bottom_left_raer",
        &["unknown frame `bottom_left_raer`", "did you mean `bottom_left_rear`?", "trial.toml:8:53"],
    );
    trial("law", "'hunt-crossley'", "'hunt'", &["`contact[0].law`", "`hunt`", "hunt-crossley"]);
    trial("no-law", "law = 'hunt-crossley'\n", "", &["`contact[0].law` is missing"]);
    let words = ["unknown key `contact[0].exponant`", "did you mean `exponent`?"];
    trial("key", "damping = 0.3", "damping = 0.3\nexponant = 2", &words);
    trial("missing", "stiffness = 5e4\n", "", &["`contact[0].stiffness` is missing"]);
    trial(
        "negative",
        "damping = 0.3",
        "damping = -0.3",
        &[
            "`damping` of a contact is -0.3, and must be zero or positive, and finite",
            "out of range",
            "trial.toml:12:11",
        ],
    );
    trial(
        "exponent",
        "damping = 0.3",
        "exponent = 0.5\ndamping = 0.3",
        &["`exponent` of a contact is 0.5", "1 or more"],
    );
    trial("twice", "'bottom_left_rear'", "'bottom_left_front'", &["two contacts are called `bottom_left_front`"]);
    trial(
        "empty",
        "'bottom_right_rear', 'bottom_right_front', 'bottom_left_rear', 'bottom_left_front'",
        "",
        &["`contact[0].frame` has no frame"],
    );
    trial("name", "friction = 0.5", "friction = 0.5\nname = 'corner'", &["4 frames and one name, `corner`"]);
    trial("normal", "[forward]", "ground = { normal = [0, 0, 0] }\n[forward]", &["the normal of the ground is zero"]);
    let own = "friction = 0.5\nground = { normal = [0, 0, 0] }";
    trial("wall", "friction = 0.5", own, &["the normal of the ground is zero", "trial.toml:10:21"]);
    trial("ground", "[forward]", "ground = { height = 1 }\n[forward]", &["unknown key `ground.height`"]);
    let folder = scratch("contact-fault-no-frames");
    let rest =
        format!("[forward]\nend = 1.0\nstep = 0.1\n[[contact]]\nframe = 'foot'\nfriction = 0.5\n{HUNT_CROSSLEY}");
    let words = ["a contact requires a frame, but the model does not have a `[[frame]]`", "trial.toml:6:9"];
    refuses_in(&folder, "forward", &scenario(&folder, "two_link.toml", &rest), 1, &words);
}

#[test]
fn a_ground_without_contacts_is_warned_of() {
    let folder = scratch("contact-ground-alone");
    let rest = "ground = { point = [0, 0, 1] }\n[forward]\nend = 0.1\nstep = 0.1\n";
    let run = call(&folder, &["forward", &scenario(&folder, "parcel.toml", rest), "-o", "run"]);
    assert_eq!(run.code, 0, "{}", run.output());
    let warning = "`ground` applies only to contacts, and the scenario has no contact";
    assert!(run.stderr.contains(warning), "{}", run.stderr);
    assert!(!folder.join("run/contacts.csv").exists());
}

#[test]
fn contacts_are_not_in_the_forces_of_inverse_dynamics_which_is_warned_of() {
    let folder = scratch("contact-inverse");
    let still = "trajectory = { from = [0, 0, 0, 0, 0, 0, 1], to = [0, 0, 0, 0, 0, 0, 1], duration = 0.1 }\n\
                 inverse = { end = 0.1, step = 0.1 }\n";
    let forces = |name: &str, rest: &str| {
        let run = call(&folder, &["inverse", &scenario(&folder, "parcel.toml", rest), "-o", name]);
        assert_eq!(run.code, 0, "{}", run.output());
        (run.stderr, fs::read(folder.join(name).join("tor.csv")).unwrap())
    };
    let (without, in_the_air) = forces("without", still);
    assert!(!without.contains("contact"), "{without}");
    let (warned, forces) = forces("with", &format!("{still}[[contact]]\n{CORNERS}{HUNT_CROSSLEY}"));
    for words in ["`contact` applies only to `redysim forward`", "not in these forces", "computed-torque", "prescribed"]
    {
        assert!(warned.contains(words), "{words}: {warned}");
    }
    assert!(forces == in_the_air);
    assert!(!folder.join("with/contacts.csv").exists());
}

/// The four-bar of the paper, let go, with a frame on its coupler that touches the ground.
#[test]
fn a_coupler_of_a_four_bar_that_touches_the_ground_keeps_the_balance_of_energy() {
    let folder = scratch("contact-fourbar");
    let model = fs::read_to_string(model("fourbar.toml")).unwrap();
    let frame = "[[frame]]\nname = 'tip'\nlink = 'coupler'\norigin = { xyz = [0.2304, 0, 0] }\n";
    fs::write(folder.join("fourbar.toml"), format!("{model}{frame}")).unwrap();
    let scenario = "model = 'fourbar.toml'\ninitial = { q = [0.0, 0.9844, 4.3144] }\n\
                    ground = { point = [0, -0.145, 0], normal = [0, 1, 0] }\n[forward]\nend = 0.2\nstep = 0.002\n\
                    integrator = { method = 'Ode45', rtol = 1e-11, atol = 1e-13 }\n[[contact]]\nframe = 'tip'\n\
                    law = 'hunt-crossley'\nstiffness = 1e5\ndamping = 0.3\nfriction = 0.4\nslip_velocity = 0.01\n";
    fs::write(folder.join("trial.toml"), scenario).unwrap();
    let output = succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    assert!(output.contains("1 contact, 1 touch-down"), "{output}");
    let energy = Table::csv(&folder.join("run/energy.csv"));
    let exchanged = energy.rows.iter().map(|row| row[1]).fold(0.0, Real::maximum);
    for row in &energy.rows {
        let [kinetic, potential, total, work, drift, ground, loss] = row[1..].try_into().unwrap();
        assert!((kinetic + potential + ground - total).abs() < 1e-12 && work == 0.0, "{row:?}");
        assert!((total + loss - energy.rows[0][3] - drift).abs() < 1e-9, "{row:?}");
        // Tolerances of 1e-11 over some hundred steps.
        assert!(drift.abs() < 1e-8 * exchanged, "{row:?} of {exchanged}");
    }
    let lost = energy.rows.last().unwrap()[7];
    assert!(lost > 1e-3 * exchanged, "{lost} of {exchanged}");
}

#[test]
fn contacts_as_data_read_back_to_the_same_bits() {
    let foot = |name: &str| FrameNames::One(name.into());
    let several = FrameNames::Several(vec!["top_left_rear".into(), "top_left_front".into()]);
    let written = Scenario {
        name: Some("trial".into()),
        forward: Some(Forward::new(1.0, 0.1)),
        ground: Some(Ground { point: Some([0.1, 0.2, 1.0 / 3.0]), normal: None }),
        contact: Some(vec![
            Contact::ReDySim {
                name: Some("heel".into()),
                frame: foot("bottom_left_rear"),
                ground: Some(Ground { point: None, normal: Some([-1.0, 0.1, 1.0 / 7.0]) }),
                stiffness: 2500.0,
                damping: 3464.1016151377544,
                leaving_speed: 4.5,
                friction: 0.7,
                sliding_damping: 1500.0,
            },
            Contact::HuntCrossley {
                name: None,
                frame: several,
                ground: None,
                stiffness: 1e5 / 3.0,
                exponent: None,
                damping: 0.4,
                friction: 0.6,
                slip_velocity: 0.01,
            },
        ]),
        ..Scenario::new("parcel.toml")
    };
    let text = written.to_toml();
    assert_eq!(Scenario::from_toml(&*text, model("trial.toml")).unwrap(), written, "{text}");
    let json = serde_json::to_string(&written).unwrap();
    assert_eq!(serde_json::from_str::<Scenario>(&json).unwrap(), written, "{json}");
}

/// The largest error of the energy balance of the results in `run`, J, as `run.toml` states it.
fn energy_drift(folder: &Path) -> f64 {
    let run = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    run.lines().find_map(|line| line.strip_prefix("energy_drift = ")).unwrap().parse().unwrap()
}

/// Four seconds at full speed, and a second each to start and to stop: five strides of 0.3 m. Slipping and the sinking of
/// feet take 2 % of the way; the trunk tilts by two degrees.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_quadruped_trots_five_strides_on_diagonal_legs_without_falling() {
    let folder = scratch("contact-quadruped");
    let output = succeed(&folder, &["forward", &shipped("quadruped"), "-o", "run"]);
    assert!(output.contains("4 contacts, 24 touch-downs"), "{output}");
    let state = Table::csv(&folder.join("run/statevar.csv"));
    for row in &state.rows {
        let [x, y, _, qx, _, qz, _] = row[1..8].try_into().unwrap();
        // The cosine of the angle between the trunk's y axis and the vertical.
        let tilt = (1.0 - 2.0 * (qx * qx + qz * qz)).acos().to_degrees();
        assert!(tilt < 3.0 && (y - 0.49).abs() < 0.02 && x.abs() < 0.05, "{row:?}");
    }
    let way = state.rows.last().unwrap()[3];
    assert!((1.4..1.5).contains(&way), "{way}");
    let desired = Table::csv(&root().join("scenarios/quadruped.csv"));
    for (row, desired) in state.rows.iter().zip(&desired.rows) {
        for (found, desired) in row[8..20].iter().zip(&desired[1..]) {
            assert!((found - desired).abs() < 1e-4, "{found} instead of {desired}");
        }
    }
    let contacts = Table::csv(&folder.join("run/contacts.csv"));
    let mut pairs = [0, 0];
    for row in &contacts.rows {
        let touching = [6, 12, 18, 24].map(|column| row[column] == 1.0);
        pairs[0] += usize::from(touching == [true, false, false, true]);
        pairs[1] += usize::from(touching == [false, true, true, false]);
        assert!([4, 10, 16, 22].iter().all(|&column| row[column] >= 0.0), "no foot is held back: {row:?}");
    }
    assert!(pairs.iter().all(|rows| *rows > 90), "{pairs:?}");
    let drift = energy_drift(&folder);
    assert!(drift < 1e-5, "{drift} J of the 4 J that are exchanged");
    succeed(&folder, &["animate", "run", "--quiet"]);
    let page = data(&fs::read_to_string(folder.join("run/animation.html")).unwrap());
    assert_eq!(
        page["contacts"]["planes"],
        serde_json::json!([{ "point": [0.0, 0.0, 0.0], "normal": [0.0, 1.0, 0.0] }])
    );
    let places = page["contacts"]["places"].as_array().unwrap();
    let steps = |foot: usize| places[foot]["footprints"].as_array().unwrap();
    // At the start all feet stand; a touch-down is there for a row at least, unless the foot lifts off before.
    assert!((0..4).all(|foot| steps(foot).len() >= 6));
    for foot in 0..4 {
        let [first, last] = [0, steps(foot).len() - 1].map(|step| steps(foot)[step][3].as_f64().unwrap());
        assert!(last - first > 1.2 && steps(foot).iter().all(|step| step[2].as_f64().unwrap().abs() < 1e-12));
    }
}

/// 14 kg on six feet, which settle into the ground and stay.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_hexapod_stands_and_its_feet_carry_its_weight() {
    let folder = scratch("contact-hexapod");
    let text = fs::read_to_string(shipped("hexapod")).unwrap();
    let path = root().join("models/hexapod.toml").display().to_string();
    let text = text.replace("../models/hexapod.toml", &path).replace("end = 3.0", "end = 1.0");
    fs::write(folder.join("stands.toml"), text).unwrap();
    let output = succeed(&folder, &["forward", "stands.toml", "-o", "run"]);
    assert!(output.contains("6 contacts, 0 touch-downs"), "{output}");
    let state = Table::csv(&folder.join("run/statevar.csv"));
    let moved = state.rows.iter().flat_map(|row| [row[1], row[2] - 0.513, row[3], row[4], row[5], row[6]]);
    assert!(moved.map(f64::abs).fold(0.0, Real::maximum) < 5e-3, "it stands");
    let contacts = Table::csv(&folder.join("run/contacts.csv"));
    let normals = |row: &Vec<f64>| (0..6).map(|foot| row[4 + 6 * foot]).sum::<f64>();
    let carried = normals(contacts.rows.last().unwrap());
    assert!((carried / (14.0 * 9.81) - 1.0).abs() < 1e-3, "{carried} N");
    let energy = Table::csv(&folder.join("run/energy.csv"));
    let [.., ground, lost] = energy.rows.last().unwrap()[..] else { panic!("columns of the ground") };
    let drift = energy_drift(&folder);
    println!("{drift:e} J, {lost} J lost to the ground, which holds {ground} J");
    assert!(drift < 1e-8 && lost > 1e-3, "{drift} J of the {lost} J that the ground takes");
}

/// Six steps, the last of which puts the feet beside each other, carry the hips 1 m forward, less what feet slip on ground
/// in which they sink by 2 cm. The plane in which the biped moves is one of symmetry: it cannot leave it.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_biped_walks_six_steps_upright_on_one_foot_and_then_the_other() {
    let folder = scratch("contact-biped");
    let shipped = root().join("scenarios/walking_biped.toml").display().to_string();
    let output = succeed(&folder, &["forward", &shipped, "-o", "run"]);
    assert!(output.contains("4 contacts, "), "{output}");
    let state = Table::csv(&folder.join("run/statevar.csv"));
    let desired = Table::csv(&root().join("scenarios/walking_biped.csv"));
    assert_eq!(state.rows.len(), desired.rows.len());
    for (row, desired) in state.rows.iter().zip(&desired.rows) {
        let [_, y, z, qx, qy, qz, qw] = row[1..8].try_into().unwrap();
        let tilt = (2.0 * f64::atan2(qz, qw) + FRAC_PI_2).to_degrees();
        assert!(tilt.abs() < 1.5 && (y - 1.145).abs() < 0.015, "{row:?}");
        assert_eq!([z, qx, qy], [0.0; 3]);
        for (found, desired) in row[8..14].iter().zip(&desired[1..]) {
            assert!((found - desired).abs() < 1e-6, "{found} instead of {desired}");
        }
    }
    let way = state.rows.last().unwrap()[1] - state.rows[0][1];
    assert!((0.94..1.0).contains(&way), "{way}");
    let contacts = Table::csv(&folder.join("run/contacts.csv"));
    // Which feet carry the biped, one after the other.
    let mut carried = Vec::new();
    for row in &contacts.rows {
        assert!([4, 10, 16, 22].iter().all(|&column| row[column] >= 0.0), "no foot is held back: {row:?}");
        let feet = [6, 18].map(|foot| row[foot] == 1.0 || row[foot + 6] == 1.0);
        assert_ne!(feet, [false, false], "it does not jump");
        if feet != [true, true] && carried.last() != Some(&feet) {
            carried.push(feet);
        }
    }
    let [left, right] = [[true, false], [false, true]];
    assert_eq!(carried, [right, left, right, left, right, left]);
    let drift = energy_drift(&folder);
    assert!(drift < 1e-5, "{drift} J of the 1.6 J that are exchanged");
}

/// The motion of the joints is made for ground that does not give: where it hardly does, the biped stays upright and goes as
/// far as its feet do.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_biped_walks_a_metre_upright_on_stiff_ground() {
    let folder = scratch("contact-biped-stiff");
    let text = fs::read_to_string(root().join("scenarios/walking_biped.toml")).unwrap();
    let path = |name: &str| root().join(name).display().to_string();
    let replaced = |text: &str, from: &str, to: &str| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    };
    let text = replaced(&text, "../models/walking_biped.toml", &path("models/walking_biped.toml"));
    let text = replaced(&text, "\"walking_biped.csv\"", &format!("{:?}", path("scenarios/walking_biped.csv")));
    let text = replaced(&text, "stiffness = 2000.0", "stiffness = 1e5");
    let text = replaced(&text, "damping = 2742.2618401604173", "damping = 2e4");
    let text = replaced(&text, "1.1495", "1.1498");
    fs::write(folder.join("walks.toml"), text).unwrap();
    succeed(&folder, &["forward", "walks.toml", "-o", "run", "--quiet"]);
    let state = Table::csv(&folder.join("run/statevar.csv"));
    let tilts = state.rows.iter().map(|row| 2.0 * f64::atan2(row[6], row[7]) + FRAC_PI_2);
    let most = tilts.fold(0.0, |most: f64, tilt| Real::maximum(most, tilt.abs())).to_degrees();
    assert!(most < 0.1, "{most}");
    let way = state.rows.last().unwrap()[1] - state.rows[0][1];
    assert!((way - 1.0).abs() < 0.003, "{way}");
}

/// A step of 10 ms under the damping of 500 N s/m throws a body of 0.5 kg out of the ground before time has passed.
#[test]
fn contacts_that_chatter_are_reported_with_what_to_do_in_the_scenario() {
    let folder = scratch("contact-chattering");
    let model = "name = 'ball'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'ball'\nparent = 'base'\njoint = 'prismatic'\n\
                 axis = [0, 0, 1]\nmass = 0.5\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }\n[[frame]]\nname = 'sole'\n\
                 link = 'ball'\n";
    fs::write(folder.join("ball.toml"), model).unwrap();
    let run = |step: f64| {
        let text = format!(
            "model = 'ball.toml'\ninitial = {{ q = [0.1] }}\n[forward]\nend = 0.3\nstep = 0.01\nintegrator = {{ method = \
             'SemiImplicitEuler', step = {step:?} }}\n[[contact]]\nlaw = 'redysim'\nframe = 'sole'\nstiffness = 1e4\n\
             damping = 500\nleaving_speed = 5\nfriction = 0.3\nsliding_damping = 20\n"
        );
        fs::write(folder.join("trial.toml"), text).unwrap();
        call(&folder, &["forward", "trial.toml", "-o", "run", "--force"])
    };
    let failed = run(0.01);
    assert_eq!(failed.code, 3, "{}", failed.output());
    for words in [
        "contacts begin and end 101 times at t = 0.1",
        "take a `step` of the integrator below 0.01 s, or give the contacts less `stiffness` or `damping`",
    ] {
        assert!(failed.stderr.contains(words), "no `{words}` in {}", failed.stderr);
    }
    assert_eq!(run(1e-4).code, 0);
}
