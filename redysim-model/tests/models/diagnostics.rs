//! Each file in `models/fail` has faults, each in `models/warn` only odd values. Beside it stands the text that a user
//! sees. After a deliberate change, `BLESS=1 cargo test -p redysim-model --test models diagnostics::` writes the texts anew.

use redysim_model::{Diagnostic, Loaded, Model};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("models")
}

/// The stems of the files in `folder` with this extension.
fn stems(folder: &str, extension: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(models().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let wanted = entries.filter(|path| path.extension().is_some_and(|found| found == extension));
    wanted.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
}

/// Compares what `shown` makes of each TOML file in `folder` with the text beside it.
fn compare(folder: &str, shown: impl Fn(String, &str) -> String) {
    let bless = std::env::var_os("BLESS").is_some();
    let mut differences = Vec::new();
    for stem in stems(folder, "toml") {
        let name = format!("models/{folder}/{stem}.toml");
        let text = fs::read_to_string(models().join(folder).join(format!("{stem}.toml"))).unwrap();
        let shown = shown(text, &name) + "\n";
        let expected_path = models().join(folder).join(format!("{stem}.txt"));
        if bless {
            fs::write(expected_path, shown).unwrap();
        } else {
            let expected = fs::read_to_string(&expected_path).unwrap_or("(no text beside the file)".into());
            if shown != expected {
                differences.push(format!("{name}\n--- expected\n{expected}\n--- found\n{shown}"));
            }
        }
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    assert_eq!(stems(folder, "txt"), stems(folder, "toml"), "each text belongs to a file");
}

fn all(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(Diagnostic::to_string).collect::<Vec<_>>().join("\n\n")
}

#[test]
fn every_fault_is_shown_where_it_stands() {
    compare("fail", |text, name| Model::from_toml(text, name).expect_err(name).to_string());
}

#[test]
fn warnings_let_a_model_pass() {
    compare("warn", |text, name| {
        all(&Model::from_toml(text, name).unwrap_or_else(|faults| panic!("{faults}")).warnings)
    });
}

#[test]
fn good_models_load_without_warnings() {
    for name in ["kr5", "gripper"] {
        let Loaded { model, warnings, .. } = Model::load(models().join(format!("{name}.toml"))).unwrap();
        assert_eq!(all(&warnings), "");
        assert_eq!(model.name, name);
    }
}

#[test]
fn table_2_has_an_impossible_last_link() {
    let loaded = Model::load(models().join("kr5_table2.toml")).unwrap();
    let [warning] = loaded.warnings.as_slice() else { panic!("{}", all(&loaded.warnings)) };
    assert!(warning.title().contains("link `link6`") && warning.title().contains("by 1e-6 kg m²"), "{warning}");
}

/// Each table stands between `<!-- keys: OWNER -->` and `<!-- end -->`.
#[test]
fn the_documentation_lists_every_key_with_its_example_default_and_meaning() {
    let path = models().join("../docs/models.md");
    let written = fs::read_to_string(&path).unwrap();
    let mut expected = written.clone();
    let tables = redysim_model::key_documentation();
    for (owner, table) in &tables {
        let head = format!("<!-- keys: {owner} -->\n");
        let begin = expected.find(&head).unwrap_or_else(|| panic!("docs/models.md has no line {head}")) + head.len();
        let length = expected[begin..].find("<!-- end -->").expect("the end of the table");
        expected.replace_range(begin..begin + length, table);
    }
    assert_eq!(written.matches("<!-- keys: ").count(), tables.len(), "tables of keys that do not exist");
    if std::env::var_os("BLESS").is_some() {
        fs::write(&path, &expected).unwrap();
    } else {
        assert!(written == expected, "BLESS=1 writes the tables of docs/models.md anew");
    }
}

#[test]
fn every_key_states_its_default_or_that_it_is_required() {
    let tables = redysim_model::key_documentation();
    let keys = tables.iter().filter(|(owner, _)| *owner != "Lints");
    for (owner, row) in keys.flat_map(|(owner, table)| table.lines().skip(2).map(move |row| (owner, row))) {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").collect();
        assert!(cells.len() == 4 && !cells[2].trim().is_empty(), "{owner}: {row}");
    }
}

/// Of the documentation of the model file.
#[test]
fn pictures_that_the_documentation_names_are_there() {
    let documentation = fs::read_to_string(models().join("../docs/models.md")).unwrap();
    let pictures: Vec<&str> =
        documentation.split("](pictures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert_eq!(pictures.len(), 4);
    for picture in pictures {
        let text = fs::read_to_string(models().join("../docs/pictures").join(picture)).unwrap();
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{picture}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_a_diagnostic() {
    let shown = |path: PathBuf| {
        let faults = Model::load(&path).unwrap_err();
        let [fault] = &faults.diagnostics[..] else { panic!("{faults}") };
        assert_eq!((fault.position(), fault.file()), (None, path.to_str().unwrap()));
        assert!(faults.to_string().contains(fault.file()), "{faults}");
        fault.title().to_owned()
    };
    assert!(shown(models().join("nowhere.toml")).starts_with("cannot read the model file: "));
    assert_eq!(shown(models()), "cannot read the model file: it is a directory");
    let binary = tempfile::NamedTempFile::new().unwrap();
    fs::write(&binary, b"name = \"\xff\"").unwrap();
    assert_eq!(shown(binary.path().to_owned()), "the model file is not UTF-8: line 1 has another encoding (byte 9)");
    fs::write(&binary, b"\xff\xfen\0a\0").unwrap();
    assert_eq!(shown(binary.path().to_owned()), "the model file is UTF-16, not UTF-8");
}

#[test]
fn a_missing_file_is_reported_with_the_folder_from_which_its_path_is_taken() {
    let faults = Model::load("nowhere/at_all.toml").unwrap_err();
    let current = std::env::current_dir().unwrap();
    let wanted = format!("A path is taken from the current folder, {}", current.display());
    assert!(faults.to_string().contains(&wanted), "{faults}");
}

#[test]
fn invalid_files_have_a_public_interface() {
    for (name, links, joints) in [
        ("duplicate_key", ["upper", "fore"], ["upper", "fore"]),
        ("many_faults", ["upper", "fore"], ["upper", "fore"]),
        ("missing_key", ["link #1", "fore"], ["link #1", "fore"]),
        ("duplicate_joint", ["upper", "fore"], ["upper", "upper"]),
    ] {
        let interface = Model::load(models().join(format!("fail/{name}.toml"))).unwrap_err().interface;
        assert_eq!(interface.name, "arm", "{name}");
        assert_eq!(interface.links, links, "{name}");
        let found: Vec<_> = interface
            .joints
            .iter()
            .map(|joint| (joint.name.as_str(), joint.coordinates.len(), joint.velocities.len()))
            .collect();
        assert_eq!(found, joints.map(|joint| (joint, 1, 1)), "{name}");
    }
    let fixed = Model::load(models().join("fail/axis_on_fixed.toml")).unwrap_err().interface;
    assert_eq!(fixed.joints.len(), 1);
    assert_eq!(fixed.joints[0].name, "upper");
}

/// A suggestion compares a name with all others, so that of very many unknown ones only those that are shown have it.
#[test]
fn of_very_many_unknown_links_those_that_are_shown_have_a_suggestion() {
    let link = |index: usize| {
        let keys = "joint = 'revolute'\naxis = [0, 0, 1]\nmass = 1.0\ncom = [1, 0, 0]\n";
        format!("[[link]]\nname = 'body{index}'\nparent = 'boddy{index}'\n{keys}")
    };
    let links: String = (0..30).map(link).collect();
    let faults = Model::from_toml(format!("name = 'm'\ngravity = [0, 0, 0]\n{links}"), "m.toml").unwrap_err();
    let has_suggestion: Vec<bool> = faults.errors().map(|error| error.help().contains("did you mean")).collect();
    assert_eq!(has_suggestion, (0..30).map(|index| index < 20).collect::<Vec<_>>());
}
