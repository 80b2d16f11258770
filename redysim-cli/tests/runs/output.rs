//! Where `-o` leads: links are followed, what is no file is written into, and a full disk leaves nothing behind.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};

use crate::common::{Run, bash, fail, model, names, on_a_full_disk, program, scenario, scratch, succeed};

fn generate(folder: &Path, options: &[&str]) -> String {
    succeed(folder, &[&["generate", &model("two_link.toml"), "--quiet"], options].concat())
}

/// ESC, the C1 control CSI, a bell and ends of lines in every name of a model and its scenario.
#[test]
fn control_characters_of_names_do_not_reach_the_terminal() {
    const ODD: &str = "\\u001b[31m\\u009b1m\\u0007\\r";
    let folder = scratch("output-control");
    let text = fs::read_to_string(model("fourbar.toml")).unwrap();
    let odd = text.replace("\"crank\"", &format!("\"crank{ODD}\""));
    assert_ne!(odd, text);
    let odd = odd.replace("name = \"fourbar\"", &format!("name = \"fourbar{ODD}\""));
    fs::write(folder.join("model.toml"), &odd).unwrap();
    fs::write(folder.join("wrong.toml"), odd.replace("mass = ", "mass = -")).unwrap();
    let rest = "[forward]\nend = 0.1\nstep = 0.05\ninitial = { q = [1, 1] }\n";
    fs::write(folder.join("trial.toml"), format!("name = \"trial{ODD}\"\nmodel = 'model.toml'\n{rest}")).unwrap();
    let start = "initial = { q = { \"crank\\u001b\" = 1 } }\n[forward]\nend = 0.1\nstep = 0.05\n";
    fs::write(folder.join("start.toml"), format!("model = 'model.toml'\n{start}")).unwrap();
    let mut shown = 0;
    for arguments in [
        &["check", "model.toml"][..],
        &["check", "wrong.toml"],
        &["forward", "trial.toml", "-o", "run"],
        &["forward", "start.toml"],
        &["generate", "model.toml", "-o", "a.rs"],
        &["plot", "run"],
        &["show", "model.toml", "-o", "page.html"],
    ] {
        let output = crate::common::call(&folder, arguments).output();
        assert!(!output.contains(|c: char| c.is_control() && c != '\n'), "{arguments:?}: {output:?}");
        shown += output.matches("\\u{1b}").count();
    }
    assert!(shown > 5, "{shown}");
}

#[test]
fn the_file_that_a_link_leads_to_is_the_one_that_is_replaced() {
    let folder = scratch("output-link");
    fs::create_dir(folder.join("src")).unwrap();
    fs::write(folder.join("src/true.rs"), "before").unwrap();
    symlink("true.rs", folder.join("src/near.rs")).unwrap();
    symlink("src/near.rs", folder.join("far.rs")).unwrap();
    let source = generate(&folder, &[]);
    fail(&folder, &["generate", &model("two_link.toml"), "-o", "far.rs"], 3);
    assert_eq!(fs::read_to_string(folder.join("src/true.rs")).unwrap(), "before");
    generate(&folder, &["-o", "far.rs", "--force"]);
    assert_eq!(fs::read_to_string(folder.join("src/true.rs")).unwrap(), source);
    assert_eq!(fs::read_link(folder.join("far.rs")).unwrap(), PathBuf::from("src/near.rs"));
    assert_eq!(names(&folder.join("src")), ["near.rs", "true.rs"]);
}

#[test]
fn a_link_to_a_file_that_is_yet_to_be_made_makes_it() {
    let folder = scratch("output-dangling");
    symlink("later.rs", folder.join("link.rs")).unwrap();
    generate(&folder, &["-o", "link.rs"]);
    assert!(folder.join("later.rs").is_file() && folder.join("link.rs").is_symlink());
    symlink("round.rs", folder.join("round.rs")).unwrap();
    let output = fail(&folder, &["generate", &model("two_link.toml"), "-o", "round.rs", "--force"], 3);
    assert!(output.contains("cannot write round.rs"), "{output}");
}

#[test]
fn what_is_made_of_a_file_never_takes_its_place() {
    let folder = scratch("output-itself");
    fs::copy(model("kr5.toml"), folder.join("kr5.toml")).unwrap();
    symlink("kr5.toml", folder.join("alias.toml")).unwrap();
    for target in ["kr5.toml", "./kr5.toml", "alias.toml"] {
        let output = fail(&folder, &["generate", "kr5.toml", "-o", target, "--force"], 2);
        assert!(output.contains("is what it would be made of") && output.contains("--output"), "{output}");
    }
    assert_eq!(fs::read(folder.join("kr5.toml")).unwrap(), fs::read(model("kr5.toml")).unwrap());
}

#[test]
fn a_replaced_file_keeps_its_permissions() {
    let folder = scratch("output-permissions");
    let path = folder.join("secret.rs");
    fs::write(&path, "before").unwrap();
    fs::set_permissions(&path, PermissionsExt::from_mode(0o600)).unwrap();
    generate(&folder, &["-o", "secret.rs", "--force"]);
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
}

/// As a device is.
#[test]
fn a_pipe_with_a_name_is_written_into_and_stays_one() {
    let folder = scratch("output-pipe");
    let source = generate(&folder, &[]);
    for options in ["", "--force"] {
        let command = format!(
            "rm -f pipe; mkfifo pipe; timeout 10 cat pipe > got & \"$0\" generate \"$1\" -o pipe {options} --quiet && wait && test -p pipe"
        );
        let run = bash(&folder, &command, &[&model("two_link.toml")]);
        assert_eq!(run.code, 0, "{}", run.output());
        assert_eq!(fs::read_to_string(folder.join("got")).unwrap(), source);
    }
    assert_eq!(names(&folder), ["got", "pipe"]);
}

#[test]
fn the_standard_output_is_a_place_like_any_other() {
    let folder = scratch("output-stdout");
    let source = generate(&folder, &[]);
    assert_eq!(generate(&folder, &["-o", "/dev/stdout"]), source);
    // Be it a file, which then is added to.
    let command = "echo first > got; \"$0\" generate \"$1\" -o /dev/stdout --quiet >> got";
    assert_eq!(bash(&folder, command, &[&model("two_link.toml")]).code, 0);
    assert_eq!(fs::read_to_string(folder.join("got")).unwrap(), format!("first\n{source}"));
}

#[test]
fn a_full_disk_leaves_nothing_half_written() {
    let folder = scratch("output-full");
    let swing = "initial = { q = [0, 1] }\nforward = { end = 1.0, step = 0.01 }\n";
    scenario(&folder, "two_link.toml", swing);
    succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    fs::write(folder.join("robot.urdf"), chain(20)).unwrap();
    let model = model("two_link.toml");
    let before = (names(&folder), names(&folder.join("run")));
    for (kilobytes, arguments) in [
        (1, &["plot", "run"][..]),
        // Some of the pictures find room.
        (60, &["plot", "run", "-o", "pictures"]),
        (1, &["animate", "run"]),
        (1, &["show", &model]),
        (1, &["generate", &model, "-o", "model.rs"]),
        (1, &["import", "robot.urdf", "-o", "robot.toml"]),
    ] {
        let output = on_a_full_disk(&folder, kilobytes, arguments);
        assert!(output.contains("error: cannot write"), "{arguments:?}: {output}");
        assert_eq!((names(&folder), names(&folder.join("run"))), before, "{arguments:?}: {output}");
    }
    let output = on_a_full_disk(&folder, 1, &["forward", "trial.toml", "-o", "another"]);
    assert!(output.contains("cannot write the table ") && output.contains("make room on the disk"), "{output}");
}

#[test]
fn a_full_disk_leaves_none_of_the_files_that_belong_together() {
    let folder = scratch("output-full-together");
    let model = model("two_link.toml");
    for options in [&["--language", "c"][..], &["--language", "cpp"], &["--mex"], &["--fmu", "--source-only"]] {
        let generate = |out: &'static str| [&["generate", &model, "--quiet", "-o", out][..], options].concat();
        succeed(&folder, &generate("whole"));
        let files = || names(&folder.join("whole")).into_iter().map(|name| folder.join("whole").join(name));
        let contents: Vec<Vec<u8>> = files().map(|path| fs::read(path).unwrap()).collect();
        let largest = contents.iter().map(Vec::len).max().unwrap();
        let kilobytes = u32::try_from((largest - 1) / 1024).unwrap();
        let error = on_a_full_disk(&folder, kilobytes, &generate("none"));
        assert_eq!(error.matches("error: ").count(), 1, "{options:?}: {error}");
        assert!(error.contains("error: cannot write none/two_link"), "{options:?}: {error}");
        assert_eq!(names(&folder), ["whole"], "{options:?}");
        // Those that are there stay as they are.
        on_a_full_disk(&folder, kilobytes, &[&generate("whole")[..], &["--force", "--name", "two_link"]].concat());
        assert!(files().map(|path| fs::read(path).unwrap()).eq(contents), "{options:?}");
        fs::remove_dir_all(folder.join("whole")).unwrap();
    }
}

#[test]
fn a_full_device_is_reported() {
    let folder = scratch("output-full-device");
    let output = fail(&folder, &["generate", &model("two_link.toml"), "-o", "/dev/full"], 3);
    assert!(output.contains("cannot write /dev/full"), "{output}");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let run = Run::of(program(&folder, &["completions", "bash"]).stdout(full));
    assert!(run.code == 3 && run.stderr.contains("cannot write the output"), "{}", run.stderr);
}

/// A URDF of so many links, one on the other.
fn chain(links: usize) -> String {
    let link = |k: usize| {
        format!(
            "<link name=\"l{k}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" \
             iyz=\"0\"/></inertial></link>\n"
        )
    };
    let joint = |k: usize| {
        format!(
            "<joint name=\"j{k}\" type=\"continuous\"><parent link=\"l{}\"/><child link=\"l{k}\"/></joint>\n",
            k - 1
        )
    };
    let (links, joints): (String, String) = ((0..=links).map(link).collect(), (1..=links).map(joint).collect());
    format!("<robot name=\"chain\">\n{links}{joints}</robot>\n")
}
